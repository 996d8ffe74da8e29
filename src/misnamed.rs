//! Names that somebody mistyped, and the known name that each is nearest to.

use std::borrow::Cow;

/// The message of a parser that met an unknown field or variant, with the nearest known name in place of all of them, if one is near:
/// "unknown field `tolerence`: did you mean `tolerance`?". Any other message stays.
pub fn with_nearest(message: &str) -> Cow<'_, str> {
    let suggested = ["unknown field `", "unknown variant `"]
        .into_iter()
        .find_map(|opening| suggested(message, opening));
    suggested.map_or(Cow::Borrowed(message), Cow::Owned)
}

fn suggested(message: &str, opening: &str) -> Option<String> {
    let start = message.find(opening)? + opening.len();
    let (name, rest) = message[start..].split_once("`, expected ")?;
    // The position of the name follows the list.
    let end = rest.rfind('`')? + 1;
    let known = rest[..end].split('`').skip(1).step_by(2);
    let nearest = nearest(name, &known)?;
    let (before, after) = (&message[..start], &rest[end..]);
    Some(format!("{before}{name}`: did you mean `{nearest}`?{after}"))
}

/// The known name that adds a unit, or the one with the fewest letters to change, if these are a third at most, or one that begins alike.
fn nearest<'a>(name: &str, known: &(impl Iterator<Item = &'a str> + Clone)) -> Option<&'a str> {
    let unit = |it: &&str| {
        it.strip_prefix(name)
            .is_some_and(|rest| rest.starts_with('_'))
    };
    let nearest = known.clone().min_by_key(|it| changes(name, it));
    let near = |it: &&str| 3 * changes(name, it) <= name.len().max(it.len());
    let alike = |it: &&str| name.len() > 2 && (it.starts_with(name) || name.starts_with(*it));
    let by_unit = known.clone().find(unit);
    by_unit
        .or(nearest.filter(near))
        .or(known.clone().find(alike))
}

/// Number of letters to insert, to remove or to replace (Levenshtein, 1966).
fn changes(from: &str, to: &str) -> usize {
    let to = to.as_bytes();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (index, letter) in from.bytes().enumerate() {
        let mut diagonal = row[0];
        row[0] = index + 1;
        for (place, other) in to.iter().enumerate() {
            let replaced = diagonal + usize::from(letter != *other);
            diagonal = row[place + 1];
            row[place + 1] = replaced.min(diagonal + 1).min(row[place] + 1);
        }
    }
    row[to.len()]
}

#[cfg(test)]
mod tests {
    use super::with_nearest;

    #[test]
    fn a_mistyped_name_is_answered_with_the_nearest() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        #[expect(dead_code, reason = "only read")]
        struct Known {
            tolerance: Option<f64>,
            layer_max_mm: Option<f64>,
        }
        let said = |text: &str| {
            let error = serde_json::from_str::<Known>(text).unwrap_err();
            with_nearest(&error.to_string()).into_owned()
        };
        for (text, expected) in [
            (
                r#"{"tolerence":1}"#,
                "unknown field `tolerence`: did you mean `tolerance`? at line 1 column 12",
            ),
            (
                r#"{"layer_max":1}"#,
                "unknown field `layer_max`: did you mean `layer_max_mm`? at line 1 column 12",
            ),
            (
                r#"{"layer_max_mn":1}"#,
                "unknown field `layer_max_mn`: did you mean `layer_max_mm`? at line 1 column 15",
            ),
            (
                r#"{"colour":1}"#,
                "unknown field `colour`, expected `tolerance` or `layer_max_mm` at line 1 column 9",
            ),
            (
                r#"{"tolerance""#,
                "EOF while parsing an object at line 1 column 12",
            ),
        ] {
            assert_eq!(said(text), expected);
        }
        assert_eq!(
            with_nearest("unknown variant `cuspp`, expected one of `area`, `cusp`"),
            "unknown variant `cuspp`: did you mean `cusp`?"
        );
    }
}
