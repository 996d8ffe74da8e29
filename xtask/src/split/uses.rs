//! What functions and data use, as the linker tells with `--emit-relocs`: each place in code and data that holds the address of a
//! function or of data, and which.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use anyhow::{Context, Result, bail};
use wasm_encoder::RawSection;
use wasmparser::{
    DataKind, ElementItems, ElementKind, ExternalKind, KnownCustom, Linking, Operator, Parser,
    Payload, RelocationEntry, RelocationType, SymbolInfo, TypeRef,
};

use super::LaterExports;

/// A function, or data with a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Node {
    Function(u32),
    /// By its symbol.
    Data(usize),
}

/// The places of the table that are used only by what the later exports need.
///
/// # Errors
///
/// Fails if the module is damaged, or was linked without `--emit-relocs`.
pub fn later_slots(linked: &[u8], later: LaterExports) -> Result<BTreeSet<u32>> {
    let linked = Linked::new(linked)?;
    let uses = linked.uses()?;
    // What wasm-bindgen runs to know the types of the exports, and then removes.
    let exports = linked.exports.iter();
    let exports = exports.filter(|(name, _)| !name.starts_with("__wbindgen_describe"));
    let roots = |is_later: bool| {
        let exports = exports.clone();
        exports
            .filter(move |(name, _)| later.has(unhashed(name)) == is_later)
            .map(|&(_, function)| Node::Function(function))
    };
    let first = reached(&uses, roots(false).chain(linked.start));
    let later = reached(&uses, roots(true));
    let slots = linked.slots.iter();
    let is_later = |function| later.contains(&function) && !first.contains(&function);
    Ok(slots
        .filter(|&(_, &function)| is_later(Node::Function(function)))
        .map(|(&slot, _)| slot)
        .collect())
}

/// The module without what the linker tells, which the tools after it cannot keep up to date.
///
/// # Errors
///
/// Fails if the module is damaged.
pub fn without_relocations(linked: &[u8]) -> Result<Vec<u8>> {
    let mut out = wasm_encoder::Module::new();
    for payload in Parser::new(0).parse_all(linked) {
        let payload = payload?;
        let is_linkers = matches!(
            &payload,
            Payload::CustomSection(custom)
                if custom.name() == "linking" || custom.name().starts_with("reloc.")
        );
        if let Some((id, range)) = payload.as_section().filter(|_| !is_linkers) {
            let data = &linked[range.start as usize..range.end as usize];
            out.section(&RawSection { id, data });
        }
    }
    Ok(out.finish())
}

/// The name of an export before wasm-bindgen has run, without the hash at its end.
fn unhashed(export: &str) -> &str {
    match export.rsplit_once('_') {
        Some((name, hash)) if hash.len() == 16 && hash.bytes().all(|it| it.is_ascii_hexdigit()) => {
            name
        }
        _ => export,
    }
}

fn reached(uses: &HashMap<Node, Vec<Node>>, roots: impl Iterator<Item = Node>) -> HashSet<Node> {
    let mut found: Vec<Node> = roots.collect();
    let mut reached = HashSet::new();
    while let Some(node) = found.pop() {
        if reached.insert(node) {
            found.extend(uses.get(&node).into_iter().flatten());
        }
    }
    reached
}

/// A module as the linker wrote it.
#[derive(Default)]
struct Linked<'a> {
    imported_functions: u32,
    exports: Vec<(&'a str, u32)>,
    start: Option<Node>,
    /// The function at each place of the table.
    slots: BTreeMap<u32, u32>,
    symbols: Vec<SymbolInfo<'a>>,
    /// Where each function and each data segment begins in the file.
    bodies: Vec<u64>,
    segments: Vec<u64>,
    /// Relocations by their place in the file.
    code: Vec<(u64, RelocationEntry)>,
    data: Vec<(u64, RelocationEntry)>,
}

