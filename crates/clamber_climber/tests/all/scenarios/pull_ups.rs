//! Pull-ups onto ledges that have no room above: below a ceiling, against a crate, and with room again.

use clamber_climber::ClimberMode::{Holding, LedgeHanging, Standing};
use clamber_climber::{ClimberEvent, ClimberInput};
use clamber_surface::geometry::Similarity;
use clamber_world::SurfaceKind;
use glam::{DAffine3, DVec3};

use crate::input::{HOLD, IDLE, grip_walk};
use crate::stage::{Played, Run, Shape, Skin, Stage, every, shifted, tireless, turned, within};

/// Time after which a climber gives up a pull-up that makes no progress, seconds.
const GIVES_UP: f64 = 0.3;

/// The obstacle above the ledge, or on it. Distances are in metres.
#[derive(Clone, Copy, Debug)]
enum Above {
    /// A ceiling, at a height above the ledge.
    Ceiling(f64),
    /// A ceiling that only begins behind the edge, at a distance.
    Eaves(f64),
    /// A crate on the ledge, at a distance behind the edge.
    Crate(f64),
}

/// All obstacles that block a pull-up.
const ALL: [Above; 7] = [
    Above::Ceiling(0.2),
    Above::Ceiling(0.5),
    Above::Ceiling(0.75),
    Above::Eaves(0.1),
    Above::Crate(0.25),
    Above::Crate(0.3),
    Above::Crate(0.35),
];

impl Above {
    fn shape(self) -> Shape {
        let high = DVec3::new(4.0, 4.5, 3.0);
        match self {
            Self::Ceiling(gap) => Shape::boxed(DVec3::new(-4.0, 3.0 + gap, -3.0), high),
            Self::Eaves(behind) => {
                let high = high - DVec3::Z * behind;
                Shape::boxed(DVec3::new(-4.0, 3.5, -3.0), high)
            }
            Self::Crate(behind) => {
                let front = 3.0 - behind;
                let low = DVec3::new(-0.2, 3.0, front - 1.0);
                Shape::boxed(low, DVec3::new(0.8, 4.0, front))
            }
        }
    }
}

/// A scene that is turned about the vertical.
struct Side(Similarity);

impl Side {
    /// Turns a vector or a position that is given for the side that faces +Z.
    fn to(&self, front: DVec3) -> DVec3 {
        self.0.rotation * front
    }

    fn shape(&self, shape: Shape) -> Shape {
        shape.placed(&self.0)
    }

    fn stick(&self, front: DVec3) -> ClimberInput {
        grip_walk(self.to(front))
    }
}

fn block() -> Shape {
    Shape::boxed(DVec3::new(-4.0, -3.0, -3.0), DVec3::new(4.0, 3.0, 3.0))
}

fn ticks(seconds: f64, dt: f64) -> u32 {
    (seconds / dt).round() as u32
}

/// The stick for a pull-up, for the side that faces +Z.
const UP: DVec3 = DVec3::NEG_Z;

/// The position of the hanging climber, for the side that faces +Z.
const PLACE: DVec3 = DVec3::new(0.3, 2.4, 3.4);

/// A climber that hangs from the edge.
fn hung(stage: Stage, side: &Side, case: &str) -> Run {
    let config = tireless();
    let start = side.to(DVec3::new(0.3, 2.75, 3.5)) - DVec3::Y * config.body.radius;
    let dt = stage.dt;
    let mut run = Run::new(stage, config, start);
    let toward = side.stick(UP * 0.1);
    for _ in 0..ticks(1.0, dt) {
        let is_caught = run.mode() == LedgeHanging;
        run.step(if is_caught { &HOLD } else { &toward });
    }
    assert_eq!(run.mode(), LedgeHanging, "{case}: {}", run.position());
    run
}

/// Steps until the climber is in its place below the edge, for a limited time. Returns the time that it took, seconds.
fn until_in_place(run: &mut Run, place: DVec3, input: &ClimberInput, most: f64) -> Option<f64> {
    let dt = run.stage.dt;
    (1..=ticks(most, dt)).find_map(|tick| {
        run.step(input);
        let is_there = run.mode() == LedgeHanging && run.position().distance(place) < 1e-3;
        is_there.then_some(f64::from(tick) * dt)
    })
}

/// Steps until the climber is blocked, for a second at most.
fn until_blocked(run: &mut Run, input: &ClimberInput) {
    for _ in 0..ticks(1.0, run.stage.dt) {
        run.step(input);
        if run.state().ledge_hanging.blocked > 0.0 {
            return;
        }
    }
}

