//! Scene B31: arrows at limbs that pass by, compared with a search in small steps of time, and the places where they
//! stick.

use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use fastrand::Rng;

use super::*;
use crate::arena::CreatureId;
use crate::fighter::{BowConfig, FighterId};
use crate::projectile::{ProjectileId, ProjectilePlace, place_on};
use crate::testing::limb;

/// Gravity of the tests, metres a second squared.
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

/// Duration of an arrow's flight, seconds.
const FLIES: f64 = 0.8;

struct Shot {
    bow: BowConfig,
    from: DVec3,
    velocity: DVec3,
    /// Position of the limb in the middle of the flight. The next fields are its velocity, and the axis, initial angle
    /// and rate of its rotation.
    place: DVec3,
    moves: DVec3,
    axis: DVec3,
    angle: f64,
    spin: f64,
}

impl Shot {
    fn new(rng: &mut Rng) -> Self {
        let random = std::cell::RefCell::new(rng);
        let lot = |size: f64| (2.0 * random.borrow_mut().f64() - 1.0) * size;
        let vector = |size: f64| DVec3::new(lot(size), lot(size), lot(size));
        let velocity = vector(1.0).normalize_or(DVec3::X) * (30.0 + lot(25.0));
        // The arrow comes within half a metre of the limb's middle on each axis, at any angle to its skin.
        let middle = vector(50.0);
        let seconds = 0.5 * FLIES;
        Self {
            bow: BowConfig {
                depth: 0.1,
                ..BowConfig::default()
            },
            from: middle + vector(0.5) - velocity * seconds - GRAVITY * (0.5 * seconds * seconds),
            velocity,
            place: middle,
            moves: vector(1.0).normalize_or(DVec3::X) * 30.0 * lot(1.0).abs(),
            axis: vector(1.0).normalize_or(DVec3::Y),
            angle: lot(3.0),
            spin: lot(0.5),
        }
    }

    fn world(&self, seconds: f64) -> Similarity {
        let turned = self.angle + self.spin * seconds;
        Similarity {
            rotation: rotation_from_axis_angle(self.axis, turned),
            translation: self.place + self.moves * (seconds - 0.5 * FLIES),
            scale: 1.0,
        }
    }

    fn arrow(&self) -> Projectile {
        Projectile {
            id: ProjectileId(0),
            kind: ProjectileKind::Arrow,
            by: FighterId(0),
            body: self.bow.arrow(),
            seconds: 0.0,
            motion: ProjectileMotion::Flying {
                position: self.from,
                velocity: self.velocity,
            },
        }
    }

    /// Time at which the arrow's tip first touches the limb, and its smallest gap. The search never steps farther than
    /// the gap divided by the greatest speed.
    fn search(&self, skin: &mut SkinnedSurface, palette: &Palette) -> (Option<f64>, f64) {
        let radius = self.bow.radius;
        let fastest = self.velocity.length() + 10.0 + self.moves.length() + self.spin.abs() * 2.0;
        let (mut seconds, mut least) = (0.0, f64::INFINITY);
        while seconds <= FLIES {
            skin.teleport(palette, self.world(seconds)).unwrap();
            let tip = self.from + self.velocity * seconds + GRAVITY * (0.5 * seconds * seconds);
            let near = skin.in_world().closest_point(tip, 1e3).unwrap();
            let gap = near.distance - radius;
            least = least.min(gap);
            if gap <= 1e-6 {
                return (Some(seconds), gap);
            }
            seconds += gap / fastest;
        }
        (None, least)
    }
}

/// Flies an arrow for [`FLIES`] seconds. Returns the time at which it got stuck, and the arrow.
fn fly(
    shot: &Shot,
    skin: &mut SkinnedSurface,
    palette: &Palette,
    rate: f64,
) -> (Option<f64>, Projectile) {
    let (dt, mut arrow, mut stuck) = (1.0 / rate, shot.arrow(), None);
    skin.teleport(palette, shot.world(0.0)).unwrap();
    let ticks = (FLIES * rate).ceil() as u32;
    for tick in 0..ticks {
        skin.advance(palette, shot.world(f64::from(tick + 1) * dt))
            .unwrap();
        let skins = [(CreatureId(0), &*skin)];
        let air = Air {
            skins: Skins(&skins),
            terrain: &[],
            gravity: GRAVITY,
            dt,
        };
        let mut out = Outcome::default();
        assert_eq!(arrow.step(&air, &mut out), Flown::There);
        assert_eq!(
            out.hits.len(),
            usize::from(stuck.is_none() && arrow.is_stuck())
        );
        if let Some(hit) = out.hits.first() {
            stuck = Some((f64::from(tick) + hit.time) * dt);
        }
    }
    (stuck, arrow)
}

