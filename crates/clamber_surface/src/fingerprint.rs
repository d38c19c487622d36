/// A 64-bit hash for comparing runs, peers and files: equal data have equal hashes, on every platform.
///
/// If any bit of the data differs, the hash differs too, in all likelihood. It is not for hash tables, and does
/// not protect against an attacker that looks for two inputs with the same hash.
///
/// Each word is folded by a rotation, an exclusive or and a multiplication, as in rustc's `FxHasher`. Two folds take
/// turns, since within a fold each multiplication waits for the one before it.
///
/// ```
/// use clamber_surface::Fingerprint;
///
/// let mut hash = Fingerprint::default();
/// hash.text("walk");
/// hash.numbers([1.5, -2.0]);
/// assert_ne!(hash.value(), Fingerprint::default().value());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Fingerprint([u64; 2]);

/// 2^64 divided by the golden ratio: an odd number with well spread bits.
const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;

impl Default for Fingerprint {
    /// The hash of nothing.
    fn default() -> Self {
        Self::new(0)
    }
}

impl Fingerprint {
    /// The hash of nothing, for one of 2^64 purposes: equal data that start from different seeds have different hashes.
    pub fn new(seed: u64) -> Self {
        // Not 0 for the usual seeds, because a word of 0 leaves a fold at 0.
        Self([seed ^ FACTOR, !seed])
    }

    /// Adds 64 bits.
    #[inline]
    pub fn word(&mut self, word: u64) {
        let [turn, other] = self.0;
        self.0 = [other, fold(turn, word)];
    }

    /// Adds the bits of numbers. Their count is not added.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.word(number.to_bits());
        }
    }

    /// Adds the bits of single-precision numbers, two at a time. Their count is not added.
    pub fn floats(&mut self, numbers: &[f32]) {
        let mut pairs = numbers.chunks_exact(2);
        for pair in &mut pairs {
            self.word(u64::from(pair[0].to_bits()) << 32 | u64::from(pair[1].to_bits()));
        }
        if let [last] = pairs.remainder() {
            self.word(u64::from(last.to_bits()));
        }
    }

    /// Adds bytes, eight at a time. Their count is not added.
    #[inline]
    pub fn bytes(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks();
        for word in words {
            self.word(u64::from_le_bytes(*word));
        }
        if !rest.is_empty() {
            // Not a copy into an array, which would call `memcpy` for each number of a serialised state.
            let last = rest.iter().rev();
            self.word(last.fold(0, |word, byte| word << 8 | u64::from(*byte)));
        }
    }

    /// Adds a text and its length.
    pub fn text(&mut self, text: &str) {
        self.word(text.len() as u64);
        self.bytes(text.as_bytes());
    }

    /// The hash of all that was added.
    pub fn value(self) -> u64 {
        fold(self.0[0], self.0[1])
    }
}

fn fold(hash: u64, word: u64) -> u64 {
    (hash.rotate_left(5) ^ word).wrapping_mul(FACTOR)
}

#[cfg(test)]
mod tests {
    use super::Fingerprint;

    fn hash(add: impl FnOnce(&mut Fingerprint)) -> u64 {
        let mut hash = Fingerprint::default();
        add(&mut hash);
        hash.value()
    }

    #[test]
    fn order_count_and_every_bit_count() {
        let words = |words: &[u64]| hash(|hash| words.iter().for_each(|word| hash.word(*word)));
        let mut seen = vec![words(&[]), words(&[0]), words(&[0, 0]), words(&[0, 0, 0])];
        seen.extend([
            words(&[1, 2]),
            words(&[2, 1]),
            words(&[1, 2, 3]),
            words(&[3, 2, 1]),
        ]);
        seen.extend((0..64).map(|bit| words(&[7, 1 << bit, 9])));
        seen.push(hash(|hash| hash.text("ab")));
        seen.push(hash(|hash| {
            hash.text("a");
            hash.text("b");
        }));
        // 0.0 is the word 0.
        seen.push(hash(|hash| hash.numbers([-0.0])));
        let all = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), all);
    }

    #[test]
    fn bytes_are_the_same_as_their_words() {
        let all: [u8; 24] = std::array::from_fn(|index| 0xa1 + index as u8);
        for length in 0..=all.len() {
            let bytes = &all[..length];
            let found = hash(|hash| hash.bytes(bytes));
            // The last word is filled up with zeros.
            let mut filled = [0; 24];
            filled[..length].copy_from_slice(bytes);
            let words = hash(|hash| {
                for word in filled.chunks(8).take(length.div_ceil(8)) {
                    hash.word(u64::from_le_bytes(word.try_into().unwrap()));
                }
            });
            assert_eq!(found, words, "{length}");
        }
    }

    /// Hashes are stored in files, so they must not change.
    #[test]
    fn the_definition_stays() {
        let found = hash(|hash| {
            hash.text("clamber");
            hash.numbers([1.5]);
            hash.floats(&[0.25, 2.0, -1.0]);
        });
        assert_eq!(format!("{found:016x}"), "d53d3232390e4d0d");
    }
}
