//! Moves the body so that limbs reach what they hold: first the holds, then the body, then inverse kinematics.

use clamber_animation::damp;
use glam::DVec3;

/// Share of a limb's length at which it counts as stretched: arms keep from snapping straight (soft reach begins
/// there), legs stand nearly straight.
pub(crate) const ARM: f64 = 0.97;
pub(crate) const LEG: f64 = 0.992;

/// Share of the leg's length at which a foot is let go: hands must not slip, toes may stay back a little.
const FEET: f64 = 1.03;

/// Rounds of moving the body to one limb after the other.
const ROUNDS: usize = 8;

/// How far the body moves for its limbs, metres.
const MOST: f64 = 0.8;

/// Nearer than this share of their length, limbs push the body away.
const NEAR: f64 = 0.25;

/// How far and how fast the pelvis goes down for its feet, metres and metres a second, and the time for half of the way
/// up again, seconds (Unreal's foot placement: 0.5 m, and 0.09 s).
const DEEPEST: f64 = 0.5;
const SINKS: f64 = 1.2;
const RISES: f64 = 0.09;

/// The same for who walks: from step to step it stays down.
const DEEPEST_WALKING: f64 = 0.18;
const STEADY: f64 = 2.0;
const SINKS_WALKING: f64 = 0.8;

/// A limb's root in the world, where its end should be, and how long it may get.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    pub(crate) root: DVec3,
    pub(crate) end: DVec3,
    pub(crate) reach: f64,
    /// Of the straight limb.
    pub(crate) length: f64,
}

/// The displacement of the body by which all ties are within reach, if that is not too far: from `from` onto one ball
/// after the other.
pub(crate) fn pulled(from: DVec3, ties: &[Option<Tie>; 4], size: f64) -> DVec3 {
    let mut moved = from;
    for _ in 0..ROUNDS {
        for tie in ties.iter().flatten() {
            let way = tie.end - (tie.root + moved);
            let distance = way.length();
            let wanted = distance.clamp(NEAR * tie.length, tie.reach);
            moved += way.normalize_or_zero() * (distance - wanted);
        }
    }
    moved.clamp_length_max(MOST * size)
}

/// The limb that is farthest out of reach after the body moved; `None` if all reach.
pub(crate) fn out_of_reach(ties: &[Option<Tie>; 4], moved: DVec3) -> Option<usize> {
    let beyond = ties.iter().enumerate().filter_map(|(index, tie)| {
        let tie = tie.as_ref()?;
        let share = (tie.end - (tie.root + moved)).length() / tie.length;
        let most = if index < 2 { 1.0 } else { FEET };
        (share > most).then_some((index, share))
    });
    let worst = beyond.max_by(|a, b| a.1.total_cmp(&b.1));
    worst.map(|(index, _)| index)
}

/// How far the pelvis has to go down for its feet: the hip above each foot meets the ball about the ankle (Johansen
/// 2009, "Automated semi-procedural animation for character locomotion", 7.4.2).
pub(crate) fn needed_drop(ties: &[Option<Tie>; 2], up: DVec3) -> f64 {
    let drops = ties.iter().flatten().filter_map(|tie| {
        let way = tie.root - tie.end;
        let high = way.dot(up);
        let aside = way.length_squared() - high * high;
        let room = tie.reach * tie.reach - aside;
        (room > 0.0).then(|| high - room.sqrt())
    });
    drops.fold(0.0, f64::max)
}

/// The pelvis's way down after another `dt` seconds. Who walks keeps the pelvis steady.
pub(crate) fn dropped(drop: f64, needed: f64, walks: bool, size: f64, dt: f64) -> f64 {
    let deepest = if walks { DEEPEST_WALKING } else { DEEPEST };
    let needed = needed.min(deepest * size);
    if needed > drop {
        let sinks = if walks { SINKS_WALKING } else { SINKS };
        needed.min(drop + sinks * size.sqrt() * dt)
    } else {
        damp(drop, needed, if walks { STEADY } else { RISES }, dt)
    }
}
