use glam::DVec3;

use super::ClimberState;

impl ClimberState {
    /// A 64-bit hash of the state, for comparing runs: FNV-1a over the bits of its fields, except the support's tag.
    /// Not for hash tables.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fnv::default();
        for v in self.vectors() {
            hash.vector(v);
        }
        hash.word(u64::from(self.mode.number()));
        if let Some(support) = &self.support {
            let attachment = &support.attachment;
            hash.word(attachment.obstacle.0);
            hash.word(attachment.material.key);
            hash.vector(DVec3::from_array(attachment.material.coordinates));
            hash.vector(attachment.point);
            hash.vector(attachment.offset);
            hash.vector(support.normal);
            hash.vector(support.face);
            for x in attachment.frame.to_array() {
                hash.word(x.to_bits());
            }
        }
        if let Some(velocity) = self.support_velocity {
            hash.vector(velocity);
        }
        for x in self.numbers() {
            hash.word(x.to_bits());
        }
        for x in self.memory {
            hash.word(x.to_bits());
        }
        let flags = [
            self.crouched,
            self.flying.jumping,
            self.standing.shoved,
            self.crushed,
            self.ledge_hanging.gave_up,
            self.ledge_hanging.returns,
        ];
        let flags = flags.iter().rev();
        hash.word(flags.fold(0, |word, flag| word << 1 | u64::from(*flag)));
        hash.0
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
