//! Climbers that fall in a wind.

use bevy_clamber::prelude::*;
use bevy_transform::components::Transform;
use glam::DVec3;

use super::common;

#[test]
fn a_climber_in_the_air_goes_over_to_the_velocity_of_the_wind() {
    for wind in [DVec3::ZERO, DVec3::new(6.0, 0.0, -9.0)] {
        let mut app = common::app_with(60.0, (ClamberPlugins::default(), ClimberPlugin::default()));
        app.insert_resource(AirVelocity(wind));
        let high = Transform::from_xyz(0.0, 500.0, 0.0);
        let climber = app.world_mut().spawn((Climber::colossus_climber(), high));
        let climber = climber.id();
        for _ in 0..4 * 60 {
            app.update();
        }
        let state = app.world().get::<ClimberState>(climber).unwrap();
        assert!((state.base_velocity - wind).length() < 1e-9, "{state:?}");
    }
}
