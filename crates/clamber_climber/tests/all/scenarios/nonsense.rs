//! Numbers that are not finite, from obstacles and from callers.

use clamber_climber::ClimberMode::Standing;
use clamber_climber::{Climber, ClimberError, ClimberEvent, ClimberState};
use clamber_world::{
    Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion, WorldCapsule,
};
use glam::DVec3;

use crate::input::{IDLE, walk};
use crate::scenarios::frames::{hills, tour};
use crate::stage::{Run, Stage, TICK, jolt, one_kind, walker_at};

/// An obstacle with bad numbers in some of its answers.
struct Broken<'a> {
    inner: &'a dyn Obstacle,
    bad: DVec3,
}

impl Obstacle for Broken<'_> {
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.cast_ray(origin, direction, max_distance)
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        self.inner.closest_point(point, max_distance)
    }

    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.inner.overlap_capsule(capsule, contacts);
        contacts.extend(contacts.last().map(|contact| Contact {
            point: self.bad,
            ..*contact
        }));
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let mut hit = self.inner.cast_capsule(capsule, displacements, target)?;
        match target {
            TargetMotion::Still => hit.separation_normal = self.bad,
            TargetMotion::Moving => hit.fraction = self.bad.x,
        }
        Some(hit)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let motion = self.inner.motion(point, dt)?;
        Some(PointMotion {
            velocity: self.bad,
            ..motion
        })
    }
}

pub(crate) fn not_finite_answers_of_an_obstacle_do_not_spread() {
    for bad in [
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::NEG_INFINITY,
        DVec3::splat(f64::MAX),
    ] {
        let mut run = Run::on(one_kind(), &hills(), walker_at(3.0), DVec3::Y);
        for tick in 0..20 {
            let report = run.step_around(&tour(tick), |inner| Box::new(Broken { inner, bad }));
            let state = run.state();
            assert!(is_finite(state), "{bad}, tick {tick}: {state:?}");
            let p = run.position();
            assert!(p.length() < 100.0, "{bad}, tick {tick}: {p}, {report:?}");
        }
        // The climber goes on once the answers are finite again.
        run.steps(60, &IDLE);
        assert!(is_finite(run.state()), "{bad}");
    }
}

fn is_finite(state: &ClimberState) -> bool {
    state.position.is_finite() && state.velocity.is_finite() && state.shake.is_finite()
}

pub(crate) fn not_finite_arguments_are_refused() {
    let mut run = Run::on(one_kind(), &hills(), jolt(), DVec3::Y);
    let before = *run.climber.state();
    let mut climber = run.climber.clone();
    for bad in [f64::NAN, f64::INFINITY] {
        let state = ClimberState {
            velocity: DVec3::X * bad,
            ..before
        };
        assert_eq!(
            climber.restore(state),
            Err(ClimberError::NotFinite("state"))
        );
        let input = walk(DVec3::Z * bad);
        let refused = climber.step(&input, &[], TICK);
        assert_eq!(refused, Err(ClimberError::NotFinite("input")));
        assert!(climber.step(&IDLE, &[], bad).is_err());
        assert!(Climber::new(jolt(), DVec3::Y * bad).is_err());
    }
    assert_eq!(*climber.state(), before);
    run.step(&IDLE);
    assert_eq!(run.mode(), Standing);
}

/// At this speed the next position is not finite.
pub(crate) fn an_overflowing_velocity_is_reported() {
    let stage = Stage::new(one_kind());
    let mut run = Run::new(stage, jolt(), DVec3::Y).thrown(DVec3::X * (f64::MAX * 1e-3));
    let told = (0..100).any(|_| {
        let report = run.climber.step(&IDLE, &[], 1e6).unwrap();
        assert!(is_finite(run.climber.state()));
        report.events.contains(&ClimberEvent::NotFinite)
    });
    assert!(told, "{:?}", run.state());
}
