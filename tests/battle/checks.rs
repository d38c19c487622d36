//! Each check of a ride fails on its own fault and on no other.

use clamber::climber::{Climber, ClimberState};
use clamber::glam::DVec3;
use clamber::world::Obstacle;
use clamber_scenes::battle::{
    Battle, BattleOptions, DRIFT, FALLS, INSIDE, Intent, MAX_DRIFT, MAX_STANDS_OFF, PUSHED_OFF,
    STANDS_OFF, TERRAIN, Watch,
};
use clamber_scenes::giant::giant;
use clamber_scenes::valley;

const HEIGHT: f64 = 20.0;

/// A rider that has stood on the giant for a while, and a watch that has recorded its point there.
struct Scene<'a> {
    battle: &'a Battle<'a>,
    watch: Watch,
}

impl<'a> Scene<'a> {
    fn new(battle: &'a Battle<'a>) -> Self {
        let mut scene = Self {
            battle,
            watch: Watch::default(),
        };
        // The first look records the point that the rider stands on.
        scene.look(*battle.climber().state());
        scene
    }

    /// Checks the rider as if it were in a state; returns the drift.
    fn look(&mut self, state: ClimberState) -> Option<f64> {
        let mut climber: Climber = self.battle.climber().clone();
        climber.restore(state).unwrap();
        self.watch.look(self.battle, &climber, true)
    }
}

fn stood<R>(test: impl FnOnce(&mut Scene<'_>, ClimberState) -> R) -> R {
    let creature = giant().unwrap();
    let options = BattleOptions {
        height: Some(HEIGHT),
        ..BattleOptions::ride(0, 1)
    };
    let mut battle = Battle::new(&creature, &options).unwrap();
    for _ in 0..120 {
        battle.step(Intent::Stand).unwrap();
    }
    let state = *battle.climber().state();
    assert!(
        state.support.is_some(),
        "the rider has not landed: {state:?}"
    );
    test(&mut Scene::new(&battle), state)
}

/// The state with only its body moved.
fn moved(state: ClimberState, by: DVec3) -> ClimberState {
    ClimberState {
        position: state.position + by,
        ..state
    }
}

fn normal(state: &ClimberState) -> DVec3 {
    state.support.unwrap().normal_in_world()
}

#[test]
fn a_rider_that_stands_where_it_stood_has_no_fault() {
    stood(|scene, state| {
        let drift = scene.look(state).unwrap();
        assert!(drift < MAX_DRIFT, "drift {drift}");
        let watch = &scene.watch;
        let off = watch.found(STANDS_OFF);
        assert!(off < 1e-4, "stands off {off}");
        assert_eq!((watch.found(PUSHED_OFF), watch.found(FALLS)), (0.0, 0.0));
        assert!(watch.first_fault(DRIFT).is_none());
    });
}

#[test]
fn a_contact_or_a_body_off_the_material_point_is_drift() {
    stood(|scene, state| {
        let aside = normal(&state).any_orthonormal_vector();
        let (mut beside, mut other) = (state, state);
        beside.support.as_mut().unwrap().attachment.point += aside * 2e-4;
        let surface = scene.battle.surface();
        let nearest = surface.closest_point(state.position + aside * 0.5, 5.0);
        let nearest = nearest.unwrap();
        let attachment = &mut other.support.as_mut().unwrap().attachment;
        (attachment.material, attachment.point) = (nearest.material, nearest.point);
        for (what, state, least) in [
            ("the contact is beside its point", beside, 1.5e-4),
            ("another point, without input", other, 0.1),
            ("a sunk body", moved(state, normal(&state) * -2e-4), 1.5e-4),
        ] {
            let mut scene = Scene::new(scene.battle);
            let drift = scene.look(state).unwrap();
            assert!(drift > least, "{what}: {drift}");
            assert!(scene.watch.first_fault(DRIFT).is_some(), "{what}");
        }
    });
}

/// A ball that slid touches skin, but skin that leaves it room on its point: nothing pushed it away.
#[test]
fn a_body_that_floats_or_slid_along_open_skin_stands_off_and_is_not_pushed() {
    stood(|scene, state| {
        let surface = scene.battle.surface();
        let radius = scene.battle.climber().config().body.radius;
        let aside = state.position + normal(&state).any_orthonormal_vector() * 0.3;
        let under = surface.closest_point(aside, 5.0).unwrap();
        let place = under.point + under.separation_normal(aside) * radius;
        for (what, by) in [
            ("floats", normal(&state) * 0.011),
            ("slid", place - state.position),
        ] {
            let mut scene = Scene::new(scene.battle);
            scene.look(moved(state, by));
            let watch = &scene.watch;
            let off = watch.found(STANDS_OFF);
            assert!(off > MAX_STANDS_OFF, "{what}: {off}");
            assert_eq!(watch.found(PUSHED_OFF), 0.0, "{what}");
            assert!(watch.first_fault(STANDS_OFF).is_some(), "{what}");
            assert!(watch.first_fault(DRIFT).is_none(), "{what}");
        }
    });
}

#[test]
fn a_rider_on_the_ground_has_fallen_once_until_it_rides_again() {
    stood(|scene, state| {
        let mut support = state.support.unwrap();
        support.attachment.obstacle = TERRAIN;
        let down = ClimberState {
            support: Some(support),
            ..state
        };
        scene.look(down);
        scene.look(down);
        assert_eq!(scene.watch.found(FALLS), 1.0);
        let cause = scene.watch.first_fault(FALLS).unwrap();
        assert!(cause.contains("left the creature"), "{cause}");
        scene.look(state);
        scene.look(down);
        assert_eq!(scene.watch.found(FALLS), 2.0, "fallen again");
    });
}

#[test]
fn a_rider_below_the_ground_is_a_fault_inside_the_valley_only() {
    stood(|scene, state| {
        scene.look(moved(state, DVec3::Y * -60.0));
        assert_eq!(scene.watch.found(INSIDE), 1.0);
        let cause = scene.watch.first_fault(INSIDE).unwrap();
        assert!(cause.contains("below the ground"), "{cause}");
        scene.look(moved(state, DVec3::new(valley::SIZE, -60.0, 0.0)));
        assert_eq!(scene.watch.found(INSIDE), 1.0, "there is no ground outside");
    });
}
