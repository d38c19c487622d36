//! Riders of a giant whose poses are made less often than ticks: with a `PoseTrack`, they stay on as long as on a giant
//! that is posed in every tick.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use allocation_counter::measure;
use clamber::prelude::*;
use clamber::rig::{Pose, PoseMotion, PoseTrack};
use clamber_scenes::giant;
use glam::DVec3;

/// The times at which poses are made.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rhythm {
    /// In each tick.
    EachTick,
    /// In every n-th tick. The surface keeps its pose in the others.
    Kept(u32),
    /// In every n-th tick, blended by a track, as in all of the following rhythms.
    Every(u32),
    /// At this rate, Hz, each in the tick after its time.
    At(f64),
    /// After one to four ticks, at random.
    Random,
    /// In every third tick, but one in twelve is missed.
    Missed,
}

impl Rhythm {
    /// The time of the pose that is made in this tick, in ticks; `None` without a new pose. `next` is the tick of the
    /// next random pose.
    fn time(self, tick: u32, rate: f64, next: &mut (u32, fastrand::Rng)) -> Option<f64> {
        let time = match self {
            Self::EachTick => tick,
            Self::Kept(every) | Self::Every(every) => tick - tick % every,
            Self::At(poses) => {
                let ticks = rate / poses;
                let time = (f64::from(tick) / ticks + 1e-9).floor() * ticks;
                return (time > f64::from(tick) - 1.0).then_some(time);
            }
            Self::Random if next.0 > tick => return None,
            Self::Random => {
                next.0 = tick + next.1.u32(1..=4);
                tick
            }
            Self::Missed if tick.is_multiple_of(36) => return None,
            Self::Missed => tick - tick % 3,
        };
        (time == tick).then_some(f64::from(time))
    }

    const fn has_track(self) -> bool {
        !matches!(self, Self::EachTick | Self::Kept(_))
    }
}

/// A place at which a ride begins, on a giant of 40 m.
struct Place {
    what: &'static str,
    grips: bool,
    /// A ray that finds the skin.
    from: DVec3,
    along: DVec3,
}

/// The places at which rides begin.
const PLACES: [Place; 5] = [
    place("stands on the back", false, [0.0, 50.0, 0.0], DVec3::NEG_Y),
    place("grips the back", true, [0.0, 50.0, 0.0], DVec3::NEG_Y),
    place("grips the left arm", true, [30.0, 22.0, 0.0], DVec3::NEG_X),
    place("grips a shin", true, [3.5, 6.0, 30.0], DVec3::NEG_Z),
    place("grips the side", true, [30.0, 27.0, 0.0], DVec3::NEG_X),
];

const fn place(what: &'static str, grips: bool, from: [f64; 3], along: DVec3) -> Place {
    Place {
        what,
        grips,
        from: DVec3::from_array(from),
        along,
    }
}

/// The tick rate, the giant's size, and the motion of the world.
#[derive(Clone, Copy, Debug)]
struct Scene {
    rate: f64,
    /// Size of the giant as a share of 40 m. Its clip is slowed by the square root.
    size: f64,
    /// Velocity of the world, metres a second.
    frame: f64,
}

/// The result of a ride.
#[derive(Clone, Copy, Debug)]
struct Ride {
    /// Time at which the rider came off, seconds; the length of the ride if it stayed on.
    off: f64,
    /// The hardest shake, metres a second squared.
    shake: f64,
}

/// Longest ride, seconds.
const LENGTH: f64 = 20.0;

/// Time for which the giant walks before the rider comes, seconds: by then, the track has its poses.
const BEFORE: f64 = 2.0;

