use super::*;
use fastrand::Rng;

/// Number of halvings in the search for the least relief, from the largest gap down to its rounding.
const HALVINGS: usize = 50;

/// The half space above a plane.
fn above(normal: DVec3, offset: f64) -> MovePlane {
    MovePlane { normal, offset }
}

/// How far a point is below the plane that it is farthest below; 0 above all planes.
fn missed(planes: &[MovePlane], point: DVec3) -> f64 {
    let missed = planes.iter().map(|p| p.offset - p.normal.dot(point));
    missed.fold(0.0, f64::max)
}

/// The brute-force reference: among all points that up to three planes determine, the nearest above all the other
/// planes. If no such point exists, the planes are lowered until one does.
fn project_onto_half_spaces_reference(target: DVec3, planes: &[MovePlane]) -> Projection {
    let size = missed(planes, target);
    if size == 0.0 {
        return Projection {
            point: target,
            missed: 0.0,
        };
    }
    let wall = |plane: &MovePlane| Wall {
        normal: plane.normal,
        gap: (plane.offset - plane.normal.dot(target)) / size,
    };
    let walls: Vec<Wall> = planes.iter().map(wall).collect();
    let sound = |relief: f64| {
        let point = nearest_of_all(&walls, relief)?;
        let probe = PROBE * (1.0 + point.length());
        let relieved = nearest_of_all(&walls, relief + probe)?;
        (point.length() - relieved.length() <= STEEPEST * probe).then_some(point)
    };
    let point = sound(0.0).unwrap_or_else(|| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let relief = 0.5 * (low + high);
            if sound(relief).is_some() {
                high = relief;
            } else {
                low = relief;
            }
        }
        sound(high).unwrap_or(DVec3::ZERO)
    });
    let missed = walls.iter().map(|wall| wall.missed(point));
    Projection {
        point: target + point * size,
        missed: missed.fold(0.0, f64::max) * size,
    }
}

fn nearest_of_all(walls: &[Wall], relief: f64) -> Option<DVec3> {
    let lowered = |wall: &Wall| Wall {
        gap: wall.gap - relief,
        ..*wall
    };
    let walls: Vec<Wall> = walls.iter().map(lowered).collect();
    let mut best: Option<DVec3> = None;
    let mut consider = |point: DVec3| {
        let slack = HELD * (1.0 + point.length());
        let nearer = best.is_none_or(|best| point.length() < best.length());
        let is_above = |wall: &Wall| wall.missed(point) <= slack;
        if nearer && point.length() <= STEEPEST && walls.iter().all(is_above) {
            best = Some(point);
        }
    };
    consider(DVec3::ZERO);
    for (i, a) in walls.iter().enumerate() {
        consider(a.normal * a.gap);
        for (j, b) in walls.iter().enumerate().take(i) {
            let crease = a.normal.cross(b.normal);
            let lift = [b.normal.cross(crease), crease.cross(a.normal)];
            let lift = lift.map(|lift| lift / crease.length_squared());
            consider(refined(&[a, b], &lift));
            for c in walls.iter().take(j) {
                let volume = crease.dot(c.normal);
                let lift = [b.normal.cross(c.normal), c.normal.cross(a.normal), crease];
                consider(refined(&[a, b, c], &lift.map(|lift| lift / volume)));
            }
        }
    }
    best
}

/// The point on all walls. `lift` holds, for each wall, a step that raises the point by 1 from this wall alone. The
/// steps are repeated, since they are rounded.
fn refined(walls: &[&Wall], lift: &[DVec3]) -> DVec3 {
    let mut point = DVec3::ZERO;
    for _ in 0..4 {
        let steps = walls.iter().zip(lift);
        let steps = steps.map(|(wall, lift)| *lift * wall.missed(point));
        point += steps.sum::<DVec3>();
    }
    point
}

