//! An overlap, a correction of position or touching legs do not switch off the sweep against other obstacles.

use clamber_climber::{Climber, ClimberConfig, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::{DVec3, FloatExt, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::input::{HOLD, IDLE, walk};
use crate::scene::{
    FUR, STONE, cuboid, cuboid_at, list, moved, placed, placed_or_moved, put, throw, tick_among,
    walker,
};
use crate::stage::{Played, Run, Shape, Stage, shifted, tireless};

fn floor() -> SkinnedSurface {
    cuboid_at(Vec3::new(9.0, 1.0, 6.0), STONE, v(0.0, -1.0, 0.0))
}

/// A plate at 60 m/s passes over a climber that begins inside the floor.
#[test]
fn an_overlap_at_the_start_does_not_let_a_plate_through() {
    let floor = floor();
    let mut plate = cuboid(Vec3::new(0.05, 3.0, 3.0), STONE);
    for deep in [-0.005, -0.0005, 0.0005, 0.001, 0.002, 0.005, 0.05, 0.15] {
        placed(&mut plate, v(-0.5, 3.05, 0.0));
        moved(&mut plate, v(0.5, 3.05, 0.0));
        let start = v(0.0, 0.39 - deep, 0.0);
        let mut climber = walker(start);
        let report = tick_among(&mut climber, &[&floor, &plate], &IDLE);
        let place = climber.state().position;
        assert!(
            place.x > 0.5,
            "core {deep} m in the floor: ends at {place}, {report:?}"
        );
    }
}

/// Walls on both sides of a climber on a floor, which close until the room is `short` metres too small.
struct Fold {
    floor: SkinnedSurface,
    walls: [SkinnedSurface; 2],
    short: f64,
}

impl Fold {
    fn new(short: f64) -> Self {
        let wall = || cuboid(Vec3::new(9.0, 3.0, 0.5), STONE);
        Self {
            floor: floor(),
            walls: [wall(), wall()],
            short,
        }
    }

    fn advance(&mut self, k: u32) {
        let open = 0.05 * (1.0 - (f64::from(k) / 40.0).min(1.0));
        let half = 0.5 + (0.8 - self.short) * 0.5 + open;
        for (wall, side) in self.walls.iter_mut().zip([-1.0, 1.0]) {
            let place = v(0.0, 3.05, side * half);
            placed_or_moved(wall, place, k);
        }
    }

    fn step(&self, climber: &mut Climber, limb: &SkinnedSurface, dt: f64) {
        let all: [&dyn Obstacle; 4] = [&self.floor, &self.walls[0], &self.walls[1], limb];
        climber.step(&IDLE, &list(&all), dt).unwrap();
    }
}

#[test]
fn a_fold_does_not_let_a_plate_through() {
    for short in [0.0, 0.01, 0.018, 0.021, 0.022, 0.024, 0.03, 0.05, 0.1] {
        let mut fold = Fold::new(short);
        let mut plate = cuboid(Vec3::new(0.05, 3.0, 3.0), STONE);
        let mut climber = walker(v(0.0, 0.41, 0.0));
        for k in 0..=50 {
            fold.advance(k);
            let x = if k < 50 { -0.5 } else { 0.5 };
            placed_or_moved(&mut plate, v(x, 3.05, 0.0), k);
            fold.step(&mut climber, &plate, 1.0 / 60.0);
        }
        let place = climber.state().position;
        assert!(
            place.x > 0.8,
            "fold {short} m short of room: ends at {place}"
        );
    }
}

#[test]
fn a_fold_does_not_let_a_limb_through() {
    let mut wrong = Vec::new();
    for hz in [30.0, 60.0, 120.0] {
        let dt = 1.0 / hz;
        for thick in [0.1, 0.3, 0.6] {
            let mut limb = cuboid(Vec3::new(thick as f32 * 0.5, 3.0, 3.0), STONE);
            for short in [0.0, 0.024, 0.05] {
                let mut fold = Fold::new(short);
                for speed in [10.0, 20.0, 30.0, 40.0, 60.0] {
                    let mut behind = 0;
                    for phase in 0..10 {
                        let mut climber = walker(v(0.0, 0.41, 0.0));
                        let hit = 50;
                        let limb_at = |k: u32| {
                            let first = -0.42 - thick * 0.5 - speed * dt * 0.1 * f64::from(phase);
                            v(
                                first + speed * dt * (f64::from(k) - f64::from(hit)),
                                3.05,
                                0.0,
                            )
                        };
                        for k in 0..70 {
                            fold.advance(k);
                            placed_or_moved(&mut limb, limb_at(k), k);
                            fold.step(&mut climber, &limb, dt);
                            if k > hit && climber.state().position.x < limb_at(k).x {
                                behind += 1;
                                break;
                            }
                            if limb_at(k).x > 2.0 {
                                break;
                            }
                        }
                    }
                    if behind > 0 {
                        wrong.push(format!(
                            "{hz} Hz, limb {thick} m thick at {speed} m/s, fold {short} m short: \
                             through in {behind} of 10"
                        ));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A beam at 60 m/s crosses the climber's position in the tick of its step-up, or in one of the next three.
#[test]
fn a_step_up_does_not_let_a_beam_through() {
    let steps = |beam: Option<(u32, f64)>| {
        let stairs = Shape::stairs(1, 0.28, 1.0, 4.0);
        let mut stage = Stage::new(Played::Root).with_still(&stairs);
        if let Some((tick, middle)) = beam {
            let beam = Shape::boxed(v(-4.0, 0.85, -0.05), v(4.0, 0.95, 0.05));
            stage = stage.with(&beam, move |time| {
                let k = libm::round(time * 60.0) - f64::from(tick);
                let z = if k < 0.0 {
                    middle + 0.55
                } else {
                    middle - 0.45 - k
                };
                shifted(DVec3::Z * z)
            });
        }
        let mut run = Run::new(stage, ClimberConfig::walker(), v(0.1, 0.0, -1.0)).settle();
        (0..60)
            .map(|_| {
                run.step(&walk(DVec3::Z));
                run.position()
            })
            .collect::<Vec<_>>()
    };
    let free = steps(None);
    let up = (1..free.len())
        .find(|k| free[*k].y - free[k - 1].y > 0.05)
        .unwrap();
    for late in 0..4 {
        let k = up + late;
        let with = steps(Some((k as u32 + 1, free[k].z)));
        let off = with[k].distance(free[k]);
        assert!(
            off > 0.05,
            "{late} ticks after the step-up: {} and free {}",
            with[k],
            free[k]
        );
    }
}

/// A climber that hangs at rest from a beam of fur.
fn hung(hz: f64, beam: &SkinnedSurface) -> Climber {
    let mut config = tireless();
    config.grip.as_mut().unwrap().max_overhang = 2.0;
    let mut climber = Climber::new(config, v(0.0, 2.55, 0.0)).unwrap();
    for _ in 0..(6.0 * hz) as u32 {
        climber.step(&HOLD, &list(&[beam]), 1.0 / hz).unwrap();
    }
    assert_eq!(climber.state().mode, ClimberMode::Hanging, "{hz} Hz");
    climber
}

/// End of the climber's legs, in world space.
fn tip(climber: &Climber) -> DVec3 {
    climber.state().position + climber.state().hanging.legs
}

/// True if the legs of a climber that hangs go through an obstacle in some ticks. `is_through` gets the positions of
/// their end before and after a tick.
fn legs_go_through(
    climber: &mut Climber,
    obstacles: &[&dyn Obstacle],
    hz: f64,
    ticks: u32,
    is_through: impl Fn(DVec3, DVec3) -> bool,
) -> bool {
    for _ in 0..ticks {
        let before = tip(climber);
        climber.step(&HOLD, &list(obstacles), 1.0 / hz).unwrap();
        if climber.state().mode != ClimberMode::Hanging {
            return false;
        }
        if is_through(before, tip(climber)) {
            return true;
        }
    }
    false
}

/// A plate at the lowest point of the swing, which only the legs can hit.
#[test]
fn swinging_legs_do_not_pass_through_a_plate() {
    let mut wrong = Vec::new();
    let beam = cuboid_at(Vec3::new(1.0, 0.3, 1.0), FUR, v(0.0, 3.3, 0.0));
    for hz in [30.0, 60.0, 480.0] {
        let base = hung(hz, &beam);
        let pivot = base.state().support.unwrap().attachment.point;
        let top = pivot.y - 1.32;
        for half in [0.03, 0.15, 0.5] {
            let size = Vec3::new(half as f32, 1.0, 2.0);
            let plate = cuboid_at(size, STONE, v(half, top - 1.0, 0.0));
            for speed in [4.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0] {
                let mut through = 0;
                for start in 0..8 {
                    let clear = 0.41 + 0.05 * f64::from(start);
                    let angle = -libm::asin((clear / 1.5).min(0.99));
                    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
                    let mut climber = base.clone();
                    let arm = v(sine, -cosine, 0.0) * 0.9;
                    put(&mut climber, pivot + arm, v(cosine, sine, 0.0) * speed);
                    let mut state = *climber.state();
                    state.hanging.legs = arm.normalize() * 0.6;
                    climber.restore(state).unwrap();
                    let is_through = |before: DVec3, after: DVec3| {
                        let height = before.y.lerp(after.y, before.x / (before.x - after.x));
                        before.x < 0.0 && after.x > 0.0 && height < top
                    };
                    let (all, ticks) = ([&beam as &dyn Obstacle, &plate], (0.2 * hz) as u32);
                    let is_wrong = legs_go_through(&mut climber, &all, hz, ticks, is_through);
                    through += u32::from(is_wrong);
                }
                if through > 0 {
                    wrong.push(format!(
                        "{hz} Hz, plate {half} m half, {speed} m/s: through in {through} of 8"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A plate ahead of the swing's lowest point and below the body's ball.
#[test]
fn legs_thrown_ahead_do_not_pass_through_a_plate() {
    let mut wrong = Vec::new();
    let beam = cuboid_at(Vec3::new(1.0, 0.3, 1.0), FUR, v(0.0, 3.3, 0.0));
    for hz in [30.0, 60.0, 480.0] {
        let base = hung(hz, &beam);
        let pivot = base.state().support.unwrap().attachment.point;
        let top = pivot.y - 1.35;
        for speed in [3.0, 5.0, 7.0, 10.0, 14.0, 20.0, 28.0] {
            let mut through = 0;
            for ahead in 0..12 {
                let x = 0.42 + 0.04 * f64::from(ahead);
                let place = v(x + 0.03, top - 0.75, 0.0);
                let plate = cuboid_at(Vec3::new(0.03, 0.75, 2.0), STONE, place);
                let mut climber = base.clone();
                put(&mut climber, base.state().position, v(speed, 0.0, 0.0));
                let is_through = |before: DVec3, after: DVec3| {
                    let share = (x + 0.03 - before.x) / (after.x - before.x);
                    let height = before.y + (after.y - before.y) * share;
                    before.x < x && after.x > x + 0.06 && height < top
                };
                let ticks = (0.12 * hz).max(2.0) as u32;
                let all = [&beam as &dyn Obstacle, &plate];
                let is_wrong = legs_go_through(&mut climber, &all, hz, ticks, is_through);
                through += u32::from(is_wrong);
            }
            if through > 0 {
                wrong.push(format!("{hz} Hz, {speed} m/s: through in {through} of 12"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Two walls along X that close on a weightless climber from first contact on, each at a speed, in a moving frame.
struct Jaws {
    speed: f64,
    frame: DVec3,
    ticks: u32,
}

impl Jaws {
    /// Plays the run with another obstacle, which is at `place` in the frame. `with` may change the climber before a
    /// step. Returns the climber, and the final origin of the frame.
    fn close(
        &self,
        mut other: SkinnedSurface,
        place: impl Fn(u32) -> DVec3,
        mut with: impl FnMut(u32, &mut Climber),
    ) -> (Climber, DVec3) {
        let mut config = ClimberConfig::walker();
        config.gravity = DVec3::ZERO;
        let mut climber = Climber::new(config, DVec3::ZERO).unwrap();
        throw(&mut climber, self.frame, self.frame);
        let mut walls = [-1.0, 1.0].map(|_| cuboid(Vec3::new(9.0, 3.0, 0.5), STONE));
        let mut origin = DVec3::ZERO;
        for k in 0..self.ticks {
            origin = self.frame * (f64::from(k) / 60.0);
            let half = 0.4 - self.speed * f64::from(k) / 60.0;
            let walls_at = [-1.0, 1.0].map(|side| v(0.0, 0.0, side * (half + 0.5)));
            for (wall, at) in walls.iter_mut().zip(walls_at) {
                placed_or_moved(wall, origin + at, k);
            }
            placed_or_moved(&mut other, origin + place(k), k);
            if k == 0 {
                continue;
            }
            with(k, &mut climber);
            let all: [&dyn Obstacle; 3] = [&walls[0], &walls[1], &other];
            climber.step(&IDLE, &list(&all), 1.0 / 60.0).unwrap();
        }
        (climber, origin)
    }
}

/// Velocities of the moving frame, metres a second.
const FRAMES: [DVec3; 3] = [
    DVec3::ZERO,
    DVec3::new(30.0, 0.0, 0.0),
    DVec3::new(0.0, -30.0, 300.0),
];

/// A climber that is crushed in the same tick is still hit by other obstacles.
#[test]
fn closing_jaws_do_not_let_a_limb_through() {
    for (frame, speed, hit) in triples(FRAMES, [0.3, 0.6, 1.0, 2.0, 4.0], 1..5) {
        let limb = cuboid(Vec3::new(0.05, 3.0, 3.0), STONE);
        let limb_at = |k: u32| v(0.5 + f64::from(k) - f64::from(hit), 0.0, 0.0);
        let jaws = Jaws {
            speed,
            frame,
            ticks: hit + 1,
        };
        let (climber, origin) = jaws.close(limb, limb_at, |_, _| {});
        let place = climber.state().position - origin;
        // The climber ends in front of the limb, though it may be as deep in the limb as in the walls.
        assert!(
            place.x > 0.6,
            "{speed} m/s, in tick {hit}, frame {frame}: ends at {place}"
        );
    }
}

/// A blow does not move a crushed climber, and never through an obstacle.
#[test]
fn a_blow_does_not_throw_a_crushed_climber_through_a_plate() {
    for (frame, speed) in pairs(FRAMES, [0.3, 1.0, 4.0]) {
        let plate = cuboid(Vec3::new(0.03, 3.0, 3.0), STONE);
        let jaws = Jaws {
            speed,
            frame,
            ticks: 5,
        };
        let (climber, origin) = jaws.close(
            plate,
            |_| v(0.6, 0.0, 0.0),
            |k, climber| {
                if k == 4 {
                    let blow = frame + DVec3::X * 60.0;
                    put(climber, climber.state().position, blow);
                }
            },
        );
        assert!(climber.state().crushed);
        let place = climber.state().position - origin;
        assert!(place.x < 0.3, "{speed} m/s, frame {frame}: ends at {place}");
    }
}
