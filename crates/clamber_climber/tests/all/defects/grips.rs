//! Hands do not reach through solid obstacles.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_surface::mesh::SurfaceTag;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::events::is_grabbed;
use crate::input::{HOLD, IDLE, grip_climb};
use crate::scene::{FUR, STONE, climber, cuboid_at, moved, tagged, tick_among};

/// Input that climbs up.
const UP: ClimberInput = grip_climb(DVec3::Y);

#[test]
fn does_not_grip_fur_behind_a_plate() {
    for (thick, gap, off) in triples([0.02, 0.1, 0.3], [0.0, 0.01, 0.05], [0.38, 0.4, 0.42, 0.6]) {
        // The front face of the fur is at z = 0.
        let fur = cuboid_at(Vec3::new(4.0, 3.0, 1.0), FUR, v(0.0, 0.0, -1.0));
        let half = thick * 0.5;
        let size = Vec3::new(4.0, 3.0, half as f32);
        let plate = cuboid_at(size, STONE, v(0.0, 0.0, gap + half));
        let mut climber = climber(v(0.0, 0.0, gap + thick + off));
        for k in 0..40 {
            let input = if k < 20 { &HOLD } else { &UP };
            let report = tick_among(&mut climber, &[&fur, &plate], input);
            let state = climber.state();
            let told = format!(
                "plate {thick} m thick, {gap} m before fur, {off} m off, tick {k}: {:?}",
                report.events
            );
            assert!(!state.mode.is_holding(), "{told}");
        }
    }
}

#[test]
fn does_not_grip_fur_below_a_floor() {
    for thick in [0.02, 0.1, 0.3] {
        let fur = cuboid_at(Vec3::new(4.0, 1.0, 4.0), FUR, v(0.0, -1.0, 0.0));
        let half = thick * 0.5;
        let size = Vec3::new(4.0, half as f32, 4.0);
        let plate = cuboid_at(size, STONE, v(0.0, 0.01 + half, 0.0));
        let mut climber = climber(v(0.0, 0.01 + thick + 0.41, 0.0));
        for k in 0..40 {
            let report = tick_among(&mut climber, &[&fur, &plate], &HOLD);
            let state = climber.state();
            let told = format!("floor of {thick} m, tick {k}: {:?}", report.events);
            assert!(!state.mode.is_holding(), "{told}");
            let on = state.support.map(|support| support.attachment.obstacle);
            assert_ne!(on, Some(ObstacleId(0)), "{told}");
        }
        assert_eq!(climber.state().mode, ClimberMode::Standing, "{thick}");
    }
}

/// Parallel sheets that face +Z, each at a depth and with a tag.
fn sheets(each: &[(f32, SurfaceTag)]) -> SkinnedSurface {
    let (mut positions, mut triangles, mut tags) = (Vec::new(), Vec::new(), Vec::new());
    for (z, tag) in each {
        let a = positions.len() as u32;
        let corners = [(-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)];
        positions.extend(corners.map(|(x, y)| Vec3::new(x, y, *z)));
        triangles.extend([[a, a + 1, a + 2], [a, a + 2, a + 3]]);
        tags.extend([*tag, *tag]);
    }
    tagged(&positions, &triangles, &tags)
}

#[test]
fn does_not_grip_fur_below_a_stone_shell_of_the_same_mesh() {
    for shell in [0.02, 0.05, 0.1, 0.2, 0.3] {
        let skin = sheets(&[(0.0, FUR), (shell, STONE)]);
        for off in [0.4, 0.41, 0.42] {
            let mut climber = climber(v(0.0, 0.0, f64::from(shell) + off));
            for k in 0..10 {
                let report = tick_among(&mut climber, &[&skin], &HOLD);
                let told = format!("shell {shell} m over fur, {off} m off, tick {k}");
                let events = &report.events;
                assert!(!climber.state().mode.is_holding(), "{told}: {events:?}");
            }
        }
    }
}

