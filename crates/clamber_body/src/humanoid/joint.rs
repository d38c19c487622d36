use std::fmt;

/// A side of the body, as the body itself sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The body's left.
    Left,
    /// The body's right.
    Right,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 0 for left, 1 for right: the index into a pair such as [`Humanoid::arms`](crate::Humanoid::arms).
    pub fn index(self) -> usize {
        self as usize
    }
}

/// A joint of a human body, named as in VRM (VRMC_vrm-1.0, humanoid).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum HumanJoint {
    /// The joint that carries the spine and both legs.
    Hips,
    /// The last joint of the spine: it carries both arms.
    Chest,
    /// The first joint above the chest.
    Neck,
    /// The head.
    Head,
    /// A collar bone.
    Shoulder(Side),
    /// An upper arm.
    UpperArm(Side),
    /// A forearm.
    LowerArm(Side),
    /// A hand.
    Hand(Side),
    /// A thigh.
    UpperLeg(Side),
    /// A shin.
    LowerLeg(Side),
    /// A foot.
    Foot(Side),
    /// The toes.
    Toes(Side),
}

impl fmt::Display for HumanJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, side) = match self {
            Self::Hips => ("hips", None),
            Self::Chest => ("chest", None),
            Self::Neck => ("neck", None),
            Self::Head => ("head", None),
            Self::Shoulder(side) => ("shoulder", Some(side)),
            Self::UpperArm(side) => ("upper arm", Some(side)),
            Self::LowerArm(side) => ("lower arm", Some(side)),
            Self::Hand(side) => ("hand", Some(side)),
            Self::UpperLeg(side) => ("upper leg", Some(side)),
            Self::LowerLeg(side) => ("lower leg", Some(side)),
            Self::Foot(side) => ("foot", Some(side)),
            Self::Toes(side) => ("toes", Some(side)),
        };
        match side {
            None => f.write_str(name),
            Some(Side::Left) => write!(f, "left {name}"),
            Some(Side::Right) => write!(f, "right {name}"),
        }
    }
}
