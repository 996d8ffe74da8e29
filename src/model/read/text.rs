//! The text of files: lines and words, and what errors show of it.

use std::borrow::Cow;

/// A word as errors show it: its first 40 characters.
pub fn quoted(word: &[u8]) -> String {
    shown(word, 40)
}

/// A name or an address as errors show it: its first 160 characters.
pub fn named(name: &[u8]) -> String {
    shown(name, 160)
}

/// The first `most` characters. Those that do not print are escaped, so that bytes of a file cannot
/// control a terminal.
fn shown(word: &[u8], most: usize) -> String {
    // No character takes more than four bytes.
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * most)]);
    let mut quoted = String::new();
    for character in text.chars().take(most) {
        match character {
            '\'' | '"' | '\\' => quoted.push(character),
            _ => quoted.extend(character.escape_debug()),
        }
    }
    quoted
}

/// The words of a line.
pub fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let words = line.split(u8::is_ascii_whitespace);
    words.filter(|word| !word.is_empty())
}

/// The lines of a text with their numbers, from 1. Lines end with LF, CR or both; those that go on in the next are joined.
pub fn lines(bytes: &[u8]) -> impl Iterator<Item = (u64, Cow<'_, [u8]>)> {
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let first = number;
        let mut line = Cow::Borrowed(next_line(&mut rest));
        while line.ends_with(b"\\") {
            let joined = line.to_mut();
            joined.pop();
            joined.push(b' ');
            joined.extend(next_line(&mut rest));
            number += 1;
        }
        Some((first, line))
    })
}

fn next_line<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    let (line, after) = rest.split_at(end.unwrap_or(rest.len()));
    let length = after.len().min(1 + usize::from(after.starts_with(b"\r\n")));
    *rest = &after[length..];
    line
}
