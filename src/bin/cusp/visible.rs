//! Text from outside in the output: characters that act on a terminal, or turn a line around, are shown and not obeyed.

use std::borrow::Cow;
use std::fmt::Write as _;

use serde_json::Value;

/// Returns true if a character acts instead of being seen: control characters, ends of lines, and marks of the direction of writing.
fn acts(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// The text in one line, with such characters as `\u{1b}`.
pub fn visible(text: &str) -> Cow<'_, str> {
    visible_but(text, |_| false)
}

/// The same of several lines.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    visible_but(text, |character| character == '\n')
}

fn visible_but(text: &str, is_protected: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_escaped = |character: char| acts(character) && !is_protected(character);
    if !text.contains(is_escaped) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if is_escaped(character) {
            // Writing to a string cannot fail.
            let _ = write!(shown, "{}", character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
    shown.into()
}

/// The same of every text in typed details.
pub fn visible_detail(detail: &mut Value) {
    match detail {
        Value::String(text) => *text = visible(text).into_owned(),
        Value::Array(items) => items.iter_mut().for_each(visible_detail),
        Value::Object(fields) => fields.values_mut().for_each(visible_detail),
        Value::Null | Value::Bool(_) | Value::Number(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_is_shown_and_all_else_is_left() {
        for text in ["part.stl", "größer als 0,5 mm", "立方体", "a\u{a0}b"] {
            assert!(matches!(visible(text), Cow::Borrowed(same) if same == text));
        }
        assert_eq!(visible("a\nb\x1b[31m"), "a\\u{a}b\\u{1b}[31m");
        assert_eq!(visible("\u{202e}lts.exe\u{9b}"), "\\u{202e}lts.exe\\u{9b}");
        assert_eq!(visible_lines("a\nb\rc"), "a\nb\\u{d}c");
        let mut detail = serde_json::json!({ "key": ["x\ny", 5] });
        visible_detail(&mut detail);
        assert_eq!(detail, serde_json::json!({ "key": ["x\\u{a}y", 5] }));
    }
}