/// Position and direction of a stuck arrow.
fn place(arrow: &Projectile, skin: &SkinnedSurface) -> ProjectilePlace {
    let ProjectileMotion::Stuck { at, direction } = &arrow.motion else {
        panic!("{arrow:?}");
    };
    place_on(at, *direction, skin).unwrap()
}

#[test]
fn of_ten_thousand_arrows_none_passes_through_a_limb() {
    let palette = Palette::from_matrices([Affine::IDENTITY; 2]);
    let (mut rng, mut searched, mut hit) = (
        Rng::with_seed(31),
        SkinnedSurface::new(limb()),
        SkinnedSurface::new(limb()),
    );
    let (mut stuck, mut passed, mut grazing) = (0, 0, 0);
    let (mut late, mut early) = (0.0f64, 0.0f64);
    for case in 0..10_000 {
        let shot = Shot::new(&mut rng);
        let (time, least) = shot.search(&mut searched, &palette);
        let rate = [30.0, 60.0, 120.0, 240.0][case % 4];
        let (ours, arrow) = fly(&shot, &mut hit, &palette, rate);
        // Within a tick, arrow and skin move on straight lines. At 30 Hz the arrow's line is up to 1.4 mm beside its
        // parabola, and each line is up to 0.1 mm beside the turning skin.
        let beside = 0.002;
        match (time, ours) {
            (Some(time), Some(ours)) => {
                stuck += 1;
                late = late.max(ours - time);
                early = early.max(time - ours);
            }
            (Some(_), None) => {
                // The arrow has only grazed the skin.
                let (time, depth) = deepest(&shot, &mut searched, &palette, time.unwrap());
                assert!(
                    depth < beside,
                    "{case}: passes through at {time}, {depth} m deep"
                );
                grazing += 1;
            }
            (None, Some(ours)) => {
                assert!(least < beside, "{case}: struck at {ours} from {least} m");
                grazing += 1;
            }
            (None, None) => passed += 1,
        }
        if ours.is_some() {
            stays(&arrow, &shot, &mut hit, &palette, rate);
        }
    }
    println!(
        "{stuck} stuck, {passed} passed, {grazing} grazed, late by {late} s, early by {early} s"
    );
    assert!(
        stuck > 4_000 && passed > 1_000 && grazing < 50,
        "{stuck} {passed} {grazing}"
    );
    assert!(late < 5e-3 && early < 5e-3, "{late} {early}");
}

/// Greatest depth of the tip after its first contact, and its time. Depth counts from the contact of the arrow's
/// radius.
fn deepest(shot: &Shot, skin: &mut SkinnedSurface, palette: &Palette, from: f64) -> (f64, f64) {
    let radius = shot.bow.radius;
    let mut most = (from, 0.0);
    for step in 0..200 {
        let seconds = from + f64::from(step) * 1e-4;
        skin.teleport(palette, shot.world(seconds)).unwrap();
        let tip = shot.from + shot.velocity * seconds + GRAVITY * (0.5 * seconds * seconds);
        let near = skin.in_world().closest_point(tip, 1e3).unwrap();
        let inside = skin.in_world().is_inside(tip);
        let depth = if inside {
            radius + near.distance
        } else {
            radius - near.distance
        };
        if depth > most.1 {
            most = (seconds, depth);
        }
    }
    most
}

/// The arrow sticks as deep as configured, along its flight, and stays at its point of the skin.
fn stays(arrow: &Projectile, shot: &Shot, skin: &mut SkinnedSurface, palette: &Palette, rate: f64) {
    let ProjectileMotion::Stuck { at, direction } = &arrow.motion else {
        panic!("{arrow:?}");
    };
    assert!((direction.length() - 1.0).abs() < 1e-9);
    let now = place(arrow, skin);
    let anchor = at.material.anchor_on(skin).unwrap();
    let point = |skin: &SkinnedSurface| skin.in_world().motion(&anchor, 1.0 / rate).unwrap();
    let depth = (now.tip - point(skin).position).dot(now.direction);
    assert!((depth - 0.1).abs() < 0.001, "{depth} m deep");
    // In the frame of the skin, point and tip do not move.
    let seen = |skin: &SkinnedSurface, arrow: &Projectile| {
        let (motion, place) = (point(skin), place(arrow, skin));
        motion.frame.conjugate() * (place.tip - motion.position)
    };
    let before = seen(skin, arrow);
    for seconds in [1.3, 7.0, 60.0] {
        skin.advance(palette, shot.world(seconds)).unwrap();
        assert!(seen(skin, arrow).distance(before) < 1e-4, "drifts");
    }
}
