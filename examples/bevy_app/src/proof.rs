//! What a picture must show: arrows in skin that has carried them on, and one where the pointer has pressed.

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

use crate::arrows::Arrow;
use crate::creature::Creature;

/// How far an arrow may be from the skin, relative to the creature's radius. It lies on the skin as this frame draws
/// it, and a query finds the skin a frame earlier: a foot that swings is some hundredths farther.
const SKIN: f32 = 0.1;

/// How far from the pointer its arrow may be, pixels. The scene stands still since, so nothing but rounding is in it;
/// a hit in the pose of the tick, not of the frame that was seen, would be off by what the skin moves in a frame.
const POINTER: f32 = 0.5;

/// Red pixels that one sees of each arrow at least, on an average: of the volley at the giant some 140 are seen of each.
const RED: usize = 10;

/// What the picture is compared with.
#[derive(SystemParam)]
pub struct Proof<'w, 's> {
    creature: Res<'w, Creature>,
    surfaces: SurfaceQuery<'w, 's>,
    arrows: Query<'w, 's, (Entity, &'static Arrow, &'static GlobalTransform), With<SurfaceAnchor>>,
    camera: Single<'w, 's, (&'static Camera, &'static GlobalTransform)>,
}

impl Proof<'_, '_> {
    /// What there is to see; an error if it is not what it should be. `pressed` is where the pointer was, and its
    /// arrow.
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
            return Err("no arrow has met its skin".into());
        };
        if farthest == 0.0 {
            return Err("the skin carried no arrow on; `--clip` chooses one that moves".into());
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
            return Err(format!("{count} arrows, of which one sees {red} pixels"));
        }
        Ok(format!(
            "{count} arrows stick, {red} red pixels; the skin carried one {farthest:.2} m; \
             the pointer's is {missed:.3} pixels from it"
        ))
    }

    /// How far from the pointer its arrow is seen, pixels.
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
            return Err(format!("the pointer's arrow is {missed} pixels from it"));
        }
        Ok(missed)
    }
}

fn is_feather([red, green, blue]: [u8; 3]) -> bool {
    red > 50 && u16::from(red) > 2 * u16::from(green.max(blue))
}
