//! clamber's own messages. Their schemas come from foxglove's `Encode`, and they are read by prost: field
//! numbers follow the order of the fields in both.

use clamber_climber::{ClimberInput, ClimberMode, ClimberState, Footing};
use clamber_surface::surface::Diagnostics;
use clamber_world::{MaterialPoint, ObstacleId};
use foxglove::Encode;
use glam::{DQuat, DVec3};

/// In world space unless it is said otherwise.
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

/// What the climber was asked for.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Input {
    #[prost(message, required, tag = "1")]
    pub(crate) walk: Vector,
    #[prost(bool, tag = "2")]
    pub(crate) jump: bool,
}

/// What it stands on.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Ground {
    #[prost(uint32, tag = "1")]
    pub(crate) obstacle: u32,
    #[prost(uint64, tag = "2")]
    pub(crate) key: u64,
    #[prost(message, required, tag = "3")]
    pub(crate) coordinates: Vector,
    #[prost(message, required, tag = "4")]
    pub(crate) contact: Vector,
    #[prost(message, required, tag = "5")]
    pub(crate) offset: Vector,
    #[prost(message, required, tag = "6")]
    pub(crate) frame: Rotation,
}

/// Everything that a climber remembers.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct State {
    #[prost(message, required, tag = "1")]
    pub(crate) position: Vector,
    #[prost(message, required, tag = "2")]
    pub(crate) velocity: Vector,
    #[prost(message, required, tag = "3")]
    pub(crate) heading: Vector,
    /// 0 falling, 1 standing.
    #[prost(uint32, tag = "4")]
    pub(crate) mode: u32,
    #[prost(message, optional, tag = "5")]
    pub(crate) footing: Option<Ground>,
}

/// How contacts pushed.
#[derive(Clone, Copy, PartialEq, Encode, prost::Message)]
pub(crate) struct Push {
    #[prost(message, required, tag = "1")]
    pub(crate) displacement: Vector,
    #[prost(uint32, tag = "2")]
    pub(crate) contacts: u32,
    #[prost(double, tag = "3")]
    pub(crate) deepest: f64,
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
    pub(crate) push_out: Push,
    #[prost(uint64, tag = "5")]
    pub(crate) state_fingerprint: u64,
    #[prost(uint64, tag = "6")]
    pub(crate) palette_fingerprint: u64,
    #[prost(uint64, tag = "7")]
    pub(crate) scene_fingerprint: u64,
}

/// What the scene needs to go on from a tick, in its own words.
#[derive(Clone, PartialEq, Encode, prost::Message)]
pub(crate) struct Snapshot {
    #[prost(uint64, tag = "1")]
    pub(crate) tick: u64,
    #[prost(string, tag = "2")]
    pub(crate) scene: String,
}

/// What the queries of a tick touched.
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
    /// Appends the message. prost writes it three times as fast as foxglove, but leaves out numbers that
    /// equal zero, and the sign of a negative zero with them: where there is one, foxglove writes.
    pub(crate) fn write(&self, buffer: &mut Vec<u8>) -> Result<(), String> {
        if self.has_negative_zero() {
            Encode::encode(self, buffer).map_err(|error| error.to_string())
        } else {
            prost::Message::encode(self, buffer).map_err(|error| error.to_string())
        }
    }

    fn has_negative_zero(&self) -> bool {
        let state = &self.state;
        let vectors = [
            self.input.walk,
            state.position,
            state.velocity,
            state.heading,
            self.push_out.displacement,
        ];
        let of_footing = state.footing.is_some_and(|ground| {
            let turn = ground.frame;
            let vectors = [ground.coordinates, ground.contact, ground.offset];
            vectors.iter().any(Vector::has_negative_zero)
                || [turn.x, turn.y, turn.z, turn.w].iter().any(negative_zero)
        });
        of_footing
            || vectors.iter().any(Vector::has_negative_zero)
            || negative_zero(&self.push_out.deepest)
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

impl From<&ClimberInput> for Input {
    fn from(input: &ClimberInput) -> Self {
        Self {
            walk: input.walk.into(),
            jump: input.jump,
        }
    }
}

impl From<Input> for ClimberInput {
    fn from(input: Input) -> Self {
        Self {
            walk: input.walk.into(),
            jump: input.jump,
        }
    }
}

impl From<&ClimberState> for State {
    fn from(state: &ClimberState) -> Self {
        Self {
            position: state.position.into(),
            velocity: state.velocity.into(),
            heading: state.heading.into(),
            mode: match state.mode {
                ClimberMode::Falling => 0,
                ClimberMode::Standing => 1,
            },
            footing: state.footing.map(|footing| Ground {
                obstacle: footing.obstacle.0,
                key: footing.point.key,
                coordinates: DVec3::from_array(footing.point.coordinates).into(),
                contact: footing.contact.into(),
                offset: footing.offset.into(),
                frame: footing.frame.into(),
            }),
        }
    }
}

impl State {
    /// `Err` with the mode if it is none that this version knows.
    pub(crate) fn to_climber(self) -> Result<ClimberState, u32> {
        Ok(ClimberState {
            position: self.position.into(),
            velocity: self.velocity.into(),
            heading: self.heading.into(),
            mode: match self.mode {
                0 => ClimberMode::Falling,
                1 => ClimberMode::Standing,
                other => return Err(other),
            },
            footing: self.footing.map(|ground| Footing {
                obstacle: ObstacleId(ground.obstacle),
                point: MaterialPoint {
                    key: ground.key,
                    coordinates: DVec3::from(ground.coordinates).to_array(),
                },
                contact: ground.contact.into(),
                offset: ground.offset.into(),
                frame: DQuat::from_xyzw(
                    ground.frame.x,
                    ground.frame.y,
                    ground.frame.z,
                    ground.frame.w,
                ),
            }),
        })
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
            most_sweep_steps: touched.most_sweep_steps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_climber::{Climber, ClimberConfig};
    use prost::Message;

    #[test]
    fn every_bit_of_a_number_survives_a_negative_zero_and_the_smallest_too() {
        let state = ClimberState {
            velocity: DVec3::new(-0.0, f64::from_bits(1), -f64::MAX),
            ..*Climber::new(ClimberConfig::default(), DVec3::ZERO)
                .unwrap()
                .state()
        };
        for walk in [
            DVec3::new(-0.0, 0.0, 1.0),
            DVec3::new(0.0, -0.0, -f64::MIN_POSITIVE),
            DVec3::ZERO,
        ] {
            for state in [
                state,
                ClimberState {
                    velocity: DVec3::ZERO,
                    ..state
                },
            ] {
                let push_out = Push::default();
                let message = Tick {
                    input: Input {
                        walk: walk.into(),
                        jump: true,
                    },
                    state: (&state).into(),
                    push_out,
                    ..Tick::default()
                };
                let mut buffer = Vec::new();
                message.write(&mut buffer).unwrap();
                let read = Tick::decode(&buffer[..]).unwrap();
                let bits = |v: Vector| [v.x, v.y, v.z].map(f64::to_bits);
                assert_eq!(bits(read.input.walk), bits(message.input.walk), "{walk}");
                let restored = read.state.to_climber().unwrap();
                assert_eq!(restored.fingerprint(), state.fingerprint(), "{state:?}");
            }
        }
    }
}
