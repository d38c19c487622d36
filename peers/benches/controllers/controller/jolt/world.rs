//! A Jolt world with one character.

#![allow(unsafe_code, reason = "calls Jolt")]

use std::error::Error;
use std::ffi::c_void;
use std::ptr::{null, null_mut};
use std::sync::OnceLock;

use clamber_scenes::controllers::{HEIGHT, Motion, PADDING, Piece, RADIUS, SNAP, STEP, Solid};
use clamber_surface::geometry::Similarity;
use glam::Vec3;
use oxijolt_sys::*;

/// Distance that Jolt looks ahead of the shape, metres. With the default of 0.1, walls faster than 6 m/s enter the
/// character; 0.5 is the distance that a wall of 30 m/s moves in a tick.
const PREDICTIVE: f32 = 0.5;

/// Layer of static bodies.
const STILL: JPH_ObjectLayer = 0;
/// Layer of kinematic bodies and the character.
const MOVING: JPH_ObjectLayer = 1;
/// Number of layers.
const LAYERS: u32 = 2;

/// Start and properties of a character.
pub(super) struct Start {
    /// The lowest point of its shape, padding included.
    pub(super) feet: Vec3,
    pub(super) max_slope: f32,
    pub(super) gravity: f32,
}

/// A world, its bodies, and a character in it. The pointers are owned until drop.
pub(super) struct World {
    system: *mut JPH_PhysicsSystem,
    jobs: *mut JPH_JobSystem,
    character: *mut JPH_CharacterVirtual,
    listener: *mut JPH_CharacterContactListener,
    /// True if the character may slide. The listener reads it while the character is updated, and both live until drop.
    may_slide: *mut bool,
    moving: Vec<Mover>,
}

struct Mover {
    body: JPH_BodyID,
    motion: Motion,
    /// The body's centre in its piece's space.
    middle: glam::DVec3,
}

impl World {
    pub(super) fn new(pieces: &[Piece], start: &Start) -> Result<Self, Box<dyn Error>> {
        static STARTED: OnceLock<bool> = OnceLock::new();
        // SAFETY: called once in a process, before any other function of Jolt.
        if !STARTED.get_or_init(|| unsafe { JPH_Init() }) {
            return Err("Jolt failed to start".into());
        }
        let system = system(start.gravity)?;
        let threads = JobSystemThreadPoolConfig {
            maxJobs: 0,
            maxBarriers: 0,
            numThreads: 1,
        };
        // SAFETY: the settings live for the call.
        let jobs = unsafe { JPH_JobSystemThreadPool_Create(&raw const threads) };
        let mut world = Self {
            system,
            jobs,
            character: null_mut(),
            listener: null_mut(),
            may_slide: Box::into_raw(Box::new(false)),
            moving: Vec::new(),
        };
        for piece in pieces {
            world.add(piece)?;
        }
        // SAFETY: the system lives.
        unsafe { JPH_PhysicsSystem_OptimizeBroadPhase(system) };
        world.character = character(system, start)?;
        world.listen();
        Ok(world)
    }

    fn listen(&mut self) {
        static PROCS: JPH_CharacterContactListener_Procs = JPH_CharacterContactListener_Procs {
            OnAdjustBodyVelocity: None,
            OnContactValidate: None,
            OnCharacterContactValidate: None,
            OnContactAdded: None,
            OnContactPersisted: None,
            OnContactRemoved: None,
            OnCharacterContactAdded: None,
            OnCharacterContactPersisted: None,
            OnCharacterContactRemoved: None,
            OnContactSolve: Some(stay),
            OnCharacterContactSolve: None,
        };
        // SAFETY: the functions are static. The listener and `may_slide` live until drop, longer than the character.
        unsafe {
            JPH_CharacterContactListener_SetProcs(&raw const PROCS);
            self.listener = JPH_CharacterContactListener_Create(self.may_slide.cast());
            JPH_CharacterVirtual_SetListener(self.character, self.listener);
        }
    }

    fn bodies(&self) -> *mut JPH_BodyInterface {
        // SAFETY: the system lives until drop, and owns the returned interface.
        unsafe { JPH_PhysicsSystem_GetBodyInterface(self.system) }
    }