/// Climbs along fur that is covered by a plate on the way.
#[test]
fn climbing_does_not_move_a_hold_behind_a_plate() {
    for thick in [0.02, 0.1, 0.3] {
        for (name, way) in [
            ("up", DVec3::Y),
            ("aside", DVec3::X),
            ("up and aside", v(1.0, 1.0, 0.0).normalize()),
        ] {
            let half = thick * 0.5;
            let fur = cuboid_at(Vec3::new(4.0, 4.0, 1.0), FUR, v(0.0, 0.0, -1.0));
            // The plate's edge is a metre ahead.
            let size = Vec3::new(2.0, 2.0, half as f32);
            let middle = v(
                way.x.signum() * 3.0 * way.x.abs().ceil(),
                way.y.ceil() * 3.0,
                0.0,
            );
            let plate = cuboid_at(size, STONE, middle + DVec3::Z * (0.01 + half));
            let mut climber = climber(v(0.0, 0.0, 0.42));
            let input = grip_climb(way);
            for k in 0..180 {
                let report = tick_among(
                    &mut climber,
                    &[&fur, &plate],
                    if k < 10 { &HOLD } else { &input },
                );
                let state = climber.state();
                let told = format!(
                    "plate {thick} m thick, climbs {name}, tick {k}: {:?} at {}, {:?}",
                    state.mode, state.position, report.events
                );
                let Some(support) = state.support else {
                    continue;
                };
                let hold = support.attachment;
                let apart = (hold.point - middle).abs();
                let is_behind = hold.obstacle == ObstacleId(0) && apart.x < 1.98 && apart.y < 1.98;
                assert!(!is_behind, "{told}: holds {}", hold.point);
                // No obstacle is between the body and the hold.
                let reach = hold.point - state.position;
                let clear = reach.length() - 0.02;
                let hit = plate.cast_ray(state.position, reach, clear);
                assert_eq!(hit, None, "{told}: holds {}", hold.point);
            }
        }
    }
}

/// Fur that moves sideways behind a plate does not carry the climber.
#[test]
fn fur_behind_a_plate_does_not_drag_the_climber_along() {
    let mut fur = cuboid_at(Vec3::new(4.0, 3.0, 1.0), FUR, v(0.0, 0.0, -1.0));
    let plate = cuboid_at(Vec3::new(4.0, 3.0, 0.05), STONE, v(0.0, 0.0, 0.06));
    let mut climber = climber(v(0.0, 0.0, 0.53));
    for k in 0..90 {
        if climber.state().position.y < -1.5 {
            // The climber has fallen past the plate's lower edge.
            return;
        }
        let by = v(0.05 * f64::from(k), 0.0, -1.0);
        moved(&mut fur, by);
        let report = tick_among(&mut climber, &[&fur, &plate], &HOLD);
        let grabbed = report.events.iter().any(is_grabbed);
        assert!(!grabbed, "tick {k}: {:?}", report.events);
        let state = climber.state();
        assert!(state.position.x.abs() < 1e-3, "tick {k}: {state:?}");
    }
}

/// Armour above fur, of skin and of half-spaces: hands reach through at most a 400th of the radius.
#[test]
fn does_not_grip_fur_through_thin_armour() {
    let shares = [0.003, 0.005, 0.01, 0.02, 0.024, 0.03, 0.05];
    for (radius, share) in pairs([0.02, 0.4, 2.0, 40.0], shares) {
        for (along, is_skin) in pairs([DVec3::ZERO, v(0.3, 0.0, -0.8)], [true, false]) {
            let gap = share * radius;
            let half = Vec3::new(4.0, 0.5, 4.0);
            let fur = cuboid_at(half, FUR, DVec3::NEG_Y * f64::from(half.y));
            let thin = Vec3::new(half.x, 1e-4, half.z);
            let plate = cuboid_at(thin, STONE, DVec3::Y * gap);
            let spaces = [(0.0, FUR), (gap, STONE)]
                .map(|(height, tag)| clamber_world::HalfSpace::below(height).with_tag(tag));
            let obstacles: [&dyn Obstacle; 2] = if is_skin {
                [&fur, &plate]
            } else {
                [&spaces[0], &spaces[1]]
            };
            let mut config = ClimberConfig::colossus_climber();
            config.body.radius = radius;
            config.body.margin = radius / 40.0;
            let start = DVec3::Y * (gap + 1e-4 + radius) + along * radius;
            let mut climber = Climber::new(config, start).unwrap();
            for k in 0..20 {
                let input = if k < 10 { &IDLE } else { &HOLD };
                tick_among(&mut climber, &obstacles, input);
                let state = climber.state();
                let told = format!("{is_skin}, radius {radius}, {share} thick: {state:?}");
                assert!(!state.mode.is_holding(), "{told}");
            }
        }
    }
}
