//! Moving triangles against moving spheres and capsules.

use super::*;
use crate::geometry::triangle::first_contact::STEPS;
use crate::simd::SimdLevel;

fn bits(contact: &Option<Contact>) -> Option<[u64; 5]> {
    contact.map(|c| {
        let [x, y, z] = c.barycentric.to_array();
        [x, y, z, c.time, c.distance].map(f64::to_bits)
    })
}

/// Casts a sphere at a triangle that does not move.
fn cast(corners: [Vec3; 3], center: Vec3, motion: Vec3, radius: f32) -> Option<Contact> {
    let core = MovingCore::new([center], [motion], radius, 1e-4);
    first_contact([corners, corners], &core, 1.0).0
}

/// Asserts that a contact is at a time, or a little earlier.
#[track_caller]
fn assert_time(contact: &Contact, expected: f64) {
    let early = expected - contact.time;
    assert!((0.0..1e-4).contains(&early), "{early} early: {contact:?}");
}

/// A large triangle in the plane Y = 0, around the origin.
const FLOOR: [Vec3; 3] = [
    Vec3::new(-5.0, 0.0, -5.0),
    Vec3::new(-5.0, 0.0, 10.0),
    Vec3::new(10.0, 0.0, -5.0),
];

#[test]
fn a_falling_sphere_meets_the_floor_when_its_height_is_the_radius() {
    let contact = cast(FLOOR, Vec3::Y * 3.0, Vec3::NEG_Y * 4.0, 1.0).unwrap();
    assert!((contact.time - 0.5).abs() < 1e-13, "{contact:?}");
    assert!((contact.distance - 1.0).abs() < 1e-13, "{contact:?}");
    assert!(!contact.undecided);
    assert_eq!(cast(FLOOR, Vec3::Y * 3.0, Vec3::NEG_Y * 1.99, 1.0), None);
    // Moving away from the floor, and along it.
    assert_eq!(cast(FLOOR, Vec3::Y * 1.00005, Vec3::Y, 1.0), None);
    assert_eq!(cast(FLOOR, Vec3::Y * 1.00005, Vec3::X, 1.0), None);
    let overlap = cast(FLOOR, Vec3::Y * 0.9, Vec3::Y, 1.0).unwrap();
    assert_eq!((overlap.time, overlap.undecided), (0.0, false));
}

#[test]
fn contact_times_of_a_sphere_with_an_edge_and_a_corner_match_a_quadratic() {
    // Along x at height 1/2 towards the edge x = -5, and along the diagonal towards a corner.
    let contact = cast(FLOOR, Vec3::new(-9.0, 0.5, 0.0), Vec3::X * 4.0, 1.0).unwrap();
    assert_time(&contact, (4.0 - 0.75f64.sqrt()) / 4.0);
    let way = Vec3::new(4.0, 0.0, 4.0);
    let contact = cast(FLOOR, Vec3::new(-9.0, 0.0, -9.0), way, 1.0).unwrap();
    assert_time(&contact, (32.0f64.sqrt() - 1.0) / 32.0f64.sqrt());
}

#[test]
fn a_limb_that_passes_through_a_resting_capsule_touches_it_first() {
    let limb = [
        Vec3::new(-3.0, -0.1, -1.0),
        Vec3::new(-3.0, 0.1, 1.0),
        Vec3::new(-3.0, 0.2, -1.0),
    ];
    let later = limb.map(|p| p + Vec3::X * 6.0);
    let ends = [Vec3::NEG_Y, Vec3::Y];
    let core = MovingCore::new(ends, [Vec3::ZERO; 2], 0.25, 1e-4);
    let contact = first_contact([limb, later], &core, 1.0).0.unwrap();
    assert_time(&contact, (3.0 - 0.25) / 6.0);
}

