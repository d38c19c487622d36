//! The giant's clips: the shakes that riders feel, and the starts of limbs. Scenes B42, B43 and B46.

use crate::support::{Feel, TICK, brain_file, kind};
use clamber_animation::rig::{Clip, JointId, Playback, WeakPoint};
use clamber_climber::{Climber, ClimberConfig, ClimberInput};
use clamber_colossus::CreatureKind;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{SurfaceKind, TriangleId};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle, ObstacleId};
use glam::DVec3;

/// Clips that play in a loop. They do not start from rest, so the test of abrupt starts leaves them out.
const LOOPS: [&str; 6] = [
    "idle",
    "walk",
    "turn_left",
    "turn_right",
    "breathe",
    "shake_loop",
];

/// The shakes, each with the weak point that it is meant for.
const SHAKES: [(&str, &str); 4] = [
    ("shake", "weak_point_nape"),
    ("rage", "weak_point_nape"),
    ("shake_head", "weak_point_head"),
    ("shake_arm_left", "weak_point_forearm.L"),
];

fn clip<'a>(kind: &'a CreatureKind, name: &str) -> &'a Clip {
    let id = kind.clips().find(name).unwrap();
    kind.clips().clip(id).unwrap()
}

/// Plays a clip and half a second more on a skin. Calls `look` after every tick.
fn play(kind: &CreatureKind, clip: &Clip, mut look: impl FnMut(&SkinnedSurface)) {
    let rest = kind.skeleton().rest_pose();
    let mut surface = SkinnedSurface::new(std::sync::Arc::clone(kind.mesh()));
    for tick in 0..=(clip.duration() / TICK) as u32 + 30 {
        let time = f64::from(tick) * TICK;
        let pose = clip.sample(&rest, time, Playback::Clamp).unwrap();
        let palette = kind.skeleton().palette(&pose).unwrap();
        if tick == 0 {
            surface.teleport(&palette, Similarity::IDENTITY).unwrap();
        } else {
            surface.advance(&palette, Similarity::IDENTITY).unwrap();
        }
        look(&surface);
    }
}

/// The weak point with this name.
fn find<'a>(kind: &'a CreatureKind, weak_point: &str) -> &'a WeakPoint {
    let mut all = kind.weak_points().iter();
    all.find(|one| one.name == weak_point).unwrap()
}

/// Points of fur and stone around a weak point, each with its distance from it, nearest first.
fn spots(kind: &CreatureKind, weak_point: &str) -> Vec<(f64, MaterialPoint)> {
    let point = find(kind, weak_point);
    let rest = kind.skeleton().rest_pose();
    let palette = kind.skeleton().palette(&rest).unwrap();
    let frame = palette.model_from_joint(point.joint).unwrap();
    let place = frame.transform_point3(point.position.as_dvec3());
    let mesh = kind.mesh();
    let middle = |triangle: &[clamber_surface::mesh::VertexId; 3]| {
        let sum: DVec3 = triangle
            .iter()
            .map(|vertex| mesh.positions()[vertex.0 as usize].as_dvec3())
            .sum();
        sum / 3.0
    };
    let mut all: Vec<(f64, usize)> = mesh
        .triangles()
        .iter()
        .enumerate()
        .map(|(index, triangle)| (middle(triangle).distance(place), index))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let material =
        |index: usize| MaterialPoint::on_triangle(TriangleId(index as u32), [1.0 / 3.0; 3]);
    let near = all.iter().filter(|(distance, index)| {
        *distance < all[0].0 + 1.5 && mesh.tags()[*index].kind != SurfaceKind::Skin
    });
    near.map(|(away, index)| (*away, material(*index)))
        .collect()
}

/// The shake that is felt at a point of the skin.
#[derive(Clone, Copy, Debug, Default)]
struct Felt {
    feel: Feel,
    /// Time above 15 m/s^2, seconds.
    thrown: f64,
    /// Time integral of the acceleration above 4 m/s^2, m/s.
    excess: f64,
    /// Largest acceleration, m/s^2.
    most: f64,
}

/// Within a weak point there is skin where a shake throws a climber but does not wear it out. Near it there is skin
/// where a climber can hold out.
#[test]
fn shakes_throw_and_can_be_held_out() {
    let kind = kind(&brain_file());
    for (name, weak_point) in SHAKES {
        let near = spots(&kind, weak_point);
        let mut felt = vec![Felt::default(); near.len()];
        play(&kind, clip(&kind, name), |surface| {
            for (felt, (_, point)) in felt.iter_mut().zip(&near) {
                let now = felt
                    .feel
                    .step(surface.motion(point, TICK).unwrap().position);
                felt.thrown += f64::from(u8::from(now > 15.0)) * TICK;
                felt.excess += (now - 4.0).max(0.0) * TICK;
                felt.most = felt.most.max(now);
            }
        });
        let radius = f64::from(find(&kind, weak_point).radius) + near[0].0;
        let inside = near
            .iter()
            .zip(&felt)
            .filter(|((away, _), _)| *away <= radius);
        let bounded = |felt: &&Felt| felt.excess <= 20.0;
        let best = inside
            .map(|(_, felt)| felt)
            .filter(bounded)
            .max_by(|a, b| a.thrown.total_cmp(&b.thrown))
            .unwrap();
        let calm = felt
            .iter()
            .map(|felt| felt.most)
            .fold(f64::INFINITY, f64::min);
        println!(
            "{name}: above 15 m/s^2 for {:.2} s, {:.1} m/s above 4; {calm:.1} m/s^2 at the calmest spot of {}",
            best.thrown,
            best.excess,
            near.len()
        );
        assert!(best.thrown >= 0.3, "{name}: {} s", best.thrown);
        assert!(calm <= 10.5, "{name}: {calm} m/s^2");
    }
}