fn direction(rng: &mut Rng) -> DVec3 {
    loop {
        let v = DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// Random directions. Some repeat, oppose others, or differ from them by 1e-12 to 1e-6.
fn normals(rng: &mut Rng, count: usize) -> Vec<DVec3> {
    let mut normals: Vec<DVec3> = Vec::new();
    for _ in 0..count {
        let other = if normals.is_empty() {
            DVec3::Y
        } else {
            normals[rng.usize(..normals.len())]
        };
        let tilt = direction(rng) * libm::exp(-14.0 - 14.0 * rng.f64());
        normals.push(match rng.u32(..10) {
            0 => other,
            1 => -other,
            2 => (other + tilt).normalize(),
            3 => (tilt - other).normalize(),
            4 => DVec3::AXES[rng.usize(..3)],
            _ => direction(rng),
        });
    }
    normals
}

/// Planes with a common point above or on them, about 0.5 from the target.
fn with_room(rng: &mut Rng, normals: &[DVec3]) -> Vec<MovePlane> {
    let inside = direction(rng) * rng.f64();
    let plane = |&normal: &DVec3| {
        let margin = [0.0, 1e-12, 0.1, 0.5][rng.usize(..4)] * rng.f64();
        above(normal, normal.dot(inside) - margin)
    };
    normals.iter().map(plane).collect()
}

fn anyhow(rng: &mut Rng, normals: &[DVec3]) -> Vec<MovePlane> {
    let plane = |&normal: &DVec3| above(normal, rng.f64() * 2.0 - 1.0);
    normals.iter().map(plane).collect()
}

fn size(target: DVec3, planes: &[MovePlane], found: &Projection) -> f64 {
    let offsets = planes.iter().map(|plane| plane.offset.abs());
    offsets.fold(target.length().max(found.point.length()), f64::max)
}

/// Compares with the reference. The weighted sum of violation and distance is compared in every case; each of them
/// alone is compared if there is room.
fn check(target: DVec3, planes: &[MovePlane]) {
    let found = project_onto_half_spaces(target, planes);
    let sought = project_onto_half_spaces_reference(target, planes);
    let slack = 1e-9 * size(target, planes, &found);
    let [far, least] = [found, sought].map(|above| above.point.distance(target));
    let context = || format!("{found:?} against {sought:?}\ntarget {target:?}\nplanes {planes:?}");
    let is_finite = found.point.is_finite() && found.missed.is_finite();
    assert!(is_finite, "{}", context());
    let off = (missed(planes, found.point) - found.missed).abs();
    assert!(off <= 1e-15, "`missed` is wrong: {}", context());
    let weighed = |missed: f64, far: f64| missed + far / STEEPEST;
    let worse = weighed(found.missed, far) - weighed(sought.missed, least);
    assert!(worse.abs() <= slack, "worse by {worse:e}: {}", context());
    if sought.missed <= 1e-14 {
        assert!(found.missed <= slack, "violates a plane: {}", context());
        assert!(far <= least + slack, "too far: {}", context());
        assert!(far >= least - slack, "nearer than allowed: {}", context());
    }
}

#[test]
fn with_room_the_point_agrees_with_brute_force() {
    let mut rng = Rng::with_seed(1);
    for count in 1..=17 {
        for _ in 0..6000 / (count * count) + 12 {
            let normals = normals(&mut rng, count);
            let planes = with_room(&mut rng, &normals);
            let target = direction(&mut rng) * rng.f64() * 2.0;
            check(target, &planes);
        }
    }
}

#[test]
fn without_room_the_least_violation_is_found() {
    let mut rng = Rng::with_seed(2);
    for count in 1..=8 {
        for _ in 0..600 / (count * count) + 4 {
            let normals = normals(&mut rng, count);
            let planes = anyhow(&mut rng, &normals);
            check(direction(&mut rng) * rng.f64(), &planes);
        }
    }
}

#[test]
fn with_room_no_plane_of_many_is_violated() {
    let mut rng = Rng::with_seed(3);
    for _ in 0..4000 {
        let count = rng.usize(1..=40);
        let normals = normals(&mut rng, count);
        let mut planes = with_room(&mut rng, &normals);
        // Nearly opposite planes need room between them.
        for plane in &mut planes {
            plane.offset -= 1e-3;
        }
        let target = direction(&mut rng) * rng.f64() * 3.0;
        let found = project_onto_half_spaces(target, &planes);
        assert!(
            found.missed <= 1e-11,
            "{found:?} target {target:?} planes {planes:?}"
        );
    }
}

#[test]
fn the_order_of_planes_changes_no_bit() {
    let mut rng = Rng::with_seed(4);
    for case in 0..3000 {
        let count = rng.usize(2..=17);
        let normals = normals(&mut rng, count);
        let make = [anyhow, with_room, with_room][case % 3];
        let mut planes = make(&mut rng, &normals);
        let target = direction(&mut rng);
        let first = project_onto_half_spaces(target, &planes);
        rng.shuffle(&mut planes);
        let second = project_onto_half_spaces(target, &planes);
        assert_eq!(first, second, "target {target:?} planes {planes:?}");
    }
}

#[test]
fn results_scale_with_the_input() {
    let mut rng = Rng::with_seed(5);
    for case in 0..3000 {
        let count = rng.usize(1..=12);
        // Random directions only: additional rounding must not turn a wedge into a wall.
        let normals: Vec<DVec3> = (0..count).map(|_| direction(&mut rng)).collect();
        let make = [anyhow, with_room, with_room][case % 3];
        let planes = make(&mut rng, &normals);
        let target = direction(&mut rng);
        let found = project_onto_half_spaces(target, &planes);
        let scaled = |scale: f64| {
            let planes = planes.iter();
            let scaled = planes.map(|plane| above(plane.normal, plane.offset * scale));
            project_onto_half_spaces(target * scale, &scaled.collect::<Vec<_>>())
        };
        for scale in [f64::from(1 << 20), 1.0 / f64::from(1 << 20)] {
            let other = scaled(scale);
            let wanted = (found.point * scale, found.missed * scale);
            let found = (other.point, other.missed);
            assert_eq!(found, wanted, "{target:?} {planes:?}");
        }
        // At the limit of a wedge, rounded offsets move the point by the square root of the rounding.
        let share = if found.missed < 1e-12 { 1e-9 } else { 2e-5 };
        for scale in [1e-6, 1e6] {
            let other = scaled(scale);
            let apart = other.point.distance(found.point * scale);
            assert!(
                apart <= share * scale * size(target, &planes, &found),
                "{apart:e}: {found:?}, times {scale}: {other:?}; target {target:?} planes {planes:?}"
            );
        }
    }
}

fn planes<const N: usize>(planes: [([f64; 3], f64); N]) -> [MovePlane; N] {
    planes.map(|(normal, offset)| above(DVec3::from_array(normal).normalize(), offset))
}

#[track_caller]
fn expect(target: [f64; 3], planes: &[MovePlane], point: [f64; 3], missed: f64) {
    let found = project_onto_half_spaces(DVec3::from_array(target), planes);
    let apart = found.point.distance(DVec3::from_array(point));
    assert!(apart <= 1e-9, "{found:?}, {apart:e} off, planes {planes:?}");
    assert!((found.missed - missed).abs() <= 1e-10, "{found:?}");
}

#[test]
fn a_target_above_all_planes_does_not_move() {
    let target = DVec3::new(0.1, 0.2, 0.3);
    let floor = planes([([0.0, 1.0, 0.0], 0.2)]);
    for planes in [&floor[..], &[]] {
        let found = project_onto_half_spaces(target, planes);
        assert_eq!((found.point, found.missed), (target, 0.0));
    }
}

#[test]
fn a_floor_a_crease_and_a_corner() {
    let all = planes([
        ([0.0, 1.0, 0.0], 0.0),
        ([1.0, 0.0, 0.0], 0.5),
        ([0.0, 0.0, 1.0], -1.0),
    ]);
    expect([0.0, -2.0, 0.0], &all[..1], [0.0, 0.0, 0.0], 0.0);
    expect([0.0, -2.0, 0.0], &all[..2], [0.5, 0.0, 0.0], 0.0);
    expect([0.0, -2.0, -3.0], &all, [0.5, 0.0, -1.0], 0.0);
}

#[test]
fn a_slab_without_room_is_violated_equally_on_both_sides() {
    let closing = planes([([0.0, 1.0, 0.0], 1.0), ([0.0, -1.0, 0.0], 0.0)]);
    expect([3.0, 0.0, 2.0], &closing, [3.0, 0.5, 2.0], 0.5);
    let beside = planes([
        ([0.0, 1.0, 0.0], 1.0),
        ([0.0, -1.0, 0.0], 0.0),
        ([1.0, 0.0, 0.0], 4.0),
    ]);
    expect([3.0, 0.0, 2.0], &beside, [3.5, 0.5, 2.0], 0.5);
    let thin = planes([([0.0, 1.0, 0.0], 1.0), ([0.0, -1.0, 0.0], -1.0 - 1e-12)]);
    expect([3.0, 0.0, 2.0], &thin, [3.0, 1.0, 2.0], 0.0);
}

#[test]
fn walls_within_rounding_of_opposite_throw_nothing_far() {
    for tilt in [0.0, 1e-12, 1e-9, 1e-7, 1e-5] {
        let closing = planes([([tilt, 1.0, 0.0], 0.001), ([tilt, -1.0, 0.0], 0.001)]);
        let found = project_onto_half_spaces(DVec3::ZERO, &closing);
        assert!(
            found.point.length() < 1e-4 && (found.missed - 0.001).abs() < 1e-8,
            "tilt {tilt}: {found:?}"
        );
    }
    // With a degree of difference, the body slips out of the wedge.
    let wedge = planes([([0.01, 1.0, 0.0], 0.001), ([0.01, -1.0, 0.0], 0.001)]);
    expect(
        [0.0; 3],
        &wedge,
        [0.001 * 1.00005_f64 / 0.01, 0.0, 0.0],
        0.0,
    );
}

#[test]
fn a_closed_tetrahedron_is_violated_evenly() {
    let tetrahedron = planes([
        ([1.0, 1.0, 1.0], 1.0),
        ([1.0, -1.0, -1.0], 1.0),
        ([-1.0, 1.0, -1.0], 1.0),
        ([-1.0, -1.0, 1.0], 1.0),
    ]);
    expect([5.0, -3.0, 2.0], &tetrahedron, [0.0; 3], 1.0);
}

#[test]
fn cones_of_many_planes_have_one_apex() {
    for tilt in [1.0, 1e-3, 1e-6, 1e-9] {
        let cone: Vec<MovePlane> = (0..32)
            .map(|k| {
                let angle = f64::from(k) * 0.2;
                let normal = DVec3::new(tilt * libm::cos(angle), 1.0, tilt * libm::sin(angle));
                above(normal.normalize(), 0.0)
            })
            .collect();
        let found = project_onto_half_spaces(DVec3::new(0.0, -1.0, 0.0), &cone);
        assert!(found.missed < 1e-12, "tilt {tilt}: {found:?}");
        // The apex of a flat cone is no nearer than the planes themselves, to second order.
        let far = found.point.distance(DVec3::new(0.0, -1.0, 0.0));
        assert!((far - 1.0).abs() < 1e-9, "tilt {tilt}: {found:?}");
    }
}

#[test]
fn invalid_half_spaces_are_ignored() {
    let all = [
        above(DVec3::Y, 1.0),
        above(DVec3::ZERO, 1.0),
        above(DVec3::NAN, 1.0),
        above(DVec3::INFINITY, 1.0),
        above(DVec3::X * 1e-200, 1.0),
        above(DVec3::X * 1e200, 1.0),
        above(DVec3::X, f64::NAN),
        above(DVec3::X, f64::INFINITY),
        above(DVec3::X, f64::NEG_INFINITY),
    ];
    expect([0.0; 3], &all, [0.0, 1.0, 0.0], 0.0);
}

#[test]
fn extremes_stay_finite() {
    let sizes = [
        0.0, 5e-324, 1e-310, 1e-200, 1e-20, 1.0, 1e20, 1e200, 1e307, -1.0, -1e307,
    ];
    let mut rng = Rng::with_seed(6);
    for _ in 0..4000 {
        let count = rng.usize(1..=6);
        let planes: Vec<MovePlane> = normals(&mut rng, count)
            .into_iter()
            .map(|normal| above(normal, sizes[rng.usize(..sizes.len())]))
            .collect();
        let target = direction(&mut rng) * sizes[rng.usize(..sizes.len())];
        let found = project_onto_half_spaces(target, &planes);
        assert!(
            found.point.is_finite() && !found.missed.is_nan(),
            "{found:?} target {target:?} planes {planes:?}"
        );
    }
}

/// The cost that [`project_where_it_pays`] minimises.
struct Worth<'a> {
    target: DVec3,
    planes: &'a [MovePlane],
    free: f64,
    steepest: f64,
}

impl Worth<'_> {
    fn cost(&self, point: DVec3) -> f64 {
        let far = point.distance(self.target).max(self.free);
        far + self.steepest * missed(self.planes, point)
    }

    /// The least cost, by ternary search over the relief, in which the cost is convex. The reference finds each point.
    fn least(&self, gap: f64) -> f64 {
        let cost = |relief: f64| {
            let planes = self.planes.iter();
            let lowered = planes.map(|plane| above(plane.normal, plane.offset - relief));
            let lowered: Vec<MovePlane> = lowered.collect();
            self.cost(project_onto_half_spaces_reference(self.target, &lowered).point)
        };
        let (mut low, mut high) = (0.0, gap);
        for _ in 0..60 {
            let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
            if cost(thirds[0]) <= cost(thirds[1]) {
                high = thirds[1];
            } else {
                low = thirds[0];
            }
        }
        let costs = [0.0, low, high, gap].map(cost).into_iter();
        costs.fold(f64::INFINITY, f64::min)
    }
}

