use wasm_encoder::{
    CodeSection, ConstExpr, ElementSection, Elements, ExportKind, ExportSection, Function,
    FunctionSection, ImportSection, MemorySection, MemoryType, Module, RefType, TableSection,
    TableType, TypeSection, ValType,
};
use wasmparser::Validator;

use super::*;

const LATER: LaterExports = LaterExports {
    names: &["check", "plate"],
};

/// Numbers of the functions of [`whole`].
const SCRIPT: u32 = 0;
const SHARED: u32 = 1;
const PLAN: u32 = 2;
const CHECK: u32 = 3;
const DEEP: u32 = 4;
const LISTED: u32 = 5;
const LISTED_LATER: u32 = 6;
const PLATE_ADD: u32 = 7;

/// A module whose functions take a number and return one. Its table lists some of them from place 1 on.
fn whole() -> Vec<u8> {
    let mut types = TypeSection::new();
    types.ty().function([ValType::I32], [ValType::I32]);
    let mut imports = ImportSection::new();
    imports.import("script", "call", EntityType::Function(0));

    let calls: [&[u32]; 7] = [
        &[],               // SHARED
        &[SHARED],         // PLAN
        &[SHARED, DEEP],   // CHECK
        &[SCRIPT],         // DEEP
        &[],               // LISTED
        &[SHARED, LISTED], // LISTED_LATER
        &[CHECK],          // PLATE_ADD
    ];
    let (mut functions, mut code) = (FunctionSection::new(), CodeSection::new());
    for called in calls {
        functions.function(0);
        let mut function = Function::new([]);
        let mut body = function.instructions();
        body.local_get(0);
        for &called in called {
            body.call(called);
        }
        body.end();
        code.function(&function);
    }

    let mut tables = TableSection::new();
    tables.table(TableType {
        element_type: RefType::FUNCREF,
        table64: false,
        minimum: 4,
        maximum: Some(4),
        shared: false,
    });
    let mut memories = MemorySection::new();
    memories.memory(MemoryType {
        minimum: 1,
        maximum: None,
        memory64: false,
        shared: false,
        page_size_log2: None,
    });
    let mut exports = ExportSection::new();
    exports
        .export("memory", ExportKind::Memory, 0)
        .export("plan", ExportKind::Func, PLAN)
        .export("checks", ExportKind::Func, SHARED)
        .export("check", ExportKind::Func, CHECK)
        .export("plate_add", ExportKind::Func, PLATE_ADD);
    let mut elements = ElementSection::new();
    let listed = [LISTED, LISTED_LATER, SHARED];
    elements.active(
        None,
        &ConstExpr::i32_const(1),
        Elements::Functions(listed.as_slice().into()),
    );

    let mut module = Module::new();
    module
        .section(&types)
        .section(&imports)
        .section(&functions)
        .section(&tables)
        .section(&memories)
        .section(&exports)
        .section(&elements)
        .section(&code);
    module.finish()
}

fn parts() -> Parts {
    split(&whole(), LATER, &BTreeSet::from([2])).unwrap()
}

/// Functions that a part defines.
fn defined(part: &Read<'_>) -> usize {
    part.functions() - part.imported_functions as usize
}

#[test]
fn both_parts_are_valid() {
    let Parts { first, later } = parts();
    Validator::new().validate_all(&first).unwrap();
    Validator::new().validate_all(&later).unwrap();
}

#[test]
fn each_function_is_in_one_part() {
    let Parts { first, later } = parts();
    let first = Read::new(&first).unwrap();
    // SHARED, PLAN and LISTED, and two calls through the table.
    assert_eq!(defined(&first), 5);
    assert_eq!(first.slots.keys().copied().collect::<Vec<_>>(), [1, 3]);
    assert_eq!(first.tables[0].ty.initial, 6);
    // CHECK, DEEP, LISTED_LATER and PLATE_ADD.
    assert_eq!(later_functions(&later), 4);
}

/// [`Read`] does not read modules that import a memory.
fn later_functions(later: &[u8]) -> u32 {
    let payloads = wasmparser::Parser::new(0).parse_all(later);
    let mut functions = payloads.filter_map(|payload| match payload.unwrap() {
        wasmparser::Payload::FunctionSection(functions) => Some(functions.count()),
        _ => None,
    });
    functions.next().unwrap()
}

#[test]
fn what_a_first_export_or_a_place_of_the_table_needs_is_first() {
    let module = whole();
    let module = Read::new(&module).unwrap();
    let first = |later_slots: &[u32]| {
        let slots = later_slots.iter().copied().collect();
        needed_at_first(&module, LATER, &slots).unwrap()
    };
    let [t, f] = [true, false];
    assert_eq!(first(&[2]), [t, t, t, f, f, t, f, f]);
    assert_eq!(first(&[]), [t, t, t, f, f, t, t, f]);
    // A function that another needs stays, although its place is used later only.
    assert_eq!(first(&[1, 2, 3]), [t, t, t, f, f, f, f, f]);
}

#[test]
fn a_name_stands_for_a_class_or_a_function() {
    for export in ["plate", "plate_add", "__wbg_plate_free"] {
        assert!(belongs(export, "plate"), "{export}");
    }
    for export in ["plates", "slicer_plate", "plat"] {
        assert!(!belongs(export, "plate"), "{export}");
    }
}

#[test]
fn a_name_without_an_export_is_an_error() {
    let later = LaterExports {
        names: &["check", "inspect"],
    };
    assert!(split(&whole(), later, &BTreeSet::new()).is_err());
}

#[test]
fn splitting_twice_gives_the_same() {
    let (one, other) = (parts(), parts());
    assert!(one.first == other.first && one.later == other.later);
}
