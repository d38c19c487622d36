//! The names of what a case is made of.

use core::fmt;
use core::str::FromStr;

/// An enum whose values have names, for command lines and reports.
macro_rules! named {
    ($(#[$about:meta])* $name:ident { $($(#[$what:meta])* $value:ident = $text:literal),* $(,)? }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name { $($(#[$what])* $value),* }

        impl $name {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$value),*];

            /// As on command lines and in reports.
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
    /// What is skinned.
    MeshFamily {
        /// A closed ball, every vertex moved by up to six joints.
        Ball = "ball",
        /// A closed tube along a chain of twelve joints.
        Limb = "limb",
        /// A closed ball of a single joint.
        OneJoint = "one-joint",
        /// A closed tube along a chain of a thousand joints.
        Chain = "chain",
        /// A limb of which one joint has all weights.
        AllOnOne = "all-on-one",
        /// A closed tube whose rings stand by turns far apart and next to each other: edges in a ratio of up to a
        /// million.
        SliverTube = "sliver-tube",
        /// Loose triangles, each up to a million times as long as it is wide.
        Slivers = "slivers",
        /// A ball with triangles doubled, flipped, moved by other joints than their doubles, and without area.
        Copies = "copies",
        /// A closed ball of which some vertices stand a hundred to ten thousand radii out.
        Spikes = "spikes",
        /// A ball with vertices in the middle of edges that only one of the edge's two triangles knows.
        TJunctions = "t-junctions",
    }
}

named! {
    /// What the joints do.
    PoseFamily {
        /// Nothing.
        Rest = "rest",
        /// They turn, each a little more than the one before.
        Bent = "bent",
        /// Some of them take all that they move to one point.
        Collapsed = "collapsed",
        /// Some or all mirror.
        Mirrored = "mirrored",
        /// Some reflect in a point: what they move is turned inside out, and pinched at the ends.
        InsideOut = "inside-out",
        /// Some take all that they move into a plane or onto a line.
        Flat = "flat",
        /// Some scale by 1e-4 to 1e4, beside others that do not.
        Scaled = "scaled",
        /// Some of their elements are too small for normal numbers.
        Denormal = "denormal",
        /// They jump by many lengths of the creature from tick to tick.
        Flung = "flung",
    }
}

named! {
    /// Where in the world the creature stands, and how large it is there.
    Place {
        /// At the origin, and stays; 1 to 50 m.
        Home = "home",
        /// On its way, up to a hundred metres from the origin; 1 to 50 m.
        Near = "near",
        /// On its way, 100 km from the origin; 1 to 50 m.
        Far = "far",
        /// A creature of 1 cm, anywhere up to 100 km.
        Tiny = "tiny",
        /// A creature of 1 km, anywhere up to 100 km.
        Vast = "vast",
    }
}

impl MeshFamily {
    /// True for meshes without a border: no ray leaves them.
    pub fn is_closed(self) -> bool {
        !matches!(self, Self::Slivers | Self::Copies | Self::TJunctions)
    }
}
