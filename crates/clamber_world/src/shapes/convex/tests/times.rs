use super::*;
use crate::RigidPose;

/// Tolerance of the casts, metres.
const TOLERANCE: f64 = 1e-4;

/// A capsule that moves, and in half of the cases turns by up to 1.5 rad, in the frame of the shape.
fn path(rng: &mut fastrand::Rng, radius: f64) -> MovingCapsule {
    let start = segment(rng, 3.0);
    let by = point(rng, 3.0) - start[0];
    let turn = match rng.u32(0..2) {
        0 => DQuat::IDENTITY,
        _ => {
            let axis = direction(rng);
            clamber_surface::geometry::rotation_from_axis_angle(axis, rng.f64() * 1.5)
        }
    };
    MovingCapsule {
        start,
        end: start.map(|end| start[0] + turn * (end - start[0]) + by),
        radius,
    }
}

#[test]
fn contacts_are_never_late_and_within_the_tolerance() {
    let mut rng = fastrand::Rng::with_seed(55);
    let (mut met, mut missed, mut inside) = (0, 0, 0);
    for round in 0..150 {
        for case in cases(&mut rng) {
            let radius = [0.0, 0.05, 0.4][rng.usize(0..3)];
            let path = path(&mut rng, radius);
            let convex = case.convex();
            let name = case.name;
            let reach = radius + convex.round;
            let touch = MovingConvex::still(&convex).first_contact(&path, TOLERANCE, 1.0);
            let until = touch.as_ref().map_or(1.0, |touch| touch.time);
            // No contact before. Each step is too short for the gap to close, or 1e-3.
            let (mut time, fastest) = (0.0, speed(&path));
            while time < until {
                let gap = case.distance(path.at(time)) - reach;
                let told = format_args!("{name} {round} {path:?}: {gap} at {time}");
                assert!(gap > -2e-7, "{told}, before {until}");
                time += (gap / fastest).max(1e-3);
            }
            let Some(touch) = touch else {
                missed += 1;
                continue;
            };
            assert!(!touch.undecided, "{name} {round} {path:?}");
            let gap = case.distance(path.at(touch.time)) - reach;
            let most = TOLERANCE + 2e-7;
            assert!(gap < most, "{name} {round} {path:?}: {gap} at {until}");
            met += 1;
            inside += u32::from(touch.time == 0.0);
        }
    }
    assert!(
        met > 200 && missed > 300 && inside > 20,
        "{met} {missed} {inside}"
    );
}

fn speed(path: &MovingCapsule) -> f64 {
    let [a, b] = [0, 1].map(|k| (path.end[k] - path.start[k]).length());
    a.max(b).max(1e-9)
}

#[test]
fn sliding_along_a_side_and_leaving_are_no_contacts() {
    let side = SharedShape::cuboid(50.0, 1.0, 1.0);
    let convex = Convex::new(&*side).unwrap();
    for (height, by, time, case) in [
        (1.501, DVec3::X * 80.0, None, "beside"),
        (1.500_01, DVec3::X * 80.0, None, "within the tolerance"),
        (1.500_01, DVec3::Y, None, "leaving from within"),
        (1.500_01, DVec3::ZERO, None, "still"),
        (1.500_01, DVec3::NEG_Y, Some(0.0), "coming from within"),
        (1.499, DVec3::Y, Some(0.0), "leaving from inside"),
        (1.499, DVec3::ZERO, Some(0.0), "still, inside"),
    ] {
        let path = MovingCapsule::ball(DVec3::new(-40.0, height, 0.0), by, 0.5);
        let touch = MovingConvex::still(&convex).first_contact(&path, TOLERANCE, 1.0);
        assert_eq!(touch.map(|touch| touch.time), time, "{case}");
    }
}

#[test]
fn a_contact_at_the_limit_is_found_and_no_limit_changes_its_time() {
    let mut rng = fastrand::Rng::with_seed(56);
    for round in 0..200 {
        for case in cases(&mut rng) {
            let path = path(&mut rng, 0.2);
            let convex = case.convex();
            let time = |limit: f64| {
                let touch = MovingConvex::still(&convex).first_contact(&path, TOLERANCE, limit);
                touch.map(|touch| touch.time)
            };
            let Some(all) = time(1.0) else { continue };
            assert_eq!(time(all), Some(all), "{} {round} {path:?}", case.name);
            let before = time(all * 0.9);
            let none = before.is_none() || before == Some(all);
            assert!(none, "{} {round} {path:?}: {before:?} {all}", case.name);
        }
    }
}

