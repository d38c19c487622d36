//! How far the creature may turn.

use core::ops::Range;

use clamber_surface::geometry::WorldCapsule;
use glam::DVec3;

use super::{Among, OBSTACLE_MARGIN, Room, STEP_OVER_HEIGHT, STRAIGHT_FROM};
use crate::kind::{BAND_COUNT, BAND_EDGES};

/// Largest angle of the chords in which the arcs of a turn are checked, radians. Such a chord leaves its arc by 1.1 %
/// of the radius.
const MOST_CHORD_ANGLE: f64 = 0.3;

impl Room<'_> {
    /// How far the creature may turn on the spot, radians: at most `far` and with its sign, positive to the left.
    pub(in crate::creature) fn turn(&self, far: f64, slope: DVec3) -> f64 {
        let pieces = (far.abs() / MOST_CHORD_ANGLE).ceil().max(1.0);
        let piece = far / pieces;
        let mut free = 0.0;
        for index in 0..pieces as u32 {
            let turned = self.turn_piece(f64::from(index) * piece, piece, slope);
            free += turned;
            if turned.abs() < piece.abs() {
                break;
            }
        }
        free
    }

    /// How far the creature may turn on after it has turned by the angle `from`, radians: at most `far` and with its
    /// sign.
    fn turn_piece(&self, from: f64, far: f64, slope: DVec3) -> f64 {
        let mut free = far.abs();
        let feet = self.band(0);
        let over = STEP_OVER_HEIGHT * self.height;
        for (aside, along) in [
            (feet.right, feet.back),
            (feet.left, feet.back),
            (feet.right, feet.front),
            (feet.left, feet.front),
        ] {
            // A place where the feet may stand after this turn.
            let corner = turned(self.left * aside + self.forward * along, from + far);
            let below = self.below(self.origin + corner + DVec3::Y * corner.dot(slope));
            let most = self.steepest * corner.length() + over;
            if below.is_none_or(|level| (level - self.origin.y).abs() > most) {
                free = 0.0;
            }
        }
        for index in 1..BAND_COUNT {
            let turn = [from, far];
            if index == STRAIGHT_FROM && self.is_turn_clear(index..BAND_COUNT, turn, slope) {
                break;
            }
            if !self.is_turn_clear(index..index + 1, turn, slope) {
                free = self
                    .turn_band(index, [from, far.signum() * free], slope)
                    .abs();
            }
        }
        far.signum() * free
    }

    /// How far one band may turn on from the angle `from`, radians: at most `by` and with its sign.
    fn turn_band(&self, index: usize, [from, by]: [f64; 2], slope: DVec3) -> f64 {
        let mut free = by;
        let band = self.band(index);
        let thick = self.thick(index);
        let inner = thick - OBSTACLE_MARGIN * self.height;
        let [back, right] = [band.back, band.right].map(|at| (at + inner).min(0.0));
        let [front, left] = [band.front, band.left].map(|at| (at - inner).max(0.0));
        // Along the body, across it, and along both diagonals of its box.
        let spans = [
            [(0.0, back), (0.0, front)],
            [(right, 0.0), (left, 0.0)],
            [(right, back), (left, front)],
            [(left, back), (right, front)],
        ];
        for span in spans {
            let ends =
                span.map(|(aside, along)| turned(self.left * aside + self.forward * along, from));
            let turned = ends.map(|end| turned(end, free));
            let place = |level: DVec3| {
                let up = self.middle(index) + level.dot(slope);
                self.origin + level + DVec3::Y * up
            };
            let from = ends.map(place);
            let to = turned.map(place);
            let capsule = WorldCapsule {
                ends: from,
                radius: thick,
            };
            let ways = [to[0] - from[0], to[1] - from[1]];
            let goes = |contact: DVec3| {
                let way = DVec3::Y.cross(contact - self.origin) * by.signum();
                way.normalize_or_zero()
            };
            let all = [Among::Terrain, Among::Creatures];
            if let Some(time) = self.sweep(&capsule, ways, &goes, &all) {
                free *= time;
            }
        }
        free
    }

    /// True if certainly nothing is in the way of several bands that turn by the angle `by` from the angle `from`.
    ///
    /// A single capsule, as thick as the bands are high together, lies along the body at the middle of the turn. It
    /// sweeps sideways over the whole area that the bands pass. It covers a box without bulging out above and below.
    fn is_turn_clear(&self, bands: Range<usize>, [from, by]: [f64; 2], slope: DVec3) -> bool {
        let around = self.box_of(bands.clone());
        // The bands' capsules are round, so their axes end this far inside the bands' boxes.
        let thicks = bands.clone().map(|index| self.thick(index));
        let inner = thicks.fold(f64::INFINITY, f64::min) - OBSTACLE_MARGIN * self.height;
        let back = (around.back + inner).min(0.0);
        let front = (around.front - inner).max(0.0);
        let wide = (around.left.max(-around.right) - inner).max(0.0);
        let sine = libm::sin((0.5 * by).abs());
        let aside = wide + front.max(-back) * sine;
        let along = [back - wide * sine, front + wide * sine];
        let axis = turned(self.forward, from + 0.5 * by);
        let side = DVec3::new(axis.z, 0.0, -axis.x);
        let [low, high] = [bands.start, bands.end].map(|edge| BAND_EDGES[edge] * self.height);
        let sloped = |level: DVec3| level + DVec3::Y * level.dot(slope);
        let middle = self.origin + DVec3::Y * (0.5 * (low + high));
        let capsule = WorldCapsule {
            ends: along.map(|along| middle + sloped(axis * along - side * aside)),
            radius: 0.5 * (high - low),
        };
        self.is_clear(&capsule, sloped(side * (2.0 * aside)))
    }
}

