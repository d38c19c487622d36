/// Counts of debris bodies in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct DebrisReport {
    /// Bodies with skin near them.
    pub near: u32,
    /// Bodies that skin entered in rapier's step and that were put back in front of it. A body counts once for each
    /// creature.
    pub put_back: u32,
    /// Bodies that skin passes through. They are caught in a closing fold, or between skin and something immovable,
    /// such as the ground under a foot, or skin appeared around them and they are too deep to be put out. A body counts
    /// once for each creature.
    pub caught: u32,
    /// Bodies around which skin was found in this tick without having moved there: new bodies inside a creature, bodies
    /// that were moved into one, and bodies where a creature is new, was teleported, got skin by an edit or shows
    /// hidden skin again. They are put out or let through from this tick on. A body counts once for each creature.
    pub enclosed: u32,
    /// Bodies that are moved out of a creature whose skin appeared around them. A body counts once for each creature.
    pub put_out: u32,
}
