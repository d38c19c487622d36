//! Cuts: the blade is swept along its arc while the skin moves.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::{CastOptions, SkinnedSurface, SweepHit};
use clamber_world::ObstacleId;
use glam::DVec3;

use super::{Blade, FighterFrame, SwordConfig};
use crate::arena::{CreatureId, Skins, creature_obstacle};

/// Greatest distance of a coarse chord from the blade's arc, metres. The blade is thickened by it for the coarse test.
const MOST_ARC_ERROR: f64 = 0.004;

/// Number of fine chords into which a coarse chord is divided where a creature is near.
const FINE_CHORDS: u32 = 8;

/// Greatest number of coarse chords in a tick. It bounds the cost of an extremely fast cut.
const MOST_CHORDS: f64 = 1e4;

/// A contact of a blade with a part of a creature.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BladeHit {
    pub(crate) creature: CreatureId,
    pub(crate) hit: SweepHit<DVec3>,
    /// Time of the contact, as a share of the tick.
    pub(crate) time: f64,
}

impl SwordConfig {
    /// Angle of the blade in a cut, `seconds` after its beginning: 0 at the right, up to the whole angle, radians.
    pub(super) fn cut_angle(&self, seconds: f64) -> f64 {
        self.angle * ((seconds - self.wind_up) / self.cut).clamp(0.0, 1.0)
    }

    /// Adds to `hits` the first contact of the blade with each part of each creature in a tick of `dt` seconds, sorted
    /// by time. In the tick, the cut goes from one time to another, and the body from one frame to another. Parts in
    /// `struck` are skipped, and the parts that are hit are added to it.
    ///
    /// The blade's arc is swept in chords. A chord that spans at most `2 acos(1 - e / r)` of an arc of radius r stays
    /// within e of it. A blade that is thicker by e then covers the arc, so no contact is missed. Coarse chords, for
    /// which e is [`MOST_ARC_ERROR`], only tell whether a creature is near. Where one is, fine chords find the
    /// contacts: they have an eighth of the length, and are 64 times nearer to the arc. A contact is early by at most
    /// the time in which the blade comes nearer by 0.06 mm and the sweep's tolerance.
    pub(crate) fn cut_through(
        &self,
        [from, to]: [f64; 2],
        frames: [FighterFrame; 2],
        dt: f64,
        skins: Skins<'_>,
        struck: &mut Vec<(ObstacleId, u32)>,
        hits: &mut Vec<BladeHit>,
    ) {
        let share = |seconds: f64| ((seconds - from) / dt).clamp(0.0, 1.0);
        let [begin, end] = [share(self.wind_up), share(self.wind_up + self.cut)];
        if from > self.wind_up + self.cut || to < self.wind_up || begin >= end {
            return;
        }
        let blade = |share: f64| {
            let frame = frames[0].to(&frames[1], share);
            self.in_cut(&frame, self.cut_angle(from + share * dt))
        };
        let turn = self.cut_angle(to) - self.cut_angle(from) + frames[0].angle_to(&frames[1]);
        let reach = self.arm + self.blade;
        let chord = 2.0 * libm::acos(1.0 - (MOST_ARC_ERROR / reach).min(1.0));
        let parts = (turn / chord).ceil().clamp(1.0, MOST_CHORDS) as u32;
        let mut sweeps = Sweeps {
            struck,
            hits,
            radius: self.radius,
        };
        for chord in chords([begin, end], parts) {
            for (creature, skin) in skins.iter() {
                // Only if the thickened blade may touch a part on the chord that is not yet struck.
                let blades = chord.map(blade);
                let near = sweeps.first(skin, creature, chord, blades, MOST_ARC_ERROR);
                if near.is_none() {
                    continue;
                }
                for fine in chords(chord, FINE_CHORDS) {
                    sweeps.strike(skin, creature, fine, fine.map(blade));
                }
            }
        }
        hits.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.creature.cmp(&b.creature)));
    }
}

/// Divides a span of the tick into equal parts.
fn chords([begin, end]: [f64; 2], parts: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |part: u32| begin + (end - begin) * (f64::from(part) / f64::from(parts));
    (0..parts).map(move |part| [at(part), at(part + 1)])
}

/// Sweeps of a blade along chords.
struct Sweeps<'a> {
    struck: &'a mut Vec<(ObstacleId, u32)>,
    hits: &'a mut Vec<BladeHit>,
    /// Radius of the blade, metres.
    radius: f64,
}

impl Sweeps<'_> {
    /// Records the contacts on a fine chord.
    fn strike(
        &mut self,
        skin: &SkinnedSurface,
        creature: CreatureId,
        span: [f64; 2],
        blades: [Blade; 2],
    ) {
        let thicker = MOST_ARC_ERROR / f64::from(FINE_CHORDS * FINE_CHORDS);
        while let Some(hit) = self.first(skin, creature, span, blades, thicker) {
            self.struck
                .push((creature_obstacle(creature), hit.hit.part.0));
            self.hits.push(BladeHit {
                creature,
                hit,
                time: span[0] + (span[1] - span[0]) * hit.fraction,
            });
        }
    }

    fn first(
        &self,
        skin: &SkinnedSurface,
        creature: CreatureId,
        [from, to]: [f64; 2],
        [before, after]: [Blade; 2],
        thicker: f64,
    ) -> Option<SweepHit<DVec3>> {
        let capsule = WorldCapsule {
            ends: [before.hilt, before.tip],
            radius: self.radius + thicker,
        };
        let ways = [after.hilt - before.hilt, after.tip - before.tip];
        let options = CastOptions::MOVING
            .during(from, to)
            .with_tolerance(capsule.sweep_tolerance());
        let mut is_new = |hit: &SweepHit<DVec3>| {
            !self
                .struck
                .contains(&(creature_obstacle(creature), hit.hit.part.0))
        };
        let space = skin.in_world();
        space.cast_capsule_where(&capsule, ways, &options, &mut is_new)
    }
}

#[cfg(test)]
mod tests;
