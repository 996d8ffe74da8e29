//! What errors show of a file's text.

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
