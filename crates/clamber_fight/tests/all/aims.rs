//! Aims at moving targets, compared with the exact quartic.

use clamber_fight::aim::lead;
use dashu_int::IBig;
use dashu_ratio::RBig;
use glam::DVec3;

/// Gravity, metres a second squared.
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// A polynomial with exact coefficients, beginning with the constant.
type Polynomial = Vec<RBig>;

fn exact(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

fn dot(a: DVec3, b: DVec3) -> RBig {
    let (a, b) = (a.to_array(), b.to_array());
    (0..3).fold(RBig::ZERO, |sum, k| sum + exact(a[k]) * exact(b[k]))
}

/// The quartic whose positive roots are the times at which the arrow and the target can meet.
fn quartic(d: DVec3, w: DVec3, g: DVec3, s: f64) -> Polynomial {
    let two = RBig::from(2);
    vec![
        dot(d, d),
        two * dot(d, w),
        dot(w, w) - dot(d, g) - exact(s) * exact(s),
        -dot(w, g),
        dot(g, g) / RBig::from(4),
    ]
}

fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(|x| *x == RBig::ZERO) {
        p.pop();
    }
    p
}

fn derivative(p: &Polynomial) -> Polynomial {
    let powers = (1..).map(|k: i32| RBig::from(IBig::from(k)));
    p.iter().skip(1).zip(powers).map(|(x, k)| x * k).collect()
}

/// The negated remainder of a polynomial division.
fn negated_remainder(a: &Polynomial, b: &Polynomial) -> Polynomial {
    let mut rest = a.clone();
    while rest.len() >= b.len() {
        let factor = rest.last().unwrap().clone() / b.last().unwrap();
        let shift = rest.len() - b.len();
        for (k, x) in b.iter().enumerate() {
            rest[shift + k] -= &factor * x;
        }
        rest.pop();
    }
    trimmed(rest.into_iter().map(|x| -x).collect())
}

/// True if a polynomial has a positive root, by Sturm's theorem.
fn has_positive_root(p: Polynomial) -> bool {
    let first = trimmed(p);
    let mut chain = vec![first.clone(), derivative(&first)];
    while chain.last().unwrap().len() > 1 {
        let next = negated_remainder(&chain[chain.len() - 2], &chain[chain.len() - 1]);
        if next.is_empty() {
            break;
        }
        chain.push(next);
    }
    let changes = |signs: Vec<i8>| {
        let signs: Vec<i8> = signs.into_iter().filter(|sign| *sign != 0).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    let sign = |x: &RBig| i8::from(*x > RBig::ZERO) - i8::from(*x < RBig::ZERO);
    let at_zero = chain.iter().map(|p| sign(&p[0])).collect();
    let at_infinity = chain.iter().map(|p| sign(p.last().unwrap())).collect();
    changes(at_zero) > changes(at_infinity)
}

#[test]
fn the_oracle_knows_roots() {
    let p = |values: &[i32]| {
        values
            .iter()
            .map(|x| RBig::from(*x))
            .collect::<Polynomial>()
    };
    assert!(has_positive_root(p(&[2, -3, 1])), "1 and 2");
    assert!(!has_positive_root(p(&[2, 3, 1])), "-1 and -2");
    assert!(!has_positive_root(p(&[1, 0, 0, 0, 1])), "none");
    assert!(has_positive_root(p(&[1, -2, 1])), "1 twice");
    assert!(has_positive_root(p(&[5, 0, -6, 0, 1])), "1 and more");
}

#[test]
fn aims_hit_or_are_out_of_reach_as_the_quartic_says() {
    let mut rng = fastrand::Rng::with_seed(33);
    let (mut hit, mut unreachable) = (0, 0);
    for case in 0..100_000 {
        let mut lot = |size: f64| (2.0 * rng.f64() - 1.0) * size;
        let size = [30.0, 150.0, 400.0][case % 3];
        let from = DVec3::new(lot(50.0), lot(50.0), lot(50.0));
        let target = from + DVec3::new(lot(size), lot(0.5 * size), lot(size));
        let way = DVec3::new(lot(1.0), lot(1.0), lot(1.0)).clamp_length_max(1.0) * lot(20.0).abs();
        let gravity = if case % 50 == 0 { DVec3::ZERO } else { GRAVITY };
        let speed = 20.0 + lot(10.0).abs() * 3.64;
        let d = target - from;
        let is_reachable = has_positive_root(quartic(d, way, gravity, speed));
        let found = lead(from, target, way, gravity, speed);
        assert_eq!(
            found.is_some(),
            is_reachable,
            "{from} {target} {way} {speed}"
        );
        let Some(found) = found else {
            unreachable += 1;
            continue;
        };
        hit += 1;
        assert!((found.velocity.length() - speed).abs() < 1e-9 * speed);
        let t = found.seconds;
        let arrow = from + found.velocity * t + gravity * (0.5 * t * t);
        let miss = arrow.distance(target + way * t);
        assert!(
            miss < 0.01,
            "missed by {miss} m: {from} {target} {way} {speed}"
        );
        // No earlier time hits, so the arc is the flatter one.
        let f = |t: f64| {
            (d + way * t - gravity * (0.5 * t * t)).length_squared() - (speed * t) * (speed * t)
        };
        for k in 1..50 {
            let sooner = t * f64::from(k) / 50.0 * 0.999;
            assert!(
                f(sooner) > -1e-6 * d.length_squared(),
                "sooner at {sooner} of {t}"
            );
        }
    }
    assert!(hit > 40_000 && unreachable > 10_000, "{hit} {unreachable}");
}

#[test]
fn wild_numbers_have_no_aim() {
    let aim = |d: DVec3, w: DVec3, s: f64| lead(DVec3::ZERO, d, w, GRAVITY, s);
    assert_eq!(aim(DVec3::NAN, DVec3::ZERO, 50.0), None);
    assert_eq!(aim(DVec3::X, DVec3::INFINITY, 50.0), None);
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(aim(DVec3::X, DVec3::ZERO, speed), None, "{speed}");
    }
    assert_eq!(aim(DVec3::ZERO, DVec3::X, 50.0), None, "it is there");
}
