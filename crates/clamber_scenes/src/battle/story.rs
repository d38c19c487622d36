/// The climber's task in a battle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Story {
    /// The climber comes over an outcrop, runs from blows, grips a leg and climbs to the top.
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
