use clamber_world::Fingerprint;

use super::ClimberState;

impl ClimberState {
    /// A hash of the bits of the state's fields, except the support's tag, for comparing runs.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fingerprint::default();
        for v in self.vectors() {
            hash.numbers(v.to_array());
        }
        hash.word(u64::from(self.mode.number()));
        if let Some(support) = &self.support {
            let attachment = &support.attachment;
            hash.word(attachment.obstacle.0);
            hash.word(attachment.material.key);
            hash.numbers(attachment.material.coordinates);
            hash.numbers(attachment.point.to_array());
            hash.numbers(attachment.offset.to_array());
            hash.numbers(support.normal.to_array());
            hash.numbers(support.face.to_array());
            hash.numbers(attachment.frame.to_array());
        }
        if let Some(velocity) = self.support_velocity {
            hash.numbers(velocity.to_array());
        }
        hash.numbers(self.numbers());
        hash.numbers(self.custom_slots);
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
        hash.value()
    }
}