/// Turns a horizontal vector about Y.
fn turned(level: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(angle);
    DVec3::new(
        level.x * cos + level.z * sin,
        level.y,
        level.z * cos - level.x * sin,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::creature::Surroundings;
    use crate::kind::{Band, Extent};
    use clamber_world::{Obstacle, TriangleTerrain};
    use glam::Vec3;

    /// Bodies of random boxes on random slopes, with a small triangle near them. If a turn is reported as clear, no
    /// sweep of a band may meet anything. Many turns must be clear, and many must meet the triangle.
    #[test]
    fn turns_that_are_clear_meet_nothing() {
        let mut rng = fastrand::Rng::with_seed(7);
        let (mut clear, mut met) = (0, 0);
        for _ in 0..12_000 {
            let mut up_to = |most: f64| rng.f64() * most;
            let height = 0.5 + up_to(40.0);
            let bands = core::array::from_fn(|_| Band {
                right: -up_to(1.2),
                left: up_to(1.2),
                back: -up_to(1.2),
                front: up_to(1.2),
            });
            let extent = Extent { bands };
            let slope = DVec3::new(up_to(1.0) - 0.5, 0.0, up_to(1.0) - 0.5);
            let turn = [up_to(6.0), up_to(2.0 * MOST_CHORD_ANGLE) - MOST_CHORD_ANGLE];
            let forward = turned(DVec3::Z, up_to(6.0));
            let mut random = || Vec3::from_array(core::array::from_fn(|_| up_to(2.0) as f32 - 1.0));
            let (at, size) = (random() * 1.5, random().x);
            let corners = [random(), random(), random()];
            let corners =
                corners.map(|corner| (at + Vec3::Y * 0.5 + corner * size) * height as f32);
            let origin = DVec3::new(-70.0, 8.0, 3000.0);
            let triangle = TriangleTerrain::new(&corners, &[[0, 1, 2]], &[], origin).unwrap();
            let terrain: [&dyn Obstacle; 1] = [&triangle];
            let around = Surroundings {
                terrain: &terrain,
                ..Surroundings::default()
            };
            let room = Room {
                around: &around,
                extent: &extent,
                origin,
                forward,
                left: DVec3::new(forward.z, 0.0, -forward.x),
                scale: height,
                height,
                steepest: 1.0,
            };
            let single = (0..BAND_COUNT).map(|index| index..index + 1);
            for bands in single.chain(std::iter::once(STRAIGHT_FROM..BAND_COUNT)) {
                let mut ends = bands
                    .clone()
                    .map(|index| room.turn_band(index, turn, slope));
                let meets = ends.any(|free| free != turn[1]);
                let is_clear = room.is_turn_clear(bands.clone(), turn, slope);
                assert!(
                    !(is_clear && meets),
                    "{bands:?} {turn:?} {slope} {extent:?} {corners:?}"
                );
                clear += u32::from(is_clear);
                met += u32::from(meets);
            }
        }
        println!("{clear} clear, {met} met something, of 72,000");
        assert!(clear > 20_000 && met > 2_000, "{clear} {met}");
    }
}
