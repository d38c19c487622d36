//! The rule for contacts: who may be stood on, stepped onto, hung from, gripped and passed through.

use std::cell::Cell;
use std::rc::Rc;

use clamber_climber::ClimberMode::{Falling, Holding, LedgeHanging, Sliding, Standing};
use clamber_climber::{ClimberConfig, ClimberEvent, ClimberInput, ContactQuery, ContactRule};
use clamber_surface::geometry::Similarity;
use clamber_world::ObstacleId;
use glam::DVec3;

use crate::stage::{IDLE, JUMP, Played, Run, Shape, Stage, every, radians, shifted, walk, within};

const RATES: [f64; 3] = [30.0, 60.0, 240.0];

const RADIUS: f64 = 0.4;

const G: f64 = 9.81;

/// The shape that rules are about; all others have the number 0.
const ODD: u32 = 1;

const GRIP: ClimberInput = ClimberInput { grip: true, ..IDLE };

fn stage(played: Played, rate: f64) -> Stage {
    Stage::at(played, 1.0 / rate, DVec3::ZERO)
}

/// The usual rule, but for the odd shape.
fn but(
    odd: impl Fn(&ContactQuery<'_>) -> ContactRule,
) -> impl Fn(&ContactQuery<'_>) -> ContactRule {
    move |query| {
        if query.tag().user == ODD {
            odd(query)
        } else {
            query.usual()
        }
    }
}

/// A climber that neither tires nor is hurt.
fn person() -> ClimberConfig {
    ClimberConfig {
        stamina: None,
        health: None,
        tumble: None,
        ..ClimberConfig::colossus_climber()
    }
}

fn seconds(rate: f64, seconds: f64) -> u32 {
    (rate * seconds).round() as u32
}

/// A plate of 6 cm and a sheet without thickness, with their tops at height 1.
fn platforms() -> [Shape; 2] {
    let corner = |x: f64, z: f64| DVec3::new(x, 1.0, z);
    let sheet = [
        corner(-3.0, -3.0),
        corner(-3.0, 3.0),
        corner(3.0, 3.0),
        corner(3.0, -3.0),
    ];
    let plate = Shape::boxed(DVec3::new(-3.0, 0.94, -3.0), corner(3.0, 3.0));
    [plate, Shape::quad(sheet)]
}

/// Jumps through a platform, stands and walks on it, and drops through it. A body with a height reaches through the
/// platform before it jumps.
fn through_and_back(
    played: Played,
    rate: f64,
    (platform, height): (&Shape, f64),
    motion: fn(f64) -> DVec3,
) -> crate::stage::Trace {
    let case = format!("{played:?}, {rate} Hz");
    let stage = stage(played, rate)
        .with_still(&Shape::floor(9.0))
        .numbered(ODD)
        .with(platform, move |time| shifted(motion(time)));
    let mut config = ClimberConfig::walker();
    config.ground.jump_speed = 5.5;
    config.body.height = height;
    let mut run = Run::new(stage, config, DVec3::ZERO);
    let drops = Rc::new(Cell::new(false));
    let key = Rc::clone(&drops);
    run.set_rule(but(move |query| {
        if key.get() {
            ContactRule::PASS
        } else {
            query.one_way()
        }
    }));
    let mut run = run.settle();
    run.step(&JUMP);
    let held = ClimberInput {
        jump_held: true,
        ..IDLE
    };
    run.steps(seconds(rate, 1.5), &held);
    let heights = run.trace.positions.iter().map(|at| at.y - RADIUS);
    let top = heights.fold(0.0, f64::max);
    let apex = 5.5 * 5.5 / (2.0 * G);
    let dt = 1.0 / rate;
    within!(
        (top - apex).abs(),
        G * dt * dt / 8.0 + 1e-4,
        "{case}: rose to {top} of {apex}"
    );
    let stands = |run: &Run| {
        let off = run.feet().y - 1.0 - motion(run.stage.time()).y;
        assert_eq!(run.mode(), Standing, "{case} at {}", run.feet());
        within!(off.abs(), 1e-3, "{case}: stands at {}", run.feet());
    };
    stands(&run);
    for tick in 0..seconds(rate, 1.0) {
        let side = if tick < seconds(rate, 0.5) { 1.0 } else { -1.0 };
        run.step(&walk(DVec3::X * side));
        stands(&run);
    }
    drops.set(true);
    run.step(&IDLE);
    assert_eq!(run.mode(), Falling, "{case}");
    run.steps(seconds(rate, 0.1), &IDLE);
    drops.set(false);
    run.steps(seconds(rate, 1.4), &IDLE);
    assert_eq!(run.mode(), Standing, "{case}");
    within!(
        run.feet().y.abs(),
        1e-3,
        "{case}: dropped to {}",
        run.feet()
    );
    run.sound()
}

pub(crate) fn a_one_way_platform_is_jumped_through_stood_on_and_dropped_through() {
    for rate in RATES {
        for (platform, height) in platforms().iter().zip([0.0, 0.8]) {
            every(0.0, |played| {
                through_and_back(played, rate, (platform, height), |_| DVec3::ZERO)
            });
        }
    }
}

pub(crate) fn a_one_way_platform_that_moves_is_boarded_from_below() {
    for rate in RATES {
        for (platform, height) in platforms().iter().zip([0.8, 0.0]) {
            every(0.0, |played| {
                through_and_back(played, rate, (platform, height), |time| {
                    DVec3::new(0.3 * time, 0.1 * libm::sin(2.0 * time), 0.0)
                })
            });
        }
    }
}

/// A walker at rest on a floor with a friction.
fn on_floor(played: Played, rate: f64, floor: &Shape, friction: f64) -> Run {
    let stage = stage(played, rate).numbered(ODD).with_still(floor);
    let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
    run.set_rule(but(move |query| query.usual().with_friction(friction)));
    run
}

pub(crate) fn ice_accelerates_and_brakes_slowly() {
    let pull = 0.1 * 15.0;
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let mut run = on_floor(played, rate, &Shape::floor(9.0), 0.1);
            let start = run.position().x;
            run.steps(seconds(rate, 1.0), &walk(DVec3::X));
            let (went, speed) = (run.position().x - start, run.state().velocity.x);
            within!((speed - pull).abs(), 1e-3, "{case}: {speed} m/s");
            within!((went - pull / 2.0).abs(), 1e-3, "{case}: went {went} m");
            run.steps(seconds(rate, 1.5), &IDLE);
            let went = run.position().x - start;
            within!(
                (went - pull).abs(),
                5e-3,
                "{case}: came to rest at {went} m"
            );
            assert_eq!(
                run.state().velocity.x,
                run.state().base_velocity.x,
                "{case}"
            );
            run.sound()
        });
    }
}

