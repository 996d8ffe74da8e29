//! The shader's data layouts against the Rust structs that fill them.

#![cfg(not(target_arch = "wasm32"))]

use std::mem::offset_of;

use cusp_slicer::ldi::layout::{Corner, Tile};
use naga::{Module, TypeInner};

fn peel_shader() -> Module {
    naga::front::wgsl::parse_str(include_str!("../shaders/peel.wgsl")).unwrap()
}

/// Names and offsets of the members of a struct, and its size.
fn layout(module: &Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let (_, found) = module
        .types
        .iter()
        .find(|(_, found)| found.name.as_deref() == Some(name))
        .unwrap();
    let TypeInner::Struct { members, span } = &found.inner else {
        panic!("{name} is no struct")
    };
    let members = members
        .iter()
        .map(|member| (member.name.clone().unwrap(), member.offset as usize))
        .collect();
    (members, *span as usize)
}

#[test]
fn tile_is_laid_out_as_the_shader_reads_it() {
    let (members, size) = layout(&peel_shader(), "Tile");
    assert_eq!(size, size_of::<Tile>());
    let expected = [
        ("origin", offset_of!(Tile, origin)),
        ("size", offset_of!(Tile, size)),
        ("depth_per_mm", offset_of!(Tile, depth_per_mm)),
        ("steps", offset_of!(Tile, steps)),
    ];
    assert_eq!(
        members,
        expected.map(|(name, offset)| (name.to_owned(), offset))
    );
}

#[test]
fn corner_has_the_fields_that_the_shader_reads_in_order() {
    let (members, size) = layout(&peel_shader(), "Corner");
    // Vertex attributes are not laid out by WGSL's rules, but here the two agree.
    assert_eq!(size, size_of::<Corner>());
    let expected = [
        ("position", offset_of!(Corner, position)),
        ("z_mm", offset_of!(Corner, z_mm)),
        ("facet", offset_of!(Corner, facet)),
    ];
    assert_eq!(
        members,
        expected.map(|(name, offset)| (name.to_owned(), offset))
    );
}

#[test]
fn the_shader_is_valid() {
    let flags = naga::valid::ValidationFlags::all();
    naga::valid::Validator::new(flags, naga::valid::Capabilities::empty())
        .validate(&peel_shader())
        .unwrap();
}
