use std::sync::Arc;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::*;
use bevy_ecs::world::DeferredWorld;
use bevy_math::Vec3;
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;
use clamber_body::{Body, BodyError, BodyInput, Figure, Plant};
use thiserror::Error;

use crate::creature::transform;
use crate::tell::tell;
use crate::{SpawnedRig, WorldOrigin};

/// Draws a [`Climber`](crate::Climber) as a humanoid: insert it on the climber's entity.
/// [`ClimberFigurePlugin`](crate::ClimberFigurePlugin) then writes the `Transform`s of the figure's root and joints in
/// each frame, so that hands hold skin as it is drawn and feet stand where they came down.
///
/// The rig is an entity of its own, without a parent, that `RigAssets` or your own loader has spawned. It is despawned
/// with the climber ([`FigureOf`]). Any humanoid that [`Humanoid::find`](clamber_body::Humanoid::find) knows will do;
/// `clamber_body` says how a file without clips gets the clips of another one.
///
/// ```
/// # use std::sync::Arc;
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// use bevy_clamber::clamber_body::{Figure, Humanoid};
/// use bevy_clamber::prelude::*;
///
/// /// Made once, for all climbers that look like this.
/// #[derive(Resource)]
/// struct Hero {
///     rig: RigAssets,
///     figure: Arc<Figure>,
/// }
///
/// fn figure(rig: &RigAssets) -> Result<Arc<Figure>, Box<dyn std::error::Error>> {
///     let rig = rig.rig();
///     let humanoid = Humanoid::find(&rig.skeleton)?;
///     Ok(Arc::new(Figure::new(rig.skeleton.clone(), humanoid, rig.clips.clone())?))
/// }
///
/// fn spawn(mut commands: Commands, hero: Res<Hero>) {
///     let rig = hero.rig.spawn(&mut commands, Transform::IDENTITY);
///     let figure = ClimberFigure::new(hero.figure.clone(), &rig).expect("the rig is the figure's own");
///     commands.spawn((Climber::colossus_climber(), Transform::from_xyz(0.0, 2.0, 0.0), figure));
/// }
/// # let _ = figure;
/// # let _ = spawn;
/// ```
#[derive(Component, Clone, Debug)]
#[component(on_insert = relate, on_discard = unrelate)]
pub struct ClimberFigure {
    pub(super) figure: Arc<Figure>,
    #[entities]
    pub(super) root: Entity,
    #[entities]
    pub(super) joints: Vec<Entity>,
    pub(super) body: Body,
    /// Where its eyes look, in Bevy's world space; `None` for straight ahead.
    pub look_at: Option<Vec3>,
}

/// The climber that the rig of this root shows: a relationship, inserted and removed with the climber's
/// [`ClimberFigure`]. The rig is despawned with the climber.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[relationship(relationship_target = ClimberFigures)]
pub struct FigureOf(pub Entity);

/// The roots of the rigs that show this climber; inserted beside its first [`ClimberFigure`].
#[derive(Component, Clone, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[relationship_target(relationship = FigureOf, linked_spawn)]
pub struct ClimberFigures(Vec<Entity>);

/// Relates a rig to its climber.
fn relate(mut world: DeferredWorld<'_>, context: HookContext) {
    if let Some(figure) = world.get::<ClimberFigure>(context.entity) {
        let root = figure.root;
        let mut commands = world.commands();
        commands.entity(root).try_insert(FigureOf(context.entity));
    }
}

fn unrelate(mut world: DeferredWorld<'_>, context: HookContext) {
    if let Some(figure) = world.get::<ClimberFigure>(context.entity) {
        let root = figure.root;
        let mut commands = world.commands();
        commands.entity(root).try_remove::<FigureOf>();
    }
}

/// A rig has another number of joints than the figure's skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the figure has {figure} joints, but {joints} entities were given")]
pub struct WrongJoints {
    /// Joints of the figure.
    pub figure: usize,
    /// Entities.
    pub joints: usize,
}

/// A hand or foot of a [`ClimberFigure`] came down on something: for sounds, dust and prints.
///
/// Triggered on the climber's entity, and written as a message. Places are in clamber's world space: Bevy's world space
/// plus [`WorldOrigin`](crate::WorldOrigin).
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct ClimberPlant {
    /// The climber.
    pub entity: Entity,
    /// The hand or foot, where it came down, and how fast.
    pub plant: Plant,
}

impl ClimberFigure {
    /// Poses a rig that was spawned from the figure's own file.
    ///
    /// # Errors
    /// [`WrongJoints`] if the rig has another number of joints.
    pub fn new(figure: Arc<Figure>, rig: &SpawnedRig) -> Result<Self, WrongJoints> {
        Self::with_joints(figure, rig.root, rig.joints.clone())
    }

    /// Poses joints that something else has spawned below `root`: one entity for each joint of the figure's skeleton,
    /// in its order.
    ///
    /// # Errors
    /// [`WrongJoints`] if there are more or fewer.
    pub fn with_joints(
        figure: Arc<Figure>,
        root: Entity,
        joints: Vec<Entity>,
    ) -> Result<Self, WrongJoints> {
        let count = figure.skeleton().joints().len();
        if count != joints.len() {
            return Err(WrongJoints {
                figure: count,
                joints: joints.len(),
            });
        }
        Ok(Self {
            body: Body::new(&figure),
            figure,
            root,
            joints,
            look_at: None,
        })
    }

    /// The data that it shares with others of its kind.
    pub fn figure(&self) -> &Arc<Figure> {
        &self.figure
    }

    /// The body as the last frame drew it, with the holds of hands and feet.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The body, to [play clips over it](Body::set_overlay).
    pub fn body_mut(&mut self) -> &mut Body {
        &mut self.body
    }
    /// Poses the body.
    pub(crate) fn update(&mut self, frame: &BodyInput<'_>, dt: f64) -> Result<(), BodyError> {
        let figure = Arc::clone(&self.figure);
        self.body.update(&figure, frame, dt)
    }

    /// Writes the pose into the transforms of root and joints, and tells which hands and feet came down.
    pub(crate) fn write(
        &self,
        entity: Entity,
        origin: &WorldOrigin,
        transforms: &mut Query<'_, '_, &mut Transform>,
        commands: &mut Commands<'_, '_>,
    ) {
        for plant in self.body.plants().iter().copied() {
            tell(commands, ClimberPlant { entity, plant });
        }
        let place = self.body.world_from_model();
        if let Ok(mut root) = transforms.get_mut(self.root) {
            root.set_if_neq(Transform {
                translation: (place.translation - origin.0).as_vec3(),
                rotation: place.rotation.as_quat(),
                scale: Vec3::splat(place.scale as f32),
            });
        }
        let locals = &self.body.pose().transforms;
        for (joint, local) in self.joints.iter().zip(locals) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
    }
}
