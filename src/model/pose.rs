//! The pose of a model on the plate.

use glam::{DMat3, DQuat, DVec3};

use super::MeshError;

/// How a model stands on the plate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// A rotation from the pose in the file: a quaternion x, y, z, w of any length except 0.
    pub rotation: Option<[f64; 4]>,
    /// The height in millimetres to which the model is then scaled uniformly.
    pub height_mm: Option<f64>,
}

impl Pose {
    /// The pose in the file, scaled uniformly to a height.
    pub fn of_height(height_mm: f64) -> Self {
        Self {
            rotation: None,
            height_mm: Some(height_mm),
        }
    }

    /// The direction that points up from the plate, as a unit vector in the coordinates of the file.
    ///
    /// # Errors
    /// [`MeshError::BadRotation`].
    pub(crate) fn up(&self) -> Result<[f64; 3], MeshError> {
        let up = match self.rotation {
            None => DVec3::Z,
            Some(rotation) => rotation_matrix(rotation)?.row(2),
        };
        Ok(up.to_array())
    }
}

/// The rotation matrix of a quaternion x, y, z, w of any length except 0.
pub(crate) fn rotation_matrix(rotation: [f64; 4]) -> Result<DMat3, MeshError> {
    let quaternion = DQuat::from_array(rotation);
    let length = quaternion.length();
    if !length.is_normal() {
        return Err(MeshError::BadRotation);
    }
    Ok(DMat3::from_quat(quaternion / length))
}
