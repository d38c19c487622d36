/// Counts of what a tick did to debris.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DebrisReport {
    /// Bodies with skin near them.
    pub near: u32,
    /// Bodies that skin entered in rapier's step and that were put back in front of it. A body counts once for each
    /// creature.
    pub put_back: u32,
    /// Bodies that skin passes through, since they are caught in a closing fold, or between skin and something
    /// immovable, such as the ground under a foot. A body counts once for each creature.
    pub caught: u32,
}
