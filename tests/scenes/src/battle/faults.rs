//! The first fault of each check, described so that it can be found again.

use std::collections::BTreeMap;

use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::DVec3;

use super::{Performer, TICK};

/// Descriptions name the nearest skin within this distance of a place, as a share of the creature's height.
const NEAR: f64 = 0.25;

/// The creature at one tick, for descriptions of faults.
#[derive(Clone, Copy)]
pub(super) struct Moment<'a> {
    /// The creature's part of the battle.
    pub(super) performer: &'a Performer<'a>,
    /// The creature's height, metres.
    pub(super) height: f64,
    /// Number of the tick.
    pub(super) tick: u64,
}

impl<'a> Moment<'a> {
    /// The creature's skin.
    pub(super) fn surface(&self) -> &'a SkinnedSurface {
        self.performer.surface()
    }

    /// Describes a fault `what` at a place: tick, clip, position, and the nearest skin with its speed.
    pub(super) fn describe(&self, what: &str, place: DVec3) -> String {
        let seconds = self.tick as f64 * TICK;
        let near = self.surface().closest_point(place, NEAR * self.height);
        let skin = near.map_or("no skin near".into(), |near| {
            let motion = self.surface().motion(&near.material, TICK);
            let speed = motion.map_or(0.0, |motion| motion.velocity.length());
            let (distance, joint) = (near.distance, self.joint(near.material.key));
            format!("{distance:.3} m from skin of {joint} that moves at {speed:.1} m/s")
        });
        format!(
            "tick {} ({seconds:.2} s, {}): {what} at ({:.2}, {:.2}, {:.2}), {skin}",
            self.tick,
            self.performer.playing(),
            place.x,
            place.y,
            place.z,
        )
    }

    /// The name of the joint that moves a triangle most.
    fn joint(&self, triangle: u64) -> String {
        let mesh = self.surface().mesh();
        let joint = mesh.joint_of(TriangleId(triangle as u32));
        let joints = self.performer.creature().skeleton.joints();
        joint
            .and_then(|joint| joints.get(joint.0 as usize))
            .map_or("no joint".into(), |joint| joint.name.clone())
    }
}

/// The first fault of every check, by the check's name.
#[derive(Clone, Debug, Default)]
pub(super) struct Faults(BTreeMap<&'static str, String>);

impl Faults {
    /// Keeps the text of `describe` if it is the check's first fault; calls it only then.
    pub(super) fn note(&mut self, check: &'static str, describe: impl FnOnce() -> String) {
        self.0.entry(check).or_insert_with(describe);
    }

    /// The first fault of a check; `None` if there was none.
    pub(super) fn first(&self, check: &str) -> Option<&str> {
        self.0.get(check).map(String::as_str)
    }
}
