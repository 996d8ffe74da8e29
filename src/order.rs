//! Numbers in order.

/// The places of numbers from the least up; of equal ones the first comes first.
pub fn ascending(numbers: impl Iterator<Item = f64>) -> Vec<usize> {
    sorted(numbers.zip(0..).collect())
}

/// Apart from [`ascending`], so that sorting is compiled once and not for each iterator.
fn sorted(mut order: Vec<(f64, usize)>) -> Vec<usize> {
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.into_iter().map(|(_, place)| place).collect()
}
