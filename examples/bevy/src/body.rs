//! The hero's body: a person from a file, whose hands and feet are on what the climber touches.

use std::sync::Arc;

use bevy::mesh::skinning::SkinnedMeshInverseBindposes;
use bevy::prelude::*;
use bevy_clamber::clamber_body::{Figure, Humanoid};
use bevy_clamber::clamber_gltf::{self, Material};
use bevy_clamber::prelude::*;

/// The person's file.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/hero.glb");

/// The person, and what it looks like.
#[derive(Resource)]
pub struct Person {
    assets: RigAssets,
    figure: Arc<Figure>,
    materials: Vec<Handle<StandardMaterial>>,
}

/// Loads the person.
///
/// # Errors
/// If the file is missing, is no humanoid, or lacks clips.
pub fn load(app: &mut App) -> Result<(), Box<dyn std::error::Error>> {
    let model = clamber_gltf::load(FILE)?;
    let humanoid = Humanoid::find(&model.rig.skeleton)?;
    let figure = Figure::new(
        model.rig.skeleton.clone(),
        humanoid,
        model.rig.clips.clone(),
    )?;
    let world = app.world_mut();
    let mut looks = world.resource_mut::<Assets<StandardMaterial>>();
    let materials = model.materials.iter();
    let materials = materials.map(|material| looks.add(standard(material)));
    let materials = materials.collect();
    let assets = world.resource_scope(|world, mut meshes: Mut<Assets<Mesh>>| {
        let mut poses = world.resource_mut::<Assets<SkinnedMeshInverseBindposes>>();
        RigAssets::new(model, &mut meshes, &mut poses)
    })?;
    app.insert_resource(Person {
        assets,
        figure: Arc::new(figure),
        materials,
    });
    app.add_plugins(ClimberFigurePlugin);
    Ok(())
}

fn standard(material: &Material) -> StandardMaterial {
    let [red, green, blue, alpha] = material.base_color;
    StandardMaterial {
        base_color: Color::linear_rgba(red, green, blue, alpha),
        metallic: material.metallic,
        perceptual_roughness: material.roughness,
        double_sided: material.double_sided,
        ..default()
    }
}

impl Person {
    /// Spawns the person for a climber.
    pub fn figure(&self, commands: &mut Commands) -> ClimberFigure {
        let rig = self.assets.spawn(commands, Transform::IDENTITY);
        commands.entity(rig.root).insert(Visibility::default());
        let looks = self.assets.model().visual.iter();
        let looks = looks.flat_map(|mesh| &mesh.primitives);
        for (mesh, primitive) in rig.meshes.iter().zip(looks) {
            let material = primitive
                .material
                .and_then(|index| self.materials.get(index));
            let material = material.cloned().unwrap_or_default();
            commands.entity(*mesh).insert(MeshMaterial3d(material));
        }
        ClimberFigure::new(self.figure.clone(), &rig).expect("the rig is the figure's own")
    }
}
