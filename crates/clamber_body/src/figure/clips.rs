//! The clips of a figure, found by the names that the project's hero uses.

use clamber_animation::{AnimationSet, ClipId};

/// A motion of a body. [`Figure::new`](crate::Figure::new) looks for its clip under [`BodyClip::name`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BodyClip {
    /// Stands still. A figure needs no other clip than this one.
    Idle,
    /// Walks ahead. The clips from this one to [`BodyClip::StrafeRight`] are loops that start when the left foot comes
    /// down.
    Walk,
    /// Runs ahead.
    Run,
    /// Walks backwards.
    WalkBack,
    /// Walks to the left.
    StrafeLeft,
    /// Walks to the right.
    StrafeRight,
    /// Takes off.
    Jump,
    /// Falls.
    Fall,
    /// Is knocked over, and moves through the air.
    Tumble,
    /// Lies on the ground.
    Lie,
    /// Gets up from lying to standing.
    GetUp,
    /// Falls down dead.
    Die,
    /// Is crushed: obstacles leave too little room.
    Crushed,
    /// Stands under a low ceiling.
    Crouch,
    /// Holds on to a wall with hands and feet.
    Climb,
    /// Hangs by both hands.
    Hang,
    /// Hangs from a ledge.
    Ledge,
    /// Pulls itself up from the ledge, to standing on it.
    Mantle,
}

impl BodyClip {
    /// All motions, in the order of the variants.
    pub const ALL: [Self; 18] = [
        Self::Idle,
        Self::Walk,
        Self::Run,
        Self::WalkBack,
        Self::StrafeLeft,
        Self::StrafeRight,
        Self::Jump,
        Self::Fall,
        Self::Tumble,
        Self::Lie,
        Self::GetUp,
        Self::Die,
        Self::Crushed,
        Self::Crouch,
        Self::Climb,
        Self::Hang,
        Self::Ledge,
        Self::Mantle,
    ];

    /// The name of the clip, such as `walk_back`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Idle => "idle",
            Self::Walk => "walk",
            Self::Run => "run",
            Self::WalkBack => "walk_back",
            Self::StrafeLeft => "strafe_left",
            Self::StrafeRight => "strafe_right",
            Self::Jump => "jump",
            Self::Fall => "fall",
            Self::Tumble => "tumble",
            Self::Lie => "lie",
            Self::GetUp => "get_up",
            Self::Die => "die",
            Self::Crushed => "crushed",
            Self::Crouch => "crouch",
            Self::Climb => "climb",
            Self::Hang => "hang",
            Self::Ledge => "ledge",
            Self::Mantle => "mantle",
        }
    }

    /// The motion that replaces this one where its clip is missing.
    const fn instead(self) -> Self {
        match self {
            Self::Run | Self::WalkBack | Self::StrafeLeft | Self::StrafeRight => Self::Walk,
            Self::Jump | Self::Tumble | Self::Hang => Self::Fall,
            Self::Lie => Self::Tumble,
            Self::Die => Self::Lie,
            Self::Crushed => Self::Crouch,
            Self::Ledge => Self::Climb,
            Self::Mantle => Self::Ledge,
            _ => Self::Idle,
        }
    }
}

/// The clips of a figure.
#[derive(Clone, Debug)]
pub(crate) struct Clips {
    found: [Option<ClipId>; BodyClip::ALL.len()],
    idle: ClipId,
}

impl Clips {
    /// `None` without a clip named `idle`.
    pub(crate) fn find(set: &AnimationSet) -> Option<Self> {
        let found = BodyClip::ALL.map(|clip| set.find(clip.name()));
        let idle = found[BodyClip::Idle as usize]?;
        Some(Self { found, idle })
    }

    /// The clip of a motion, or of the motion that replaces it.
    pub(crate) fn get(&self, clip: BodyClip) -> ClipId {
        let mut next = clip;
        while next != BodyClip::Idle {
            if let Some(found) = self.found[next as usize] {
                return found;
            }
            next = next.instead();
        }
        self.idle
    }

    pub(crate) fn has(&self, clip: BodyClip) -> bool {
        self.found[clip as usize].is_some()
    }
}
