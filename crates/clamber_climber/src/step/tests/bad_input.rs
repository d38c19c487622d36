//! Invalid input from callers and from obstacles.

use clamber_world::{
    Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::DVec3;

use super::*;
use crate::{ClimberError, ClimberState, Knockback, StepRules, Support};

/// An obstacle that returns numbers that are not finite.
struct Broken;

impl Obstacle for Broken {
    fn cast_ray(&self, _: DVec3, _: DVec3, _: f64) -> Option<Contact> {
        Some(self.nonsense())
    }

    fn closest_point(&self, _: DVec3, _: f64) -> Option<Contact> {
        Some(self.nonsense())
    }

    fn overlap_capsule(&self, _: &WorldCapsule, contacts: &mut Vec<Contact>) {
        contacts.push(self.nonsense());
    }

    fn cast_capsule(
        &self,
        _: &WorldCapsule,
        _: [DVec3; 2],
        _: TargetMotion,
    ) -> Option<SweepContact> {
        Some(self.met())
    }

    fn inverse_effective_mass(&self, _: &MaterialPoint, _: DVec3) -> f64 {
        f64::NAN
    }

    fn motion(&self, _: &MaterialPoint, _: f64) -> Option<PointMotion> {
        None
    }
}

impl Broken {
    fn met(&self) -> SweepContact {
        SweepContact {
            fraction: f64::NAN,
            contact: self.nonsense(),
            separation_normal: DVec3::NAN,
            started_inside: false,
        }
    }

    fn nonsense(&self) -> Contact {
        Contact {
            point: DVec3::NAN,
            normal: DVec3::splat(f64::INFINITY),
            distance: f64::NAN,
            material: MaterialPoint {
                key: 0,
                coordinates: [f64::NAN; 3],
            },
            tag: Default::default(),
        }
    }
}

#[test]
fn bad_input_is_refused_and_changes_nothing() {
    let ground = level();
    let mut climber = landed(0.0, 0.5, 0.0, &ground);
    let before = *climber.state();
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(climber.step(&IDLE, &obstacles, dt).is_err(), "{dt}");
    }
    let nan = DVec3::new(f64::NAN, 0.0, 0.0);
    for input in [walking(nan), ClimberInput { climb: nan, ..IDLE }] {
        let refused = climber.step(&input, &obstacles, DT);
        assert_eq!(refused, Err(ClimberError::NotFinite("input")), "{input:?}");
    }
    for (velocity, damage) in [(nan, 0.1), (DVec3::X, f64::INFINITY)] {
        let knockback = Knockback {
            velocity,
            damage,
            by: None,
        };
        let rules = StepRules {
            knockback: Some(knockback),
            ..StepRules::default()
        };
        let refused = climber.step_with(&IDLE, &obstacles, &rules, DT);
        let expected = ClimberError::NotFinite("knockback");
        assert_eq!(refused, Err(expected), "{knockback:?}");
    }
    assert_eq!(*climber.state(), before);
}

#[test]
fn inconsistent_or_not_finite_states_are_refused() {
    let ground = level();
    let mut climber = landed(0.0, 0.5, 0.0, &ground);
    let before = *climber.state();
    let with_support = |change: fn(&mut Support)| {
        let mut state = before;
        state.support.iter_mut().for_each(change);
        state
    };
    let with = |change: fn(&mut ClimberState)| {
        let mut state = before;
        change(&mut state);
        state
    };
    for state in [
        with(|state| state.velocity = DVec3::NAN),
        with(|state| state.shake = DVec3::NAN),
        with(|state| state.support_velocity = Some(DVec3::NAN)),
        with(|state| state.stamina = f64::NAN),
        with(|state| state.coyote = f64::NAN),
        with_support(|support| support.attachment.offset.x = f64::NAN),
        with_support(|support| support.normal.y = f64::INFINITY),
        with_support(|support| support.face.y = f64::INFINITY),
        with_support(|support| support.attachment.frame.w = f64::NAN),
        with_support(|support| support.attachment.material.coordinates[1] = f64::NAN),
    ] {
        let refused = climber.restore(state);
        assert_eq!(refused, Err(ClimberError::NotFinite("state")), "{state:?}");
    }
    for mode in ClimberMode::ALL {
        let supported = ClimberState { mode, ..before };
        let unsupported = ClimberState {
            support: None,
            ..supported
        };
        let [right, wrong] = if mode.is_supported() {
            [supported, unsupported]
        } else {
            [unsupported, supported]
        };
        assert_eq!(climber.restore(wrong), Err(ClimberError::Support(mode)));
        assert_eq!(climber.restore(right), Ok(()), "{mode:?}");
        climber.restore(before).unwrap();
    }
    for stamina in [-0.1, 1.1] {
        let refused = climber.restore(ClimberState { stamina, ..before });
        let name = "stamina";
        assert!(
            matches!(refused, Err(ClimberError::OutOfRange { name: n, .. }) if n == name),
            "{refused:?}"
        );
    }
    assert_eq!(*climber.state(), before);
}

