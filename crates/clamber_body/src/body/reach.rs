//! Moves the body so that limbs reach their holds. The holds come first, then the body, then inverse kinematics.

use clamber_animation::damp;
use glam::DVec3;

/// Share of an arm's length that the body keeps within. It is below 1 to keep elbows from snapping straight: soft reach
/// begins there.
pub(crate) const ARM_REACH: f64 = 0.97;

/// Share of a leg's length that the body keeps within: standing legs are nearly straight.
pub(crate) const LEG_REACH: f64 = 0.992;

/// Share of the leg's length beyond which a foot is let go. It is above 1: hands must not slip, but toes may stay back
/// a little.
const FOOT_RELEASE_REACH: f64 = 1.03;

/// Number of rounds in which the body moves to one limb after the other.
const PROJECTION_ROUNDS: usize = 8;

/// Largest displacement of the body for its limbs, metres.
const MAX_PULL: f64 = 0.8;

/// Share of a limb's length below which the limb pushes the body away.
const PUSH_AWAY_REACH: f64 = 0.25;

/// Largest depth of the pelvis for the feet, metres (Unreal's foot placement: 0.5 m).
const MAX_DROP: f64 = 0.5;

/// Largest speed at which the pelvis goes down, metres a second.
const SINK_SPEED: f64 = 1.2;

/// Half time of the pelvis's way up again, seconds (Unreal's foot placement: 0.09 s).
const RISE_HALF_TIME: f64 = 0.09;

/// [`MAX_DROP`] while the body walks, metres.
const MAX_DROP_WALKING: f64 = 0.18;

/// [`RISE_HALF_TIME`] while the body walks, seconds: so long that the pelvis stays down from step to step.
const RISE_HALF_TIME_WALKING: f64 = 2.0;

/// [`SINK_SPEED`] while the body walks, metres a second.
const SINK_SPEED_WALKING: f64 = 0.8;

/// The root of a limb in world space, the place of its end, and the largest distance between them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tie {
    pub(crate) root: DVec3,
    pub(crate) end: DVec3,
    pub(crate) reach: f64,
    /// Length of the straight limb, metres.
    pub(crate) length: f64,
}

/// The displacement of the body, from `from` on, by which all limbs are within reach, at most [`MAX_PULL`]. It projects
/// onto the allowed distances of one limb after the other.
pub(crate) fn pulled(from: DVec3, ties: &[Option<Tie>; 4], size: f64) -> DVec3 {
    let mut moved = from;
    for _ in 0..PROJECTION_ROUNDS {
        for tie in ties.iter().flatten() {
            let way = tie.end - (tie.root + moved);
            let distance = way.length();
            let wanted = distance.clamp(PUSH_AWAY_REACH * tie.length, tie.reach);
            moved += way.normalize_or_zero() * (distance - wanted);
        }
    }
    moved.clamp_length_max(MAX_PULL * size)
}

/// The limb that is farthest out of reach after the body moved; `None` if all limbs reach.
pub(crate) fn out_of_reach(ties: &[Option<Tie>; 4], moved: DVec3) -> Option<usize> {
    let beyond = ties.iter().enumerate().filter_map(|(index, tie)| {
        let tie = tie.as_ref()?;
        let share = (tie.end - (tie.root + moved)).length() / tie.length;
        let most = if index < 2 { 1.0 } else { FOOT_RELEASE_REACH };
        (share > most).then_some((index, share))
    });
    let worst = beyond.max_by(|a, b| a.1.total_cmp(&b.1));
    worst.map(|(index, _)| index)
}

/// Depth to which the pelvis has to go down for its feet, metres: each hip comes straight down onto the sphere of the
/// leg's reach about the ankle (Johansen 2009, "Automated semi-procedural animation for character locomotion", 7.4.2).
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

/// The pelvis's depth after another `dt` seconds. While the body walks, the pelvis is kept steady.
pub(crate) fn dropped(drop: f64, needed: f64, walks: bool, size: f64, dt: f64) -> f64 {
    let deepest = if walks { MAX_DROP_WALKING } else { MAX_DROP };
    let needed = needed.min(deepest * size);
    if needed > drop {
        let sinks = if walks {
            SINK_SPEED_WALKING
        } else {
            SINK_SPEED
        };
        needed.min(drop + sinks * size.sqrt() * dt)
    } else {
        damp(
            drop,
            needed,
            if walks {
                RISE_HALF_TIME_WALKING
            } else {
                RISE_HALF_TIME
            },
            dt,
        )
    }
}