pub(crate) fn an_icy_slope_pulls_down() {
    let angle = radians(20.0);
    let floor = Shape::floor(30.0).turned(DVec3::Z, angle);
    for rate in RATES {
        for (friction, jumps) in [(0.0, false), (0.1, false), (0.5, false), (0.1, true)] {
            every(0.0, |played| {
                let case = format!("{played:?}, {rate} Hz, friction {friction}");
                let mut run = on_floor(played, rate, &floor, friction);
                let start = run.position();
                let pull = (G * libm::sin(angle) - friction * 15.0).max(0.0);
                run.steps(seconds(rate, 1.0), &IDLE);
                assert!(run.trace.always(Standing), "{case}");
                let (went, speed) = (
                    run.position().distance(start),
                    run.state().velocity.length(),
                );
                within!((speed - pull).abs(), 2e-3, "{case}: {speed} m/s");
                within!((went - pull / 2.0).abs(), 2e-3, "{case}: went {went} m");
                if jumps {
                    run.step(&JUMP);
                    assert_eq!(run.mode(), Falling, "{case}");
                }
                run.sound()
            });
        }
    }
}

pub(crate) fn mud_slows_a_walk() {
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let mut run = on_floor(played, rate, &Shape::floor(9.0), 3.0);
            let start = run.position().x;
            run.steps(seconds(rate, 1.0), &walk(DVec3::X));
            let went = run.position().x - start;
            within!((went - 1.0).abs(), 1e-3, "{case}: went {went} m");
            run.sound()
        });
    }
}

/// A wall whose face is at z 0, from one height to another.
fn wall(from: f64, to: f64) -> Shape {
    Shape::boxed(DVec3::new(-3.0, from, -1.0), DVec3::new(3.0, to, 0.0))
}