    fn add(&mut self, piece: &Piece) -> Result<(), Box<dyn Error>> {
        let (shape, middle) = shape(&piece.solid)?;
        let (position, rotation) = placed(&(piece.motion)(0.0), middle);
        let (kind, layer) = if piece.moves {
            (JPH_MotionType_Kinematic, MOVING)
        } else {
            (JPH_MotionType_Static, STILL)
        };
        // SAFETY: the shape holds one reference, which is released once the body has its own; position and rotation
        // live for the call; settings are destroyed after their only use.
        let body = unsafe {
            let settings = JPH_BodyCreationSettings_Create3(
                shape,
                &raw const position,
                &raw const rotation,
                kind,
                layer,
            );
            if piece.moves {
                give_mass(settings);
            }
            let body = JPH_BodyInterface_CreateAndAddBody(
                self.bodies(),
                settings,
                JPH_Activation_Activate,
            );
            JPH_BodyCreationSettings_Destroy(settings);
            JPH_Shape_Destroy(shape);
            body
        };
        if body == u32::MAX {
            return Err("Jolt failed to make a body".into());
        }
        if piece.moves {
            self.moving.push(Mover {
                body,
                motion: piece.motion.clone(),
                middle,
            });
        }
        Ok(())
    }

    /// Gives the moving bodies the velocities that take them to their poses at `time`.
    pub(super) fn drive(&mut self, time: f64, dt: f32) {
        let bodies = self.bodies();
        for mover in &self.moving {
            let (mut position, mut rotation) = placed(&(mover.motion)(time), mover.middle);
            // SAFETY: the body was added and never removed; position and rotation live for the call.
            unsafe {
                JPH_BodyInterface_MoveKinematic(
                    bodies,
                    mover.body,
                    &raw mut position,
                    &raw mut rotation,
                    dt,
                );
            }
        }
    }

    pub(super) fn step(&mut self, dt: f32) -> Result<(), Box<dyn Error>> {
        // SAFETY: system and job system live until drop.
        let error = unsafe { JPH_PhysicsSystem_Update(self.system, dt, 1, self.jobs) };
        if error == JPH_PhysicsUpdateError_None {
            return Ok(());
        }
        Err(format!("Jolt's step failed: {error}").into())
    }

    /// Updates the ground's velocity, which `drive` has changed.
    pub(super) fn look_at_ground(&mut self) {
        // SAFETY: the character lives until drop.
        unsafe { JPH_CharacterVirtual_UpdateGroundVelocity(self.character) };
    }

    /// Moves the character, sticks it to the floor, and moves it up steps. If it may not slide, it stays in place on
    /// still ground.
    pub(super) fn update(&mut self, velocity: Vec3, may_slide: bool, dt: f32) {
        let velocity = vector(velocity);
        // Jolt's defaults, except for our distances.
        let settings = JPH_ExtendedUpdateSettings {
            stickToFloorStepDown: vector(Vec3::Y * -SNAP as f32),
            walkStairsStepUp: vector(Vec3::Y * STEP as f32),
            walkStairsMinStepForward: 0.02,
            walkStairsStepForwardTest: 0.15,
            walkStairsCosAngleForwardContact: libm::cosf(75.0 * core::f32::consts::PI / 180.0),
            walkStairsStepDownExtra: vector(Vec3::ZERO),
        };
        // SAFETY: character and system live until drop, velocity and settings for the call. Null means no filters: the
        // layers alone decide.
        unsafe {
            *self.may_slide = may_slide;
            JPH_CharacterVirtual_SetLinearVelocity(self.character, &raw const velocity);
            JPH_CharacterVirtual_ExtendedUpdate(
                self.character,
                dt,
                &raw const settings,
                MOVING,
                self.system,
                null(),
                null(),
            );
        }
    }

    pub(super) fn velocity(&self) -> Vec3 {
        let mut velocity = vector(Vec3::ZERO);
        // SAFETY: the character lives until drop; only `velocity` is written to.
        unsafe { JPH_CharacterVirtual_GetLinearVelocity(self.character, &raw mut velocity) };
        Vec3::new(velocity.x, velocity.y, velocity.z)
    }

    pub(super) fn ground_velocity(&self) -> Vec3 {
        let mut velocity = vector(Vec3::ZERO);
        // SAFETY: as above.
        unsafe { JPH_CharacterBase_GetGroundVelocity(self.character.cast(), &raw mut velocity) };
        Vec3::new(velocity.x, velocity.y, velocity.z)
    }

    /// True if the ground is too steep to stand on.
    pub(super) fn is_on_steep(&self) -> bool {
        let mut normal = vector(Vec3::ZERO);
        // SAFETY: the character lives until drop; only `normal` is written to.
        unsafe {
            JPH_CharacterBase_GetGroundNormal(self.character.cast(), &raw mut normal);
            JPH_CharacterBase_IsSlopeTooSteep(self.character.cast(), &raw const normal)
        }
    }

    pub(super) fn is_on_ground(&self) -> bool {
        // SAFETY: the character lives until drop.
        let state = unsafe { JPH_CharacterBase_GetGroundState(self.character.cast()) };
        state == JPH_GroundState_OnGround
    }

