//! The pose of a model on the plate.

use glam::{DMat3, DQuat, DVec3};

use super::{MeshError, ModelUnit};

/// Pose of a model on the plate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose {
    /// A rotation from the pose in the file: a quaternion x, y, z, w of any length except 0.
    pub rotation: Option<[f64; 4]>,
    /// The height in millimetres to which the model is then scaled uniformly.
    pub height_mm: Option<f64>,
    /// The unit of the coordinates in the file; millimetres if absent. It does not matter if there is a height.
    pub unit: Option<ModelUnit>,
}

impl Pose {
    /// The pose in the file, scaled uniformly to a height.
    pub fn of_height(height_mm: f64) -> Self {
        Self {
            height_mm: Some(height_mm),
            ..Self::default()
        }
    }

    /// This pose, turned about z by `turns` times 15°, counter-clockwise as seen from above.
    #[must_use]
    pub fn turned(&self, turns: u32) -> Self {
        let step = (turns % TURNS) as usize;
        if step == 0 {
            return *self;
        }
        // Half the angle, as quaternions have it.
        let cos = if step <= 12 {
            COSINES[step]
        } else {
            -COSINES[TURNS as usize - step]
        };
        let sin = COSINES[step.abs_diff(12)];
        let [x, y, z, w] = self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
        Self {
            rotation: Some([
                cos * x - sin * y,
                cos * y + sin * x,
                cos * z + sin * w,
                cos * w - sin * z,
            ]),
            ..*self
        }
    }

    /// The factor from the coordinates in the file to millimetres, if there is no height.
    pub(crate) fn unit_mm(&self) -> f64 {
        self.unit.map_or(1.0, ModelUnit::mm)
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

/// Steps of 15° in a whole turn about z.
pub const TURNS: u32 = 24;

/// The cosines of 0°, 7.5° and so on up to 90°: constants, as libraries differ in the last bit.
const COSINES: [f64; 13] = [
    1.0,
    0.991_444_861_373_810_4,
    0.965_925_826_289_068_3,
    0.923_879_532_511_286_7,
    0.866_025_403_784_438_7,
    0.793_353_340_291_235_2,
    std::f64::consts::FRAC_1_SQRT_2,
    0.608_761_429_008_720_7,
    0.5,
    0.382_683_432_365_089_84,
    0.258_819_045_102_520_74,
    0.130_526_192_220_051_7,
    0.0,
];

/// The rotation matrix of a quaternion x, y, z, w of any length except 0.
pub(crate) fn rotation_matrix(rotation: [f64; 4]) -> Result<DMat3, MeshError> {
    let quaternion = DQuat::from_array(rotation);
    let length = quaternion.length();
    if !length.is_normal() {
        return Err(MeshError::BadRotation);
    }
    Ok(DMat3::from_quat(quaternion / length))
}
