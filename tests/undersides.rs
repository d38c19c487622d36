//! A held stick leads one way under the giant, wherever it was pressed.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber::climber::ClimberMode;
use clamber::gltf::load;
use clamber::prelude::*;
use clamber_scenes::giant;
use glam::DVec3;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;

/// Number of rides, half with each clip.
const RIDES: u32 = 800;

/// Time for which the stick is held, seconds.
const HELD: f64 = 4.0;

/// Time in which the arms draw the climber to its hold, before the stick is pressed, seconds.
const DRAWN: f64 = 0.4;

/// Time for which a step back is not counted after skin has pushed the climber aside, as between two limbs, seconds.
const PUSHED: f64 = 0.1;

/// Largest step back that counts as rounding, metres.
const BACK: f64 = 1e-3;

/// Radius of the climber's ball, metres.
const RADIUS: f64 = 0.4;

fn pose(rig: &Rig, clip: &str, time: f64) -> Palette {
    let clip = rig.clip(clip).unwrap();
    let rest = rig.skeleton.rest_pose();
    let pose = clip.sample(&rest, time, Playback::Loop).unwrap();
    rig.skeleton.palette(&pose).unwrap()
}

/// The results of the rides.
#[derive(Debug, Default)]
struct Seen {
    held: u32,
    /// Ticks in which no skin has pushed the climber lately.
    free: u32,
    way: f64,
    back: u32,
    /// Steps back while a limb pushes the climber.
    pushed: u32,
    worst: f64,
    told: String,
}

fn ride(rig: &Rig, clip: &str, rng: &mut fastrand::Rng, seen: &mut Seen) {
    let root = clamber::geometry::Similarity::IDENTITY;
    let mut giant = SkinnedSurface::new(rig.collider.clone());
    let start = rng.f64() * 5.0;
    giant.teleport(&pose(rig, clip, start), root).unwrap();
    // Casts rays straight up, until one hits fur that faces down.
    let (low, high) = (DVec3::new(-7.0, -1.0, -7.0), DVec3::new(7.0, -1.0, 7.0));
    let contact = loop {
        let share = DVec3::new(rng.f64(), 0.0, rng.f64());
        let from = low + (high - low) * share + DVec3::Y * (22.0 * rng.f64());
        let found = Obstacle::cast_ray(&giant, from, DVec3::Y, 30.0);
        let Some(contact) = found else { continue };
        let faces = contact.normal.y;
        let is_fur = contact.tag.kind == clamber::mesh::SurfaceKind::Fur;
        if faces < -0.3 && is_fur && contact.distance > 2.0 * RADIUS {
            break contact;
        }
    };
    let mut config = ClimberConfig::colossus_climber();
    config.stamina = None;
    config.tumble = None;
    let grip = config.grip.as_mut().unwrap();
    // The climber always climbs and never only hangs, in any motion of the giant.
    grip.hang_acceleration = f64::INFINITY;
    grip.max_overhang = std::f64::consts::PI;
    let at = contact.point + contact.normal * (RADIUS * 1.02);
    let mut climber = Climber::new(config, at).unwrap();
    let turn = std::f64::consts::TAU * rng.f64();
    let stick = DVec3::new(libm::cos(turn), 0.0, libm::sin(turn));
    let mut last: Option<DVec3> = None;
    let (mut since, mut pushed) = (0.0, f64::INFINITY);
    for tick in 1..=((DRAWN + HELD) / DT) as u32 {
        let palette = pose(rig, clip, start + f64::from(tick) * DT);
        giant.advance(&palette, root).unwrap();
        let held = climber.state().mode == ClimberMode::Holding;
        since = if held { since + DT } else { 0.0 };
        let input = ClimberInput {
            grip: true,
            walk: if since > DRAWN { stick } else { DVec3::ZERO },
            ..ClimberInput::IDLE
        };
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), &giant)];
        let report = climber.step(&input, &obstacles, DT).unwrap();
        pushed = if report.pushed_out.length() > BACK {
            0.0
        } else {
            pushed + DT
        };
        let is_pushed = pushed < PUSHED;
        let state = climber.state();
        if state.mode != ClimberMode::Holding || since <= DRAWN {
            last = None;
            continue;
        }
        // The climber's way over the skin.
        let way = state.own_way;
        seen.held += 1;
        seen.free += u32::from(!is_pushed);
        seen.way += way.length();
        if let Some(last) = last.replace(way)
            && way.dot(last) < 0.0
        {
            let back = way.length().min(last.length());
            if back > seen.worst && !is_pushed {
                seen.worst = back;
                seen.told =
                    format!("{clip} from {start} s at {at}, tick {tick}: {last}, then {way}");
            }
            seen.back += u32::from(back > BACK && !is_pushed);
            seen.pushed += u32::from(back > BACK && is_pushed);
        }
    }
}

#[test]
fn a_held_stick_leads_one_way_on_the_undersides_of_the_giant() {
    let rig = load(giant::path()).unwrap().rig;
    let mut rng = fastrand::Rng::with_seed(52);
    for clip in ["idle", "walk"] {
        let mut seen = Seen::default();
        for _ in 0..RIDES / 2 {
            ride(&rig, clip, &mut rng, &mut seen);
        }
        println!("{clip}: {seen:?}");
        assert!(seen.held > 80_000 && seen.free > 60_000, "{clip}: {seen:?}");
        assert!(seen.way > 1_500.0, "{clip}: {seen:?}");
        assert_eq!(seen.back, 0, "{clip}: {seen:?}");
        assert!(seen.pushed < 100, "{clip}: {seen:?}");
    }
}
