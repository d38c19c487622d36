//! What a script has achieved: the hero's ride, and whether its arrows are where they should be.

use bevy::ecs::system::SystemParam;
use bevy::math::DVec3;
use bevy::prelude::*;
use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::events::{ClimberGrabbed, ClimberHurt, ClimberJumped, ClimberShakenOff};
use bevy_clamber::prelude::*;

use crate::arrows::Arrow;
use crate::hero::Hero;

/// Largest distance of an arrow from the skin, metres: only rounding counts, since both are as the last frame drew
/// them.
const SKIN: f32 = 1e-3;

/// Largest distance from a pointer to its arrow when it was shot, pixels. A hit in the pose of the tick instead of the
/// drawn frame would be off by the motion of a frame.
const POINTER: f32 = 0.5;

/// Least number of visible colours: a picture of nothing has one.
const COLORS: usize = 1000;

/// The hero's ride.
#[derive(Resource, Debug, Default)]
struct Ride {
    /// Ticks on the creature, and those of them holding on.
    ridden: u32,
    held: u32,
    /// Greatest height on the creature, metres.
    highest: f64,
    jumps: u32,
    grips: u32,
    throws: u32,
    /// Hit points lost.
    hurt: f32,
    /// Where the hero is, metres.
    place: DVec3,
}

pub fn plugin(app: &mut App) {
    app.init_resource::<Ride>()
        .add_systems(FixedLast, count)
        .add_observer(|_: On<ClimberJumped>, mut ride: ResMut<Ride>| ride.jumps += 1)
        .add_observer(|_: On<ClimberGrabbed>, mut ride: ResMut<Ride>| ride.grips += 1)
        .add_observer(|_: On<ClimberShakenOff>, mut ride: ResMut<Ride>| ride.throws += 1)
        .add_observer(|hurt: On<ClimberHurt>, mut ride: ResMut<Ride>| ride.hurt += hurt.damage);
}

fn count(
    heroes: Query<&ClimberState, With<Hero>>,
    surfaces: Query<(), With<PosedSurface>>,
    mut ride: ResMut<Ride>,
) {
    for state in &heroes {
        ride.place = state.position;
        let on = state.support.map(|support| support.attachment.obstacle.0);
        let on = on.and_then(Entity::try_from_bits);
        if on.is_some_and(|on| surfaces.contains(on)) {
            ride.ridden += 1;
            ride.held += u32::from(matches!(
                state.mode,
                ClimberMode::Holding | ClimberMode::Hanging
            ));
            ride.highest = ride.highest.max(state.position.y);
        }
    }
}

/// The state of the world that is checked.
#[derive(SystemParam)]
pub struct Proof<'w, 's> {
    ride: Res<'w, Ride>,
    heroes: Query<'w, 's, &'static Hero>,
    surfaces: DrawnSurfaceQuery<'w, 's>,
    arrows: Query<'w, 's, (&'static Arrow, &'static GlobalTransform), With<SurfaceAnchor>>,
}

impl Proof<'_, '_> {
    /// Checks the last picture and the arrows, and describes the ride.
    pub fn check(&self, pixels: impl Iterator<Item = [u8; 3]>) -> Result<String, String> {
        let mut seen: Vec<[u8; 3]> = pixels.collect();
        seen.sort_unstable();
        seen.dedup();
        if seen.len() < COLORS {
            return Err(format!("the picture has only {} colours", seen.len()));
        }
        let (mut off_skin, mut off_pointer, mut carried) = (0.0f32, 0.0f32, 0.0f32);
        for (arrow, place) in &self.arrows {
            let point = place.translation();
            let skin = self
                .surfaces
                .closest_point(point, 1.0, &SurfaceFilter::default());
            let skin = skin.ok_or_else(|| format!("an arrow, at {point}, is in no skin"))?;
            off_skin = off_skin.max(skin.distance);
            off_pointer = off_pointer.max(arrow.missed);
            carried = carried.max(point.distance(arrow.hit));
        }
        if off_skin > SKIN || off_pointer > POINTER {
            return Err(format!(
                "an arrow is {off_skin} m off the skin, or was {off_pointer} pixels from its pointer"
            ));
        }
        let count = self.arrows.iter().count();
        if count > 0 && carried == 0.0 {
            return Err("the skin has moved no arrow".into());
        }
        let ride = &*self.ride;
        let seconds = |ticks: u32| f64::from(ticks) / 64.0;
        let has_won = self.heroes.iter().any(|hero| hero.has_won);
        Ok(format!(
            "on the creature for {:.2} s, {:.2} s of them holding on, up to {:.2} m high; {} jumps, {} grips, shaken \
             off {} times, hurt by {:.2}{}; at {:.1}\n{count} arrows, carried by up to {carried:.2} m, at most {off_skin:.1e} m \
             off the skin and {off_pointer:.3} pixels from the pointer",
            seconds(ride.ridden),
            seconds(ride.held),
            ride.highest,
            ride.jumps,
            ride.grips,
            ride.throws,
            ride.hurt,
            if has_won { ", and has won" } else { "" },
            ride.place,
        ))
    }
}
