/// Factors from one size to another under the same gravity. Accelerations stay the same, so times and speeds both grow
/// with the square root of lengths (Froude's law).
///
/// Each part of a configuration names every field where it is scaled, so that a new field cannot be forgotten.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    pub(super) length: f64,
    pub(super) speed: f64,
    pub(super) time: f64,
}

impl Scale {
    pub(super) fn of_size(size: f64) -> Self {
        let root = libm::sqrt(size);
        Self {
            length: size,
            speed: root,
            time: root,
        }
    }
}
