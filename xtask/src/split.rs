//! Splits a WebAssembly module into a first part, and a later part that is fetched when it is first needed.
//!
//! The later part has the functions that only certain exports need. It has no memory and no table of its own: it imports those of
//! the first part, and what it calls there, so no value is copied and no function is in both. In the first part each of those
//! exports is a call through an empty place of the table; the later part fills these places when it is instantiated.
//!
//! Which functions only those exports need is known from calls and from the module's table: a function whose address is taken is in
//! the table, and whoever calls it does so by its place there. After linking, such a place is a number like any other. Only the
//! linker knows which numbers are places, and in which code and data they are: see [`uses`].

mod module;
mod uses;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, bail};
use wasm_encoder::reencode::{Error, Reencode, RoundtripReencoder};
use wasm_encoder::{
    CodeSection, ConstExpr, ElementSection, Elements, EntityType, ExportKind, ExportSection,
    Function, FunctionSection, ImportSection, Module, RawSection, SectionId, StartSection,
    TableSection,
};

use module::{Read, Section};
pub use uses::{later_slots, without_relocations};

/// The name under which the later part imports the first.
const FIRST: &str = "first";

/// The exports that need the later part.
#[derive(Debug, Clone, Copy)]
pub struct LaterExports {
    /// A class with all its methods, or a function, or a method: `plate`, `price`, `slicer_inspect`, all in lower case.
    pub names: &'static [&'static str],
}

impl LaterExports {
    /// Whether an export belongs to one of the names.
    fn has(&self, export: &str) -> bool {
        self.names.iter().any(|name| belongs(export, name))
    }

    /// # Errors
    ///
    /// Fails if one of the names has no export.
    fn check(&self, module: &Read<'_>) -> Result<()> {
        for name in self.names {
            let mut exports = module.exports.iter();
            if !exports.any(|export| belongs(export.name, name)) {
                bail!("there is no export {name}");
            }
        }
        Ok(())
    }
}

fn belongs(export: &str, name: &str) -> bool {
    let own = export.strip_prefix("__wbg_").unwrap_or(export);
    own.strip_prefix(name)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

/// The two parts of a module.
pub struct Parts {
    pub first: Vec<u8>,
    pub later: Vec<u8>,
}

/// Splits a module. `later_slots` are the places of the table that only the later exports need, as [`uses::later_slots`] finds
/// them.
///
/// # Errors
///
/// Fails if the module is damaged, has no such exports, or has what no module of ours has.
pub fn split(bytes: &[u8], later: LaterExports, later_slots: &BTreeSet<u32>) -> Result<Parts> {
    let module = Read::new(bytes)?;
    later.check(&module)?;
    let is_first = needed_at_first(&module, later, later_slots)?;
    let plan = Plan::new(&module, later, &is_first)?;
    Ok(Parts {
        first: plan.first()?,
        later: plan.later()?,
    })
}

/// Whether each function is needed at first: by an export that is not later, by the start, or by a place of the table.
fn needed_at_first(
    module: &Read<'_>,
    later: LaterExports,
    later_slots: &BTreeSet<u32>,
) -> Result<Vec<bool>> {
    let exports = module.exports.iter();
    let exported = exports
        .filter(|export| export.kind == wasmparser::ExternalKind::Func && !later.has(export.name))
        .map(|export| export.index);
    let slots = module.slots.iter();
    let listed = slots
        .filter(|(slot, _)| !later_slots.contains(slot))
        .map(|(_, &function)| function);
    let mut found: Vec<u32> = exported.chain(listed).chain(module.start).collect();
    // What is imported comes from JavaScript, which the first part is bound to.
    found.extend(0..module.imported_functions);

    let mut is_first = vec![false; module.functions()];
    while let Some(function) = found.pop() {
        if !std::mem::replace(&mut is_first[function as usize], true) {
            found.extend(module.calls(function)?);
        }
    }
    Ok(is_first)
}

/// What becomes of each function.
struct Plan<'a> {
    module: &'a Read<'a>,
    is_first: &'a [bool],
    /// The later exports: the function of each, and the place of the table through which the first part calls it.
    stubs: BTreeMap<u32, u32>,
    /// The functions that the later part calls in the first.
    shared: Vec<u32>,
}

