//! clamber's own messages. foxglove's `Encode` makes their schemas, and prost reads them. In both, field numbers follow
//! the order of the fields.

use clamber_climber::{
    Blow, ClimberInput, ClimberMode, ClimberState, FlyingMemory, HangingMemory, HoldingMemory,
    LedgeHangingMemory, MEMORY, StandingMemory, StepReport, Support, TumblingMemory,
};
use clamber_surface::surface::Diagnostics;
use clamber_world::{Attachment, MaterialPoint, ObstacleId, SurfaceKind, SurfaceTag};
use foxglove::Encode;
use glam::{DQuat, DVec3};

/// A vector, in world space unless its field says otherwise.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Vector {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
}

#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Rotation {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
    #[prost(double, tag = "4")]
    pub(crate) w: f64,
}

/// The climber's input.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Input {
    #[prost(message, required, tag = "1")]
    pub(crate) walk: Vector,
    #[prost(message, required, tag = "2")]
    pub(crate) climb: Vector,
    #[prost(bool, tag = "3")]
    pub(crate) jump: bool,
    #[prost(bool, tag = "4")]
    pub(crate) grip: bool,
    #[prost(message, optional, tag = "5")]
    pub(crate) blow: Option<Struck>,
    #[prost(bool, tag = "6")]
    pub(crate) jump_held: bool,
    #[prost(uint32, tag = "7")]
    pub(crate) actions: u32,
    #[prost(message, required, tag = "8")]
    pub(crate) aim: Vector,
    #[prost(bool, tag = "9")]
    pub(crate) crouch: bool,
}

/// A blow that struck the climber.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Struck {
    #[prost(message, required, tag = "1")]
    pub(crate) velocity: Vector,
    #[prost(double, tag = "2")]
    pub(crate) damage: f64,
    #[prost(uint64, optional, tag = "3")]
    pub(crate) by: Option<u64>,
}

/// The support that the climber stands on, grips, or hangs from.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Held {
    #[prost(uint64, tag = "1")]
    pub(crate) obstacle: u64,
    #[prost(uint64, tag = "2")]
    pub(crate) key: u64,
    #[prost(message, required, tag = "3")]
    pub(crate) coordinates: Vector,
    #[prost(message, required, tag = "4")]
    pub(crate) contact: Vector,
    /// In the frame of the material, as `normal` is.
    #[prost(message, required, tag = "5")]
    pub(crate) offset: Vector,
    #[prost(message, required, tag = "6")]
    pub(crate) normal: Vector,
    /// Normal of the face, in the frame of the material.
    #[prost(message, required, tag = "7")]
    pub(crate) face: Vector,
    #[prost(message, required, tag = "8")]
    pub(crate) frame: Rotation,
    /// 0 skin, 1 fur, 2 stone.
    #[prost(uint32, tag = "9")]
    pub(crate) kind: u32,
    #[prost(bool, tag = "10")]
    pub(crate) ledge: bool,
    /// The game's own number.
    #[prost(uint32, tag = "11")]
    pub(crate) user: u32,
}

/// Memory of the game's custom modes.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Memory {
    #[prost(double, tag = "1")]
    pub(crate) a: f64,
    #[prost(double, tag = "2")]
    pub(crate) b: f64,
    #[prost(double, tag = "3")]
    pub(crate) c: f64,
    #[prost(double, tag = "4")]
    pub(crate) d: f64,
    #[prost(double, tag = "5")]
    pub(crate) e: f64,
    #[prost(double, tag = "6")]
    pub(crate) f: f64,
    #[prost(double, tag = "7")]
    pub(crate) g: f64,
    #[prost(double, tag = "8")]
    pub(crate) h: f64,
}

