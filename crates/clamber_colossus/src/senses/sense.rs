use std::fmt;

/// A number that a creature senses. All are one tick old when the brain reads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sense {
    /// Number of people on the creature.
    Riders,
    /// Seconds for which the one who has been on it longest has been there.
    RiderSeconds,
    /// Height of the highest rider above the creature's feet, metres.
    RiderHeight,
    /// Number of riders that hang, rather than stand or grip.
    RidersHanging,
    /// 1 if somebody is seen who is not on the creature, else 0.
    PreySeen,
    /// Level distance to the prey from the creature's middle, metres; infinite before any was seen.
    PreyDistance,
    /// Bearing of the prey, degrees: 0 ahead, positive to the left, to 180 on either side.
    PreyBearingDeg,
    /// Seconds since prey was seen last; infinite before any was.
    PreyUnseenSeconds,
    /// Hit points that the creature lost in the last tick.
    Hurt,
    /// Number of blows and arrows that struck it in the last tick, whether they hurt or not.
    Struck,
    /// Share of its hit points that is left, 1 to 0.
    Health,
    /// Number of weak points that are left.
    WeakPoints,
    /// Number of plates that staggered or broke in the last tick.
    Staggered,
    /// Number of plates that are left.
    Plates,
    /// Number of people under its feet.
    Underfoot,
    /// Loudest noise of the last tick at the creature, as the game counts it.
    Noise,
    /// Bearing of that noise, degrees, as [`Sense::PreyBearingDeg`].
    NoiseBearingDeg,
    /// Distance to the nearest wall, metres; infinite if none is within the creature's height.
    WallDistance,
    /// Level distance to where the creature was placed first, metres.
    HomeDistance,
    /// 1 if the current act is over: the clip at its end, the place reached; else 0. A walk or a turn that is blocked is
    /// over as well.
    Done,
    /// 1 if the creature cannot do its current act: it does not get on in a walk or a turn, or a blow would go through
    /// rock and is not begun; else 0. It tries for a while before it says so: for a second if it is 41 m high, and else by
    /// the square root of its height.
    Blocked,
}

/// All senses, with their names in brain files.
const NAMES: [(Sense, &str); 21] = [
    (Sense::Riders, "riders"),
    (Sense::RiderSeconds, "rider_seconds"),
    (Sense::RiderHeight, "rider_height"),
    (Sense::RidersHanging, "riders_hanging"),
    (Sense::PreySeen, "prey_seen"),
    (Sense::PreyDistance, "prey_distance"),
    (Sense::PreyBearingDeg, "prey_bearing_deg"),
    (Sense::PreyUnseenSeconds, "prey_unseen_seconds"),
    (Sense::Hurt, "hurt"),
    (Sense::Struck, "struck"),
    (Sense::Health, "health"),
    (Sense::WeakPoints, "weak_points"),
    (Sense::Staggered, "staggered"),
    (Sense::Plates, "plates"),
    (Sense::Underfoot, "underfoot"),
    (Sense::Noise, "noise"),
    (Sense::NoiseBearingDeg, "noise_bearing_deg"),
    (Sense::WallDistance, "wall_distance"),
    (Sense::HomeDistance, "home_distance"),
    (Sense::Done, "done"),
    (Sense::Blocked, "blocked"),
];

impl Sense {
    /// Number of senses.
    pub(crate) const COUNT: usize = NAMES.len();

    /// All senses.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        NAMES.iter().map(|(sense, _)| *sense)
    }

    /// The sense with this name in brain files; `None` if there is none.
    pub fn find(name: &str) -> Option<Self> {
        let known = NAMES.iter().find(|(_, known)| *known == name);
        known.map(|(sense, _)| *sense)
    }

    /// Its name in brain files.
    pub fn name(self) -> &'static str {
        NAMES[self as usize].1
    }
}

impl fmt::Display for Sense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A sense of one region of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RegionSense {
    /// Number of people on it.
    Riders,
    /// Seconds for which the one who has been on it longest has been there.
    RiderSeconds,
    /// Hit points lost through it in the last tick.
    Hurt,
    /// Number of blows and arrows that struck it in the last tick.
    Struck,
}

impl RegionSense {
    pub(crate) const ALL: [Self; 4] = [Self::Riders, Self::RiderSeconds, Self::Hurt, Self::Struck];

    /// The sense with this name in brain files; `None` if there is none.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sense| sense.name() == name)
    }

    /// Its name in brain files, before `@` and the region's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Riders => "riders",
            Self::RiderSeconds => "rider_seconds",
            Self::Hurt => "hurt",
            Self::Struck => "struck",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_in_the_order_of_the_senses() {
        for (index, sense) in Sense::all().enumerate() {
            assert_eq!(sense as usize, index, "{sense}");
            assert_eq!(Sense::find(sense.name()), Some(sense));
        }
    }
}