#[test]
fn no_other_point_has_a_lower_cost() {
    let mut rng = Rng::with_seed(9);
    let (mut relieved, mut beyond) = (0, 0);
    for count in 1..=5 {
        for _ in 0..60 {
            let normals = normals(&mut rng, count);
            let planes = anyhow(&mut rng, &normals);
            let target = direction(&mut rng) * rng.f64();
            let gap = missed(&planes, target);
            let free = [0.0, gap * rng.f64(), gap * 3.0 * rng.f64()][rng.usize(..3)];
            let steepest = 1.1 + 5.0 * rng.f64();
            let worth = Worth {
                target,
                planes: &planes,
                free,
                steepest,
            };
            let found = project_where_it_pays(target, &planes, free, steepest);
            let told = || format!("{found:?}\n{target} {free} {steepest} {planes:?}");
            let cost = worth.cost(found.point);
            let least = worth.least(gap);
            let slack = 1e-8 * (gap + free);
            assert!(cost <= least + slack, "{cost} for {least}: {}", told());
            for _ in 0..200 {
                let other = found.point + direction(&mut rng) * gap * libm::exp(-20.0 * rng.f64());
                let other = worth.cost(other);
                assert!(cost <= other + slack, "{cost} for {other}: {}", told());
            }
            let far = found.point.distance(target);
            let most = free + steepest * (gap - found.missed) + 1e-9 * gap;
            assert!(far <= most, "{far}: {}", told());
            relieved += u32::from(found.missed > 1e-9 * gap);
            beyond += u32::from(found.missed > 1e-9 * gap && far > free * (1.0 + 1e-9));
        }
    }
    assert!(relieved > 60 && beyond > 30, "{relieved} {beyond}");
}

/// Walls that close to a wedge: with some angles it does not pay to slip out, with others it does. In both cases, a
/// little less room moves the body by a little.
#[test]
fn the_point_changes_continuously_with_the_room() {
    for (tilt, pays) in [(0.05, false), (0.2, false), (0.3, true), (0.6, true)] {
        let mut before: Option<DVec3> = None;
        for step in 0..=1_000 {
            let lacking = 0.1 * f64::from(step) / 1_000.0;
            let wedge = planes([
                ([tilt, 1.0, 0.0], lacking),
                ([tilt, -1.0, 0.0], 0.5 * lacking),
            ]);
            let found = project_where_it_pays(DVec3::ZERO, &wedge, 0.0, 4.0);
            assert_eq!(
                found.missed <= 1e-12,
                pays || step == 0,
                "{tilt} {lacking}: {found:?}"
            );
            let moved = before.map_or(0.0, |before| before.distance(found.point));
            assert!(moved <= 4.0 * 1e-4, "{tilt} {lacking}: {moved}");
            before = Some(found.point);
        }
    }
}
