//! Moving ground, such as ships that turn and lifts that rise, carries the creatures that stand and walk on it.

use std::sync::Arc;

use clamber_colossus::{Creature, CreatureKind};
use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{SkinnedSurface, TargetMotion};
use clamber_world::{
    Contact, HalfSpace, MaterialPoint, Obstacle, PointMotion, SweepContact, WorldCapsule,
};
use glam::{DVec3, Vec3};

use crate::support::life::motion;
use crate::support::{TICK, noise, on_terrain, with_noises};
use crate::walls::{config, creatures};

/// An endless level deck with an exact motion. It turns about the vertical axis only.
#[derive(Clone, Copy)]
pub(crate) struct Deck {
    pub(crate) before: Similarity,
    pub(crate) now: Similarity,
}

impl Deck {
    fn level(&self) -> HalfSpace {
        HalfSpace::below(self.now.translation.y)
    }

    fn contact(&self, contact: Contact) -> Contact {
        let material = MaterialPoint {
            key: 0,
            coordinates: self.now.inverse_transform_point(contact.point).to_array(),
        };
        Contact {
            material,
            ..contact
        }
    }
}

impl Obstacle for Deck {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let from = contacts.len();
        self.level().overlap_capsule(capsule, contacts);
        for contact in &mut contacts[from..] {
            *contact = self.contact(*contact);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let hit = self.level().cast_capsule(capsule, displacements, target)?;
        Some(SweepContact {
            contact: self.contact(hit.contact),
            ..hit
        })
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        Some(motion([self.before, self.now], point, dt))
    }
}

/// The life of a creature on a deck: its states and its places relative to the deck, in each tick.
struct Life {
    states: Vec<usize>,
    places: Vec<DVec3>,
    /// Largest distance of a settled sole from the deck, as a share of the tolerance: the larger of 1 % of the foot's
    /// length and 0.1 % of the height.
    gap: f64,
}

/// In each lap the creature turns and walks to another noise on the deck, and stands there.
fn live(kind: &Arc<CreatureKind>, moves: &dyn Fn(f64) -> Similarity) -> Life {
    let mut creature = Creature::new(Arc::clone(kind), config()).unwrap();
    let height = creature.height();
    let mut deck = Deck {
        before: Similarity::IDENTITY,
        now: Similarity::IDENTITY,
    };
    let mut life = Life {
        states: Vec::new(),
        places: Vec::new(),
        gap: 0.0,
    };
    let legs = kind.brain().file().body.legs.len();
    let mut since = vec![0u32; legs];
    let settled = (0.6 * height.sqrt() / TICK) as u32;
    let lap = 20.0 * height.sqrt();
    for tick in 1..=(3.0 * lap / TICK) as u32 {
        let time = f64::from(tick) * TICK;
        let at = moves(time);
        (deck.before, deck.now) = (deck.now, at);
        let angle = (time / lap).floor() * 2.4;
        let place = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * (3.0 * height);
        let noises = [noise(at.transform_point(place))];
        let rings = time.rem_euclid(lap) > 2.0 * height.sqrt();
        let terrain: [&dyn Obstacle; 1] = [&deck];
        creature
            .step(&with_noises(&terrain, &noises[..usize::from(rings)]))
            .unwrap();
        life.states.push(creature.state().current().index());
        life.places
            .push(at.inverse_transform_point(creature.state().position()));
        for (leg, since) in since.iter_mut().enumerate() {
            *since = if creature.state().is_planted(leg) {
                *since + 1
            } else {
                0
            };
            if *since > settled {
                let most = (0.01 * kind.foot_length(leg) * creature.scale()).max(0.001 * height);
                let gap = creature.foot_clearance(leg, &terrain).unwrap() / most;
                life.gap = life.gap.max(gap.abs());
            }
        }
    }
    life
}

#[test]
fn on_a_deck_that_moves_it_lives_as_on_one_that_does_not() {
    let mut failed = Vec::new();
    for (name, kind, height) in creatures().into_iter().take(3) {
        let at_rest = live(&kind, &|_| Similarity::IDENTITY);
        let pace = height.sqrt();
        let sails =
            |time: f64| Similarity::from_translation(DVec3::new(1.3, 0.0, -0.8) * (time * pace));
        let rises = |time: f64| Similarity::from_translation(DVec3::Y * (0.5 * time * pace));
        let turns = |time: f64| Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, 0.2 * time / pace),
            translation: DVec3::new(3.0, 0.3, 0.0) * (time * pace),
            ..Similarity::IDENTITY
        };
        let all: [(&str, &dyn Fn(f64) -> Similarity); 3] =
            [("sails", &sails), ("rises", &rises), ("turns", &turns)];
        for (what, moves) in all {
            let carried = live(&kind, moves);
            let away = carried.places.iter().zip(&at_rest.places);
            let away = away.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / height;
            let other = carried.states.iter().zip(&at_rest.states);
            let other = other.filter(|(a, b)| a != b).count();
            let moved = at_rest.places.last().unwrap().length() / height;
            let told = format!(
                "{name} {what}: {away:.2e} heights away, {other} ticks in another state, soles \
                 {:.2} (at rest {:.2}), ends {moved:.1} heights away",
                carried.gap, at_rest.gap
            );
            println!("{told}");
            if away > 1e-6 || other > 0 || carried.gap > 1.0 || moved < 1.0 {
                failed.push(told);
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// A plate of two triangles on one joint.
pub(crate) fn plate(corners: [Vec3; 4]) -> SkinnedSurface {
    let source = MeshSource::rigid(&corners, &[[0, 1, 2], [0, 2, 3]]);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

/// A plate of 3 m that slides and spins between the giant's feet does not carry it.
#[test]
fn what_moves_between_its_feet_does_not_carry_it() {
    let (_, kind, _) = creatures().remove(0);
    let corners = [(-1.5, -1.5), (-1.5, 1.5), (1.5, 1.5), (1.5, -1.5)];
    let mut plate = plate(corners.map(|(x, z)| Vec3::new(x, 0.2, z)));
    let still = Palette::from_matrices([Affine::IDENTITY]);
    let ground = HalfSpace::below(0.0);
    let mut creature = Creature::new(kind, config()).unwrap();
    let (mut moved, mut turned) = (0f64, 0f64);
    for tick in 0..240 {
        let time = f64::from(tick) * TICK;
        let at = Similarity {
            rotation: rotation_from_axis_angle(DVec3::Y, 3.0 * time),
            translation: DVec3::X * (0.5 * time - 1.0),
            ..Similarity::IDENTITY
        };
        plate.advance(&still, at).unwrap();
        let terrain: [&dyn Obstacle; 2] = [&ground, &plate];
        creature.step(&on_terrain(&terrain)).unwrap();
        moved = moved.max(creature.state().position().with_y(0.0).length());
        turned = turned.max(creature.state().yaw().abs());
    }
    assert!(moved < 1e-9 && turned < 1e-9, "{moved} m, {turned}");
}
