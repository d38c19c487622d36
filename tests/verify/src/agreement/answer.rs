use glam::Vec3;

/// One row of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found {
    /// The query found a hit, and returns no details.
    Any,
    /// A point of the surface.
    Hit(Hit),
    /// The first contact of a moving capsule with a triangle.
    Contact {
        /// The surface's point at that time, and its distance from the segment.
        hit: Hit,
        /// Fraction of the motion until the contact, from 0 to 1.
        fraction: f64,
        /// Unit vector from the surface's point to the segment.
        separation_normal: Vec3,
        /// True if capsule and triangle overlap at the start.
        started_inside: bool,
        /// True if the distance could not be certified.
        undecided: bool,
    },
    /// A triangle in motion.
    Triangle {
        /// The triangle's id.
        triangle: u32,
        /// The triangle's corners a tick ago, in the current model frame.
        previous: [Vec3; 3],
        /// The triangle's corners now.
        current: [Vec3; 3],
    },
}

/// A point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The mesh that the hit names, as any number that differs between meshes.
    pub mesh: u64,
    /// The triangle's id.
    pub triangle: u32,
    /// The part that the triangle belongs to.
    pub part: u32,
    /// The triangle's tag, as any number that differs between tags.
    pub tag: u64,
    /// Weights of the triangle's corners.
    pub barycentric: [f32; 3],
    /// The point.
    pub point: Vec3,
    /// The surface's unit normal.
    pub normal: Vec3,
    /// Distance from the ray's origin, the query's point or the capsule's segment.
    pub distance: f64,
}

/// Largest difference from 1 of the sum of a valid hit's weights, and of the length of a normal. Both are rounded to
/// f32, so a much smaller value rejects valid hits.
const ROUNDED: f64 = 1e-6;

impl Found {
    /// The surface's point, if this row has one.
    pub fn hit(&self) -> Option<&Hit> {
        match self {
            Self::Hit(hit) | Self::Contact { hit, .. } => Some(hit),
            Self::Any | Self::Triangle { .. } => None,
        }
    }

    /// True for a contact that could not be decided.
    pub fn is_undecided(&self) -> bool {
        matches!(
            self,
            Self::Contact {
                undecided: true,
                ..
            }
        )
    }

    /// Name of a field whose value no valid answer has: weights that are negative or do not add up to 1, a coordinate
    /// or distance that is not finite, a normal whose length is not 1, a negative distance, a fraction outside 0..=1, a
    /// fraction other than 0 of a contact that started inside. `None` if the row is valid.
    pub fn fault(&self) -> Option<&'static str> {
        let own = match self {
            Self::Any | Self::Hit(_) => None,
            Self::Contact {
                fraction,
                separation_normal,
                started_inside,
                ..
            } => {
                let sound = (0.0..=1.0).contains(fraction) && (!started_inside || *fraction == 0.0);
                let fraction = (!sound).then_some("fraction");
                fraction.or((!is_unit(*separation_normal)).then_some("separation_normal"))
            }
            Self::Triangle {
                previous, current, ..
            } => {
                let finite = |corners: &[Vec3; 3]| corners.iter().all(|corner| corner.is_finite());
                (!finite(previous) || !finite(current)).then_some("corners")
            }
        };
        own.or_else(|| self.hit().and_then(Hit::fault))
    }

    /// The first field in which two rows differ in any bit.
    pub(super) fn difference(&self, other: &Self) -> Option<&'static str> {
        let (ours, theirs) = (self.bits(), other.bits());
        let differs = ours.0.iter().zip(&theirs.0).find(|(a, b)| a != b);
        differs.map(|((field, _), _)| *field)
    }

    /// The bits of every number, each with its field: unlike with `==`, -0 differs from 0, and NaN equals itself.
    fn bits(&self) -> Bits {
        let mut bits = Bits::default();
        match self {
            Self::Any => bits.push("kind", [1]),
            Self::Hit(hit) => {
                bits.push("kind", [2]);
                hit.bits(&mut bits);
            }
            Self::Contact {
                hit,
                fraction,
                separation_normal,
                started_inside,
                undecided,
            } => {
                bits.push("kind", [4]);
                bits.push("fraction", [fraction.to_bits()]);
                hit.bits(&mut bits);
                bits.floats("separation_normal", separation_normal.to_array());
                bits.push("started_inside", [(*started_inside).into()]);
                bits.push("undecided", [(*undecided).into()]);
            }
            Self::Triangle {
                triangle,
                previous,
                current,
            } => {
                bits.push("kind", [5]);
                bits.push("triangle", [(*triangle).into()]);
                for (field, corners) in [("previous", previous), ("current", current)] {
                    for corner in corners {
                        bits.floats(field, corner.to_array());
                    }
                }
            }
        }
        bits
    }
}

/// The numbers of a row as bits, each with its field, and how many there are. The longest row has 21.
struct Bits([(&'static str, u64); 21], usize);

impl Default for Bits {
    fn default() -> Self {
        Self([("kind", 0); 21], 0)
    }
}

impl Bits {
    fn push<const N: usize>(&mut self, field: &'static str, numbers: [u64; N]) {
        for number in numbers {
            self.0[self.1] = (field, number);
            self.1 += 1;
        }
    }

    fn floats<const N: usize>(&mut self, field: &'static str, numbers: [f32; N]) {
        self.push(field, numbers.map(|number| number.to_bits().into()));
    }
}

impl Hit {
    fn fault(&self) -> Option<&'static str> {
        let [u, v, w] = self.barycentric.map(f64::from);
        let weights = u.min(v).min(w) >= 0.0 && (u + v + w - 1.0).abs() < ROUNDED;
        let checks = [
            ("barycentric", weights),
            ("point", self.point.is_finite()),
            ("normal", is_unit(self.normal)),
            (
                "distance",
                self.distance >= 0.0 && self.distance.is_finite(),
            ),
        ];
        let wrong = checks.into_iter().find(|(_, sound)| !sound);
        wrong.map(|(field, _)| field)
    }

    fn bits(&self, bits: &mut Bits) {
        bits.push("mesh", [self.mesh]);
        bits.push("triangle", [self.triangle.into()]);
        bits.push("part", [self.part.into()]);
        bits.push("tag", [self.tag]);
        bits.floats("barycentric", self.barycentric);
        bits.floats("point", self.point.to_array());
        bits.floats("normal", self.normal.to_array());
        bits.push("distance", [self.distance.to_bits()]);
    }
}

fn is_unit(normal: Vec3) -> bool {
    (normal.as_dvec3().length() - 1.0).abs() < ROUNDED
}