/// Steps a climber that is blocked until it gives up. Checks that its velocity is the velocity at which it moves, and
/// that it does not go back and forth once it slides along the obstacle.
fn blocked_at_rest(run: &mut Run, input: &ClimberInput, case: &str) {
    let dt = run.stage.dt;
    let (mut blocked, mut last) = (0, DVec3::ZERO);
    for _ in 0..ticks(1.0, dt) {
        let from = run.position();
        run.step(input);
        let velocity = run.state().velocity;
        let is_blocked = run.state().ledge_hanging.blocked > 0.0;
        blocked += u32::from(is_blocked);
        if blocked > 0 && !is_blocked {
            break;
        }
        let off = velocity.distance((run.position() - from) / dt);
        within!(off, 1e-2 + 0.05 * velocity.length(), "{case}: {velocity}");
        within!(-velocity.dot(last), 1e-4, "{case}: {last} {velocity}");
        last = if blocked > 1 { velocity } else { DVec3::ZERO };
    }
    let waited = f64::from(blocked) * dt;
    within!(
        (waited - GIVES_UP).abs(),
        4.0 * dt,
        "{case}: waits {waited} s"
    );
}

/// Asserts that the climber is where it hung, and that its velocity is zero, for a second.
fn rests(run: &mut Run, place: DVec3, input: &ClimberInput, case: &str) {
    for _ in 0..ticks(1.0, run.stage.dt) {
        run.step(input);
        assert_eq!(run.mode(), LedgeHanging, "{case}: {}", run.position());
        let off = run.position().distance(place);
        within!(off, 5e-3, "{case}: rests at {}", run.position());
        let speed = run.state().velocity.length();
        within!(speed, 1e-3, "{case}: {}", run.state().velocity);
    }
}

fn each_case(play: impl Fn(Played, Above, &Side, f64, &str) -> crate::stage::Trace) {
    let rates = [60.0, 30.0, 120.0, 240.0];
    for (index, above) in ALL.into_iter().enumerate() {
        let side = Side(turned(DVec3::Y, 1.1 * index as f64));
        let rate = rates[index % rates.len()];
        every(0.0, |played| {
            let case = format!("{played:?}, {above:?}, {rate} Hz");
            play(played, above, &side, 1.0 / rate, &case)
        });
    }
}

fn stage(played: Played, above: Above, side: &Side, dt: f64) -> Stage {
    let stage = Stage::at(played, dt, DVec3::ZERO);
    let stage = stage.with_still(&side.shape(block()));
    stage.with_still(&side.shape(above.shape()))
}

pub(crate) fn a_pull_up_without_room_is_given_up_after_a_while() {
    each_case(|played, above, side, dt, case| {
        let mut run = hung(stage(played, above, side, dt), side, case);
        let (place, up) = (side.to(PLACE), side.stick(UP));
        // The climber tries, gives up by itself, and does not try again while the stick is held up.
        run.steps(ticks(0.25, dt), &up);
        let at = run.position();
        assert!(run.state().ledge_hanging.pull_up > 0.0, "{case}: {at}");
        blocked_at_rest(&mut run, &up, case);
        let back = until_in_place(&mut run, place, &up, 1.3);
        assert!(back.is_some(), "{case}: {:?}", run.state());
        rests(&mut run, place, &up, case);
        // The climber tries again once the stick was released, and gives up again.
        run.step(&HOLD);
        run.steps(ticks(0.3, dt), &up);
        let pull_up = run.state().ledge_hanging.pull_up;
        let rises = (run.position() - place).y;
        assert!(
            pull_up > 0.0 && rises > 0.05,
            "{case}: {pull_up} at {}",
            run.position()
        );
        let back = until_in_place(&mut run, place, &up, 1.6);
        assert!(back.is_some(), "{case}: {:?}", run.state());
        run.sound()
    });
}

pub(crate) fn a_pull_up_without_room_obeys_the_stick_at_once() {
    each_case(|played, above, side, dt, case| {
        let mut run = hung(stage(played, above, side, dt), side, case);
        let (place, up) = (side.to(PLACE), side.stick(UP));
        for input in [HOLD, side.stick(-UP), side.stick(DVec3::X * 1e-6)] {
            until_blocked(&mut run, &up);
            let (blocked, high) = (run.state().ledge_hanging.blocked, run.position());
            assert!(blocked > 0.0, "{case}: at {high}");
            run.step(&input);
            let pull_up = run.state().ledge_hanging.pull_up;
            assert_eq!(pull_up, 0.0, "{case}, {:?}", input.walk);
            // Arms draw the climber back three times as fast as it goes along a ledge: at 3 m/s.
            let most = high.distance(place) / 3.0 * 1.6 + 2.0 * dt;
            let back = until_in_place(&mut run, place, &input, 1.0);
            let back = back.unwrap_or(f64::INFINITY);
            within!(back, most, "{case}, {:?}: from {high}", input.walk);
            rests(&mut run, place, &input, case);
        }
        run.sound()
    });
}

