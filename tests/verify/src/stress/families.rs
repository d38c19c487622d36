//! The families from which a case is made, with their names.

use core::fmt;
use core::str::FromStr;

/// An enum whose values have names, for command lines and reports.
macro_rules! named {
    ($(#[$about:meta])* $name:ident { $($(#[$what:meta])* $value:ident = $text:literal),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $($(#[$what])* $value),* }

        impl $name {
            /// All values.
            pub const ALL: &'static [Self] = &[$(Self::$value),*];

            /// The name on command lines and in reports.
            pub fn name(self) -> &'static str {
                match self { $(Self::$value => $text),* }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.name())
            }
        }

        impl FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                let known = Self::ALL.iter().map(|value| value.name());
                let names: Vec<_> = known.collect();
                let found = names.iter().position(|name| *name == text);
                found.map(|index| Self::ALL[index]).ok_or_else(|| {
                    format!("{text:?} is none of {}", names.join(", "))
                })
            }
        }
    };
}

named! {
    /// The mesh of a case.
    MeshFamily {
        /// A closed ball. Up to six joints influence each vertex.
        Ball = "ball",
        /// A closed tube along a chain of twelve joints.
        Limb = "limb",
        /// A closed ball on a single joint.
        OneJoint = "one-joint",
        /// A closed tube along a chain of a thousand joints.
        Chain = "chain",
        /// A closed tube along twelve joints. The middle joint has all weights.
        AllOnOne = "all-on-one",
        /// A closed tube with rings in close pairs. The edge lengths differ by a factor of up to a million.
        SliverTube = "sliver-tube",
        /// Loose triangles, each up to a million times as long as it is wide.
        Slivers = "slivers",
        /// A ball with additional triangles: duplicates, flipped ones, duplicates that follow other joints, and
        /// triangles without area.
        Copies = "copies",
        /// A closed ball with some vertices at a hundred to ten thousand times the radius.
        Spikes = "spikes",
        /// A ball with vertices in the middle of edges. Only the triangle on one side of the edge is cut there.
        TJunctions = "t-junctions",
    }
}

named! {
    /// The poses of a case. In all families but `Rest` the joints turn as well; on a chain the turns add up.
    PoseFamily {
        /// No joint moves.
        Rest = "rest",
        /// The joints only turn.
        Bent = "bent",
        /// Some joints collapse all their vertices to one point.
        Collapsed = "collapsed",
        /// Some or all joints mirror.
        Mirrored = "mirrored",
        /// Some joints reflect in a point: their skin is turned inside out, and pinched where the joints' influence
        /// ends.
        InsideOut = "inside-out",
        /// Some or all joints flatten their vertices onto a plane or a line.
        Flat = "flat",
        /// Some joints scale by 1e-4 to 1e4, next to joints that do not.
        Scaled = "scaled",
        /// Some joints' matrices have subnormal elements.
        Denormal = "denormal",
        /// Some joints jump by many lengths of the creature from tick to tick.
        Flung = "flung",
    }
}

named! {
    /// The creature's place in the world, and its size. In all places but `Home` the creature moves and turns from tick
    /// to tick.
    Place {
        /// A creature of 1 to 50 m that stays at the origin.
        Home = "home",
        /// A creature of 1 to 50 m that starts up to 100 m from the origin.
        Near = "near",
        /// A creature of 1 to 50 m that starts 100 km from the origin.
        Far = "far",
        /// A creature of 1 cm that starts 1 m to 100 km from the origin.
        Tiny = "tiny",
        /// A creature of 1 km that starts 1 m to 100 km from the origin.
        Vast = "vast",
    }
}

impl MeshFamily {
    /// True for meshes without a border: no ray passes through the skin of such a mesh without a hit.
    pub fn is_closed(self) -> bool {
        !matches!(self, Self::Slivers | Self::Copies | Self::TJunctions)
    }
}
