//! The same triangles as skin and as a rapier body give the same answers.

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::surface::SkinnedSurface;
use glam::{DQuat, Vec3};

use super::*;
use crate::testing::{rest, rigid};

/// World positions of the scenes' origins, metres: zero, and 100 km from it.
const ORIGINS: [DVec3; 2] = [DVec3::ZERO, DVec3::new(8e4, -3e3, 6e4)];

/// A bumpy patch of about 4 m, and a lone sliver above it.
fn patch(rng: &mut fastrand::Rng) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let side = 7;
    let mut positions = Vec::new();
    for i in 0..side {
        for j in 0..side {
            let (x, z) = (i as f32 * 0.7 - 2.1, j as f32 * 0.7 - 2.1);
            positions.push(Vec3::new(x, rng.f32() * 0.6, z));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..side - 1 {
        for j in 0..side - 1 {
            let at = i * side + j;
            triangles.push([at, at + 1, at + side]);
            triangles.push([at + 1, at + side + 1, at + side]);
        }
    }
    let first = positions.len() as u32;
    let sliver = [(-1.0, 1.5, 0.0), (1.0, 1.6, 0.3), (0.0, 1.55, 0.16)];
    positions.extend(sliver.map(|(x, y, z)| Vec3::new(x, y, z)));
    triangles.push([first, first + 1, first + 2]);
    (positions, triangles)
}

struct Both {
    surface: SkinnedSurface,
    world: PhysicsWorld,
    before: BodyPoses,
    origin: DVec3,
}

impl Both {
    /// A surface and a body that move over a tick from the first place to the second, relative to the origin.
    fn new(rng: &mut fastrand::Rng, origin: DVec3, places: [Pose; 2]) -> Self {
        let (positions, triangles) = patch(rng);
        let mut surface = rigid(&positions, &triangles);
        let roots = places.map(|place| Similarity {
            rotation: place.rotation.as_dquat().normalize(),
            scale: 1.0,
            translation: origin + place.translation.as_dvec3(),
        });
        surface.teleport(&rest(), roots[0]).unwrap();
        surface.advance(&rest(), roots[1]).unwrap();
        let mut world = PhysicsWorld::default();
        let body = RigidBodyBuilder::kinematic_position_based().pose(places[0]);
        let collider = ColliderBuilder::trimesh(positions, triangles).unwrap();
        let (body, _) = world.insert(body, collider);
        world.step();
        let mut before = BodyPoses::new();
        before.record(&world.bodies);
        world.bodies[body].set_next_kinematic_position(places[1]);
        world.step();
        Self {
            surface,
            world,
            before,
            origin,
        }
    }

    fn terrain(&self) -> RapierTerrain<'_> {
        RapierTerrain::of_world(&self.world, &self.before).with_origin(self.origin)
    }
}

fn capsule(rng: &mut fastrand::Rng, center: DVec3) -> WorldCapsule {
    let center = center + point(rng, 2.5);
    let along = point(rng, 0.6);
    let radius = [0.0, 0.05, 0.3][rng.usize(0..3)];
    if rng.bool() {
        WorldCapsule::ball(center, radius)
    } else {
        WorldCapsule {
            ends: [center - along, center + along],
            radius,
        }
    }
}

/// Poses of the patch before and after a tick, in which it turns by an angle and moves.
fn places(rng: &mut fastrand::Rng, angle: f64) -> [Pose; 2] {
    let first = rotation_from_axis_angle(point(rng, 1.0).normalize(), 1.0);
    let turn = rotation_from_axis_angle(point(rng, 1.0).normalize(), angle);
    let pose = |rotation: DQuat, translation: DVec3| {
        Pose::from_parts(translation.as_vec3(), rotation.as_quat())
    };
    let [from, to] = [point(rng, 0.5), point(rng, 0.5)];
    let first_f32 = pose(first, from);
    if angle == 0.0 {
        return [
            first_f32,
            Pose::from_parts(to.as_vec3(), first_f32.rotation),
        ];
    }
    [first_f32, pose(turn * first, to)]
}