/// The climber's state.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct State {
    #[prost(message, required, tag = "1")]
    pub(crate) position: Vector,
    #[prost(message, required, tag = "2")]
    pub(crate) velocity: Vector,
    #[prost(message, required, tag = "3")]
    pub(crate) heading: Vector,
    /// `ClimberMode::number` of the current mode.
    #[prost(uint32, tag = "4")]
    pub(crate) mode: u32,
    #[prost(message, optional, tag = "5")]
    pub(crate) support: Option<Held>,
    #[prost(message, optional, tag = "6")]
    pub(crate) support_velocity: Option<Vector>,
    #[prost(message, required, tag = "7")]
    pub(crate) shake: Vector,
    #[prost(double, tag = "8")]
    pub(crate) stamina: f64,
    #[prost(double, tag = "9")]
    pub(crate) hit_points: f64,
    #[prost(double, tag = "10")]
    pub(crate) arm: f64,
    #[prost(double, tag = "11")]
    pub(crate) pull_up: f64,
    #[prost(double, tag = "12")]
    pub(crate) calm: f64,
    #[prost(double, tag = "13")]
    pub(crate) coyote: f64,
    #[prost(double, tag = "14")]
    pub(crate) jump_buffer: f64,
    #[prost(double, tag = "15")]
    pub(crate) open_handed: f64,
    #[prost(bool, tag = "16")]
    pub(crate) crouched: bool,
    #[prost(message, required, tag = "17")]
    pub(crate) base_velocity: Vector,
    #[prost(bool, tag = "18")]
    pub(crate) jumping: bool,
    #[prost(message, required, tag = "19")]
    pub(crate) memory: Memory,
    #[prost(bool, tag = "20")]
    pub(crate) shoved: bool,
    /// How long a tumbling climber has lain still, seconds.
    #[prost(double, tag = "21")]
    pub(crate) still: f64,
    /// End of the climber's legs while it hangs, relative to its position.
    #[prost(message, required, tag = "22")]
    pub(crate) legs: Vector,
    #[prost(bool, tag = "23")]
    pub(crate) crushed: bool,
    /// How long the climber has touched nothing, seconds.
    #[prost(double, tag = "24")]
    pub(crate) untouched: f64,
    /// The held stick and the climbing direction that was found for it.
    #[prost(message, optional, tag = "25")]
    pub(crate) held_stick: Option<HeldStick>,
    /// How long ago a tumbling climber first touched ground, seconds.
    #[prost(double, tag = "26")]
    pub(crate) down: f64,
    /// How long an obstacle has kept the climber from pulling itself up, seconds.
    #[prost(double, tag = "27")]
    pub(crate) blocked: f64,
    #[prost(bool, tag = "28")]
    pub(crate) gave_up: bool,
    #[prost(bool, tag = "29")]
    pub(crate) returns: bool,
    /// Direction of the input that leads to the climber's right along a ledge, set while the input has led it around a
    /// corner.
    #[prost(message, required, tag = "30")]
    pub(crate) right: Vector,
    /// Displacement of the climber in the last tick beyond its support's displacement, or beyond its velocity in the
    /// air.
    #[prost(message, required, tag = "31")]
    pub(crate) own_way: Vector,
    /// Share of the climber's weight that it put on its support.
    #[prost(double, tag = "32")]
    pub(crate) load: f64,
}

/// A stick that is held while the climber climbs.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct HeldStick {
    #[prost(message, required, tag = "1")]
    pub(crate) stick: Vector,
    #[prost(message, required, tag = "2")]
    pub(crate) along: Vector,
    #[prost(message, required, tag = "3")]
    pub(crate) normal: Vector,
}

/// A summary of the step's report.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Report {
    #[prost(message, required, tag = "1")]
    pub(crate) pushed_out: Vector,
    #[prost(double, tag = "2")]
    pub(crate) penetration: f64,
    #[prost(uint32, tag = "3")]
    pub(crate) rounds: u32,
    #[prost(bool, tag = "4")]
    pub(crate) is_clear: bool,
    /// Sum of the impulses of all pushes, newton seconds.
    #[prost(message, required, tag = "5")]
    pub(crate) impulse: Vector,
    /// Number of pushes.
    #[prost(uint32, tag = "6")]
    pub(crate) pushes: u32,
}

/// One tick.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Tick {
    #[prost(uint64, tag = "1")]
    pub(crate) tick: u64,
    #[prost(message, required, tag = "2")]
    pub(crate) input: Input,
    #[prost(message, required, tag = "3")]
    pub(crate) state: State,
    #[prost(message, required, tag = "4")]
    pub(crate) report: Report,
    #[prost(uint64, tag = "5")]
    pub(crate) state_fingerprint: u64,
    #[prost(uint64, tag = "6")]
    pub(crate) palette_fingerprint: u64,
    #[prost(uint64, tag = "7")]
    pub(crate) scene_fingerprint: u64,
}

/// A snapshot: the caller's text from which the scene can resume after a tick.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct Snapshot {
    #[prost(uint64, tag = "1")]
    pub(crate) tick: u64,
    #[prost(string, tag = "2")]
    pub(crate) scene: String,
}