pub(crate) fn a_climber_that_gives_up_a_pull_up_goes_aside_lets_go_and_jumps() {
    each_case(|played, above, side, dt, case| {
        let mut run = hung(stage(played, above, side, dt), side, case);
        let (place, up) = (side.to(PLACE), side.stick(UP));
        until_blocked(&mut run, &up);
        run.steps(ticks(0.6, dt), &side.stick(DVec3::NEG_X));
        let made = (place - run.position()).dot(side.to(DVec3::X));
        assert!(made > 0.3, "{case}: made {made}, at {}", run.position());
        assert_eq!(run.mode(), LedgeHanging, "{case}: {}", run.position());
        run.steps(ticks(0.6, dt), &side.stick(DVec3::X));
        until_in_place(&mut run, place, &HOLD, 1.0);
        let state = *run.state();
        for (input, says) in [
            (IDLE, ClimberEvent::Released),
            (ClimberInput { jump: true, ..HOLD }, ClimberEvent::Jumped),
        ] {
            run.put(state);
            run.step_held(&HOLD);
            until_blocked(&mut run, &up);
            run.step(&HOLD);
            let report = run.step(&input);
            assert!(report.events.contains(&says), "{case}: {:?}", report.events);
            assert_ne!(run.mode(), LedgeHanging, "{case}");
        }
        run.sound()
    });
}

/// While the climber goes back, it climbs down to a hold.
pub(crate) fn a_climber_that_gives_up_a_pull_up_climbs_down() {
    every(0.0, |played| {
        let still = |_| (vec![DAffine3::IDENTITY], shifted(DVec3::ZERO));
        let low = Shape::boxed(DVec3::new(-4.0, -3.0, -3.0), DVec3::new(4.0, 2.2, 3.0));
        let fur = Skin::of(&low, SurfaceKind::Fur, &|_| vec![1.0], Box::new(still));
        let top = Shape::boxed(DVec3::new(-4.0, 2.2, -3.0), DVec3::new(4.0, 3.0, 3.0));
        let stage = Stage::new(played).with_still(&top).with_skin(fur);
        let stage = stage.with_still(&Above::Ceiling(0.5).shape());
        let side = Side(Similarity::IDENTITY);
        let mut run = hung(stage, &side, "fur below");
        run.steps(60, &side.stick(UP));
        run.steps(60, &side.stick(-UP));
        assert_eq!(run.mode(), Holding, "{played:?}: {}", run.position());
        run.sound()
    });
}

/// A ceiling that rises while the climber pulls itself up.
pub(crate) fn a_pull_up_goes_on_once_there_is_room() {
    for opens in [0.1, 0.2] {
        every(0.0, |played| {
            let rises = move |time: f64| {
                // The climber hangs for a second, and is blocked some 0.3 s after that.
                let since = (time - 1.0 - 2.0 / 60.0 - 0.3 - opens).max(0.0);
                shifted(DVec3::Y * (4.0 * since).min(2.0))
            };
            let stage = Stage::new(played).with_still(&block());
            let stage = stage.with(&Above::Ceiling(0.5).shape(), rises);
            let side = Side(Similarity::IDENTITY);
            let mut run = hung(stage, &side, "opens");
            run.steps(90, &side.stick(UP));
            assert_eq!(run.mode(), Standing, "{played:?}: {}", run.position());
            run.sound()
        });
    }
}

/// With room, a pull-up goes on without the stick.
pub(crate) fn a_pull_up_with_room_goes_on_by_itself() {
    for rate in [30.0, 60.0, 240.0] {
        every(0.0, |played| {
            let dt = 1.0 / rate;
            let stage = Stage::at(played, dt, DVec3::ZERO).with_still(&block());
            let side = Side(Similarity::IDENTITY);
            let mut run = hung(stage, &side, "room");
            run.steps(ticks(0.1, dt), &side.stick(UP));
            run.steps(ticks(0.8 + GIVES_UP, dt), &HOLD);
            assert_eq!(run.mode(), Standing, "{played:?}: {}", run.position());
            run.sound()
        });
    }
}
