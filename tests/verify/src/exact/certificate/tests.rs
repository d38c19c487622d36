//! Certificates of motions whose first contact is known, and of random motions, compared with distances at many times.

use glam::Vec3;

use super::*;

/// A level triangle at height 0, which contains the origin.
const FLOOR: [Vec3; 3] = [
    Vec3::new(-5.0, 0.0, -5.0),
    Vec3::new(-5.0, 0.0, 10.0),
    Vec3::new(10.0, 0.0, -5.0),
];

/// A sphere of radius 1 that falls by 4 from a height of 3. At time 1/2 its height is 1.
fn falling() -> MovingPair {
    MovingPair {
        corners: [FLOOR; 2],
        ends: [Vec3::Y * 3.0; 2],
        motions: [Vec3::Y * -4.0; 2],
        radius: 1.0,
    }
}

#[test]
fn a_fall_is_clear_up_to_contact_and_not_at_the_next_f64() {
    let pair = falling();
    let motion = Motion::new(&pair);
    for until in [0.0, 0.25, 0.5f64.next_down(), 0.5] {
        let shown = motion.apart(1.0, until, Last::Excluded);
        assert_eq!(shown, Apart::Always, "{until}");
    }
    for until in [0.5f64.next_up(), 0.5 + 1e-9, 0.75, 1.0] {
        let shown = motion.apart(1.0, until, Last::Excluded);
        assert!(
            matches!(shown, Apart::Until(t) if t >= 0.5),
            "{until} {shown:?}"
        );
    }
    assert!(matches!(
        motion.apart(1.0, 0.5, Last::Included),
        Apart::Until(_)
    ));
    let above = 0.5f64.next_down();
    assert_eq!(motion.apart(1.0, above, Last::Included), Apart::Always);
}

#[test]
fn a_slide_is_clear_at_any_height_above_the_radius() {
    for (height, expected) in [(1.0f32.next_up(), true), (1.0, false)] {
        let pair = MovingPair {
            ends: [Vec3::new(-20.0, height, 0.0), Vec3::new(-19.0, height, 1.0)],
            motions: [Vec3::X * 40.0; 2],
            ..falling()
        };
        let shown = Motion::new(&pair).apart(1.0, 1.0, Last::Included);
        assert_eq!(shown == Apart::Always, expected, "{height}: {shown:?}");
        assert_eq!(matches!(shown, Apart::Until(_)), !expected, "{shown:?}");
    }
}

#[test]
fn a_passage_through_a_face_between_two_clear_ends_is_found() {
    let pair = MovingPair {
        ends: [Vec3::new(0.0, 1e3, 0.0); 2],
        motions: [Vec3::Y * -2048.0; 2],
        radius: 0.0,
        ..falling()
    };
    let shown = Motion::new(&pair).apart(0.0, 1.0, Last::Included);
    // Only one time, 1000 / 2048, has distance 0.
    assert_eq!(shown, Apart::Until(1000.0 / 2048.0));
}

#[test]
fn certified_pairs_are_apart_at_random_times() {
    let mut rng = fastrand::Rng::with_seed(60);
    let (mut clear, mut met) = (0, 0);
    for case in 0..2_000 {
        let mut point = || Vec3::new(rng.f32() - 0.5, rng.f32() - 0.5, rng.f32() - 0.5);
        let corners = [(); 2].map(|()| [(); 3].map(|()| point()));
        let ends = [point(), point()];
        let motions = [point(), point()];
        let pair = MovingPair {
            corners,
            ends,
            motions,
            radius: rng.f32() * 0.3,
        };
        let radius = f64::from(pair.radius);
        let motion = Motion::new(&pair);
        let until = rng.f64();
        match motion.apart(radius, until, Last::Excluded) {
            Apart::Always => {
                clear += 1;
                let exact = motion.exact();
                for _ in 0..4 {
                    let time = until * rng.f64();
                    let apart = !exact.is_within(time, &number(radius));
                    assert!(apart, "case {case} at {time}: {pair:?}");
                }
            }
            Apart::Until(time) => {
                met += 1;
                assert!(time < until, "case {case}");
                let touches = motion.exact().is_within(time, &number(radius));
                assert!(touches, "case {case} at {time}: {pair:?}");
            }
            Apart::Unknown(time) => panic!("case {case} at {time}: {pair:?}"),
        }
    }
    assert!(clear > 300 && met > 300, "{clear} {met}");
}

#[test]
fn a_pair_in_rational_numbers_has_the_same_certificates_as_in_f32() {
    let pair = falling();
    let motion = Motion::of_exact((&pair).into());
    assert_eq!(motion.apart(1.0, 0.5, Last::Excluded), Apart::Always);
    let later = motion.apart(1.0, 0.5f64.next_up(), Last::Excluded);
    assert!(matches!(later, Apart::Until(_)), "{later:?}");
}
