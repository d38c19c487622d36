//! clamber in a custom engine: slices and a palette, without glTF and rapier.

use clamber::glam::{DVec3, Vec3};
use clamber::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A raft of two triangles; its left edge follows joint 0, its right edge joint 1.
    let corners = [(-2.0, -2.0), (-2.0, 2.0), (2.0, 2.0), (2.0, -2.0)];
    let (joints, weight) = ([0, 0, 1, 1].map(JointId), 1.0);
    let source = MeshSource {
        positions: &corners.map(|(x, z)| Vec3::new(x, 0.0, z)),
        triangles: &[[0, 1, 2], [0, 2, 3]],
        influences: &joints.map(|joint| Influence { joint, weight }),
        joint_count: 2,
        ..MeshSource::default()
    };
    let (mesh, _report) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    let mut raft = SkinnedSurface::new(mesh.into());
    let mut climber = Climber::new(ClimberConfig::default(), DVec3::new(0.5, 0.9, 0.0))?;

    for tick in 0..=120u8 {
        // The engine's animation: both edges rise, the right one twice as fast.
        let height = f32::from(tick) / 120.0;
        let mut matrices = [Affine::IDENTITY; 2];
        matrices[0].rows[1][3] = height;
        matrices[1].rows[1][3] = 2.0 * height;
        raft.advance(&Palette::from_matrices(matrices), Similarity::IDENTITY)?;
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &raft)];
        climber.step(&ClimberInput::default(), &obstacles, 1.0 / 60.0)?;
    }
    let contact = climber.state().support.ok_or("fell off")?.attachment.point;
    println!("lifted to {:.3} m", contact.y);
    assert!((contact.y - (1.5 + contact.x / 4.0)).abs() < 1e-5);
    Ok(())
}
