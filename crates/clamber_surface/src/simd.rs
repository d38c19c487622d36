//! Instruction sets for the fast paths, selected at run time.

use std::fmt;

use fearless_simd::Level;

/// A SIMD instruction set that this machine supports. All of them give the same bits; only speed differs.
///
/// ```
/// use clamber_surface::SimdLevel;
///
/// let levels = SimdLevel::available();
/// assert_eq!(levels[0], SimdLevel::best());
/// ```
#[derive(Clone, Copy)]
pub struct SimdLevel(Level);

impl SimdLevel {
    /// The widest instruction set of this machine.
    pub fn best() -> Self {
        Self(Level::new())
    }

    /// All instruction sets of this machine, the widest first. Scalar code comes last; it is listed only if the
    /// machine has no other, or with the feature `scalar`.
    pub fn available() -> Vec<Self> {
        let best = Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let simd = [
            best.as_avx512().map(Level::Avx512),
            best.as_avx2().map(Level::Avx2),
            best.as_sse4_2().map(Level::Sse4_2),
            best.as_sse2().map(Level::Sse2),
        ]
        .into_iter()
        .flatten();
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let simd = Some(best).filter(|level| !level.is_fallback());
        #[cfg(feature = "scalar")]
        let scalar = Some(Level::fallback());
        #[cfg(not(feature = "scalar"))]
        let scalar = Some(best).filter(|level| level.is_fallback());
        simd.into_iter().chain(scalar).map(Self).collect()
    }

    /// The common name, such as `"AVX2"`; `"scalar"` for scalar code.
    pub fn name(&self) -> &'static str {
        match self.0 {
            level if level.is_fallback() => "scalar",
            #[cfg(target_arch = "aarch64")]
            Level::Neon(_) => "NEON",
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Level::WasmSimd128(_) => "WASM SIMD",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse2(_) => "SSE2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Sse4_2(_) => "SSE4.2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(_) => "AVX2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx512(_) => "AVX-512",
            _ => "unknown",
        }
    }

    pub(crate) fn level(self) -> Level {
        self.0
    }
}

impl PartialEq for SimdLevel {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for SimdLevel {}

impl Default for SimdLevel {
    fn default() -> Self {
        Self::best()
    }
}

impl fmt::Debug for SimdLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for SimdLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(all(test, feature = "scalar"))]
mod tests {
    use super::SimdLevel;

    #[test]
    fn scalar_code_is_the_last_level() {
        let levels = SimdLevel::available();
        assert_eq!(levels.last().map(SimdLevel::name), Some("scalar"));
    }
}
