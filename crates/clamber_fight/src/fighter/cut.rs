//! Cuts: the blade is swept along its arc while the skin moves.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::{CastOptions, SkinnedSurface, WorldSweepHit};
use clamber_world::ObstacleId;

use super::{Blade, BodyFrame, SwordConfig};
use crate::arena::{CreatureId, Skins, creature_obstacle};

/// How far the chords on which something is looked for may be from the arc, metres.
const ARC: f64 = 0.004;

/// Into how many chords such a one is cut where something is near.
const FINER: u32 = 8;

/// No tick is cut into more chords.
const MOST_CHORDS: f64 = 1e4;

/// Something that a blade struck.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BladeHit {
    pub(crate) creature: CreatureId,
    pub(crate) hit: WorldSweepHit,
    /// Share of the tick.
    pub(crate) time: f64,
}

impl SwordConfig {
    /// The angle of the blade at a time of its cut: from 0 at the right to the whole angle.
    pub(super) fn cut_angle(&self, seconds: f64) -> f64 {
        self.angle * ((seconds - self.wind_up) / self.cut).clamp(0.0, 1.0)
    }

    /// What the blade strikes in a tick of `dt` seconds, in which the cut gets from one time to another and the body
    /// from one place to another: of each part of each creature the first contact, by time. Parts that are in `struck`
    /// are left out, and those that are struck are added to it.
    ///
    /// The blade's arc is swept in chords. Those of an arc of radius r that are at most e from it span `2 acos(1 - e /
    /// r)`; a blade that is thicker by e covers the arc, so that nothing is missed. Chords of [`ARC`] tell whether
    /// anything is near enough. Only there chords of an eighth of their length follow, which are 64 times nearer to the
    /// arc, and tell what is struck, and when: early by no more than it takes to come nearer by 0.06 mm and the sweep's
    /// tolerance.
    pub(crate) fn cut_through(
        &self,
        [from, to]: [f64; 2],
        frames: [BodyFrame; 2],
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
        let chord = 2.0 * libm::acos(1.0 - (ARC / reach).min(1.0));
        let parts = (turn / chord).ceil().clamp(1.0, MOST_CHORDS) as u32;
        let mut sweeps = Sweeps {
            struck,
            hits,
            radius: self.radius,
        };
        for chord in chords([begin, end], parts) {
            for (creature, skin) in skins.iter() {
                if !sweeps.is_near(skin, creature, chord, chord.map(blade)) {
                    continue;
                }
                for fine in chords(chord, FINER) {
                    sweeps.strike(skin, creature, fine, fine.map(blade));
                }
            }
        }
        hits.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.creature.cmp(&b.creature)));
    }
}

/// Cuts a span of the tick into parts.
fn chords([begin, end]: [f64; 2], parts: u32) -> impl Iterator<Item = [f64; 2]> {
    let at = move |part: u32| begin + (end - begin) * (f64::from(part) / f64::from(parts));
    (0..parts).map(move |part| [at(part), at(part + 1)])
}

/// Sweeps of a blade along chords.
struct Sweeps<'a> {
    struck: &'a mut Vec<(ObstacleId, u32)>,
    hits: &'a mut Vec<BladeHit>,
    /// Of the blade.
    radius: f64,
}

impl Sweeps<'_> {
    /// True if something that is not yet struck may be met on a chord.
    fn is_near(
        &self,
        skin: &SkinnedSurface,
        creature: CreatureId,
        span: [f64; 2],
        blades: [Blade; 2],
    ) -> bool {
        self.first(skin, creature, span, blades, ARC).is_some()
    }

    /// Strikes what is met on a chord.
    fn strike(
        &mut self,
        skin: &SkinnedSurface,
        creature: CreatureId,
        span: [f64; 2],
        blades: [Blade; 2],
    ) {
        let thicker = ARC / f64::from(FINER * FINER);
        while let Some(hit) = self.first(skin, creature, span, blades, thicker) {
            self.struck
                .push((creature_obstacle(creature), hit.hit.part.0));
            self.hits.push(BladeHit {
                creature,
                hit,
                time: span[0] + (span[1] - span[0]) * hit.time,
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
    ) -> Option<WorldSweepHit> {
        let capsule = WorldCapsule {
            ends: [before.hilt, before.tip],
            radius: self.radius + thicker,
        };
        let ways = [after.hilt - before.hilt, after.tip - before.tip];
        let options = CastOptions::MOVING
            .during(from, to)
            .with_tolerance(capsule.sweep_tolerance());
        let mut is_new = |hit: &WorldSweepHit| {
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
