//! A ray from above at a walking creature hits the posed skin, not the bind pose.

use clamber::glam::DVec3;
use clamber::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let creature = clamber::gltf::load("assets/colossus.glb")?.rig;
    let walk = creature.clip("walk").ok_or("no walk")?;
    let mut surface = SkinnedSurface::new(creature.collider.clone());
    let above = DVec3::new(0.0, 60.0, 4.0);

    let mut heights = Vec::new();
    for tick in 0..12 {
        let time = f64::from(tick) * 0.25;
        let pose = walk.sample(&creature.skeleton.rest_pose(), time, Playback::Loop)?;
        let palette = creature.skeleton.palette(&pose)?;
        surface.advance(&palette, Similarity::IDENTITY)?;
        let hit = surface.in_world().cast_ray(above, DVec3::NEG_Y, 100.0);
        let hit = hit.ok_or("a miss")?;
        println!(
            "{time:4.2} s  the head is {:.3} m up, {:?}",
            hit.point.y, hit.tag
        );
        heights.push(hit.point.y);
    }
    let highest = heights.iter().copied().fold(f64::MIN, f64::max);
    let lowest = heights.iter().copied().fold(f64::MAX, f64::min);
    assert!(highest - lowest > 0.1, "the head does not nod: {heights:?}");
    Ok(())
}