/// A climber that holds a wall, with its centre at a height.
fn at_wall(stage: Stage, height: f64) -> Run {
    let feet = DVec3::new(0.0, height - RADIUS, RADIUS);
    Run::new(stage, person(), feet)
}

pub(crate) fn armour_stops_hands() {
    let up = ClimberInput {
        climb: DVec3::Y,
        ..GRIP
    };
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let stage = stage(played, rate)
                .numbered(ODD)
                .with_still(&wall(0.0, 3.0))
                .numbered(2)
                .with_still(&wall(3.0, 6.0));
            let mut run = at_wall(stage, 1.5);
            run.set_rule(|query| query.usual().with_grip(query.tag().user == ODD));
            for _ in 0..seconds(rate, 4.0) {
                run.step(&up);
                assert_eq!(run.mode(), Holding, "{case} at {}", run.position());
                let on = run.state().support.unwrap().tag.user;
                assert_eq!(on, ODD, "{case} at {}", run.position());
            }
            let height = run.position().y;
            assert!((2.6..3.6).contains(&height), "{case}: climbed to {height}");
            run.sound()
        });
    }
}

pub(crate) fn a_hold_that_is_refused_lets_go() {
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let stage = stage(played, rate)
                .numbered(ODD)
                .with_still(&wall(-9.0, 6.0));
            let mut run = at_wall(stage, 1.5);
            let closed = Rc::new(Cell::new(false));
            let is_closed = Rc::clone(&closed);
            run.set_rule(move |query| query.usual().with_grip(!is_closed.get()));
            run.steps(seconds(rate, 0.5), &GRIP);
            assert_eq!(run.mode(), Holding, "{case}");
            closed.set(true);
            let report = run.step(&GRIP);
            assert_eq!(run.mode(), Falling, "{case}");
            let lost = |event: &ClimberEvent| matches!(event, ClimberEvent::LostFooting { .. });
            assert!(
                report.events.iter().any(lost),
                "{case}: {:?}",
                report.events
            );
            run.steps(seconds(rate, 0.3), &GRIP);
            assert_eq!(run.mode(), Falling, "{case}");
            run.sound()
        });
    }
}

pub(crate) fn wet_fur_slips_through_hands() {
    let climb_speed = person().grip.unwrap().climb_speed;
    for rate in RATES {
        for (climb, rise) in [(0.0, -0.5), (1.0, 0.5), (0.5, 0.0), (-1.0, -1.5)] {
            every(0.0, |played| {
                let case = format!("{played:?}, {rate} Hz, {climb}");
                let stage = stage(played, rate)
                    .numbered(ODD)
                    .with_still(&wall(-9.0, 9.0));
                let mut run = at_wall(stage, 0.0);
                run.set_rule(but(|_| ContactRule::GRIP));
                run.steps(seconds(rate, 0.5), &GRIP);
                assert_eq!(run.mode(), Holding, "{case}");
                run.set_rule(but(|_| ContactRule::GRIP.with_friction(0.5)));
                let start = run.position().y;
                let input = ClimberInput {
                    climb: DVec3::Y * climb,
                    ..GRIP
                };
                run.steps(seconds(rate, 1.0), &input);
                assert!(
                    run.trace.modes[1..].iter().all(|mode| *mode == Holding),
                    "{case}"
                );
                let rose = run.position().y - start;
                within!(
                    (rose - rise * climb_speed).abs(),
                    2e-3,
                    "{case}: rose {rose}"
                );
                run.sound()
            });
        }
    }
}

/// Falls past a friend's shoulders with the grip held, facing it. `rule` is the rule for the friend.
fn past_a_friend(
    played: Played,
    rate: f64,
    rule: Option<fn(&ContactQuery<'_>) -> ContactRule>,
) -> Run {
    let mut config = person();
    config.body.height = 1.0;
    let stage = stage(played, rate).with_still(&Shape::floor(9.0));
    let mut run = Run::new(stage, config, DVec3::new(0.0, 1.2, 0.9));
    run.meet_friend(DVec3::ZERO);
    if let Some(rule) = rule {
        run.set_rule(move |query| {
            if query.is_character() {
                rule(query)
            } else {
                query.usual()
            }
        });
    }
    let towards = ClimberInput {
        walk: DVec3::NEG_Z,
        ..GRIP
    };
    run.steps(seconds(rate, 1.0), &towards);
    run
}

pub(crate) fn a_friend_is_neither_hung_from_nor_gripped_unless_the_rule_says_so() {
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let holds = |run: &Run| run.trace.modes.iter().any(|mode| mode.is_holding());
            let run = past_a_friend(played, rate, None);
            assert!(!holds(&run), "{case}: holds a friend");
            let ledge = past_a_friend(played, rate, Some(|query| query.usual().with_hang(true)));
            assert!(
                ledge.trace.modes.contains(&LedgeHanging),
                "{case}: {:?}",
                ledge.mode()
            );
            let gripped = past_a_friend(played, rate, Some(|_| ContactRule::GRIP));
            assert!(
                gripped.trace.modes.contains(&Holding),
                "{case}: {:?}",
                gripped.mode()
            );
            run.sound()
        });
    }
}

