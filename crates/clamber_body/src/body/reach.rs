//! Moves the body so that limbs reach what they hold: first the holds, then the body, then inverse kinematics.

use clamber_animation::damp;
use glam::DVec3;

/// Share of a limb's length at which it counts as stretched: arms keep from snapping straight (soft reach begins there),
/// legs stand nearly straight.
pub(crate) const ARM: f64 = 0.97;
pub(crate) const LEG: f64 = 0.992;

/// Rounds of moving the body to one limb after the other.
const ROUNDS: usize = 8;

/// How far the body moves for its limbs, metres.
const MOST: f64 = 0.35;

/// How far and how fast the pelvis goes down for its feet, metres and metres a second, and the time for half of the way up
/// again, seconds (Unreal's foot placement: 0.5 m, and 0.09 s).
const DEEPEST: f64 = 0.5;
const SINKS: f64 = 1.2;
const RISES: f64 = 0.09;

/// A limb's root in the world, where its end should be, and how long it may get.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    pub(crate) root: DVec3,
    pub(crate) end: DVec3,
    pub(crate) reach: f64,
}

/// The displacement of the body by which all ties are within reach, if that is not too far: onto one ball after the other.
pub(crate) fn pulled(ties: &[Option<Tie>; 4], size: f64) -> DVec3 {
    let mut moved = DVec3::ZERO;
    for _ in 0..ROUNDS {
        for tie in ties.iter().flatten() {
            let way = tie.end - (tie.root + moved);
            let beyond = way.length() - tie.reach;
            if beyond > 0.0 {
                moved += way.normalize_or_zero() * beyond;
            }
        }
    }
    moved.clamp_length_max(MOST * size)
}

/// How far the pelvis has to go down for its feet: the hip above each foot meets the ball about the ankle (Johansen 2009,
/// "Automated semi-procedural animation for character locomotion", 7.4.2).
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

/// The pelvis's way down after another `dt` seconds.
pub(crate) fn dropped(drop: f64, needed: f64, size: f64, dt: f64) -> f64 {
    let needed = needed.min(DEEPEST * size);
    if needed > drop {
        needed.min(drop + SINKS * size.sqrt() * dt)
    } else {
        damp(drop, needed, RISES, dt)
    }
}