#[test]
fn contacts_of_turning_solids_are_never_late() {
    let mut rng = fastrand::Rng::with_seed(57);
    let (mut met, mut missed, mut undecided) = (0, 0, 0);
    for round in 0..100 {
        for case in cases(&mut rng) {
            let radius = [0.0, 0.05, 0.4][rng.usize(0..3)];
            let path = path(&mut rng, radius);
            let convex = case.convex();
            let angle = [0.1, 0.6, 1.5][rng.usize(0..3)];
            let axis = direction(&mut rng);
            let moving = MovingConvex {
                convex: &convex,
                before: Some(RigidPose {
                    rotation: clamber_surface::geometry::rotation_from_axis_angle(axis, angle),
                    translation: point(&mut rng, 2.0),
                }),
            };
            let name = case.name;
            let input = (name, round, &path, moving.before);
            let touch = moving.first_contact(&path, TOLERANCE, 1.0);
            let until = touch.as_ref().map_or(1.0, |touch| touch.time);
            let reach = radius + convex.round;
            let gap = |time: f64| {
                let nearest = moving.nearest(time, path.at(time), DVec3::ZERO);
                let Some(nearest) = nearest else {
                    return -reach;
                };
                // The distance is the gap along the normal, so a plane separates the two.
                let normal = nearest.normal;
                let ends = path.at(time).map(|end| end.dot(normal));
                let extent = moving.point(time, moving.support(time, normal)).dot(normal);
                let parted = ends[0].min(ends[1]) - extent;
                let distance = nearest.distance;
                let off = (parted - distance).abs();
                assert!(off < 1e-7, "{input:?} {time}: {parted} {nearest:?}");
                distance - reach
            };
            let steps = if until > 0.0 { 300 } else { 0 };
            for step in 0..steps {
                let time = until * f64::from(step) / 300.0;
                let gap = gap(time);
                assert!(gap > -2e-7, "{input:?}: {gap} at {time}, before {until}");
            }
            let Some(touch) = touch else {
                missed += 1;
                continue;
            };
            met += 1;
            undecided += u32::from(touch.undecided);
            let is_near = touch.undecided || gap(until) < TOLERANCE + 1e-7;
            assert!(is_near, "{input:?}: {until}");
        }
    }
    assert!(
        met > 100 && missed > 200 && undecided == 0,
        "{met} {missed} {undecided}"
    );
}

#[test]
fn contacts_of_long_levers_are_neither_late_nor_undecided() {
    // Rods of some metres that swing past a small solid about one end or about the middle. Half of the solids swing as
    // well.
    let mut rng = fastrand::Rng::with_seed(58);
    let (mut met, mut missed) = (0, 0);
    for round in 0..200 {
        for case in cases(&mut rng) {
            let pivot = point(&mut rng, 1.5);
            let (back, ahead) = (rng.f64() * 4.0, rng.f64() * 4.0);
            let along = direction(&mut rng);
            let axis = along.any_orthonormal_vector();
            let angle = 0.5 + rng.f64() * 2.4;
            let turn = clamber_surface::geometry::rotation_from_axis_angle(axis, angle);
            let ends = |along: DVec3| [pivot - along * back, pivot + along * ahead];
            let path = MovingCapsule {
                start: ends(along),
                end: ends(turn * along),
                radius: 0.02,
            };
            let convex = case.convex();
            let moving = MovingConvex {
                convex: &convex,
                before: rng.bool().then(|| RigidPose {
                    rotation: turn.conjugate(),
                    translation: point(&mut rng, 0.5),
                }),
            };
            let input = (case.name, round, &path, moving.before);
            let touch = moving.first_contact(&path, TOLERANCE, 1.0);
            let until = touch.as_ref().map_or(1.0, |touch| touch.time);
            let steps = if until > 0.0 { 400 } else { 0 };
            for step in 0..steps {
                let time = until * f64::from(step) / 400.0;
                let nearest = moving.nearest(time, path.at(time), DVec3::ZERO);
                let gap = nearest.map_or(0.0, |nearest| nearest.distance) - 0.02 - convex.round;
                assert!(gap > -2e-7, "{input:?}: {gap} at {time}, before {until}");
            }
            match touch {
                Some(touch) => {
                    assert!(!touch.undecided, "{input:?} {until}");
                    met += 1;
                }
                None => missed += 1,
            }
        }
    }
    assert!(met > 300 && missed > 300, "{met} {missed}");
}
