//! Import cycles among the modules of the library and of the command line: each imports the ones before it and nothing else.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::Path,
};

use anyhow::{Result, ensure};

use crate::project::Project;

/// The modules that each module imports.
type Graph = BTreeMap<String, BTreeSet<String>>;

/// Files that may import every module: the roots of crates, and the command line.
const OUTSIDE: [&str; 3] = ["lib", "bin", "main"];

/// Fails with the modules of import cycles, if there are any.
pub fn check(project: &Project) -> Result<()> {
    check_folder(&project.root.join("src"))?;
    check_folder(&project.root.join("src/bin/cusp"))
}

fn check_folder(folder: &Path) -> Result<()> {
    let mut graph = Graph::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if !OUTSIDE.contains(&&*name) {
            collect(&path, graph.entry(name.into_owned()).or_default())?;
        }
    }
    let circular = circular(graph);
    ensure!(
        circular.is_empty(),
        "import cycle among {}",
        circular.join(", ")
    );
    Ok(())
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
    let code = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let code = code.collect::<Vec<_>>().join("\n");
    let mut found = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        let Some(group) = rest.strip_prefix('{') else {
            found.insert(word(rest));
            continue;
        };
        // The first word of each item, up to the brace that closes the group.
        let mut depth = 0;
        let mut is_start = true;
        for (place, letter) in group.char_indices() {
            match letter {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' => is_start |= depth == 0,
                _ if is_start && !letter.is_whitespace() => {
                    found.insert(word(&group[place..]));
                    is_start = false;
                }
                _ => {}
            }
        }
    }
    found
}

fn word(text: &str) -> String {
    let is_part = |letter: &char| letter.is_ascii_alphanumeric() || *letter == '_';
    text.chars().take_while(is_part).collect()
}

/// The modules that are left when those that import none of the others are taken away, again and again.
fn circular(mut graph: Graph) -> Vec<String> {
    loop {
        let before = graph.len();
        let names: BTreeSet<String> = graph.keys().cloned().collect();
        graph.retain(|name, imports| imports.iter().any(|it| it != name && names.contains(it)));
        if graph.len() == before {
            return names.into_iter().collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{circular, imported};

    #[test]
    fn imports_are_read_one_by_one_in_groups_and_in_place() {
        let text = "//! [`crate::no`]\nuse crate::mesh::{Mesh, Pose};\nuse crate::{stl, plan::{a, b}, mask};\n\
                    fn f() -> crate::error::Error {}\n#[cfg(test)]\nmod tests { use crate::never; }";
        let found: Vec<String> = imported(text).into_iter().collect();
        assert_eq!(found, ["error", "mask", "mesh", "plan", "stl"]);
    }

    #[test]
    fn a_circle_is_named_and_a_line_is_none() {
        let circular = |edges: &[(&str, &[&str])]| {
            let edge = |(from, to): &(&str, &[&str])| {
                let to = to.iter().map(|&it| it.to_owned());
                ((*from).to_owned(), to.collect())
            };
            circular(edges.iter().map(edge).collect())
        };
        let line: [(&str, &[&str]); 3] = [("a", &["b", "c"]), ("b", &["c"]), ("c", &["c"])];
        assert_eq!(circular(&line), [""; 0]);
        assert_eq!(circular(&[("b", &["c"]), ("c", &["b"])]), ["b", "c"]);
    }
}
