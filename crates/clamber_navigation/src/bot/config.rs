/// How a bot plays.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BotConfig {
    /// It stands and rests in shakes up to this share of the one that throws it off. Default 0.35.
    pub stands_in: f64,
    /// With less stamina it rests before it goes on, until it has `rested`. It goes on all the same if it has the
    /// stamina that its plan counts on there, or if the forecast is still and its stamina is enough for its goal.
    /// Default 0.3.
    pub tired: f64,
    /// Default 0.9.
    pub rested: f64,
    /// Stamina that its plans do not count on. Default 0.2.
    pub reserve: f64,
    /// It climbs in shakes up to this share of the one in which it can only hang. Default 0.7.
    pub climbs_in: f64,
    /// It aims so many radii of the climber ahead on its way. Default 3.
    pub ahead: f64,
    /// It plans anew if it is farther from its way than so many radii. Default 4.
    pub off_its_way: f64,
    /// It counts as stuck after it has not got on for so long, seconds. Default 1.5.
    pub patience: f64,
    /// It avoids a way on which it was stuck for so long, seconds. Default 10.
    pub blocked_for: f64,
    /// Least time between two plans that found no way, and for which it keeps a plan, seconds. Default 0.5.
    pub plans_every: f64,
    /// It lets go after hanging in calm for so long, seconds; from a ledge after twice as long. Default 2.5.
    pub hangs_for: f64,
    /// Seconds from the beginning of an attack until it reacts. Default 0.25.
    pub reaction: f64,
    /// It keeps so many radii away from where it means to get on while the creature walks about. Default 27.5.
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