impl<'a> Plan<'a> {
    fn new(module: &'a Read<'a>, later: LaterExports, is_first: &'a [bool]) -> Result<Self> {
        let mut shared = BTreeSet::new();
        for (function, _) in is_first
            .iter()
            .enumerate()
            .filter(|(_, is_first)| !**is_first)
        {
            let calls = module.calls(function as u32)?;
            shared.extend(
                calls
                    .into_iter()
                    .filter(|&called| is_first[called as usize]),
            );
        }
        let exports = module
            .exports
            .iter()
            .filter(|export| later.has(export.name));
        let called: BTreeSet<u32> = exports
            .map(|export| export.index)
            .filter(|&function| !is_first[function as usize])
            .collect();
        let slots = module.table()?.ty.initial as u32..;
        Ok(Self {
            module,
            is_first,
            stubs: called.into_iter().zip(slots).collect(),
            shared: shared.into_iter().collect(),
        })
    }

    /// Defined functions of the first part, or of the later.
    fn defined(&self, of_first: bool) -> impl Iterator<Item = u32> {
        let all = self.module.imported_functions..self.module.functions() as u32;
        all.filter(move |&function| self.is_first[function as usize] == of_first)
    }

    /// The table with places for the later exports.
    fn tables(&self) -> Result<Vec<wasm_encoder::TableType>> {
        let tables = self.module.tables.iter().enumerate();
        tables
            .map(|(index, table)| {
                let mut ty = RoundtripReencoder.table_type(table.ty)?;
                if index as u32 == self.module.listing_table {
                    let stubs = self.stubs.len() as u64;
                    ty.minimum += stubs;
                    ty.maximum = ty.maximum.map(|most| most + stubs);
                }
                Ok(ty)
            })
            .collect()
    }

    fn first(&self) -> Result<Vec<u8>> {
        let module = self.module;
        let mut indices = Indices::default();
        let kept = (0..module.imported_functions).chain(self.defined(true));
        // Stubs have the numbers of the functions that they call.
        for function in kept.chain(self.stubs.keys().copied()) {
            indices.add(function);
        }

        let mut functions = FunctionSection::new();
        let mut code = CodeSection::new();
        for function in self.defined(true) {
            functions.function(module.type_of(function));
            indices.parse_function_body(&mut code, module.body(function))?;
        }
        for (&function, &slot) in &self.stubs {
            functions.function(module.type_of(function));
            code.function(&self.stub(function, slot)?);
        }

        let mut exports = ExportSection::new();
        for export in &module.exports {
            indices.parse_export(&mut exports, *export)?;
        }
        for &function in &self.shared {
            let index = indices.function_index(function)?;
            exports.export(&Name::Function(function).text(), ExportKind::Func, index);
        }
        for (name, kind, index, _) in self.shared_state()? {
            exports.export(&name, kind, index);
        }

        let mut elements = ElementSection::new();
        let slots = module
            .slots
            .iter()
            .map(|(&slot, &function)| (slot, function));
        let slots = slots.filter(|&(_, function)| self.is_first[function as usize]);
        self.list(&mut elements, slots, &mut indices)?;

        let mut out = Module::new();
        for section in &module.sections {
            match *section {
                Section::Raw { id, data } => out.section(&RawSection { id, data }),
                Section::Functions => out.section(&functions),
                Section::Tables => {
                    let mut section = TableSection::new();
                    for ty in self.tables()? {
                        section.table(ty);
                    }
                    out.section(&section)
                }
                Section::Exports => out.section(&exports),
                Section::Start(function) => out.section(&StartSection {
                    function_index: indices.function_index(function)?,
                }),
                Section::Elements => out.section(&elements),
                Section::Code => out.section(&code),
            };
        }
        Ok(out.finish())
    }

    fn later(&self) -> Result<Vec<u8>> {
        let module = self.module;
        let mut indices = Indices::default();
        for function in self.shared.iter().copied().chain(self.defined(false)) {
            indices.add(function);
        }

        let mut imports = ImportSection::new();
        for &function in &self.shared {
            let ty = EntityType::Function(module.type_of(function));
            imports.import(FIRST, &Name::Function(function).text(), ty);
        }
        for (name, _, _, ty) in self.shared_state()? {
            imports.import(FIRST, &name, ty);
        }

        let mut functions = FunctionSection::new();
        let mut code = CodeSection::new();
        for function in self.defined(false) {
            functions.function(module.type_of(function));
            indices.parse_function_body(&mut code, module.body(function))?;
        }

        let mut elements = ElementSection::new();
        let slots = module
            .slots
            .iter()
            .map(|(&slot, &function)| (slot, function));
        let slots = slots.filter(|&(_, function)| !self.is_first[function as usize]);
        let stubs = self.stubs.iter().map(|(&function, &slot)| (slot, function));
        self.list(&mut elements, slots.chain(stubs), &mut indices)?;

        let mut out = Module::new();
        let types = module.sections.iter().find_map(|section| match *section {
            Section::Raw { id, data } if id == SectionId::Type as u8 => {
                Some(RawSection { id, data })
            }
            _ => None,
        });
        out.section(&types.context("the module has no types")?)
            .section(&imports)
            .section(&functions)
            .section(&elements)
            .section(&code);
        Ok(out.finish())
    }

