//! Detects import cycles among the library's modules: each imports the ones before it and nothing else.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use anyhow::{Result, bail};

use crate::project::Project;

/// The modules that each module imports.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Files that may import every module: the crate's root and the two front ends.
const OUTSIDE: [&str; 3] = ["lib", "wasm", "bin"];

/// Fails with the modules of an import cycle, if there is one.
pub fn check(project: &Project) -> Result<()> {
    let source = project.root.join("src");
    let mut graph = Graph::new();
    for entry in fs::read_dir(&source)? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if !OUTSIDE.contains(&&*name) {
            collect(&path, graph.entry(name.into_owned()).or_default())?;
        }
    }
    match circle(&graph) {
        Some(circle) => bail!("import cycle: {}", circle.join(" → ")),
        None => Ok(()),
    }
}

/// Adds the imports of a file, or of the files in a folder.
fn collect(path: &Path, imports: &mut BTreeSet<String>) -> Result<()> {
    if path.is_dir() {
        for entry in fs::read_dir(path)? {
            collect(&entry?.path(), imports)?;
        }
    } else if path.extension().is_some_and(|it| it == "rs") {
        imports.extend(imported(&fs::read_to_string(path)?));
    }
    Ok(())
}

/// The modules that a text names after `crate::`. Comments and tests are ignored: they may name any module.
fn imported(text: &str) -> BTreeSet<String> {
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let code: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect();
    let code = code.join("\n");
    let mut found = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        match rest.strip_prefix('{') {
            None => _ = found.insert(word(rest)),
            Some(group) => found.extend(heads(group)),
        }
    }
    found
}

/// The first word of each item of a `use` group, up to its closing brace.
fn heads(group: &str) -> Vec<String> {
    let mut depth = 0;
    let mut starts = vec![0];
    for (place, letter) in group.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => starts.push(place + 1),
            _ => {}
        }
    }
    let words = starts
        .iter()
        .map(|&start| word(group[start..].trim_start()));
    words.filter(|word| !word.is_empty()).collect()
}

fn word(text: &str) -> String {
    let is_part = |letter: &char| letter.is_ascii_alphanumeric() || *letter == '_';
    text.chars().take_while(is_part).collect()
}

/// The modules of a cycle, with the first repeated at the end.
fn circle(graph: &Graph) -> Option<Vec<String>> {
    let mut done = BTreeSet::new();
    graph
        .keys()
        .find_map(|start| walk(graph, start, &mut Vec::new(), &mut done))
}

fn walk(
    graph: &Graph,
    at: &String,
    way: &mut Vec<String>,
    done: &mut BTreeSet<String>,
) -> Option<Vec<String>> {
    if let Some(first) = way.iter().position(|it| it == at) {
        let mut circle = way[first..].to_vec();
        circle.push(at.clone());
        return Some(circle);
    }
    if done.contains(at) {
        return None;
    }
    way.push(at.clone());
    let next = graph.get(at).into_iter().flatten();
    let found = next
        .filter(|it| *it != at && graph.contains_key(*it))
        .find_map(|it| walk(graph, it, way, done));
    way.pop();
    done.insert(at.clone());
    found
}

#[cfg(test)]
mod tests {
    use super::{Graph, circle, imported};

    #[test]
    fn imports_are_read_one_by_one_in_groups_and_in_place() {
        let text = "//! [`crate::no`]\nuse crate::mesh::{Mesh, Pose};\nuse crate::{stl, plan::{a, b}, mask};\n\
                    fn f() -> crate::error::Error {}\n#[cfg(test)]\nmod tests { use crate::never; }";
        let found: Vec<String> = imported(text).into_iter().collect();
        assert_eq!(found, ["error", "mask", "mesh", "plan", "stl"]);
    }

    #[test]
    fn a_circle_is_named_and_a_line_is_none() {
        let graph = |edges: &[(&str, &str)]| {
            let mut graph = Graph::new();
            for (from, to) in edges {
                graph.entry((*to).to_owned()).or_default();
                graph
                    .entry((*from).to_owned())
                    .or_default()
                    .insert((*to).to_owned());
            }
            circle(&graph)
        };
        assert_eq!(
            graph(&[("a", "b"), ("b", "c"), ("a", "c"), ("c", "c")]),
            None
        );
        let found = graph(&[("a", "b"), ("b", "c"), ("c", "b")]).unwrap();
        assert_eq!(found, ["b", "c", "b"]);
    }
}
