//! Scene B29: blades of 20 rad/s against limbs of up to 30 m/s, compared with a search in small steps of time.

use clamber_surface::geometry::{Affine, Similarity, WorldCapsule, rotation_from_axis_angle};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use fastrand::Rng;
use glam::DVec3;

use super::*;
use crate::testing::limb;

/// A cut at a limb that passes by.
struct Phase {
    sword: SwordConfig,
    /// Velocity of the body, metres a second; `turns` is its angular velocity about Y, radians a second.
    body: DVec3,
    turns: f64,
    /// Position of the limb when the cut begins, metres; then its velocity, metres a second, and its constant rotation.
    place: DVec3,
    velocity: DVec3,
    axis: DVec3,
    angle: f64,
}

impl Phase {
    fn new(rng: &mut Rng) -> Self {
        let random = std::cell::RefCell::new(rng);
        let lot = |size: f64| (2.0 * random.borrow_mut().f64() - 1.0) * size;
        let vector = |size: f64| DVec3::new(lot(size), lot(size), lot(size));
        let sword = SwordConfig {
            // 20 rad/s.
            angle: 3.5,
            cut: 0.175,
            ..SwordConfig::default()
        };
        let velocity = vector(1.0).normalize_or(DVec3::X);
        // Either it passes near the blade in the middle of the cut, or it misses the blade.
        let near = DVec3::new(0.0, 0.9, -1.3) + vector(1.2);
        let speed = 30.0 * lot(1.0).abs();
        Self {
            sword,
            body: vector(3.0),
            turns: lot(2.0),
            place: near - velocity * (speed * (0.5 * sword.cut + lot(0.1))),
            velocity: velocity * speed,
            axis: vector(1.0).normalize_or(DVec3::Y),
            angle: lot(3.0),
        }
    }

    /// The body's frame `seconds` after the cut began.
    fn frame(&self, seconds: f64) -> FighterFrame {
        FighterFrame {
            origin: self.body * seconds,
            rotation: rotation_from_axis_angle(DVec3::Y, self.turns * seconds),
        }
    }

    fn blade(&self, seconds: f64) -> Blade {
        let sword = &self.sword;
        sword.in_cut(
            &self.frame(seconds),
            sword.cut_angle(sword.wind_up + seconds),
        )
    }

    fn world(&self, seconds: f64) -> Similarity {
        Similarity {
            rotation: rotation_from_axis_angle(self.axis, self.angle),
            translation: self.place + self.velocity * seconds,
            scale: 1.0,
        }
    }

    /// The first contact of each part, and its smallest gap. The search poses the skin at each time, and never steps
    /// farther than the gap divided by the greatest speed.
    fn search(&self, surface: &mut SkinnedSurface, palette: &Palette) -> [(Option<f64>, f64); 2] {
        let reach = self.sword.arm + self.sword.blade;
        let spin = self.sword.angle / self.sword.cut + self.turns.abs();
        let fastest = self.velocity.length() + spin * reach + self.body.length() + 1.0;
        [0u32, 1].map(|part| {
            for other in 0..2 {
                let id = surface
                    .mesh()
                    .parts()
                    .iter()
                    .position(|p| p.joint.0 == other)
                    .unwrap();
                let id = clamber_surface::mesh::PartId(id as u32);
                if other == part {
                    surface.enable_part(id).unwrap();
                } else {
                    surface.disable_part(id).unwrap();
                }
            }
            let (mut seconds, mut least) = (0.0, f64::INFINITY);
            while seconds <= self.sword.cut {
                surface.teleport(palette, self.world(seconds)).unwrap();
                let blade = self.blade(seconds);
                let capsule = WorldCapsule {
                    ends: [blade.hilt, blade.tip],
                    radius: self.sword.radius,
                };
                let near = surface
                    .in_world()
                    .closest_to_capsule(&capsule, 1e3)
                    .unwrap();
                let gap = near.distance - self.sword.radius;
                least = least.min(gap);
                if gap <= 1e-6 {
                    return (Some(seconds), gap);
                }
                seconds += gap / fastest;
            }
            (None, least)
        })
    }

    /// The parts that the cut strikes, tick by tick, with the times in seconds.
    fn cut(
        &self,
        surface: &mut SkinnedSurface,
        palette: &Palette,
        rate: f64,
        offset: f64,
    ) -> Vec<(u32, f64)> {
        let dt = 1.0 / rate;
        let (mut struck, mut all) = (Vec::new(), Vec::new());
        // The cut begins at any time within a tick.
        let mut begin = -offset * dt;
        surface.teleport(palette, self.world(begin)).unwrap();
        while begin < self.sword.cut {
            let end = begin + dt;
            surface.advance(palette, self.world(end)).unwrap();
            let times = [begin, end].map(|seconds| seconds + self.sword.wind_up);
            let frames = [begin, end].map(|seconds| self.frame(seconds));
            let mut hits = Vec::new();
            let skins = [(CreatureId(0), &*surface)];
            let skins = Skins(&skins);
            self.sword
                .cut_through(times, frames, dt, skins, &mut struck, &mut hits);
            assert!(hits.is_sorted_by(|a, b| a.time <= b.time));
            for hit in hits {
                let part = surface.mesh().parts()[hit.hit.hit.part.index()].joint.0;
                all.push((part, begin + hit.time * dt));
            }
            begin = end;
        }
        all
    }
}

#[test]
fn ten_thousand_cuts_miss_nothing_and_strike_each_part_once_at_its_time() {
    let palette = Palette::from_matrices([Affine::IDENTITY; 2]);
    let mut rng = Rng::with_seed(29);
    let mut surface = SkinnedSurface::new(limb());
    let mut swept = SkinnedSurface::new(limb());
    let (mut struck, mut passed, mut grazed) = (0, 0, 0);
    let mut worst = 0.0f64;
    for phase in 0..10_000 {
        let swing = Phase::new(&mut rng);
        let found = swing.search(&mut surface, &palette);
        let rate = [30.0, 60.0, 120.0, 240.0][phase % 4];
        let offset = rng.f64();
        let hits = swing.cut(&mut swept, &palette, rate, offset);
        for (part, (time, least)) in (0..).zip(found) {
            let ours: Vec<f64> = hits
                .iter()
                .filter(|hit| hit.0 == part)
                .map(|hit| hit.1)
                .collect();
            assert!(
                ours.len() <= 1,
                "phase {phase}: part {part} is struck {ours:?}"
            );
            match (time, ours.first()) {
                (Some(time), Some(ours)) => {
                    struck += 1;
                    // A contact is early by the time in which the blade comes nearer by 0.06 mm and the tolerance. It
                    // is late only by rounding.
                    assert!(ours - time < 1e-6, "phase {phase}: late by {}", ours - time);
                    worst = worst.max(time - ours);
                    grazed += u32::from(time - ours > 1e-3);
                }
                (Some(time), None) => panic!("phase {phase}: missed part {part} at {time}"),
                (None, Some(_)) => {
                    assert!(least < 0.0002, "phase {phase}: struck from {least} m");
                    passed += 1;
                }
                (None, None) => passed += 1,
            }
        }
    }
    println!("{struck} struck, {passed} passed, {grazed} early by over 1 ms, at most {worst} s");
    assert!(struck > 4_000 && passed > 4_000, "{struck} {passed}");
    // Such a contact occurs only where the blade hardly comes nearer.
    assert!(grazed * 500 < struck, "{grazed} of {struck}");
}