/// Motions of many kinds: slivers, spins, collapses, parallel slides, at many scales.
fn pair(rng: &mut fastrand::Rng, size: f32) -> [[Vec3; 3]; 2] {
    let far = [0.0, 0.0, 1e3][rng.usize(0..3)];
    let offset = point(rng, size * far);
    let mut start = [(); 3].map(|()| point(rng, size));
    if rng.u32(0..4) == 0 {
        start[2] = start[0] + (start[1] - start[0]) * rng.f32() + point(rng, size * 1e-7);
    }
    let way = [0.0, 0.1, 1.0, 10.0][rng.usize(0..4)];
    let shift = point(rng, size * way);
    let end = match rng.u32(0..4) {
        0 => start.map(|p| p + shift),
        1 => start.map(|p| shift - p),
        2 => start.map(|p| shift + Vec3::new(p.y, -p.x, p.z)),
        _ => start.map(|p| p + point(rng, size)),
    };
    [start, end].map(|corners| corners.map(|p| p + offset))
}

fn core<const N: usize>(rng: &mut fastrand::Rng, [start, end]: [[Vec3; 3]; 2]) -> MovingCore<N> {
    let size = (start[0] - start[1]).length();
    let ends = [(); N].map(|()| start[rng.usize(0..3)] + point(rng, size));
    let mut motions = [Vec3::ZERO; N];
    for (motion, from) in motions.iter_mut().zip(ends) {
        let target = end[rng.usize(0..3)] + point(rng, size * 0.1);
        *motion = (target - from) * [0.0, 1.0, 2.0][rng.usize(0..3)];
    }
    let radius = size * [0.0, 1e-3, 0.1, 1.0][rng.usize(0..4)] * rng.f32();
    let tolerance = size * [0.0, 1e-6, 1e-4, 1e-2][rng.usize(0..4)];
    MovingCore::new(ends, motions, radius, tolerance)
}

fn compare<const N: usize>(batches: u32, seed: u64) -> [u32; 3] {
    let levels = SimdLevel::available();
    let mut rng = fastrand::Rng::with_seed(seed);
    let (mut contacts, mut undecided, mut most) = (0, 0, 0);
    for batch in 0..batches {
        let size = [1.0, 1.0, 1e-3, 1e3, 1e-30, 1e20][rng.usize(0..6)];
        let pairs = [(); EIGHT].map(|()| pair(&mut rng, size));
        let core = core::<N>(&mut rng, pairs[0]);
        let limit = [1.0, rng.f64()][rng.usize(0..2)];
        let mut corners = [Corners8::default(); 2];
        for (lane, [start, end]) in pairs.into_iter().enumerate() {
            corners[0].set(lane, start);
            corners[1].set(lane, end);
        }
        let found = levels
            .iter()
            .map(|level| first_contact_of_eight(*level, &corners, &core, limit));
        let found: Vec<_> = found.collect();
        let still = [corners[0]];
        let of_still = levels
            .iter()
            .map(|level| first_contact_of_eight(*level, &still, &core, limit));
        let of_still: Vec<_> = of_still.collect();
        for (lane, [start, end]) in pairs.into_iter().enumerate() {
            let case = format_args!("batch {batch} {start:?} {end:?} {core:?} {limit}");
            let (one, steps) = first_contact([start, end], &core, limit);
            for (level, found) in levels.iter().zip(&found) {
                assert_eq!(bits(&found.get(lane)), bits(&one), "{level} {case}");
                assert!((steps..=STEPS).contains(&found.steps), "{level} {case}");
            }
            // A triangle that stands still has the bits of one that moves by nothing.
            let (still, _) = first_contact([start], &core, limit);
            let (nowhere, _) = first_contact([start, start], &core, limit);
            assert_eq!(bits(&still), bits(&nowhere), "{case}");
            for (level, found) in levels.iter().zip(&of_still) {
                assert_eq!(bits(&found.get(lane)), bits(&still), "{level} {case}");
            }
            // The limit removes later contacts and changes nothing else.
            let whole = first_contact([start, end], &core, 1.0).0;
            let kept = whole.filter(|c| c.time <= limit);
            assert_eq!(bits(&one), bits(&kept), "{case}");
            if let Some(contact) = one {
                contacts += 1;
                undecided += u32::from(contact.undecided && core.tolerance > 0.0);
                assert!(contact.distance.is_finite(), "{case}");
                assert!(contact.barycentric.is_finite(), "{case}");
            }
            most = most.max(steps);
        }
    }
    [contacts, undecided, most]
}

