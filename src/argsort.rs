//! Sorting by numbers.

/// The indices of `numbers` in ascending order of value; equal ones keep their order.
pub fn argsort(numbers: impl Iterator<Item = f64>) -> Vec<usize> {
    sorted(numbers.zip(0..).collect())
}

/// Separate from [`argsort`], so that sorting is compiled once rather than for each iterator.
fn sorted(mut order: Vec<(f64, usize)>) -> Vec<usize> {
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.into_iter().map(|(_, place)| place).collect()
}

/// Sorts a list by a number of each item; items with equal numbers keep their order.
///
/// For short lists: the standard library's stable sort, compiled for each of them, takes ten times as much of the module.
pub fn sort_by_number<T: Clone>(items: &mut Vec<T>, number: impl Fn(&T) -> f64) {
    let order = argsort(items.iter().map(number));
    *items = order
        .into_iter()
        .map(|place| items[place].clone())
        .collect();
}
