//! Knees bend one way, and legs pass beside each other: the second half of scene B44.

use crate::support;

use crate::support::{TICK, ground, person, strew_boulders, terrain_of, with_people};
use clamber_animation::rig::JointId;
use clamber_colossus::{Creature, CreatureConfig, CreatureKind};
use clamber_surface::mesh::VertexId;
use clamber_world::Obstacle;
use clamber_world::rapier3d::parry::query::contact;
use clamber_world::rapier3d::parry::shape::ConvexPolyhedron;
use clamber_world::rapier3d::prelude::{PhysicsWorld, Pose};
use glam::{DQuat, DVec3, Vec3};

/// States in which the giant walks about, kicks and stomps, as JSON.
const LIVES: &str = r#"{
    "roams": { "act": { "walk": { "to": "patrol", "within": 10 } }, "transitions": [
        { "to": "kicks", "when": ["done"] }, { "to": "kicks", "after": 20 }] },
    "kicks": { "act": { "attack": { "clip": "kick_left", "limb": ["foot.L", "toe.L"], "damage": 0.5, "throw": 9, "aim": 5 } },
        "transitions": [{ "to": "stomps" }] },
    "stomps": { "act": { "attack": { "clip": "stomp", "limb": ["foot.R", "toe.R"], "damage": 0.5, "throw": 9, "aim": 5 } },
        "transitions": [{ "to": "roams" }] }
}"#;

/// The convex hull of the skin that moves with these joints alone, in the space of the first joint.
struct Part {
    joint: JointId,
    hull: ConvexPolyhedron,
}

impl Part {
    fn new(kind: &CreatureKind, names: &[&str]) -> Self {
        let skeleton = kind.skeleton();
        let joints: Vec<JointId> = (names.iter())
            .map(|name| skeleton.find(name).unwrap())
            .collect();
        let mesh = kind.mesh();
        let is_part = |vertex: VertexId| {
            let influences = mesh.influences(vertex);
            let ours = influences.filter(|(joint, _)| joints.contains(joint));
            ours.map(|(_, weight)| weight).sum::<f32>() > 0.95
        };
        let inverse = skeleton.joints()[joints[0].index()].inverse_bind.to_f64();
        let points: Vec<Vec3> = (mesh.positions().iter().enumerate())
            .filter(|(index, _)| is_part(VertexId(*index as u32)))
            .map(|(_, place)| inverse.transform_point3(place.as_dvec3()).as_vec3())
            .collect();
        Self {
            joint: joints[0],
            hull: ConvexPolyhedron::from_convex_hull(&points).unwrap(),
        }
    }

    fn pose(&self, giant: &Creature) -> Pose {
        let frame = giant.palette().model_from_joint(self.joint).unwrap();
        let (_, rotation, place) = frame.to_scale_rotation_translation();
        Pose::from_parts(place.as_vec3(), rotation.as_quat())
    }
}

#[derive(Debug)]
struct Figures {
    /// Least angle of a knee, radians.
    knee: f64,
    /// Least distance of a knee in front of the line from hip to ankle, as a share of the leg's length.
    front: f64,
    /// Largest depth of one leg in the other, metres.
    depth: f64,
    /// Time of that depth, seconds.
    at: f64,
}

fn live(world: &PhysicsWorld, seed: u64, seconds: f64) -> Figures {
    let kind = support::kind(&support::brain_with("roams", LIVES));
    let config = CreatureConfig {
        seed,
        most_slope: 0.6,
        ..CreatureConfig::default()
    };
    let mut giant = support::creature(&kind, config);
    let terrain = terrain_of(world);
    let all: [&dyn Obstacle; 1] = [&terrain];
    let find = |name: &str| kind.skeleton().find(name).unwrap();
    let legs = ["L", "R"]
        .map(|side| ["thigh", "shin", "foot"].map(|name| find(&format!("{name}.{side}"))));
    let parts = ["L", "R"].map(|side| {
        let name = |name: &str| format!("{name}.{side}");
        [
            Part::new(&kind, &[&name("foot"), &name("toe")]),
            Part::new(&kind, &[&name("shin")]),
        ]
    });
    let mut figures = Figures {
        knee: f64::INFINITY,
        front: f64::INFINITY,
        depth: 0.0,
        at: 0.0,
    };
    for tick in 0..(seconds / TICK) as usize {
        let people = [person(giant.state().position() + DVec3::new(3.0, 0.0, 9.0))];
        giant.step(&with_people(&all, &people)).unwrap();
        let frame = |joint| giant.palette().model_from_joint(joint).unwrap();
        let pelvis = frame(find("pelvis")).to_scale_rotation_translation().1;
        // Forward turns with the pelvis, relative to its rest pose.
        let at_rest = kind.skeleton().joints()[find("pelvis").index()]
            .inverse_bind
            .to_f64();
        let at_rest = DQuat::from_mat3(&at_rest.matrix3);
        let forward = pelvis * at_rest * DVec3::Z;
        for leg in legs {
            let [hip, knee, ankle] = leg.map(|joint| frame(joint).translation);
            let (thigh, shin) = (hip - knee, ankle - knee);
            figures.knee = figures.knee.min(angle(thigh, shin));
            let line = (ankle - hip).normalize();
            let out = (knee - hip).reject_from(line);
            let length = thigh.length() + shin.length();
            figures.front = figures.front.min(out.dot(forward) / length);
        }
        for one in &parts[0] {
            for other in &parts[1] {
                let hit = contact(
                    &one.pose(&giant),
                    &one.hull,
                    &other.pose(&giant),
                    &other.hull,
                    0.0,
                );
                let depth = hit.unwrap().map_or(0.0, |hit| -f64::from(hit.dist));
                if depth > figures.depth {
                    figures.depth = depth;
                    figures.at = tick as f64 * TICK;
                }
            }
        }
    }
    println!("{figures:.3?}");
    figures
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

fn check(figures: &Figures) {
    // The limits leave room for the rounding of poses to f32.
    assert!(figures.knee > 19.9f64.to_radians(), "{figures:?}");
    assert!(figures.front > -0.005, "{figures:?}");
    assert!(figures.depth < 0.02, "{figures:?}");
}

#[test]
fn on_level_ground() {
    check(&live(&ground(|_, _| 0.0), 4, 180.0));
}

#[test]
fn on_a_slope_of_25_degrees() {
    let slope = libm::tan(25f64.to_radians());
    check(&live(&ground(|_, z| slope * z), 4, 180.0));
}

#[test]
fn on_boulders_of_2_m() {
    let mut world = ground(|_, _| 0.0);
    strew_boulders(&mut world, 7);
    for seed in [13, 31, 39, 56] {
        check(&live(&world, seed, 180.0));
    }
}
