//! A climber's input and state.

use clamber_climber::{
    ClimberInput, ClimberMode, ClimberState, FlyingMemory, HangingMemory, HoldingMemory, Knockback,
    LedgeHangingMemory, StandingMemory, Support, TumblingMemory,
};
use clamber_world::{Attachment, MaterialPoint, ObstacleId, SurfaceKind, SurfaceTag};

use super::{Mirror, Rotation, Vector, message};

message! {
    /// The climber's input.
    Input of ClimberInput {
        walk: Vector (message, required, tag = 1),
        climb: Vector (message, required, tag = 2),
        jump: bool (bool, tag = 3),
        grip: bool (bool, tag = 4),
        jump_held: bool (bool, tag = 5),
        actions: u32 (uint32, tag = 6),
        aim: Vector (message, required, tag = 7),
        crouch: bool (bool, tag = 8),
    }
}

message! {
    /// A blow that strikes the climber in the tick.
    Struck of Knockback {
        velocity: Vector (message, required, tag = 1),
        damage: f64 (double, required, tag = 2),
        by: Option<u64> (uint64, optional, tag = 3),
    }
}

message! {
    /// The climber's state.
    State of ClimberState {
        position: Vector (message, required, tag = 1),
        velocity: Vector (message, required, tag = 2),
        heading: Vector (message, required, tag = 3),
        /// `ClimberMode::number` of the current mode.
        mode: u32 (uint32, tag = 4),
        support: Option<Held> (message, optional, tag = 5),
        support_velocity: Option<Vector> (message, optional, tag = 6),
        shake: Vector (message, required, tag = 7),
        stamina: f64 (double, required, tag = 8),
        hit_points: f64 (double, required, tag = 9),
        hanging: Hanging (message, required, tag = 10),
        ledge_hanging: LedgeHanging (message, required, tag = 11),
        tumbling: Tumbling (message, required, tag = 12),
        coyote: f64 (double, required, tag = 13),
        jump_buffer: f64 (double, required, tag = 14),
        grip_cooldown: f64 (double, required, tag = 15),
        crouched: bool (bool, tag = 16),
        crushed: bool (bool, tag = 17),
        base_velocity: Vector (message, required, tag = 18),
        /// Displacement of the climber in the last tick beyond its support's displacement, or beyond its velocity in
        /// the air.
        own_way: Vector (message, required, tag = 19),
        flying: Flying (message, required, tag = 20),
        standing: Standing (message, required, tag = 21),
        /// How long the climber has touched nothing, seconds.
        untouched: f64 (double, required, tag = 22),
        /// Share of the climber's weight that it put on its support.
        load: f64 (double, required, tag = 23),
        holding: Holding (message, required, tag = 24),
        /// Memory of the game's custom modes.
        custom_slots: Vec<f64> (double, repeated, tag = 25),
    }
}

message! {
    /// Memory of hanging by the hands.
    Hanging of HangingMemory {
        arm: f64 (double, required, tag = 1),
        calm: f64 (double, required, tag = 2),
        /// End of the climber's legs, relative to its position.
        legs: Vector (message, required, tag = 3),
    }
}

message! {
    /// Memory of hanging from a ledge.
    LedgeHanging of LedgeHangingMemory {
        pull_up: f64 (double, required, tag = 1),
        /// How long an obstacle has kept the climber from pulling itself up, seconds.
        blocked: f64 (double, required, tag = 2),
        gave_up: bool (bool, tag = 3),
        returns: bool (bool, tag = 4),
        /// Direction of the input that leads to the climber's right along a ledge, set while the input has led it
        /// around a corner.
        right: Vector (message, required, tag = 5),
    }
}

message! {
    /// Memory of tumbling.
    Tumbling of TumblingMemory {
        /// How long the climber has lain still, seconds.
        still: f64 (double, required, tag = 1),
        /// How long ago the climber first touched ground, seconds.
        down: f64 (double, required, tag = 2),
    }
}

message! {
    /// Memory of flying.
    Flying of FlyingMemory {
        jumping: bool (bool, tag = 1),
    }
}

message! {
    /// Memory of standing.
    Standing of StandingMemory {
        shoved: bool (bool, tag = 1),
    }
}

message! {
    /// Memory of climbing: the held stick and the climbing direction that was found for it.
    Holding of HoldingMemory {
        stick: Vector (message, required, tag = 1),
        along: Vector (message, required, tag = 2),
        normal: Vector (message, required, tag = 3),
    }
}

message! {
    /// The support that the climber stands on, grips, or hangs from.
    Held of Support {
        attachment: Attached (message, required, tag = 1),
        normal: Vector (message, required, tag = 2),
        /// Normal of the face, in the frame of the material.
        face: Vector (message, required, tag = 3),
        tag: Tag (message, required, tag = 4),
    }
}

message! {
    /// The point of an obstacle that the climber is attached to.
    Attached of Attachment {
        obstacle: u64 (uint64, tag = 1),
        material: Material (message, required, tag = 2),
        point: Vector (message, required, tag = 3),
        /// In the frame of the material, as the support's normal is.
        offset: Vector (message, required, tag = 4),
        frame: Rotation (message, required, tag = 5),
    }
}

message! {
    /// A point of the material of an obstacle.
    Material of MaterialPoint {
        key: u64 (uint64, tag = 1),
        coordinates: Vec<f64> (double, repeated, tag = 2),
    }
}

message! {
    /// The kind of a surface.
    Tag of SurfaceTag {
        /// 0 skin, 1 fur, 2 stone.
        kind: u32 (uint32, tag = 1),
        /// The game's own number.
        user: u32 (uint32, tag = 2),
    }
}

impl Mirror<ObstacleId> for u64 {
    fn of(own: &ObstacleId) -> Self {
        own.0
    }

    fn own(&self) -> Result<ObstacleId, String> {
        Ok(ObstacleId(*self))
    }
}

impl Mirror<ClimberMode> for u32 {
    fn of(own: &ClimberMode) -> Self {
        own.number()
    }

    fn own(&self) -> Result<ClimberMode, String> {
        ClimberMode::from_number(*self).ok_or_else(|| format!("unknown climber mode {self}"))
    }
}

impl Mirror<SurfaceKind> for u32 {
    fn of(own: &SurfaceKind) -> Self {
        match own {
            SurfaceKind::Skin => 0,
            SurfaceKind::Fur => 1,
            SurfaceKind::Stone => 2,
        }
    }

    fn own(&self) -> Result<SurfaceKind, String> {
        Ok(match self {
            1 => SurfaceKind::Fur,
            2 => SurfaceKind::Stone,
            _ => SurfaceKind::Skin,
        })
    }
}