/// A door 20 cm thick.
fn door() -> Shape {
    Shape::boxed(DVec3::new(1.0, 0.0, -2.0), DVec3::new(1.2, 3.0, 2.0))
}

/// Walks at a door, as the climber with an id.
fn at_door(played: Played, rate: f64, id: u64) -> Run {
    let stage = stage(played, rate)
        .with_still(&Shape::floor(9.0))
        .numbered(ODD)
        .with_still(&door());
    let mut config = ClimberConfig::walker();
    config.body.height = 1.0;
    let mut run = Run::new(stage, config, DVec3::ZERO).settle();
    run.id = Some(ObstacleId(id));
    run.set_rule(but(|query| {
        if query.climber == Some(ObstacleId(7)) {
            ContactRule::PASS
        } else {
            query.usual()
        }
    }));
    run.steps(seconds(rate, 1.0), &walk(DVec3::X));
    run
}

pub(crate) fn a_door_lets_one_pass_and_not_another() {
    for rate in RATES {
        for (id, ends) in [(7, 3.0), (8, 1.0 - RADIUS)] {
            every(0.0, |played| {
                let case = format!("{played:?}, {rate} Hz, {id}");
                let run = at_door(played, rate, id);
                let x = run.position().x;
                within!((x - ends).abs(), 2e-3, "{case}: at {x}");
                assert!(run.trace.always(Standing), "{case}");
                run.sound()
            });
        }
    }
}

/// A door that closes on the climber pushes it out to the nearer side, and holds it no longer than that.
pub(crate) fn a_door_that_closes_on_a_climber_pushes_it_out() {
    for rate in RATES {
        for (x, ends) in [(0.9, 1.0 - RADIUS), (1.3, 1.2 + RADIUS)] {
            every(0.0, |played| {
                let case = format!("{played:?}, {rate} Hz, from {x}");
                let stage = stage(played, rate)
                    .with_still(&Shape::floor(9.0))
                    .numbered(ODD)
                    .with_still(&door());
                let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::X * x);
                let open = Rc::new(Cell::new(true));
                let is_open = Rc::clone(&open);
                run.set_rule(but(move |query| query.usual().with_solid(!is_open.get())));
                let mut run = run.settle();
                within!(
                    (run.position().x - x).abs(),
                    1e-9,
                    "{case}: not let through"
                );
                open.set(false);
                run.steps(seconds(rate, 1.0), &IDLE);
                let at = run.position();
                within!((at.x - ends).abs(), 2e-3, "{case}: at {at}");
                assert_eq!(run.mode(), Standing, "{case}");
                run.trace.clone()
            });
        }
    }
}

/// Falls off a ledge that the rule refuses, and does not pull itself up onto a top that may not be stood on.
pub(crate) fn a_ledge_that_is_refused_is_let_go_and_one_without_footing_is_only_hung_from() {
    let up = ClimberInput {
        walk: DVec3::NEG_Z,
        ..GRIP
    };
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let stage = stage(played, rate)
                .numbered(ODD)
                .with_still(&wall(-9.0, 1.0));
            let mut config = person();
            config.grip = None;
            let mut run = Run::new(stage, config, DVec3::new(0.0, 0.2, RADIUS));
            let holds = Rc::new(Cell::new(true));
            let may_hang = Rc::clone(&holds);
            run.set_rule(but(move |query| {
                query.usual().with_stand(false).with_hang(may_hang.get())
            }));
            run.steps(seconds(rate, 2.0), &up);
            assert_eq!(run.mode(), LedgeHanging, "{case}");
            holds.set(false);
            run.steps(seconds(rate, 0.2), &up);
            assert_eq!(run.mode(), Falling, "{case}");
            run.sound()
        });
    }
}