    /// The lowest point of the character's shape, padding included, as Jolt reports it.
    pub(super) fn feet(&self) -> Vec3 {
        let mut position = vector(Vec3::ZERO);
        // SAFETY: the character lives until drop; only `position` is written to.
        unsafe { JPH_CharacterVirtual_GetPosition(self.character, &raw mut position) };
        Vec3::new(position.x, position.y, position.z)
    }
}

impl Drop for World {
    fn drop(&mut self) {
        // SAFETY: each object is destroyed once, and before the objects that it uses.
        unsafe {
            if !self.character.is_null() {
                JPH_CharacterBase_Destroy(self.character.cast());
            }
            if !self.listener.is_null() {
                JPH_CharacterContactListener_Destroy(self.listener);
            }
            drop(Box::from_raw(self.may_slide));
            JPH_PhysicsSystem_Destroy(self.system);
            JPH_JobSystem_Destroy(self.jobs);
        }
    }
}

/// Keeps a character that does not walk from sliding on ground that is still and not too steep, as in Jolt's tests and
/// samples.
///
/// # Safety
/// Called by Jolt during an update, with the `may_slide` that the listener was made with.
unsafe extern "C" fn stay(
    may_slide: *mut c_void,
    character: *const JPH_CharacterVirtual,
    _: JPH_BodyID,
    _: JPH_SubShapeID,
    _: *const JPH_RVec3,
    normal: *const JPH_Vec3,
    contact: *const JPH_Vec3,
    _: *const JPH_PhysicsMaterial,
    _: *const JPH_Vec3,
    velocity: *mut JPH_Vec3,
) {
    // SAFETY: all pointers are valid during the call, and only `velocity` is written to.
    unsafe {
        let still = Vec3::new((*contact).x, (*contact).y, (*contact).z).length_squared() < 1e-12;
        let steep = JPH_CharacterBase_IsSlopeTooSteep(character.cast_mut().cast(), normal);
        if !*may_slide.cast::<bool>() && still && !steep {
            *velocity = vector(Vec3::ZERO);
        }
    }
}

/// A physics system in which moving bodies collide with all bodies.
fn system(gravity: f32) -> Result<*mut JPH_PhysicsSystem, Box<dyn Error>> {
    let gravity = vector(Vec3::Y * -gravity);
    // SAFETY: each table has the given number of layers, is alive when the next one is made from it, and is passed to
    // the system, which destroys it.
    let system = unsafe {
        let pairs = JPH_ObjectLayerPairFilterTable_Create(LAYERS);
        JPH_ObjectLayerPairFilterTable_EnableCollision(pairs, STILL, MOVING);
        JPH_ObjectLayerPairFilterTable_EnableCollision(pairs, MOVING, MOVING);
        let broad = JPH_BroadPhaseLayerInterfaceTable_Create(LAYERS, LAYERS);
        JPH_BroadPhaseLayerInterfaceTable_MapObjectToBroadPhaseLayer(broad, STILL, 0);
        JPH_BroadPhaseLayerInterfaceTable_MapObjectToBroadPhaseLayer(broad, MOVING, 1);
        let filter = JPH_ObjectVsBroadPhaseLayerFilterTable_Create(broad, LAYERS, pairs, LAYERS);
        let settings = JPH_PhysicsSystemSettings {
            maxBodies: 256,
            numBodyMutexes: 0,
            maxBodyPairs: 256,
            maxContactConstraints: 256,
            _padding: 0,
            broadPhaseLayerInterface: broad,
            objectLayerPairFilter: pairs,
            objectVsBroadPhaseLayerFilter: filter,
        };
        JPH_PhysicsSystem_Create(&raw const settings)
    };
    if system.is_null() {
        return Err("Jolt failed to make a physics system".into());
    }
    // SAFETY: the system lives.
    unsafe { JPH_PhysicsSystem_SetGravity(system, &raw const gravity) };
    Ok(system)
}

