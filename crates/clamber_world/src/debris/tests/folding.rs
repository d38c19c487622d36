use clamber_surface::mesh::{Influence, MeshSource};
use clamber_surface::rig::JointId;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::{DT, Scene, at, lifted, slab};
use crate::testing::surface_of;

/// Half the size of a jaw, metres.
const HALF: Vec3 = Vec3::new(3.0, 0.5, 3.0);

/// Height of the upper jaw above the lower one, at rest, metres.
const OPEN: f32 = 3.0;

/// Two slabs of one creature, one above the other, each on a joint of its own.
fn jaws() -> SkinnedSurface {
    let lower = slab(HALF, 0.6, 1);
    let lower = lower.mesh();
    let upper = lower.positions().iter().map(|p| *p + Vec3::Y * OPEN);
    let positions: Vec<Vec3> = lower.positions().iter().copied().chain(upper).collect();
    let count = lower.positions().len();
    let of = |first: usize| {
        let triangles = lower.triangles().iter();
        triangles.map(move |corners| corners.map(|v| v.0 + first as u32))
    };
    let triangles: Vec<_> = of(0).chain(of(count)).collect();
    let influence = |vertex| Influence {
        joint: JointId(u32::from(vertex >= count)),
        weight: 1.0,
    };
    let influences: Vec<_> = (0..positions.len()).map(influence).collect();
    surface_of(&MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: 2,
        ..MeshSource::default()
    })
}

/// Jaws close on a rock, down to a fifth of its width, and stay closed. The creature moves along meanwhile. Skin passes
/// through the rock until the rock has fallen out of the creature; the rock does not stay inside unnoticed.
#[test]
fn a_rock_on_which_skin_closes_from_both_sides_is_let_through_until_it_is_outside() {
    for (shape, drift) in [
        (ColliderBuilder::ball(0.4), 0.0),
        (ColliderBuilder::ball(0.4), 2.0),
        (ColliderBuilder::cuboid(0.4, 0.35, 0.4), 0.0),
        (ColliderBuilder::cuboid(0.4, 0.35, 0.4), 2.0),
    ] {
        let mut scene = Scene::new(jaws());
        let (rock, _) = scene.drop(shape, Vector::new(0.3, 0.95, 0.2));
        let closed = f64::from(OPEN - 2.0 * HALF.y) - 0.16;
        let mut let_through = 0;
        for tick in 0..600 {
            let seconds = f64::from(tick) * DT;
            let down = (2.0 * (seconds - 0.5).max(0.0)).min(closed);
            let palette = lifted(2, |joint| if joint == 1 { -down } else { 0.0 });
            let place = at(DVec3::X * (drift * seconds), DVec3::Y, 0.0);
            scene.tick(&palette, place);
            let middle = scene.in_model(rock);
            let half = HALF.as_dvec3() - 0.05;
            let upper = DVec3::Y * (f64::from(OPEN) - down);
            let inside = [DVec3::ZERO, upper]
                .iter()
                .any(|slab| (middle - *slab).abs().cmplt(half).all());
            let passed = scene.debris.is_let_through(rock);
            let_through += u32::from(passed);
            assert!(!inside || passed, "inside at {middle} in tick {tick}");
        }
        let middle = scene.in_model(rock);
        assert!(let_through > 0, "it was never caught");
        assert!(
            !scene.debris.is_let_through(rock) && middle.y < -0.5,
            "it is still at {middle}"
        );
    }
}