#[test]
fn overlaps_agree() {
    let mut rng = fastrand::Rng::with_seed(61);
    let mut found = 0;
    for round in 0..60 {
        for origin in ORIGINS {
            let places = places(&mut rng, 0.3);
            let both = Both::new(&mut rng, origin, places);
            for case in 0..20 {
                let capsule = capsule(&mut rng, origin);
                let (mut of_skin, mut of_body) = (Vec::new(), Vec::new());
                both.surface.overlap_capsule(&capsule, &mut of_skin);
                both.terrain().overlap_capsule(&capsule, &mut of_body);
                // A body's contacts are sorted by position, a skin's by triangle.
                for contacts in [&mut of_skin, &mut of_body] {
                    contacts.retain(|contact| contact.distance < capsule.radius - 1e-5);
                    contacts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
                }
                let same = of_skin.len().abs_diff(of_body.len()) == 0;
                assert!(same, "{round} {case} {capsule:?}: {of_skin:?} {of_body:?}");
                for (a, b) in of_skin.iter().zip(&of_body) {
                    let off = (a.distance - b.distance).abs();
                    assert!(off < 1e-5, "{round} {case} {capsule:?}: {a:?} {b:?}");
                    let nearest = capsule.nearest_on_axis(b.point);
                    let measured = (nearest - b.point).length();
                    assert!((measured - b.distance).abs() < 1e-5, "{capsule:?} {b:?}");
                    found += 1;
                }
            }
        }
    }
    assert!(found > 500, "{found}");
}

/// Counts of how the two answers to a query differ.
#[derive(Default, Debug)]
struct Tally {
    /// Number of cases in which both found a contact.
    met: u32,
    inside: u32,
    /// Only one found a contact: at the very end, or at a grazing angle.
    grazed: u32,
}

impl Tally {
    /// `way` is the displacement of the capsule relative to the patch. The two distances travelled may differ by
    /// `slack` metres for a perpendicular impact.
    fn compare(
        &mut self,
        [skin, body]: [Option<SweepContact>; 2],
        capsule: &WorldCapsule,
        way: DVec3,
        slack: f64,
    ) {
        let input = (capsule, way);
        for met in [&skin, &body].into_iter().flatten() {
            let apart = met.contact.distance - capsule.radius;
            assert!(
                apart <= 1e-4 + 1e-5,
                "{input:?}: {met:?} is {apart} from touching"
            );
            assert!(
                (met.separation_normal.length() - 1.0).abs() < 1e-6,
                "{input:?}: {met:?}"
            );
            assert!((0.0..=1.0).contains(&met.fraction), "{input:?}: {met:?}");
            assert!(
                !met.started_inside || met.fraction == 0.0,
                "{input:?}: {met:?}"
            );
        }
        // If the gap closes slowly, the tolerance makes a larger difference in time.
        let slowness = |met: &SweepContact| {
            (met.separation_normal.dot(way) / way.length())
                .abs()
                .max(1e-9)
        };
        match (skin, body) {
            (Some(skin), Some(body)) => {
                self.met += 1;
                self.inside += u32::from(skin.started_inside);
                let off = (skin.fraction - body.fraction).abs() * way.length();
                let slowest = slowness(&skin).min(slowness(&body));
                assert!(
                    off <= slack / slowest,
                    "{input:?}: {off} m, {slowest}: {skin:?} {body:?}"
                );
                if skin.started_inside && body.started_inside {
                    let off = (skin.contact.distance - body.contact.distance).abs();
                    assert!(off < 1e-5, "{input:?}: {skin:?} {body:?}");
                }
            }
            (Some(met), None) | (None, Some(met)) => {
                self.grazed += 1;
                let left = (1.0 - met.fraction) * way.length();
                let touches = slack.max(1e-3) / slowness(&met);
                assert!(
                    left.min(1.0 / touches) < 0.2,
                    "{input:?}: {skin:?} {body:?}"
                );
            }
            (None, None) => {}
        }
    }
}