    /// A function that calls what the later part puts into a place of the table.
    fn stub(&self, function: u32, slot: u32) -> Result<Function> {
        let ty = self.module.type_of(function);
        let parameters = self.module.parameters(ty)?;
        let mut stub = Function::new([]);
        let mut code = stub.instructions();
        for parameter in 0..parameters {
            code.local_get(parameter);
        }
        code.i32_const(slot.cast_signed())
            .call_indirect(self.module.listing_table, ty)
            .end();
        Ok(stub)
    }

    /// Lists functions at their places of the table, one segment for each run of places.
    fn list(
        &self,
        elements: &mut ElementSection,
        slots: impl Iterator<Item = (u32, u32)>,
        indices: &mut Indices,
    ) -> Result<()> {
        let mut runs: Vec<(u32, Vec<u32>)> = Vec::new();
        for (slot, function) in slots {
            let index = indices.function_index(function)?;
            match runs.last_mut() {
                Some((begin, run)) if *begin + run.len() as u32 == slot => run.push(index),
                _ => runs.push((slot, vec![index])),
            }
        }
        let table = Some(self.module.listing_table).filter(|&table| table != 0);
        for (begin, run) in runs {
            let begin = ConstExpr::i32_const(begin.cast_signed());
            elements.active(table, &begin, Elements::Functions(Cow::Owned(run)));
        }
        Ok(())
    }

    /// Memories, tables, globals and tags, which keep their numbers in both parts.
    fn shared_state(&self) -> Result<Vec<(String, ExportKind, u32, EntityType)>> {
        let module = self.module;
        let mut all = Vec::new();
        for (index, ty) in (0..).zip(self.tables()?) {
            all.push((ExportKind::Table, index, ty.into()));
        }
        for (index, &ty) in (0..).zip(&module.memories) {
            all.push((
                ExportKind::Memory,
                index,
                RoundtripReencoder.memory_type(ty)?.into(),
            ));
        }
        for (index, &ty) in (0..).zip(&module.globals) {
            all.push((
                ExportKind::Global,
                index,
                RoundtripReencoder.global_type(ty)?.into(),
            ));
        }
        for (index, &ty) in (0..).zip(&module.tags) {
            all.push((
                ExportKind::Tag,
                index,
                RoundtripReencoder.tag_type(ty)?.into(),
            ));
        }
        let named = |(kind, index, ty)| (Name::State(kind, index).text(), kind, index, ty);
        Ok(all.into_iter().map(named).collect())
    }
}

/// Names of what the first part exports for the later, short and unlike those of JavaScript: they begin with a digit.
enum Name {
    Function(u32),
    State(ExportKind, u32),
}

impl Name {
    fn text(&self) -> String {
        match *self {
            Self::Function(index) => format!("{index}"),
            Self::State(kind, index) => {
                format!("{index}{}", ["f", "t", "m", "g", "e"][kind as usize])
            }
        }
    }
}

/// The numbers of functions in a part, by those in the whole.
#[derive(Default)]
struct Indices {
    of: BTreeMap<u32, u32>,
}

impl Indices {
    fn add(&mut self, function: u32) {
        let next = self.of.len() as u32;
        self.of.insert(function, next);
    }
}

/// A function that is not in a part.
#[derive(Debug, thiserror::Error)]
#[error("function {0} is in the other part")]
struct Elsewhere(u32);

impl Reencode for Indices {
    type Error = Elsewhere;

    fn function_index(&mut self, function: u32) -> Result<u32, Error<Elsewhere>> {
        let index = self.of.get(&function).copied();
        index.ok_or(Error::UserError(Elsewhere(function)))
    }
}

#[cfg(test)]
mod tests;
