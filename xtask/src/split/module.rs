//! A module as the split needs it.

use std::collections::BTreeMap;

use anyhow::{Context, Result, bail};
use wasmparser::{
    ElementItems, ElementKind, Export, FunctionBody, GlobalType, MemoryType, Operator, Parser,
    Payload, Table, TagType, TypeRef,
};

/// A section, in the order of the module. Those that the parts share are raw.
pub enum Section<'a> {
    Raw { id: u8, data: &'a [u8] },
    Functions,
    Tables,
    Exports,
    Start(u32),
    Elements,
    Code,
}

/// A module with its functions.
#[derive(Default)]
pub struct Read<'a> {
    pub sections: Vec<Section<'a>>,
    pub imported_functions: u32,
    pub tables: Vec<Table<'a>>,
    pub memories: Vec<MemoryType>,
    pub globals: Vec<GlobalType>,
    pub tags: Vec<TagType>,
    pub exports: Vec<Export<'a>>,
    pub start: Option<u32>,
    /// The function at each place of the table.
    pub slots: BTreeMap<u32, u32>,
    /// The table that has these places.
    pub listing_table: u32,
    /// Parameters of each type.
    parameters: Vec<usize>,
    /// The type of each function, of which the first are imported.
    types: Vec<u32>,
    bodies: Vec<FunctionBody<'a>>,
}

impl<'a> Read<'a> {
    /// Reads a module.
    ///
    /// # Errors
    ///
    /// Fails if it is damaged, or has what no module of ours has.
    pub fn new(bytes: &'a [u8]) -> Result<Self> {
        let mut module = Self::default();
        for payload in Parser::new(0).parse_all(bytes) {
            module.take(payload?, bytes)?;
        }
        if module.types.len() != module.imported_functions as usize + module.bodies.len() {
            bail!("the module is damaged");
        }
        Ok(module)
    }

    fn take(&mut self, payload: Payload<'a>, bytes: &'a [u8]) -> Result<()> {
        let raw = payload.as_section().map(|(id, range)| Section::Raw {
            id,
            data: &bytes[range.start as usize..range.end as usize],
        });
        let section = match payload {
            Payload::TypeSection(types) => {
                for ty in types.into_iter_err_on_gc_types() {
                    self.parameters.push(ty?.params().len());
                }
                raw
            }
            Payload::ImportSection(imports) => {
                for import in imports.into_imports() {
                    let TypeRef::Func(ty) = import?.ty else {
                        bail!("the module imports what is no function");
                    };
                    self.types.push(ty);
                }
                self.imported_functions = self.types.len() as u32;
                raw
            }
            Payload::FunctionSection(functions) => {
                self.types
                    .extend(functions.into_iter().collect::<Result<Vec<_>, _>>()?);
                Some(Section::Functions)
            }
            Payload::TableSection(tables) => {
                self.tables = tables.into_iter().collect::<Result<_, _>>()?;
                Some(Section::Tables)
            }
            Payload::MemorySection(memories) => {
                self.memories = memories.into_iter().collect::<Result<_, _>>()?;
                raw
            }
            Payload::TagSection(tags) => {
                self.tags = tags.into_iter().collect::<Result<_, _>>()?;
                raw
            }
            Payload::GlobalSection(globals) => {
                for global in globals {
                    self.globals.push(global?.ty);
                }
                raw
            }
            Payload::ExportSection(exports) => {
                self.exports = exports.into_iter().collect::<Result<_, _>>()?;
                Some(Section::Exports)
            }
            Payload::StartSection { func, .. } => {
                self.start = Some(func);
                Some(Section::Start(func))
            }
            Payload::ElementSection(elements) => {
                for element in elements {
                    self.take_element(element?)?;
                }
                Some(Section::Elements)
            }
            Payload::CodeSectionStart { .. } => Some(Section::Code),
            Payload::CodeSectionEntry(body) => {
                self.bodies.push(body);
                None
            }
            // The names of functions are for debuggers.
            Payload::CustomSection(custom) if custom.name() == "name" => None,
            _ => raw,
        };
        self.sections.extend(section);
        Ok(())
    }

    fn take_element(&mut self, element: wasmparser::Element<'a>) -> Result<()> {
        let (
            ElementKind::Active {
                table_index,
                offset_expr,
            },
            ElementItems::Functions(functions),
        ) = (element.kind, element.items)
        else {
            bail!("the module has elements of an unknown kind");
        };
        let Operator::I32Const { value } = offset_expr.get_operators_reader().read()? else {
            bail!("the module has elements at an unknown place");
        };
        let table = table_index.unwrap_or(0);
        if !self.slots.is_empty() && table != self.listing_table {
            bail!("the module lists functions in two tables");
        }
        self.listing_table = table;
        for (slot, function) in (value.cast_unsigned()..).zip(functions) {
            self.slots.insert(slot, function?);
        }
        Ok(())
    }

    /// The number of functions, imported ones included.
    pub fn functions(&self) -> usize {
        self.types.len()
    }

    /// The table that lists functions.
    ///
    /// # Errors
    ///
    /// Fails if there is none.
    pub fn table(&self) -> Result<&Table<'a>> {
        let table = self.tables.get(self.listing_table as usize);
        table.context("the module has no table")
    }

    /// The number of a function's type.
    pub fn type_of(&self, function: u32) -> u32 {
        self.types[function as usize]
    }

    /// The number of a type's parameters.
    ///
    /// # Errors
    ///
    /// Fails if there is no such type.
    pub fn parameters(&self, ty: u32) -> Result<u32> {
        let parameters = self.parameters.get(ty as usize);
        Ok(*parameters.context("the module is damaged")? as u32)
    }

    /// The code of a function that is not imported.
    pub fn body(&self, function: u32) -> FunctionBody<'a> {
        self.bodies[(function - self.imported_functions) as usize].clone()
    }

    /// The functions that a function calls by their numbers; none if it is imported.
    ///
    /// # Errors
    ///
    /// Fails if the code is damaged, or refers to functions or data in ways that no module of ours does.
    pub fn calls(&self, function: u32) -> Result<Vec<u32>> {
        let mut calls = Vec::new();
        if function < self.imported_functions {
            return Ok(calls);
        }
        for operator in self.body(function).get_operators_reader()? {
            match operator? {
                Operator::Call { function_index } | Operator::ReturnCall { function_index } => {
                    calls.push(function_index);
                }
                Operator::RefFunc { .. }
                | Operator::MemoryInit { .. }
                | Operator::DataDrop { .. }
                | Operator::TableInit { .. }
                | Operator::ElemDrop { .. } => {
                    bail!("the module has an instruction that cannot be moved to another");
                }
                _ => {}
            }
        }
        Ok(calls)
    }
}
