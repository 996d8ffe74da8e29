//! Printers and resins as data: plates, what printers refuse, exposures.

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::format::{Format, FormatThicknesses};
use cusp_slicer::job::{Backend, Options, Report};
use cusp_slicer::printer::{PRINTERS, VariableLayers, named};
use cusp_slicer::resin::Resin;
use cusp_slicer::warning::Warning;

#[test]
fn exposures_follow_the_curve_or_the_table() {
    let resin = Resin::default();
    assert_eq!(resin.exposure_s(0.05), 3.0);
    // Jacobs: the exposure is proportional to exp(thickness / penetration).
    assert_near(resin.exposure_s(0.1), 3.0 * (0.05f64 / 0.15).exp(), 1e-3);
    assert_near(
        resin.overhead_s(),
        1.0 + 60.0 * (5.0 / 65.0 + 5.0 / 150.0),
        1e-9,
    );
    let measured = Resin {
        exposures: vec![[0.05, 2.0], [0.1, 3.0]],
        ..resin.clone()
    };
    let exposures =
        [0.02, 0.05, 0.075, 0.1, 0.2].map(|thickness_mm| measured.exposure_s(thickness_mm));
    // Beyond the pairs, the curve through both: a factor of 1.5 in 0.05 mm.
    let beyond = [2.0 * 1.5_f64.powf(-0.6), 3.0 * 1.5_f64.powi(2)];
    assert_near(exposures[0], beyond[0], 1e-3);
    assert_eq!(exposures[1..4], [2.0, 2.5, 3.0]);
    assert_near(exposures[4], beyond[1], 1e-3);
    assert_eq!(
        resin.exposures_s(&[0.05; 6]),
        [30.0, 30.0, 30.0, 30.0, 3.0, 3.0]
    );
    assert_near(
        resin.print_time_s(&[0.05; 6]),
        126.0 + 6.0 * resin.overhead_s(),
        1e-4,
    );
    for wrong in [
        Resin {
            exposure_s: f64::NAN,
            ..resin.clone()
        },
        Resin {
            penetration_mm: 0.0,
            ..resin.clone()
        },
        Resin {
            exposures: vec![[0.1, 2.0], [0.1, 3.0]],
            ..resin.clone()
        },
        Resin {
            exposures: vec![[0.1, -2.0]],
            ..resin
        },
    ] {
        assert!(wrong.check().is_err(), "{wrong:?}");
    }
}

#[test]
fn layers_beyond_measured_exposures_follow_the_curve_with_a_warning() {
    let tower = solids::cuboid(glam::Vec3::new(3.0, 3.0, 12.0));
    let mut slicer = Slicer::load(&binary_stl(&tower)).unwrap();
    let mut plan = |exposures: &[[f64; 2]], layer_max_mm| {
        let options = Options {
            resin: Resin {
                exposures: exposures.to_vec(),
                ..Resin::default()
            },
            layer_max_mm,
            format: Some(Format::Nanodlp),
            rays: 50,
            backend: Backend::Cpu,
            ..Options::default()
        };
        let report = pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
        let warned = report.warnings.iter().find_map(|warning| match *warning {
            Warning::ExtrapolatedExposures {
                layers,
                thinnest_mm,
                thickest_mm,
            } => Some((layers, [thinnest_mm, thickest_mm])),
            _ => None,
        });
        let longest_s = report.exposure_s[4..].iter().copied().fold(0.0, f64::max);
        let beyond = report.thickness_mm[4..]
            .iter()
            .filter(|&&it| it > 0.1 + 1e-6);
        (longest_s, warned, beyond.count())
    };
    let measured = [[0.05, 2.4], [0.1, 3.5]];
    let (longest_s, warned, beyond) = plan(&measured, None);
    assert_eq!(longest_s, 5.104);
    assert!(beyond > 60);
    assert_eq!(warned, Some((beyond, [0.05, 0.1])));
    // Limits keep a plan within what is measured.
    assert_eq!(plan(&measured, Some(0.1)), (3.5, None, 0));
    // A single pair holds for all thicknesses.
    let (longest_s, warned, _) = plan(&measured[1..], None);
    assert_eq!((longest_s, warned), (3.5, None));
}

#[test]
fn printers_are_what_their_data_says() {
    for printer in PRINTERS.iter() {
        let name = &printer.name;
        assert_eq!(named(name).as_ref(), Some(printer));
        assert_eq!(printer.check(), Ok(()), "{name}");
        for axis in 0..2 {
            let side_mm = f64::from(printer.pixels[axis]) * printer.pitch_um[axis] / 1e3;
            assert_near(side_mm, printer.volume_mm[axis], 0.005);
        }
        assert!(!printer.reads.is_empty(), "{name}");
        assert!(!printer.variable_layers_source.is_empty(), "{name}");
        let has_version = printer.format == Format::PhotonWorkshop;
        assert_eq!(printer.file_version.is_some(), has_version, "{name}");
        if printer.format.thicknesses() != FormatThicknesses::Any {
            assert_eq!(printer.variable_layers, VariableLayers::No, "{name}");
        }
    }
    let direct = |format: Format| {
        let reads = PRINTERS.iter();
        let reads = reads.filter(|printer| printer.reads_format && printer.format == format);
        reads.count()
    };
    let counts = Format::MASKS.map(|format| (format.name(), direct(format)));
    assert_eq!(
        counts,
        [
            ("png", 0),
            ("chitubox", 10),
            ("uvj", 0),
            ("sl1", 2),
            ("goo", 13),
            ("photon-workshop", 19),
            ("anycubic-zip", 6),
            ("ctb", 25),
            ("nanodlp", 2),
        ]
    );
    let on = |name: &str, triangles: &solids::Triangles| {
        let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
        let options = Options {
            printer: Some(name.into()),
            backend: Backend::Cpu,
            ..Options::default()
        };
        pollster::block_on(slicer.plan(&options, &mut quiet)).cloned()
    };
    let cube = solids::cube(2.0);
    let report = on("saturn-3-ultra", &cube).unwrap();
    let mask = &report.mask;
    assert_eq!((mask.width, mask.height), (11520, 5120));
    assert_eq!(
        (mask.pitch_mm, mask.pitch_y_mm, mask.is_mirrored),
        (0.019, 0.024, true)
    );
    // Rays only over the model: 105 columns and 83 rows, two hits per ray.
    assert!(
        (2 * 100 * 80..2 * 110 * 90).contains(&report.models[0].hits),
        "{}",
        report.models[0].hits
    );
    assert_near(report.resin_ml, 0.008, 2e-4);
    let code = |result: Result<Report, Error>| result.unwrap_err().code();
    assert_eq!(code(on("no-such-printer", &cube)), "unknown-printer");
    assert_eq!(
        code(on(
            "shuffle",
            &solids::cuboid(glam::Vec3::new(70.0, 5.0, 5.0))
        )),
        "model-too-large"
    );
    assert_eq!(
        code(on(
            "shuffle",
            &solids::cuboid(glam::Vec3::new(5.0, 5.0, 201.0))
        )),
        "model-too-high"
    );
}