/// A character with Jolt's default settings and our size. Only contacts of the lower ball can support it.
fn character(
    system: *mut JPH_PhysicsSystem,
    start: &Start,
) -> Result<*mut JPH_CharacterVirtual, Box<dyn Error>> {
    let radius = (RADIUS - PADDING) as f32;
    let half = HEIGHT as f32 * 0.5;
    let position = vector(start.feet);
    let rotation = NO_ROTATION;
    // SAFETY: the shape holds one reference, released once the character has its own; settings, position and rotation
    // live for the call.
    let character = unsafe {
        let shape: *mut JPH_Shape = JPH_CapsuleShape_Create(half, radius).cast();
        let settings = JPH_CharacterVirtualSettings {
            base: JPH_CharacterBaseSettings {
                up: vector(Vec3::Y),
                supportingVolume: JPH_Plane {
                    normal: vector(Vec3::Y),
                    distance: -radius,
                },
                maxSlopeAngle: start.max_slope,
                enhancedInternalEdgeRemoval: false,
                shape,
            },
            ID: 1,
            mass: 70.0,
            maxStrength: 100.0,
            shapeOffset: vector(Vec3::Y * (half + radius)),
            backFaceMode: JPH_BackFaceMode_CollideWithBackFaces,
            predictiveContactDistance: PREDICTIVE,
            maxCollisionIterations: 5,
            maxConstraintIterations: 15,
            minTimeRemaining: 1e-4,
            collisionTolerance: 1e-3,
            characterPadding: PADDING as f32,
            maxNumHits: 256,
            hitReductionCosMaxAngle: 0.999,
            penetrationRecoverySpeed: 1.0,
            innerBodyShape: null(),
            innerBodyIDOverride: u32::MAX,
            innerBodyLayer: 0,
        };
        let character = JPH_CharacterVirtual_Create(
            &raw const settings,
            &raw const position,
            &raw const rotation,
            0,
            system,
        );
        JPH_Shape_Destroy(shape);
        character
    };
    if character.is_null() {
        return Err("Jolt failed to make a character".into());
    }
    Ok(character)
}

/// A shape that holds one reference, and the position of its centre.
fn shape(solid: &Solid) -> Result<(*mut JPH_Shape, glam::DVec3), Box<dyn Error>> {
    let (shape, middle): (*mut JPH_Shape, _) = match solid {
        Solid::Block { low, high } => {
            let half = vector(((*high - *low) * 0.5).as_vec3());
            // SAFETY: the numbers live for the call. No convex radius: edges are as sharp as for the other controllers.
            let shape = unsafe { JPH_BoxShape_Create(&raw const half, 0.0) };
            (shape.cast(), (*high + *low) * 0.5)
        }
        Solid::Mesh(mesh) => {
            let corners: Vec<_> = mesh.positions.iter().map(|p| vector(p.as_vec3())).collect();
            let triangles: Vec<_> = mesh.triangles.iter().map(|t| triangle(*t)).collect();
            // SAFETY: corners and triangles live for the call and have the given lengths. The settings are destroyed
            // after their only use.
            let shape = unsafe {
                let settings = JPH_MeshShapeSettings_Create2(
                    corners.as_ptr(),
                    corners.len() as u32,
                    triangles.as_ptr(),
                    triangles.len() as u32,
                );
                let shape = JPH_MeshShapeSettings_CreateShape(settings);
                JPH_ShapeSettings_Destroy(settings.cast());
                shape
            };
            (shape.cast(), glam::DVec3::ZERO)
        }
    };
    if shape.is_null() {
        return Err("Jolt failed to make a shape".into());
    }
    Ok((shape, middle))
}

/// Sets a mass, of any value: a mesh has no mass of its own, and a kinematic body needs one.
///
/// # Safety
/// The settings live.
unsafe fn give_mass(settings: *mut JPH_BodyCreationSettings) {
    let unit = |k: usize| {
        let one = |j: usize| if j == k { 1.0 } else { 0.0 };
        JPH_Vec4 {
            x: one(0),
            y: one(1),
            z: one(2),
            w: one(3),
        }
    };
    let mass = JPH_MassProperties {
        mass: 1.0,
        inertia: JPH_Mat4 {
            column: [unit(0), unit(1), unit(2), unit(3)],
        },
    };
    // SAFETY: the settings live, as the caller guarantees. The mass is copied.
    unsafe {
        JPH_BodyCreationSettings_SetOverrideMassProperties(
            settings,
            JPH_OverrideMassProperties_MassAndInertiaProvided,
        );
        JPH_BodyCreationSettings_SetMassPropertiesOverride(settings, &raw const mass);
    }
}

/// The identity rotation.
const NO_ROTATION: JPH_Quat = JPH_Quat {
    x: 0.0,
    y: 0.0,
    z: 0.0,
    w: 1.0,
};

fn vector(v: Vec3) -> JPH_Vec3 {
    JPH_Vec3 {
        x: v.x,
        y: v.y,
        z: v.z,
    }
}

fn triangle([i1, i2, i3]: [u32; 3]) -> JPH_IndexedTriangle {
    JPH_IndexedTriangle {
        i1,
        i2,
        i3,
        materialIndex: 0,
        userData: 0,
    }
}

fn placed(pose: &Similarity, middle: glam::DVec3) -> (JPH_RVec3, JPH_Quat) {
    let q = pose.rotation;
    let rotation = JPH_Quat {
        x: q.x as f32,
        y: q.y as f32,
        z: q.z as f32,
        w: q.w as f32,
    };
    (vector(pose.transform_point(middle).as_vec3()), rotation)
}