fn ride(rig: &Rig, place: &Place, rhythm: Rhythm, scene: Scene) -> Ride {
    let Scene { rate, size, frame } = scene;
    let dt = 1.0 / rate;
    let walk = rig.clip("walk").unwrap();
    let rest = rig.skeleton.rest_pose();
    let posed = |time: f64| -> (Pose, Similarity) {
        let pose = walk.sample(&rest, time / size.sqrt(), Playback::Loop);
        let mut world = Similarity::from_scale(size);
        world.translation = DVec3::Z * (frame * time);
        (pose.unwrap(), world)
    };
    let mut giant = SkinnedSurface::new(rig.collider.clone());
    let (pose, world) = posed(0.0);
    let mut palette = rig.skeleton.palette(&pose).unwrap();
    giant.teleport(&palette, world).unwrap();
    let from = place.from * size;
    let hit = giant.in_world().cast_ray(from, place.along, 100.0 * size);
    let begin = giant.anchor_at(&hit.unwrap()).unwrap();

    let (mut track, mut next) = (PoseTrack::default(), (0, fastrand::Rng::with_seed(5)));
    let mut climber: Option<Climber> = None;
    let input = ClimberInput {
        grip: place.grips,
        ..ClimberInput::IDLE
    };
    let (mut ridden, mut shake) = (0.0, 0.0f64);
    for tick in 0u32.. {
        let now = f64::from(tick) * dt - BEFORE;
        let new = rhythm.time(tick, rate, &mut next).map(|ticks| {
            let time = ticks * dt - BEFORE;
            (time, posed(time))
        });
        let mut seen = now;
        if rhythm.has_track() {
            if let Some((time, (pose, world))) = &new {
                track.record(*time, pose, *world).unwrap();
            }
            let Ok(motion) = track.tick(now, dt) else {
                continue;
            };
            seen = track.clock().time();
            let world = *track.world_from_model();
            rig.skeleton
                .palette_into(track.pose(), &mut palette)
                .unwrap();
            match motion {
                PoseMotion::Moved => giant.advance(&palette, world).unwrap(),
                PoseMotion::Teleported => giant.teleport(&palette, world).unwrap(),
            }
        } else {
            let mut world = *giant.world_from_model();
            if let Some((_, (pose, place))) = new {
                rig.skeleton.palette_into(&pose, &mut palette).unwrap();
                world = place;
            }
            giant.advance(&palette, world).unwrap();
        }
        // The rider comes when the giant's seen pose is at the start of its clip.
        if seen < -1e-9 && climber.is_none() {
            continue;
        }
        let climber = climber.get_or_insert_with(|| {
            let hold = giant.in_world().motion(&begin, dt).unwrap();
            let config = ClimberConfig::colossus_climber();
            let start = hold.previous_position + hold.normal * 0.45;
            let mut climber = Climber::new(config, start).unwrap();
            let mut state = *climber.state();
            state.velocity = DVec3::Z * frame;
            state.base_velocity = state.velocity;
            climber.restore(state).unwrap();
            climber
        });
        let rules = StepRules {
            air_velocity: DVec3::Z * frame,
            ..StepRules::default()
        };
        climber
            .step_with(&input, &[(ObstacleId(1), &giant)], &rules, dt)
            .unwrap();
        ridden += dt;
        if ridden > 0.5 {
            if climber.state().support.is_none() || ridden >= LENGTH {
                break;
            }
            shake = shake.max(climber.state().shake.length());
        }
    }
    Ride { off: ridden, shake }
}

/// Rides at all places in these rhythms, and compares the rides with those on a giant that is posed in each tick.
/// Returns the rides that differ too much.
fn compare(scene: Scene, rhythms: &[Rhythm]) -> Vec<String> {
    let rig = giant::model().unwrap().rig;
    let (mut wrong, mut held) = (Vec::new(), 0);
    for place in &PLACES {
        let full = ride(&rig, place, Rhythm::EachTick, scene);
        println!("{scene:?}, {}: {full:.2?}", place.what);
        held += u32::from(full.shake > 0.0);
        for rhythm in rhythms {
            let found = ride(&rig, place, *rhythm, scene);
            println!("    {rhythm:?}: {found:.2?}");
            if (found.off - full.off).abs() > 0.1 * full.off || found.shake > 1.5 * full.shake {
                let what = place.what;
                wrong.push(format!(
                    "{scene:?}, {what}, {rhythm:?}: {found:?}, {full:?}"
                ));
            }
        }
    }
    // The other riders do not get hold of the giant at all.
    assert!(held >= 2, "{scene:?}: {held} riders");
    wrong
}

/// The usual scene: 60 Hz, 40 m, a world at rest.
const SCENE: Scene = Scene {
    rate: 60.0,
    size: 1.0,
    frame: 0.0,
};

#[test]
fn riders_stay_on_as_long_as_at_the_full_rate() {
    for rate in [30.0, 60.0, 120.0] {
        let rhythms = [2, 3, 4].map(Rhythm::Every);
        let wrong = compare(Scene { rate, ..SCENE }, &rhythms);
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

#[test]
fn other_rhythms_carry_alike() {
    let rhythms = [
        Rhythm::At(24.0),
        Rhythm::At(25.7),
        Rhythm::Random,
        Rhythm::Missed,
    ];
    let wrong = compare(SCENE, &rhythms);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn giants_of_other_sizes_carry_alike() {
    for size in [0.25, 0.5, 2.0, 10.0] {
        let wrong = compare(Scene { size, ..SCENE }, &[Rhythm::Every(3)]);
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

#[test]
fn giants_in_moving_worlds_carry_alike() {
    for frame in [30.0, 300.0] {
        let wrong = compare(Scene { frame, ..SCENE }, &[Rhythm::Every(3)]);
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

#[test]
fn without_a_track_riders_are_shaken_off() {
    let wrong = compare(SCENE, &[2, 3, 4].map(Rhythm::Kept));
    assert_eq!(wrong.len(), 3 * PLACES.len(), "{wrong:#?}");
}

#[test]
fn a_steady_tick_of_a_track_allocates_nothing() {
    let rig = giant::model().unwrap().rig;
    let walk = rig.clip("walk").unwrap();
    let rest = rig.skeleton.rest_pose();
    let (mut track, mut palette) = (PoseTrack::default(), Palette::default());
    for tick in 0u32..600 {
        let now = f64::from(tick) / 60.0;
        // Intervals of two, three and four ticks in turn: the lag takes a while to adapt to them.
        let is_new = [0, 2, 5].contains(&(tick % 9));
        let pose = walk.sample(&rest, now, Playback::Loop).unwrap();
        let found = measure(|| {
            if is_new {
                track.record(now, &pose, Similarity::IDENTITY).unwrap();
            }
            track.tick(now, 1.0 / 60.0).unwrap();
            rig.skeleton
                .palette_into(track.pose(), &mut palette)
                .unwrap();
        });
        let is_steady = tick > 300;
        assert!(!is_steady || found.count_total == 0, "{tick}: {found:?}");
    }
}