#[test]
fn eight_moving_lanes_have_the_scalar_bits_at_every_level() {
    let found = [compare::<1>(3_000, 50), compare::<2>(3_000, 51)];
    println!("contacts, undecided with a tolerance, most steps: {found:?}");
    let enough = found.iter().all(|[contacts, ..]| *contacts > 1_500);
    assert!(enough, "{found:?}");
}

#[test]
fn an_approach_by_rotation_alone_ends_in_a_contact_after_few_steps() {
    // Each case once took all steps: it came ever nearer to the radius without reaching it, since no line falls along
    // the current direction.
    let needle = [
        Vec3::new(0.6113142, 5.4071283, 0.18201125),
        Vec3::new(309.57385, -783.1844, -64.232796),
        Vec3::new(188.8219, -816.3295, 104.45469),
    ];
    let needle_later = [
        Vec3::new(0.22916088, 5.392338, 0.4358096),
        Vec3::new(461.2387, -695.15924, -134.38286),
        Vec3::new(298.06003, -788.97046, -41.088737),
    ];
    let center = Vec3::new(0.56197846, 4.6092825, -0.8551329);
    let motion = Vec3::new(-0.2915352, 0.39834568, 1.2191159);
    let core = MovingCore::new([center], [motion], 0.29228053, 7.307013e-4);
    let sphere = first_contact([needle, needle_later], &core, 1.0);

    let still = [
        Vec3::new(0.16663875, 0.15703431, -0.16905947),
        Vec3::new(0.20738038, 0.12496459, -0.07551392),
        Vec3::new(0.2286959, 0.122229256, -0.077263094),
    ];
    let ends = [
        Vec3::new(0.2214882, 0.15528747, -0.09076764),
        Vec3::new(0.29003665, 0.107907444, -0.10404461),
    ];
    let motions = [
        Vec3::new(-0.28068694, 0.079735085, 0.27360037),
        Vec3::new(-0.21398029, 0.14502981, 0.39101768),
    ];
    let core = MovingCore::new(ends, motions, 0.02, 5e-5);
    let capsule = first_contact([still, still], &core, 1.0);

    for (contact, steps) in [sphere, capsule] {
        assert!(steps <= FEW, "{steps} steps: {contact:?}");
        assert!(contact.is_some_and(|c| !c.undecided), "{contact:?}");
    }
}

#[test]
fn a_turn_of_a_lever_a_thousand_times_as_long_takes_few_steps() {
    // This once took 126 steps: each step went only as far as the fastest corner allows along the current direction.
    let start = [
        Vec3::new(-1972.4215, -500.92007, 1484.7556),
        Vec3::new(-1881.5419, 1500.78, -517.9993),
        Vec3::new(-2408.6624, -696.86896, -243.03445),
    ];
    let end = [
        Vec3::new(-2021.2794, -423.60495, 1442.5382),
        Vec3::new(-1836.7675, 1522.43, -608.3045),
        Vec3::new(-2414.663, -656.70056, -290.9189),
    ];
    let ends = [
        Vec3::new(-2132.1665, 61.733162, 89.96358),
        Vec3::new(-2133.1097, 60.32549, 87.86843),
    ];
    let motions = [
        Vec3::new(-1.1271099, 3.073804, -3.4883246),
        Vec3::new(-0.55852157, 1.9148715, -4.7341466),
    ];
    let core = MovingCore::new(ends, motions, 0.23920207, 5.980052e-4);
    let (contact, steps) = first_contact([start, end], &core, 1.0);
    assert!(steps <= FEW, "{steps} steps: {contact:?}");
    assert!(contact.is_some_and(|c| !c.undecided), "{contact:?}");
}

/// Largest number of steps that counts as few.
const FEW: u32 = 32;