/// One tick of an arena.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct ArenaTick {
    #[prost(uint64, tag = "1")]
    pub(crate) tick: u64,
    /// One input for each fighter; empty before the first step.
    #[prost(message, repeated, tag = "2")]
    pub(crate) inputs: Vec<Input>,
    /// Fingerprint of the whole arena.
    #[prost(uint64, tag = "3")]
    pub(crate) fingerprint: u64,
    /// Fingerprints of the creatures, of the fighters, and of the rest, in this order.
    #[prost(uint64, repeated, tag = "4")]
    pub(crate) parts: Vec<u64>,
    /// Numbers of the creatures.
    #[prost(uint32, repeated, tag = "5")]
    pub(crate) creatures: Vec<u32>,
    /// Numbers of the fighters.
    #[prost(uint32, repeated, tag = "6")]
    pub(crate) fighters: Vec<u32>,
    /// The orders of the step, as `Order::to_bytes` writes them; empty if there are none.
    #[prost(bytes = "bytes", tag = "7")]
    pub(crate) orders: prost::bytes::Bytes,
}

/// A saved state of an arena.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct ArenaSnapshot {
    #[prost(uint64, tag = "1")]
    pub(crate) tick: u64,
    #[prost(bytes = "bytes", tag = "2")]
    pub(crate) state: prost::bytes::Bytes,
}

/// A number with a name.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct Named {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(double, tag = "2")]
    pub(crate) value: f64,
}

/// The brain of a creature.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct Brain {
    /// Path of the current state, with the names of the states around it.
    #[prost(string, tag = "1")]
    pub(crate) state: String,
    /// Time since that state was entered, seconds.
    #[prost(double, tag = "2")]
    pub(crate) seconds: f64,
    #[prost(message, repeated, tag = "3")]
    pub(crate) moods: Vec<Named>,
    /// Senses that are finite and not 0.
    #[prost(message, repeated, tag = "4")]
    pub(crate) senses: Vec<Named>,
    /// Remaining hit points of each weak point.
    #[prost(double, repeated, tag = "5")]
    pub(crate) hit_points: Vec<f64>,
    /// For each leg, whether its foot is planted.
    #[prost(bool, repeated, tag = "6")]
    pub(crate) planted: Vec<bool>,
}

/// Counts of the clusters, vertices and triangles that the queries of a tick touched.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Touched {
    #[prost(uint64, tag = "1")]
    pub(crate) bounds_evaluated: u64,
    #[prost(uint64, tag = "2")]
    pub(crate) clusters_touched: u64,
    #[prost(uint64, tag = "3")]
    pub(crate) clusters_skinned: u64,
    #[prost(uint64, tag = "4")]
    pub(crate) clusters: u64,
    #[prost(uint64, tag = "5")]
    pub(crate) vertices_skinned: u64,
    #[prost(uint64, tag = "6")]
    pub(crate) vertices: u64,
    #[prost(uint64, tag = "7")]
    pub(crate) triangles_tested: u64,
    #[prost(uint32, tag = "8")]
    pub(crate) most_sweep_steps: u32,
}

impl Tick {
    /// Appends the encoded message. prost encodes three times as fast as foxglove, but leaves out numbers that equal
    /// zero, and so loses the sign of a negative zero. Therefore foxglove encodes messages with a negative zero.
    pub(crate) fn write(&self, buffer: &mut Vec<u8>) -> Result<(), String> {
        if self.has_negative_zero() {
            Encode::encode(self, buffer).map_err(|error| error.to_string())
        } else {
            prost::Message::encode(self, buffer).map_err(|error| error.to_string())
        }
    }

    fn has_negative_zero(&self) -> bool {
        self.input.has_negative_zero()
            || self.state.has_negative_zero()
            || self.report.pushed_out.has_negative_zero()
            || self.report.impulse.has_negative_zero()
            || negative_zero(&self.report.penetration)
    }
}

impl ArenaTick {
    /// Appends the message, as [`Tick::write`] does.
    pub(crate) fn write(&self, buffer: &mut Vec<u8>) -> Result<(), String> {
        if self.inputs.iter().any(Input::has_negative_zero) {
            Encode::encode(self, buffer).map_err(|error| error.to_string())
        } else {
            prost::Message::encode(self, buffer).map_err(|error| error.to_string())
        }
    }
}

impl Input {
    fn has_negative_zero(&self) -> bool {
        self.walk.has_negative_zero()
            || self.climb.has_negative_zero()
            || self.aim.has_negative_zero()
            || self.blow.is_some_and(|blow| {
                blow.velocity.has_negative_zero() || negative_zero(&blow.damage)
            })
    }
}

