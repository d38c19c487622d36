//! Checks the picture: arrows are in the skin, the skin has carried them, and one is where the pointer has pressed.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

use crate::arrows::Arrow;
use crate::creature::Creature;

/// Largest distance of an arrow from the skin, relative to the creature's radius. The arrow lies on the skin as this
/// frame draws it, but a query sees the skin one frame earlier. A swinging foot moves some hundredths in a frame.
const SKIN: f32 = 0.1;

/// Largest distance from the pointer to its arrow, pixels. The scene has stood still since, so only rounding counts. A
/// hit in the pose of the tick instead of the drawn frame would be off by the motion of a frame.
const POINTER: f32 = 0.5;

/// Least number of visible red pixels per arrow, on average. The giant's picture has about 140.
const RED: usize = 10;

/// The state of the world that the picture is compared with.
#[derive(SystemParam)]
pub struct Proof<'w, 's> {
    creature: Res<'w, Creature>,
    surfaces: SurfaceQuery<'w, 's>,
    arrows: Query<'w, 's, (Entity, &'static Arrow, &'static GlobalTransform), With<SurfaceAnchor>>,
    camera: Single<'w, 's, (&'static Camera, &'static GlobalTransform)>,
}

impl Proof<'_, '_> {
    /// Checks the picture and the arrows, and describes them. `pressed` is where the pointer was, and its arrow.
    pub fn check(
        &self,
        pixels: impl Iterator<Item = [u8; 3]>,
        pressed: Option<(Vec2, Option<Entity>)>,
    ) -> Result<String, String> {
        let count = self.arrows.iter().count();
        let carried = |(_, arrow, place): (_, &Arrow, &GlobalTransform)| {
            place.translation().distance(arrow.hit)
        };
        let Some(farthest) = self.arrows.iter().map(carried).max_by(f32::total_cmp) else {
            return Err("no arrow has hit its skin".into());
        };
        if farthest == 0.0 {
            return Err("the skin has moved no arrow; choose another clip with `--clip`".into());
        }
        let slack = SKIN * self.creature.radius();
        let anywhere = SurfaceFilter::default();
        for (_, _, place) in &self.arrows {
            let point = place.translation();
            let skin = self.surfaces.closest_point(point, slack, &anywhere);
            if skin.is_none() {
                return Err(format!("an arrow, at {point}, is not in the skin"));
            }
        }
        let missed = self.missed_by(pressed)?;
        let red = pixels.filter(|&pixel| is_feather(pixel)).count();
        if red < RED * count {
            return Err(format!("{count} arrows, but only {red} visible red pixels"));
        }
        Ok(format!(
            "{count} arrows stick, {red} red pixels; the skin carried one by {farthest:.2} m; \
             the pointer's arrow is {missed:.3} pixels from it"
        ))
    }

    /// Distance from the pointer to its arrow in the picture, pixels.
    fn missed_by(&self, pressed: Option<(Vec2, Option<Entity>)>) -> Result<f32, String> {
        let Some((pointer, Some(arrow))) = pressed else {
            return Err(format!("the pointer shot no arrow: {pressed:?}"));
        };
        let (camera, from) = *self.camera;
        let missed = self
            .arrows
            .get(arrow)
            .ok()
            .and_then(|(_, _, place)| camera.world_to_viewport(from, place.translation()).ok())
            .map_or(f32::INFINITY, |seen| seen.distance(pointer));
        if missed > POINTER {
            return Err(format!("the pointer's arrow is {missed} pixels off"));
        }
        Ok(missed)
    }
}

fn is_feather([red, green, blue]: [u8; 3]) -> bool {
    red > 50 && u16::from(red) > 2 * u16::from(green.max(blue))
}