impl<'a> Linked<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self> {
        let mut linked = Self::default();
        // Where sections begin: relocations count from there.
        let (mut code, mut data) = (0, 0);
        for payload in Parser::new(0).parse_all(bytes) {
            match payload? {
                Payload::ImportSection(imports) => {
                    for import in imports.into_imports() {
                        linked.imported_functions +=
                            u32::from(matches!(import?.ty, TypeRef::Func(_)));
                    }
                }
                Payload::ExportSection(exports) => {
                    for export in exports {
                        let export = export?;
                        if export.kind == ExternalKind::Func {
                            linked.exports.push((export.name, export.index));
                        }
                    }
                }
                Payload::StartSection { func, .. } => linked.start = Some(Node::Function(func)),
                Payload::ElementSection(elements) => {
                    for element in elements {
                        linked.take_element(element?)?;
                    }
                }
                Payload::CodeSectionStart {
                    unchecked_range, ..
                } => code = unchecked_range.start,
                Payload::CodeSectionEntry(body) => linked.bodies.push(body.range().start),
                Payload::DataSection(segments) => {
                    data = segments.range().start;
                    for segment in segments {
                        let segment = segment?;
                        if matches!(segment.kind, DataKind::Passive) {
                            bail!("the module has data without an address");
                        }
                        let end = segment.range.end;
                        linked.segments.push(end - segment.data.len() as u64);
                    }
                }
                Payload::CustomSection(custom) => match custom.as_known() {
                    KnownCustom::Linking(linking) => {
                        for subsection in linking.subsections() {
                            if let Linking::SymbolTable(symbols) = subsection? {
                                linked.symbols = symbols.into_iter().collect::<Result<_, _>>()?;
                            }
                        }
                    }
                    KnownCustom::Reloc(relocations) => {
                        let (begin, list) = match custom.name() {
                            "reloc.CODE" => (code, &mut linked.code),
                            "reloc.DATA" => (data, &mut linked.data),
                            _ => continue,
                        };
                        for entry in relocations.entries() {
                            let entry = entry?;
                            list.push((begin + u64::from(entry.offset), entry));
                        }
                    }
                    _ => {}
                },
                _ => {}
            }
        }
        if linked.symbols.is_empty() || linked.code.is_empty() {
            bail!("the linker does not tell what functions use: --emit-relocs is missing");
        }
        Ok(linked)
    }

    fn take_element(&mut self, element: wasmparser::Element<'a>) -> Result<()> {
        let (ElementKind::Active { offset_expr, .. }, ElementItems::Functions(functions)) =
            (element.kind, element.items)
        else {
            bail!("the module has elements of an unknown kind");
        };
        let Operator::I32Const { value } = offset_expr.get_operators_reader().read()? else {
            bail!("the module has elements at an unknown place");
        };
        for (slot, function) in (value.cast_unsigned()..).zip(functions) {
            self.slots.insert(slot, function?);
        }
        Ok(())
    }

    /// What each function and each piece of data uses.
    fn uses(&self) -> Result<HashMap<Node, Vec<Node>>> {
        let mut uses: HashMap<Node, Vec<Node>> = HashMap::new();
        for (place, entry) in &self.code {
            let body = self.bodies.partition_point(|begin| begin <= place);
            let body = body
                .checked_sub(1)
                .context("a relocation outside functions")?;
            let user = Node::Function(self.imported_functions + body as u32);
            uses.entry(user).or_default().extend(self.used(entry)?);
        }
        let pieces = self.pieces()?;
        for (place, entry) in &self.data {
            let Some(used) = self.used(entry)? else {
                continue;
            };
            // Pieces may overlap: constants that are equal to a part of others are not stored twice.
            let mut is_found = false;
            for (_, _, symbol) in pieces
                .iter()
                .filter(|(begin, end, _)| (begin..end).contains(&place))
            {
                uses.entry(Node::Data(*symbol)).or_default().push(used);
                is_found = true;
            }
            if !is_found {
                bail!("there is an address in data without a name");
            }
        }
        Ok(uses)
    }

    /// Where pieces of data are in the file, with their symbols.
    fn pieces(&self) -> Result<Vec<(u64, u64, usize)>> {
        let mut pieces = Vec::new();
        for (number, symbol) in self.symbols.iter().enumerate() {
            if let SymbolInfo::Data {
                symbol: Some(piece),
                ..
            } = symbol
            {
                let segment = self.segments.get(piece.index as usize);
                let begin = segment.context("data of no segment")? + u64::from(piece.offset);
                pieces.push((begin, begin + u64::from(piece.size), number));
            }
        }
        Ok(pieces)
    }

    /// What a relocation is about, if that is a function or data.
    fn used(&self, entry: &RelocationEntry) -> Result<Option<Node>> {
        use RelocationType::{
            EventIndexLeb, FunctionIndexLeb, FunctionOffsetI32, GlobalIndexI32, GlobalIndexLeb,
            SectionOffsetI32, TableNumberLeb, TypeIndexLeb,
        };
        if matches!(
            entry.ty,
            TypeIndexLeb
                | GlobalIndexLeb
                | GlobalIndexI32
                | EventIndexLeb
                | TableNumberLeb
                | SectionOffsetI32
                | FunctionOffsetI32
        ) {
            return Ok(None);
        }
        let number = entry.index as usize;
        let symbol = self.symbols.get(number);
        Ok(match symbol.context("a relocation of no symbol")? {
            SymbolInfo::Func { index, .. } => Some(Node::Function(*index)),
            SymbolInfo::Data { .. } if entry.ty != FunctionIndexLeb => Some(Node::Data(number)),
            _ => None,
        })
    }
}
