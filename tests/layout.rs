//! The data layouts and constants of the shaders against those in Rust.

use std::mem::offset_of;

use cusp_slicer::ldi::layout::{
    CELL_FACETS, COLLECT as WORKGROUP, Cell, FILL, PEEL, SCAN_BLOCK, Tile,
};
use cusp_slicer::ldi::projection::STEPS;
use naga::{Expression, Literal, Module, TypeInner};

const SCAN: &str = include_str!("../shaders/scan.wgsl");
const COLLECT: &str = include_str!("../shaders/collect.wgsl");

fn parse(source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap()
}

/// Names and offsets of the members of a shader's struct, and its size.
fn layout(module: &Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let (_, found) = module
        .types
        .iter()
        .find(|(_, found)| found.name.as_deref() == Some(name))
        .unwrap();
    let TypeInner::Struct { members, span } = &found.inner else {
        panic!("{name} is not a struct")
    };
    let members = members
        .iter()
        .map(|member| (member.name.clone().unwrap(), member.offset as usize))
        .collect();
    (members, *span as usize)
}

/// An integer constant of a shader.
fn constant(module: &Module, name: &str) -> i64 {
    let (_, found) = module
        .constants
        .iter()
        .find(|(_, found)| found.name.as_deref() == Some(name))
        .unwrap();
    match module.global_expressions[found.init] {
        Expression::Literal(Literal::I32(value)) => i64::from(value),
        Expression::Literal(Literal::U32(value)) => i64::from(value),
        Expression::Literal(Literal::F32(value)) if value.fract() == 0.0 => value as i64,
        ref other => panic!("{name} is {other:?}"),
    }
}

/// A struct of a shader has this size and these members at these offsets.
fn assert_layout(source: &str, name: &str, size: usize, members: &[(&str, usize)]) {
    let expected = members.iter().map(|&(name, at)| (name.to_owned(), at));
    assert_eq!(layout(&parse(source), name), (expected.collect(), size));
}

#[test]
fn tile_is_laid_out_as_the_shader_reads_it() {
    let members = [
        ("origin", offset_of!(Tile, origin)),
        ("size", offset_of!(Tile, size)),
    ];
    assert_layout(FILL, "Tile", size_of::<Tile>(), &members);
}

#[test]
fn cell_is_laid_out_as_the_shader_reads_it() {
    let members = [
        ("corner", offset_of!(Cell, corner)),
        ("first", offset_of!(Cell, first)),
    ];
    assert_layout(COLLECT, "Cell", size_of::<Cell>(), &members);
}

#[test]
fn constants_that_stand_on_both_sides_agree() {
    assert_eq!(constant(&parse(FILL), "STEPS"), STEPS);
    let least = constant(&parse(PEEL), "LEAST");
    assert_eq!(constant(&parse(COLLECT), "LEAST"), least);
    // The greatest half-precision number is reserved for the end behind all facets.
    let of_half = |half: u32| i64::from(half + (112 << 10));
    assert_eq!(least, of_half(0x400));
    assert_eq!(least + CELL_FACETS as i64, of_half(0x7bff));
    let sides = ["COLUMNS", "ROWS"].map(|name| constant(&parse(COLLECT), name));
    assert_eq!(sides, WORKGROUP.map(i64::from));
    let scan = parse(SCAN);
    assert_eq!(constant(&scan, "BLOCK"), i64::from(SCAN_BLOCK));
    assert_eq!(
        constant(&scan, "THREADS") * constant(&scan, "RUN"),
        i64::from(SCAN_BLOCK)
    );
}

#[test]
fn workgroups_cover_the_rays_that_are_dispatched() {
    let module = parse(COLLECT);
    assert!(!module.entry_points.is_empty());
    for entry in &module.entry_points {
        let expected = [WORKGROUP[0], WORKGROUP[1], 1];
        assert_eq!(entry.workgroup_size, expected, "{}", entry.name);
    }
}

/// WebGPU's compatibility mode allows 128 threads and four storage buffers.
#[test]
fn compute_passes_are_within_the_limits_of_compatible_adapters() {
    for module in [SCAN, COLLECT].map(parse) {
        for entry in &module.entry_points {
            assert!(entry.workgroup_size.iter().product::<u32>() <= 128);
        }
        let globals = module.global_variables.iter();
        assert!(globals.filter(|(_, global)| is_storage(global)).count() <= 4);
    }
}

fn is_storage(global: &naga::GlobalVariable) -> bool {
    matches!(global.space, naga::AddressSpace::Storage { .. })
}

#[test]
fn the_shaders_are_valid() {
    for source in [FILL, PEEL, SCAN, COLLECT] {
        let flags = naga::valid::ValidationFlags::all();
        naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
            .validate(&parse(source))
            .unwrap();
    }
}

/// Adapters of WebGPU's compatibility mode have no storage buffers in the vertex and fragment stages.
#[test]
fn peeling_draws_without_storage_buffers() {
    let module = parse(PEEL);
    let mut globals = module.global_variables.iter();
    assert!(globals.all(|(_, global)| !is_storage(global)));
}
