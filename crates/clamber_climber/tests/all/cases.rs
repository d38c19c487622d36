//! Numbers with which tests play, and all combinations of them.

/// Sizes of the world, and tick rates, hertz.
pub(crate) const WORLDS: [(f64, f64); 5] = [
    (1.0, 60.0),
    (1.0, 30.0),
    (1.0, 240.0),
    (0.02, 60.0),
    (100.0, 60.0),
];

/// All pairs of items; the second changes fastest.
pub(crate) fn pairs<A: Copy, B>(
    first: impl IntoIterator<Item = A>,
    second: impl IntoIterator<Item = B> + Clone,
) -> impl Iterator<Item = (A, B)> {
    let first = first.into_iter();
    first.flat_map(move |a| second.clone().into_iter().map(move |b| (a, b)))
}

/// All triples of items; the third changes fastest.
pub(crate) fn triples<A: Copy, B: Copy, C>(
    first: impl IntoIterator<Item = A>,
    second: impl IntoIterator<Item = B> + Clone,
    third: impl IntoIterator<Item = C> + Clone,
) -> impl Iterator<Item = (A, B, C)> {
    pairs(pairs(first, second), third).map(|((a, b), c)| (a, b, c))
}