/// Compares casts of random capsules at a patch that turns by an angle over the tick. Random displacements are
/// multiplied by each of the `sizes` in turn. `slides` is true if the casts see how the patch moves.
fn assert_contacts_agree(
    seed: u64,
    angle: f64,
    sizes: [f64; 3],
    slides: bool,
    cast: fn(&dyn Obstacle, &WorldCapsule, DVec3) -> Option<SweepContact>,
) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut tally = Tally::default();
    for _ in 0..60 {
        for origin in ORIGINS {
            let places = places(&mut rng, angle);
            let both = Both::new(&mut rng, origin, places);
            let slide = (places[1].translation - places[0].translation).as_dvec3();
            let slide = if slides { slide } else { DVec3::ZERO };
            for case in 0..20 {
                let capsule = capsule(&mut rng, origin);
                let by = point(&mut rng, 3.0) * sizes[case % 3];
                let skin = cast(&both.surface, &capsule, by);
                let body = cast(&both.terrain(), &capsule, by);
                tally.compare([skin, body], &capsule, by - slide, 1.2e-4);
            }
        }
    }
    let Tally {
        met,
        inside,
        grazed,
    } = tally;
    assert!(met > 500 && inside > 50 && grazed < 5, "{tally:?}");
}

#[test]
fn casts_agree() {
    assert_contacts_agree(62, 0.3, [1.0; 3], false, cast);
}

#[test]
fn sweeps_agree_for_sliding_bodies() {
    assert_contacts_agree(63, 0.0, [0.0, 1.0, 2.0], true, sweep);
}

#[test]
fn sweeps_agree_for_turning_bodies() {
    let mut rng = fastrand::Rng::with_seed(64);
    let mut tally = Tally::default();
    for round in 0..60 {
        for origin in ORIGINS {
            let places = places(&mut rng, [0.05, 0.5, 2.0][round % 3]);
            let both = Both::new(&mut rng, origin, places);
            for case in 0..20 {
                let capsule = capsule(&mut rng, origin);
                let mut by = [point(&mut rng, 3.0); 2];
                if case % 2 == 1 {
                    by[1] = point(&mut rng, 3.0);
                }
                let [skin, body] = [&both.surface as &dyn Obstacle, &both.terrain()]
                    .map(|obstacle| obstacle.cast_capsule(&capsule, by, TargetMotion::Moving));
                // For turning bodies, the speed at which the gap closes is not taken into account.
                let off = |a: SweepContact, b: SweepContact| (a.fraction - b.fraction).abs();
                match (skin, body) {
                    (Some(a), Some(b)) => {
                        tally.met += 1;
                        tally.inside += u32::from(a.started_inside);
                        tally.grazed += u32::from(off(a, b) > 2e-4);
                        assert!(off(a, b) < 5e-3, "{capsule:?} {by:?}: {a:?} {b:?}");
                        let reach = capsule.radius + 1.1e-4;
                        assert!(b.contact.distance <= reach, "{capsule:?} {by:?}: {b:?}");
                        let axis = capsule.with_ends_moved(by.map(|end| end * b.fraction));
                        let apart = axis.nearest_on_axis(b.contact.point) - b.contact.point;
                        let seen = apart - b.separation_normal * b.contact.distance;
                        assert!(seen.length() < 1e-6, "{capsule:?} {by:?}: {seen} {b:?}");
                    }
                    (None, None) => {}
                    _ => tally.grazed += 1,
                }
            }
        }
    }
    let Tally {
        met,
        inside,
        grazed,
    } = tally;
    assert!(met > 500 && inside > 50 && grazed < 10, "{tally:?}");
}