/// The odd wall is as high as a step; a ledge between two others is left out by hands that go along them.
pub(crate) fn hands_stop_where_a_ledge_may_not_be_held() {
    let aside = ClimberInput {
        walk: DVec3::X,
        ..GRIP
    };
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let part = |from: f64, to: f64| {
                Shape::boxed(DVec3::new(from, -9.0, -1.0), DVec3::new(to, 1.0, 0.0))
            };
            let stage = stage(played, rate)
                .with_still(&part(-3.0, 0.8))
                .numbered(ODD)
                .with_still(&part(0.8, 3.0));
            let mut config = person();
            config.grip = None;
            let mut run = Run::new(stage, config, DVec3::new(0.0, 0.2, RADIUS));
            run.set_rule(but(|query| query.usual().with_hang(false)));
            let face = ClimberInput {
                walk: DVec3::NEG_Z * 0.1,
                ..GRIP
            };
            run.steps(seconds(rate, 0.5), &face);
            assert_eq!(run.mode(), LedgeHanging, "{case}");
            for _ in 0..seconds(rate, 3.0) {
                run.step(&aside);
                assert_eq!(run.mode(), LedgeHanging, "{case}");
                let on = run.state().support.unwrap().tag.user;
                assert_eq!(on, 0, "{case} at {}", run.position());
            }
            let x = run.position().x;
            assert!((0.5..1.3).contains(&x), "{case}: at {x}");
            run.sound()
        });
    }
}

pub(crate) fn ground_that_may_not_be_stood_on_is_slid_off() {
    let angle = radians(20.0);
    let floor = Shape::floor(30.0).turned(DVec3::Z, angle);
    for rate in RATES {
        every(0.0, |played| {
            let case = format!("{played:?}, {rate} Hz");
            let stage = stage(played, rate).numbered(ODD).with_still(&floor);
            let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
            run.set_rule(but(|query| query.usual().with_stand(false)));
            let start = run.position();
            let report = run.step(&IDLE);
            assert!(report.events.contains(&ClimberEvent::Slipped), "{case}");
            run.steps(seconds(rate, 1.0) - 1, &IDLE);
            assert!(run.trace.always(Sliding), "{case}: {:?}", run.mode());
            let went = run.position().distance(start);
            let slid = G * libm::sin(angle) / 2.0;
            within!((went - slid).abs(), 5e-3, "{case}: slid {went} m");
            run.sound()
        });
    }
}

pub(crate) fn a_curb_that_may_not_be_stepped_onto_blocks() {
    for rate in RATES {
        for height in [0.05, 0.1, 0.2] {
            every(0.0, |played| {
                let case = format!("{played:?}, {rate} Hz, {height} m");
                let low = DVec3::new(1.0, -0.5, -9.0);
                let curb = Shape::boxed(low, DVec3::new(9.0, height, 9.0));
                let stage = stage(played, rate)
                    .with_still(&Shape::floor(9.0))
                    .numbered(ODD)
                    .with(&curb, |_| Similarity::IDENTITY);
                let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
                run.set_rule(but(|query| query.usual().with_step(false)));
                run.steps(seconds(rate, 1.0), &walk(DVec3::X));
                assert!(run.trace.always(Standing), "{case}");
                let before = libm::sqrt(RADIUS * RADIUS - (RADIUS - height) * (RADIUS - height));
                let x = run.position().x;
                // A body that is pressed onto its ground meets the edge up to one and a half margins early.
                within!(
                    (x - 1.0 + before).abs(),
                    0.015,
                    "{case}: stops at {}",
                    run.position()
                );
                within!(run.feet().y.abs(), 1e-3, "{case}: stands at {}", run.feet());
                // Once it has jumped onto it, it walks there.
                run.step(&ClimberInput {
                    jump: true,
                    jump_held: true,
                    ..walk(DVec3::X)
                });
                run.steps(seconds(rate, 1.5), &walk(DVec3::X));
                let there = run.feet();
                within!((there.y - height).abs(), 1e-3, "{case}: jumped to {there}");
                run.sound()
            });
        }
    }
}
