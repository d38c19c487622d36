/// The climber's task in a battle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Story {
    /// The climber comes over an outcrop, shoots, runs from blows, climbs to the weak points and stabs them, or to the
    /// top of a creature that has none.
    Climb,
    /// The climber is dropped on the back, and stands, walks and jumps there.
    Ride,
}

impl Story {
    /// The story's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Climb => "climb",
            Self::Ride => "ride",
        }
    }
}
