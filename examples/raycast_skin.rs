//! A ray from above against a creature in mid-stride: it meets the posed skin, not the bind pose.

use clamber::prelude::*;
use glam::{DVec3, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let creature = clamber_scenes::beast::beast(6_000);
    let walk = creature.clip_like(&["walk"]).ok_or("no walk")?;
    let mut surface = SkinnedSurface::new(creature.collider.clone());
    let down = Ray::new(Vec3::new(0.3, 60.0, 15.0), Vec3::NEG_Y).ok_or("no ray")?;

    let mut heights = Vec::new();
    for tick in 0..12 {
        let time = f64::from(tick) * 0.25;
        let pose = walk.sample(&creature.skeleton.rest_pose(), time, Playback::Loop)?;
        let palette = creature.skeleton.palette(&pose)?;
        surface.advance(&palette, Similarity::from_translation(DVec3::ZERO))?;
        let hit = surface.cast_ray(&down, f32::INFINITY)?.ok_or("a miss")?;
        println!(
            "{time:4.2} s  the head is {:.3} m up, {:?}",
            hit.point.y, hit.tag
        );
        heights.push(hit.point.y);
    }
    let highest = heights.iter().copied().fold(f32::MIN, f32::max);
    let lowest = heights.iter().copied().fold(f32::MAX, f32::min);
    assert!(highest - lowest > 0.1, "the head does not nod: {heights:?}");
    Ok(())
}
