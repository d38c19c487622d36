//! An arrow in a shaking creature follows a point of skin; its velocity is measured.

use clamber::geometry::Ray;
use clamber::glam::{DVec3, Vec3};
use clamber::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dt = 1.0 / 60.0;
    let creature = clamber::gltf::load("assets/colossus.glb")?.rig;
    let shake = creature.clip("shake").ok_or("no shake")?;
    let far_away = Similarity::from_translation(DVec3::new(1e5, 0.0, -1e5));
    let mut surface = SkinnedSurface::new(creature.collider.clone());

    // Shot from the left into the shoulder, in the rest pose.
    let shot = Ray::new(Vec3::new(30.0, 30.0, 0.0), Vec3::NEG_X).ok_or("no ray")?;
    let hit = surface.in_model().cast_ray(&shot, 100.0).ok_or("missed")?;
    let mut arrow = surface.anchor_at(&hit)?;

    let mut fastest = 0.0f32;
    for tick in 0..120 {
        let time = f64::from(tick) * dt;
        let pose = shake.sample(&creature.skeleton.rest_pose(), time, Playback::Loop)?;
        let palette = creature.skeleton.palette(&pose)?;
        if tick == 0 {
            surface.teleport(&palette, far_away)?; // no motion from the rest pose to the first one
        } else {
            surface.advance(&palette, far_away)?;
        }
        let motion = surface.in_model().motion(&arrow, dt)?;
        arrow.frame = motion.frame;
        let skin = surface.in_model().closest_point(motion.position, 1.0);
        let skin = skin.ok_or("no skin")?;
        assert!(skin.distance < 1e-5, "the arrow left the skin");
        fastest = fastest.max(motion.velocity.length());
    }
    println!("the arrow reached {fastest:.2} m/s and never left the skin");
    assert!(fastest > 1.0 && fastest < 100.0);
    Ok(())
}