/// A climber on the nape holds on through shakes with rests of three seconds between them. It survives at least one
/// shake at every point, two or more at a third of the points at least, and six at no point.
#[test]
fn a_fresh_climber_survives_two_shakes_and_not_six() {
    let kind = kind(&brain_file());
    let shake = clip(&kind, "shake");
    let rest = kind.skeleton().rest_pose();
    let mut surface = SkinnedSurface::new(std::sync::Arc::clone(kind.mesh()));
    let pose = |time: f64| {
        let pose = shake.sample(&rest, time, Playback::Clamp).unwrap();
        kind.skeleton().palette(&pose).unwrap()
    };
    // The shell over the nape is broken.
    for triangle in kind.plates().iter().flat_map(|plate| &plate.triangles) {
        surface.disable_triangle(*triangle).unwrap();
    }
    let near = spots(&kind, "weak_point_nape");
    let mesh = kind.mesh();
    let is_fur = |point: &MaterialPoint| mesh.tags()[point.key as usize].kind == SurfaceKind::Fur;
    let mut survived = Vec::new();
    for (away, point) in near.iter().filter(|(_, point)| is_fur(point)) {
        surface.teleport(&pose(0.0), Similarity::IDENTITY).unwrap();
        let corners = mesh.triangles()[point.key as usize]
            .map(|vertex| surface.in_model().position(vertex).unwrap().as_dvec3());
        let normal = (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .normalize();
        let place = (corners[0] + corners[1] + corners[2]) / 3.0;
        let config = ClimberConfig::colossus_climber();
        let above = place + normal * (config.body.radius + 0.05);
        let mut climber = Climber::new(config, above).unwrap();
        let input = ClimberInput {
            grip: true,
            ..ClimberInput::default()
        };
        let mut step = |surface: &SkinnedSurface| {
            let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), surface)];
            climber.step(&input, &obstacles, TICK).unwrap();
            climber.state().support.is_some()
        };
        for _ in 0..60 {
            surface.advance(&pose(0.0), Similarity::IDENTITY).unwrap();
            step(&surface);
        }
        assert!(step(&surface), "it never got hold {away} m away");
        let ticks = ((shake.duration() + 3.0) / TICK) as u32;
        let mut survives = |_: &u32| {
            (0..ticks).all(|tick| {
                let pose = pose(f64::from(tick) * TICK);
                surface.advance(&pose, Similarity::IDENTITY).unwrap();
                step(&surface)
            })
        };
        survived.push((1..=6).take_while(|shake| survives(shake)).count());
    }
    println!("shakes survived: {survived:?}");
    assert!(survived.len() > 20, "{survived:?}");
    assert!(
        survived.iter().all(|count| (1..6).contains(count)),
        "{survived:?}"
    );
    let two = survived.iter().filter(|count| **count >= 2).count();
    assert!(3 * two >= survived.len(), "{two} of {}", survived.len());
}

/// No joint that is at rest starts with more than half of gravity within a tenth of a second.
#[test]
fn giants_never_start_abruptly() {
    let kind = kind(&brain_file());
    let joints: Vec<JointId> = (0..kind.skeleton().joints().len() as u32)
        .map(JointId)
        .collect();
    let rest = kind.skeleton().rest_pose();
    for clip in kind.clips().clips() {
        let at = |time: f64| -> Vec<DVec3> {
            let pose = clip.sample(&rest, time, Playback::Clamp).unwrap();
            let palette = kind.skeleton().palette(&pose).unwrap();
            joints
                .iter()
                .map(|joint| palette.model_from_joint(*joint).unwrap().translation)
                .collect()
        };
        if LOOPS.contains(&clip.name.as_str()) {
            continue;
        }
        // The clip starts from rest, so the speed after a tenth of a second gives the mean acceleration.
        let (a, b) = (at(0.1 - 0.5 * TICK), at(0.1 + 0.5 * TICK));
        for (joint, (a, b)) in a.iter().zip(&b).enumerate() {
            let pull = (*b - *a).length() / TICK / 0.1;
            let name = &kind.skeleton().joints()[joint].name;
            assert!(
                pull <= 4.905,
                "{}: {name} starts with {pull} m/s^2",
                clip.name
            );
        }
    }
}
