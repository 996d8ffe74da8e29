//! The formats of models, recognised by content, never by the file's name.

use serde::Serialize;

use super::stl;
use super::text::{lines, words};

/// A format of model files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub enum ModelFormat {
    /// STL, binary or ASCII.
    #[serde(rename = "stl")]
    Stl,
    /// 3MF, or another zip: only the whole file decides.
    #[serde(rename = "3mf")]
    ThreeMf,
    /// OBJ.
    #[serde(rename = "obj")]
    Obj,
}

impl ModelFormat {
    /// The format of a file with these first bytes and this length. The first that fits counts: a binary STL may begin with
    /// anything.
    pub(super) fn of(head: &[u8], length: u64) -> Option<Self> {
        if stl::is_stl(head, length) {
            Some(Self::Stl)
        } else if head.starts_with(b"PK\x03\x04") {
            Some(Self::ThreeMf)
        } else if is_obj(head) {
            Some(Self::Obj)
        } else {
            None
        }
    }
}

/// Returns true if the first line that is neither empty nor a comment begins with a word of OBJ, and goes on after it.
fn is_obj(head: &[u8]) -> bool {
    const WORDS: [&[u8]; 9] = [
        b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl",
    ];
    let mut lines = lines(head).map(|(_, text)| text);
    let first = lines.find(|line| {
        let line = line.trim_ascii();
        !line.is_empty() && !line.starts_with(b"#")
    });
    let first = first.unwrap_or_default();
    let mut words = words(&first);
    words.next().is_some_and(|word| WORDS.contains(&word)) && words.next().is_some()
}
