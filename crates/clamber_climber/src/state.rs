use clamber_world::{MaterialPoint, ObstacleId};
use glam::{DQuat, DVec3};

/// What a climber is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ClimberMode {
    /// On its feet, carried by what it stands on.
    Standing,
    /// In the air, or sliding down what is too steep to stand on.
    Falling,
}

/// What a standing climber stands on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footing {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The material point under the climber. Changes only when the climber lands or walks.
    pub point: MaterialPoint,
    /// Where the climber's sphere touches it, in world space, after the last step.
    pub contact: DVec3,
    /// From the point to the climber's centre, one radius long, in the frame of the material: it
    /// turns with what it stands on.
    pub offset: DVec3,
    /// The frame of the material as last known: where the skin collapses, it stands.
    pub frame: DQuat,
}

/// Everything a climber remembers between ticks: a small plain value. Restored, it continues with
/// the same bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClimberState {
    /// Centre of the sphere, in world space.
    pub position: DVec3,
    /// In world space, metres a second: of the last tick while standing.
    pub velocity: DVec3,
    /// Unit vector, perpendicular to up: where the climber faces.
    pub heading: DVec3,
    /// What it is doing.
    pub mode: ClimberMode,
    /// Under its feet; `Some` if and only if it is standing.
    pub footing: Option<Footing>,
}

impl ClimberState {
    /// A number that differs, in all likelihood, if any bit of the state does: 64-bit FNV-1a over
    /// its fields. For comparing runs, not for hash tables.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fnv::default();
        hash.vector(self.position);
        hash.vector(self.velocity);
        hash.vector(self.heading);
        hash.word(match self.mode {
            ClimberMode::Standing => 1,
            ClimberMode::Falling => 2,
        });
        if let Some(footing) = &self.footing {
            hash.word(u64::from(footing.obstacle.0));
            hash.word(footing.point.key);
            hash.vector(DVec3::from_array(footing.point.coordinates));
            hash.vector(footing.contact);
            hash.vector(footing.offset);
            for x in footing.frame.to_array() {
                hash.word(x.to_bits());
            }
        }
        hash.0
    }

    pub(crate) fn is_finite(&self) -> bool {
        let footing = self.footing.is_none_or(|footing| {
            footing.contact.is_finite()
                && footing.offset.is_finite()
                && footing.frame.is_finite()
                && footing.point.coordinates.iter().all(|x| x.is_finite())
        });
        self.position.is_finite()
            && self.velocity.is_finite()
            && self.heading.is_finite()
            && footing
    }
}

/// FNV-1a with 64 bits (Fowler, Noll, Vo).
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    fn vector(&mut self, v: DVec3) {
        for x in v.to_array() {
            self.word(x.to_bits());
        }
    }
}