#[test]
fn configurations_outside_their_ranges_are_refused_by_name() {
    assert!(Climber::new(ClimberConfig::default(), DVec3::NAN).is_err());
    let refused = |change: &dyn Fn(&mut ClimberConfig)| {
        let mut config = ClimberConfig::colossus_climber();
        change(&mut config);
        match Climber::new(config, DVec3::ZERO) {
            Err(ClimberError::OutOfRange { name, .. }) => name,
            Err(ClimberError::NotFinite(name)) => name,
            other => panic!("{other:?} for {config:?}"),
        }
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(&|config| config.body.radius = bad), "body.radius");
        assert_eq!(refused(&|config| config.body.mass = bad), "body.mass");
        assert_eq!(refused(&|config| config.shake_time = bad), "shake_time");
        let arm = refused(&|config| config.hang.arm_length = bad);
        assert_eq!(arm, "hang.arm_length");
    }
    assert_eq!(refused(&|config| config.gravity = DVec3::NAN), "gravity");
    assert_eq!(
        refused(&|config| config.ground.max_slope = 1.6),
        "ground.max_slope"
    );
    let thick = refused(&|config| config.body.margin = config.body.radius);
    assert_eq!(thick, "body.margin");
    let grip = refused(&|config| config.grip.iter_mut().for_each(|grip| grip.reach = -1.0));
    assert_eq!(grip, "grip.reach");
    let bounce = refused(&|config| {
        let tumble = config.tumble.iter_mut();
        tumble.for_each(|tumble| tumble.restitution = 1.5);
    });
    assert_eq!(bounce, "tumble.restitution");
}

#[test]
fn an_obstacle_that_returns_nan_does_not_spread_it() {
    let ground = level();
    let mut climber = climber_at(0.0, 1.0, 0.0);
    let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(0), &Broken), (ObstacleId(1), &ground)];
    for _ in 0..60 {
        climber.step(&IDLE, &obstacles, DT).unwrap();
        assert!(climber.state().is_finite(), "{:?}", climber.state());
    }
    let state = climber.state();
    assert!((state.position.y - 0.4).abs() < 1e-6, "{state:?}");
}

#[test]
fn states_with_numbers_out_of_range_are_refused() {
    let mut climber = climber_at(0.0, 2.0, 0.0);
    let good = *climber.state();
    let changes: [fn(&mut ClimberState); 6] = [
        |state| state.stamina = 1.5,
        |state| state.hit_points = -0.1,
        |state| state.hanging.arm = -1.0,
        |state| state.grip_cooldown = -1e-3,
        |state| state.heading = DVec3::ZERO,
        |state| state.heading *= 2.0,
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let mut bad = good;
        change(&mut bad);
        let refused = climber.restore(bad);
        let is_range = matches!(refused, Err(ClimberError::OutOfRange { .. }));
        assert!(is_range, "{index}: {refused:?}");
        assert_eq!(climber.state(), &good, "{index}");
    }
}

#[test]
fn modes_that_the_configuration_lacks_end_in_standing() {
    let ground = level();
    for mode in ClimberMode::ALL {
        for grip in [false, true] {
            let mut climber = landed(0.0, 0.5, 0.0, &ground);
            let good = *climber.state();
            let state = ClimberState {
                mode,
                support: good.support.filter(|_| mode.is_supported()),
                ..good
            };
            climber.restore(state).unwrap();
            let input = ClimberInput { grip, ..IDLE };
            for _ in 0..60 {
                step_on(&mut climber, &ground, &input);
            }
            let state = climber.state();
            let told = format!("{mode:?}, grip {grip}: {state:?}");
            assert_eq!(state.mode, ClimberMode::Standing, "{told}");
        }
    }
}
