/// What a tick did to debris.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DebrisReport {
    /// Bodies that had skin near them.
    pub near: u32,
    /// Bodies that rapier let skin into, and that were put back in front of it. A body counts once for each creature.
    pub put_back: u32,
    /// Bodies that skin passes through: caught in a closing fold, or between skin and what does not
    /// move, such as under a foot. A body counts once for each creature.
    pub caught: u32,
}
