//! The lengths that are asked for, and their bounds.

/// A length that is out of bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BadLength {
    /// Its name in the options.
    pub option: &'static str,
    pub value_mm: f64,
    pub least_mm: f64,
    pub most_mm: f64,
}

/// Checks that each length, by its name, is at least what follows it, and at most `most_mm`.
pub(super) fn check(
    lengths: impl IntoIterator<Item = (&'static str, f64, f64)>,
    most_mm: f64,
) -> Result<(), BadLength> {
    for (option, value_mm, least_mm) in lengths {
        if !(least_mm..=most_mm).contains(&value_mm) {
            return Err(BadLength {
                option,
                value_mm,
                least_mm,
                most_mm,
            });
        }
    }
    Ok(())
}
