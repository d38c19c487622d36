use std::fmt;

/// A number that a creature senses. The brain reads values that are one tick old.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Sense {
    /// Number of people on the creature.
    Riders,
    /// Time on the creature of the rider that has been there longest, seconds.
    RiderSeconds,
    /// Height of the highest rider's middle above the creature's origin, metres.
    RiderHeight,
    /// Number of riders that hang, rather than stand or grip.
    RidersHanging,
    /// 1 if a person is in view that is not on the creature, else 0.
    PreySeen,
    /// Level distance to the prey from the creature's origin, metres; infinite before prey was first seen.
    PreyDistance,
    /// Bearing of the prey, degrees, from -180 to 180: 0 ahead, positive to the left.
    PreyBearingDeg,
    /// Seconds since prey was last seen; infinite before prey was first seen.
    PreyUnseenSeconds,
    /// Hit points that the creature lost in the last tick.
    Hurt,
    /// Number of blows and arrows that struck it in the last tick, harmless ones included.
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
    /// Loudness of the loudest noise of the last tick, as heard by the creature, in the game's unit.
    Noise,
    /// Bearing of that noise, degrees, as for [`Sense::PreyBearingDeg`].
    NoiseBearingDeg,
    /// Distance to the nearest wall, metres; infinite if none is within the creature's height.
    WallDistance,
    /// Level distance to the place where the creature began or was last put, metres.
    HomeDistance,
    /// 1 if the current act is over, else 0: its clip has ended, or its goal is reached. A blocked walk or turn is over
    /// as well.
    Done,
    /// 1 if the creature cannot do its current act, else 0: a walk or a turn does not get on, or an attack is not begun
    /// because it would go through terrain or another creature. The sense stays 0 in the first second of an act of a
    /// creature of 41 m. This time grows with the square root of the height.
    Blocked,
}

/// All senses with their names in brain files, in the order of the enum: [`Sense::name`] indexes it by the variant.
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

    /// All senses of the creature as a whole, in the order of the variants, without the senses of regions and of the
    /// game.
    pub fn all() -> impl ExactSizeIterator<Item = Self> {
        NAMES.iter().map(|(sense, _)| *sense)
    }

    /// The sense with this name in brain files; `None` if no sense has it.
    pub fn find(name: &str) -> Option<Self> {
        let known = NAMES.iter().find(|(_, known)| *known == name);
        known.map(|(sense, _)| *sense)
    }

    /// The sense's name in brain files.
    pub fn name(self) -> &'static str {
        NAMES[self as usize].1
    }
}

impl fmt::Display for Sense {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A sense of a creature for one region of its body. [`Senses::in_region`](crate::Senses::in_region) reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RegionSense {
    /// Number of people on the region.
    Riders,
    /// Time on the creature of the rider in the region that has been there longest, seconds.
    RiderSeconds,
    /// Hit points lost through the region in the last tick.
    Hurt,
    /// Number of blows and arrows that struck the region in the last tick.
    Struck,
}

impl RegionSense {
    /// All senses of a region, in the order of the enum: a sense is an index into a region's numbers.
    pub(crate) const ALL: [Self; 4] = [Self::Riders, Self::RiderSeconds, Self::Hurt, Self::Struck];

    /// The sense with this name in brain files; `None` if no sense has it.
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sense| sense.name() == name)
    }

    /// The sense's name in brain files, before `@` and the region's name.
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
