/// How a bot climbs: how much shake and tiredness it accepts, and when it plans anew. Shake is the acceleration of the
/// skin under the climber, metres per second squared ([`ClimberState::shake`](clamber_climber::ClimberState::shake)).
/// Lengths in radii are multiples of the radius of the climber's ball.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BotConfig {
    /// The bot stands and rests in shakes up to this share of the shake that throws it off. Default 0.35.
    pub stands_in: f64,
    /// Stamina, 0 to 1, below which the bot rests until it has `rested`. Default 0.3. The bot goes on if it has the
    /// stamina that its plan expects there. It also goes on if the creature keeps still by its forecast
    /// ([`Forecast::still`](crate::Forecast::still)) and its stamina is enough for its goal.
    pub tired: f64,
    /// Stamina, 0 to 1, at which a rest ends. Default 0.9.
    pub rested: f64,
    /// Stamina, 0 to 1, that the bot holds back: it plans as if it had this much less than it has, but not less than 0,
    /// and rests until it has this much more than its plan asks for, but not more than 1. Default 0.2.
    pub reserve: f64,
    /// The bot climbs in shakes up to this share of the shake in which it can only hang. Default 0.7.
    pub climbs_in: f64,
    /// How far ahead of itself, in a straight line, the bot looks along its way for the point that it steers to, radii
    /// of the climber. It steers to a nearer point where the way bends, or has a jump or a rest. Default 3.
    pub ahead: f64,
    /// The bot plans anew if it is farther from its way than this many radii. Default 4.
    pub off_its_way: f64,
    /// The bot counts as stuck if it makes no progress for this time, seconds. Default 1.5.
    pub patience: f64,
    /// Time for which the bot avoids a way on which it was stuck, seconds. Each further time doubles it. Default 10.
    pub blocked_for: f64,
    /// Least time between two searches while no way is found, and for which the bot keeps a plan, seconds. Default 0.5.
    pub plans_every: f64,
    /// The bot lets go after hanging in calm for this time, seconds; from a ledge after twice as long. Default 2.5.
    pub hangs_for: f64,
    /// Seconds from the beginning of an attack until the bot reacts. Default 0.25.
    pub reaction: f64,
    /// Distance that the bot keeps from the place where it wants to get on while the creature walks about, radii.
    /// Default 27.5.
    pub keeps_away: f64,
}

impl Default for BotConfig {
    fn default() -> Self {
        Self {
            stands_in: 0.35,
            tired: 0.3,
            rested: 0.9,
            reserve: 0.2,
            climbs_in: 0.7,
            ahead: 3.0,
            off_its_way: 4.0,
            patience: 1.5,
            blocked_for: 10.0,
            plans_every: 0.5,
            hangs_for: 2.5,
            reaction: 0.25,
            keeps_away: 27.5,
        }
    }
}
