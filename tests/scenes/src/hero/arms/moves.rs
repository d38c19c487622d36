//! Which clip shows what a fighter does, and at which time of it.

use clamber_body::clamber_animation::{AnimationSet, ClipId};
use clamber_fight::{Act, Fighter};

/// The time at which `stab_strike` arrives, seconds: its marker `hit`.
const HIT: f64 = 0.2;

/// Share of a full draw at which the clip `draw` is over and `aim` begins.
const NOCKED: f64 = 0.6;

/// Lengths of fades between clips, seconds: to the weapons' quick moves, and to others.
const QUICK: f64 = 0.06;
const FADE: f64 = 0.14;

/// What a clip shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Move {
    Raise,
    Hold,
    Strike,
    Swing,
    Draw,
    Aim,
    Loose,
}

impl Move {
    pub(super) const ALL: [Self; 7] = [
        Self::Raise,
        Self::Hold,
        Self::Strike,
        Self::Swing,
        Self::Draw,
        Self::Aim,
        Self::Loose,
    ];

    pub(super) const fn clip(self) -> &'static str {
        match self {
            Self::Raise => "stab_raise",
            Self::Hold => "stab_hold",
            Self::Strike => "stab_strike",
            Self::Swing => "swing",
            Self::Draw => "draw",
            Self::Aim => "aim",
            Self::Loose => "loose",
        }
    }

    pub(super) const fn is_bow(self) -> bool {
        matches!(self, Self::Draw | Self::Aim | Self::Loose)
    }

    /// Length of the fade to it, seconds.
    pub(super) const fn fade(self) -> f64 {
        match self {
            Self::Strike | Self::Loose => QUICK,
            _ => FADE,
        }
    }
}

/// The clips of all moves; `None` for those that a figure lacks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moves([Option<ClipId>; Move::ALL.len()]);

impl Moves {
    pub(super) fn find(set: &AnimationSet) -> Self {
        Self(Move::ALL.map(|one| set.find(one.clip())))
    }

    pub(super) fn get(&self, one: Move) -> Option<ClipId> {
        self.0[one as usize]
    }

    /// What to play, and at which time of the clip; `None` as time for one that plays by itself. An arrow was let go
    /// `loosed` seconds ago.
    pub(super) fn of(
        &self,
        set: &AnimationSet,
        fighter: &Fighter,
        loosed: f64,
    ) -> Option<(Move, Option<f64>)> {
        let length = |one: Move| {
            let clip = self.get(one).and_then(|clip| set.clip(clip).ok());
            clip.map_or(0.0, |clip| clip.duration())
        };
        let at = |one: Move, share: f64| {
            let time = share.clamp(0.0, 1.0) * length(one);
            Some((one, Some(time)))
        };
        let sword = fighter.config().sword;
        match fighter.act() {
            Act::Raise { seconds, .. } => at(Move::Raise, seconds / sword?.raise.max(1e-3)),
            Act::Charge { .. } => Some((Move::Hold, None)),
            Act::Strike { seconds, .. } => {
                let share = (seconds / sword?.strike).clamp(0.0, 1.0);
                Some((Move::Strike, Some(share * HIT)))
            }
            Act::Plunge { .. } => Some((Move::Strike, Some(HIT))),
            Act::PullOut { seconds, .. } => {
                let left = (seconds / sword?.pull_out.max(1e-3)).clamp(0.0, 1.0);
                let rest = (length(Move::Strike) - HIT).max(0.0);
                Some((Move::Strike, Some(HIT + (1.0 - left) * rest)))
            }
            Act::Cut { seconds, .. } => {
                let sword = sword?;
                at(
                    Move::Swing,
                    seconds / (sword.wind_up + sword.cut + sword.recover),
                )
            }
            Act::Draw { drawn } if *drawn < NOCKED => at(Move::Draw, drawn / NOCKED),
            Act::Draw { .. } => Some((Move::Aim, None)),
            Act::Ready | Act::Throw { .. } => {
                let is_loosing = loosed < length(Move::Loose);
                is_loosing.then_some((Move::Loose, None))
            }
        }
    }
}