impl State {
    fn has_negative_zero(&self) -> bool {
        let vectors = [
            self.position,
            self.velocity,
            self.base_velocity,
            self.own_way,
            self.heading,
            self.shake,
            self.legs,
            self.right,
        ];
        let memory: [f64; MEMORY] = self.memory.into();
        let numbers = [
            self.stamina,
            self.hit_points,
            self.arm,
            self.pull_up,
            self.blocked,
            self.calm,
            self.still,
            self.coyote,
            self.jump_buffer,
            self.open_handed,
            self.untouched,
            self.load,
            self.down,
        ];
        vectors.iter().any(Vector::has_negative_zero)
            || numbers.iter().chain(&memory).any(negative_zero)
            || self.support.is_some_and(|held| held.has_negative_zero())
            || self.held_stick.is_some_and(|held| {
                let vectors = [held.stick, held.along, held.normal];
                vectors.iter().any(Vector::has_negative_zero)
            })
            || self
                .support_velocity
                .is_some_and(|velocity| velocity.has_negative_zero())
    }
}

impl Held {
    fn has_negative_zero(&self) -> bool {
        let vectors = [
            self.coordinates,
            self.contact,
            self.offset,
            self.normal,
            self.face,
        ];
        let Rotation { x, y, z, w } = self.frame;
        vectors.iter().any(Vector::has_negative_zero) || [x, y, z, w].iter().any(negative_zero)
    }
}

impl Vector {
    fn has_negative_zero(&self) -> bool {
        [self.x, self.y, self.z].iter().any(negative_zero)
    }
}

fn negative_zero(x: &f64) -> bool {
    x.to_bits() == (-0.0_f64).to_bits()
}

impl From<DVec3> for Vector {
    fn from(v: DVec3) -> Self {
        Self {
            x: v.x,
            y: v.y,
            z: v.z,
        }
    }
}

impl From<Vector> for DVec3 {
    fn from(v: Vector) -> Self {
        Self::new(v.x, v.y, v.z)
    }
}

impl From<DQuat> for Rotation {
    fn from(q: DQuat) -> Self {
        Self {
            x: q.x,
            y: q.y,
            z: q.z,
            w: q.w,
        }
    }
}

impl From<Rotation> for DQuat {
    fn from(q: Rotation) -> Self {
        Self::from_xyzw(q.x, q.y, q.z, q.w)
    }
}

impl From<[f64; MEMORY]> for Memory {
    fn from([a, b, c, d, e, f, g, h]: [f64; MEMORY]) -> Self {
        Self {
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
        }
    }
}

impl From<Memory> for [f64; MEMORY] {
    fn from(memory: Memory) -> Self {
        let Memory {
            a,
            b,
            c,
            d,
            e,
            f,
            g,
            h,
        } = memory;
        [a, b, c, d, e, f, g, h]
    }
}

impl From<&ClimberInput> for Input {
    fn from(input: &ClimberInput) -> Self {
        Self {
            walk: input.walk.into(),
            climb: input.climb.into(),
            jump: input.jump,
            grip: input.grip,
            blow: input.blow.map(|blow| Struck {
                velocity: blow.velocity.into(),
                damage: blow.damage,
                by: blow.by.map(|by| by.0),
            }),
            jump_held: input.jump_held,
            actions: input.actions,
            aim: input.aim.into(),
            crouch: input.crouch,
        }
    }
}

impl From<Input> for ClimberInput {
    fn from(input: Input) -> Self {
        Self {
            walk: input.walk.into(),
            climb: input.climb.into(),
            jump: input.jump,
            grip: input.grip,
            blow: input.blow.map(|blow| Blow {
                velocity: blow.velocity.into(),
                damage: blow.damage,
                by: blow.by.map(ObstacleId),
            }),
            jump_held: input.jump_held,
            actions: input.actions,
            aim: input.aim.into(),
            crouch: input.crouch,
        }
    }
}

impl From<&ClimberState> for State {
    fn from(state: &ClimberState) -> Self {
        Self {
            position: state.position.into(),
            velocity: state.velocity.into(),
            heading: state.heading.into(),
            mode: state.mode.number(),
            support: state.support.as_ref().map(Held::from),
            support_velocity: state.support_velocity.map(Vector::from),
            shake: state.shake.into(),
            stamina: state.stamina,
            hit_points: state.hit_points,
            arm: state.hanging.arm,
            pull_up: state.ledge_hanging.pull_up,
            blocked: state.ledge_hanging.blocked,
            gave_up: state.ledge_hanging.gave_up,
            returns: state.ledge_hanging.returns,
            right: state.ledge_hanging.right.into(),
            calm: state.hanging.calm,
            legs: state.hanging.legs.into(),
            crushed: state.crushed,
            still: state.tumbling.still,
            coyote: state.coyote,
            jump_buffer: state.jump_buffer,
            open_handed: state.open_handed,
            crouched: state.crouched,
            base_velocity: state.base_velocity.into(),
            own_way: state.own_way.into(),
            jumping: state.flying.jumping,
            memory: state.memory.into(),
            shoved: state.standing.shoved,
            untouched: state.untouched,
            load: state.load,
            down: state.tumbling.down,
            held_stick: Some(HeldStick {
                stick: state.holding.stick.into(),
                along: state.holding.along.into(),
                normal: state.holding.normal.into(),
            }),
        }
    }
}

