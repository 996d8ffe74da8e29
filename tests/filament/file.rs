//! A 3MF as its readers see it, and what PrusaSlicer makes of a layer height profile.

use std::io::{Cursor, Read};

use cusp_slicer::format::Format;

/// A 3MF as its readers see it.
pub struct Read3mf {
    pub application: String,
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[usize; 3]>,
    /// The place to which the object is moved.
    pub moved: [f64; 2],
    pub profile: Vec<f64>,
}

impl Read3mf {
    pub fn height_mm(&self) -> f64 {
        let z = self.vertices.iter().map(|vertex| vertex[2]);
        f64::from(z.clone().fold(f32::MIN, f32::max)) - f64::from(z.fold(f32::MAX, f32::min))
    }
}

fn attribute<'a>(tag: &'a str, name: &str) -> &'a str {
    let (_, rest) = tag.split_once(&format!(" {name}=\"")).unwrap();
    rest.split_once('"').unwrap().0
}

/// Reads a 3MF, and checks what every reader asks for.
pub fn read(bytes: &[u8], profile_name: &str) -> Read3mf {
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut text = |name: &str| {
        let mut text = String::new();
        let mut file = zip.by_name(name).unwrap();
        let date = file.last_modified().unwrap();
        assert_eq!((date.year(), date.month(), date.day()), (1980, 1, 1));
        file.read_to_string(&mut text).unwrap();
        text
    };
    assert!(text("[Content_Types].xml").contains("Extension=\"model\""));
    assert!(text("_rels/.rels").contains("Target=\"/3D/3dmodel.model\""));
    let model = text("3D/3dmodel.model");
    assert!(model.contains(" unit=\"millimeter\""));
    let tags = |name: &str| {
        let opening = format!("<{name} ");
        let tags = model.split(opening.as_str()).skip(1);
        tags.map(|rest| format!(" {}", rest.split_once("/>").unwrap().0))
            .collect::<Vec<_>>()
    };
    let vertices = tags("vertex").into_iter();
    let triangles = tags("triangle").into_iter();
    let [item] = &tags("item")[..] else {
        panic!("one item");
    };
    let transform: Vec<f64> = attribute(item, "transform")
        .split(' ')
        .map(|number| number.parse().unwrap())
        .collect();
    assert_eq!(
        transform[..9],
        [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    );
    let (_, application) = model.split_once("name=\"Application\">").unwrap();
    let line = text(profile_name);
    let values = line.strip_prefix("object_id=1|").unwrap();
    let values = values.strip_suffix('\n').unwrap();
    Read3mf {
        application: application.split_once('<').unwrap().0.to_owned(),
        vertices: vertices
            .map(|tag| ["x", "y", "z"].map(|axis| attribute(&tag, axis).parse().unwrap()))
            .collect(),
        triangles: triangles
            .map(|tag| ["v1", "v2", "v3"].map(|corner| attribute(&tag, corner).parse().unwrap()))
            .collect(),
        moved: [transform[9], transform[10]],
        profile: values
            .split(';')
            .map(|value| {
                // As printf's %f writes it.
                let (_, decimals) = value.split_once('.').unwrap();
                assert_eq!(decimals.len(), 6, "{value}");
                value.parse().unwrap()
            })
            .collect(),
    }
}

/// Name under which the slicer of a format looks for the profile.
pub fn profile_name(format: Format) -> &'static str {
    match format {
        Format::Orca3mf => "Metadata/layer_heights_profile.txt",
        _ => "Metadata/Slic3r_PE_layer_heights_profile.txt",
    }
}

/// The tops of the layers that PrusaSlicer makes of a profile; `None` if it drops the profile in silence.
pub fn layers_of_prusa_slicer(
    profile: &[f64],
    height_mm: f64,
    first_layer_mm: f64,
    least_mm: f64,
) -> Option<Vec<f64>> {
    if profile.len() <= 4
        || !profile.len().is_multiple_of(2)
        || (profile[profile.len() - 2] - height_mm).abs() > 1e-3
    {
        return None;
    }
    let points: Vec<[f64; 2]> = profile.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
    let thickness_at = |z_mm: f64| {
        let place = points.iter().rposition(|point| point[0] <= z_mm).unwrap();
        let [below_mm, below] = points[place];
        match points.get(place + 1) {
            None => below,
            Some(&[above_mm, above]) => {
                below + (above - below) * (z_mm - below_mm) / (above_mm - below_mm)
            }
        }
    };
    let mut tops = vec![first_layer_mm];
    let mut print_mm = first_layer_mm;
    loop {
        let thickness_mm = thickness_at(print_mm + least_mm / 2.0);
        if print_mm + thickness_mm / 2.0 >= height_mm {
            return Some(tops);
        }
        print_mm += thickness_mm;
        tops.push(print_mm);
    }
}