impl From<&Support> for Held {
    fn from(support: &Support) -> Self {
        let attachment = &support.attachment;
        Self {
            obstacle: attachment.obstacle.0,
            key: attachment.material.key,
            coordinates: DVec3::from_array(attachment.material.coordinates).into(),
            contact: attachment.point.into(),
            offset: attachment.offset.into(),
            normal: support.normal.into(),
            face: support.face.into(),
            frame: attachment.frame.into(),
            kind: match support.tag.kind {
                SurfaceKind::Skin => 0,
                SurfaceKind::Fur => 1,
                SurfaceKind::Stone => 2,
            },
            ledge: support.tag.ledge,
            user: support.tag.user,
        }
    }
}

impl From<Held> for Support {
    fn from(held: Held) -> Self {
        Self {
            attachment: Attachment {
                obstacle: ObstacleId(held.obstacle),
                material: MaterialPoint {
                    key: held.key,
                    coordinates: DVec3::from(held.coordinates).to_array(),
                },
                point: held.contact.into(),
                offset: held.offset.into(),
                frame: held.frame.into(),
            },
            normal: held.normal.into(),
            face: held.face.into(),
            tag: SurfaceTag {
                kind: match held.kind {
                    1 => SurfaceKind::Fur,
                    2 => SurfaceKind::Stone,
                    _ => SurfaceKind::Skin,
                },
                ledge: held.ledge,
                user: held.user,
            },
        }
    }
}

impl State {
    /// Converts the message to a climber's state; `Err` is the number of a mode that this version does not know.
    pub(crate) fn to_climber(self) -> Result<ClimberState, u32> {
        let mode = ClimberMode::from_number(self.mode);
        Ok(ClimberState {
            position: self.position.into(),
            velocity: self.velocity.into(),
            heading: self.heading.into(),
            mode: mode.ok_or(self.mode)?,
            support: self.support.map(Support::from),
            support_velocity: self.support_velocity.map(DVec3::from),
            shake: self.shake.into(),
            stamina: self.stamina,
            hit_points: self.hit_points,
            hanging: HangingMemory {
                arm: self.arm,
                calm: self.calm,
                legs: self.legs.into(),
            },
            ledge_hanging: LedgeHangingMemory {
                pull_up: self.pull_up,
                blocked: self.blocked,
                gave_up: self.gave_up,
                returns: self.returns,
                right: self.right.into(),
            },
            tumbling: TumblingMemory {
                still: self.still,
                down: self.down,
            },
            coyote: self.coyote,
            jump_buffer: self.jump_buffer,
            open_handed: self.open_handed,
            crouched: self.crouched,
            crushed: self.crushed,
            base_velocity: self.base_velocity.into(),
            own_way: self.own_way.into(),
            flying: FlyingMemory {
                jumping: self.jumping,
            },
            standing: StandingMemory {
                shoved: self.shoved,
            },
            untouched: self.untouched,
            load: self.load,
            holding: self
                .held_stick
                .map_or(HoldingMemory::default(), |held| HoldingMemory {
                    stick: held.stick.into(),
                    along: held.along.into(),
                    normal: held.normal.into(),
                }),
            memory: self.memory.into(),
        })
    }
}

impl From<&StepReport> for Report {
    fn from(report: &StepReport) -> Self {
        let impulse: DVec3 = report.pushes.iter().map(|push| push.impulse).sum();
        Self {
            pushed_out: report.pushed_out.into(),
            penetration: report.penetration,
            rounds: report.rounds,
            is_clear: report.is_clear,
            impulse: impulse.into(),
            pushes: u32::try_from(report.pushes.len()).unwrap_or(u32::MAX),
        }
    }
}

impl From<Diagnostics> for Touched {
    fn from(touched: Diagnostics) -> Self {
        Self {
            bounds_evaluated: touched.bounds_evaluated as u64,
            clusters_touched: touched.clusters_touched as u64,
            clusters_skinned: touched.clusters_skinned as u64,
            clusters: touched.clusters as u64,
            vertices_skinned: touched.vertices_skinned as u64,
            vertices: touched.vertices as u64,
            triangles_tested: touched.triangles_tested,
            most_sweep_steps: touched.most_cast_steps,
        }
    }
}

#[cfg(test)]
mod tests;
