use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use crate::ClimberMode;

/// Something that happened to a climber in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ClimberEvent {
    /// Landed on ground that can be stood on.
    Landed {
        /// The ground.
        obstacle: ObstacleId,
        /// Speed towards the ground, relative to it, metres a second.
        speed: f64,
    },
    /// Jumped off the ground, a hold or a ledge.
    Jumped,
    /// The ground that it stood on or the ledge that it hung from is too steep now: it tipped, or the climber came onto
    /// a steeper part. Or the [rule](crate::ContactRule::stand) lets nobody stand on that ground.
    Slipped,
    /// Lost its support, because that ended, was removed, went out of reach, left it no room, or is refused by the
    /// [rule](crate::ContactRule).
    LostFooting {
        /// The support that was lost.
        from: Attachment,
    },
    /// Its support did not move exactly once since the last step: the creature was advanced twice, or the climber was
    /// stepped twice. Sweeps saw only the last move. An obstacle of the game's own also causes this if the motion that
    /// it reports does not begin where the last one ended.
    MovedRepeatedly {
        /// The obstacle of the support.
        obstacle: ObstacleId,
    },
    /// The ground was pulled away from under its feet.
    Thrown {
        /// Acceleration of the ground away from the feet, metres a second squared beyond gravity.
        acceleration: f64,
        /// The ground that was lost.
        from: Attachment,
    },
    /// Gripped something.
    Grabbed {
        /// The obstacle that it grips.
        obstacle: ObstacleId,
        /// The gripped point, in world space.
        point: DVec3,
    },
    /// Its hands slipped off a hold or a ledge, which passed them too fast
    /// ([`GripConfig::catch_speed`](crate::GripConfig::catch_speed)), or for which its stamina did not suffice.
    HandsSlipped {
        /// The obstacle that it could not hold.
        obstacle: ObstacleId,
        /// Speed of the climber relative to the hold, metres a second.
        speed: f64,
    },
    /// Climbed around a corner between two faces, convex or concave. Along ledges there is no such event, and none on
    /// the convex shapes of a physics engine: their edges count as round. A triangle mesh of the same box has faces.
    TurnedCorner {
        /// Angle between the normals of the face that it held before and the one that it holds now, radians.
        angle: f64,
    },
    /// Caught a ledge with its hands, or the edge that it stepped off.
    LedgeCaught {
        /// The obstacle of the ledge.
        obstacle: ObstacleId,
        /// The point that its hands hold, in world space.
        point: DVec3,
    },
    /// Pulled itself up over a ledge, and stands on top.
    Mantled,
    /// Let go because [`ClimberInput::grip`](crate::ClimberInput::grip) ended.
    Released,
    /// Its stamina was used up, and its grip opened.
    ShakenOff {
        /// The shake at that time, metres a second squared. Not above
        /// [`StaminaConfig::shake_threshold`](crate::StaminaConfig::shake_threshold), holding on alone tired it.
        shake: f64,
        /// The hold that was lost.
        from: Attachment,
    },
    /// Knocked over: off its feet, off its hold, or in the air.
    Tumbled {
        /// Its support at that time; `None` if it had none, in the air or sliding.
        from: Option<Attachment>,
        /// Which obstacle dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Pushed off its feet or its hold by a blow that does not make it tumble.
    KnockedOff {
        /// Its support at that time.
        from: Attachment,
        /// Which obstacle dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Obstacles leave its body too little room, or it is still inside something that it was pressed into.
    Crushed {
        /// The room that is missing beyond the margin, metres.
        depth: f64,
    },
    /// Lost hit points.
    Hurt {
        /// How many it lost, 0 to 1.
        damage: f64,
    },
    /// Changed its mode.
    Changed {
        /// The mode before.
        from: ClimberMode,
        /// The mode now.
        to: ClimberMode,
    },
    /// A mode's handler asked for a change to the mode that the climber is in, which counts as
    /// [`NextMode::Stay`](crate::NextMode::Stay). A custom mode that wants to begin anew resets its memory and stays.
    AlreadyInMode {
        /// The mode.
        mode: ClimberMode,
    },
    /// Reported by a custom mode ([`ModeContext::report`](crate::ModeContext::report)).
    Custom {
        /// Id of the mode.
        mode: u16,
        /// What happened; the mode defines its meaning.
        what: u32,
        /// A value; the mode defines its meaning.
        value: f64,
    },
    /// An obstacle or a custom mode gave numbers that are not finite. The state is as it was before the tick, and
    /// this is the tick's only event.
    NotFinite,
}

/// An impulse that a climber gives to an obstacle that can be pushed.
///
/// - The support gets the climber's weight at the supporting point: mass times gravity, less what the support
///   accelerates along it. While both fall freely, that is nothing. Other climbers that this one carries, on its head or
///   by their hands, weigh on its support as well, if it knows its own id
///   ([`StepRules::id`](crate::StepRules::id)).
/// - A hold from which it hangs gets the pull of its arms, by the masses of both.
/// - An obstacle that it lands on or hits in the air gets, along the contact normal, the impulse that brings both to
///   the same speed.
/// - An obstacle that it runs into gets the same, but at most
///   [`BodyConfig::push_force`](crate::BodyConfig::push_force) times the tick. Who slides on ice hits it as in the air.
/// - While it slides or tumbles, what brakes it gets the reaction, and so does what it bounces off.
/// - The support gets the reaction to all of this that the climber does while it stands or holds on: to running into
///   something, to starting, stopping and turning, and to a jump off it. So a passenger does not drive its cart by
///   pushing. A jump gives a light body that something holds up no more speed than the climber gets. Off a body that
///   falls with it, a climber jumps by its share of both masses. Bodies do not feel the climber's inertia while they
///   carry it: the momentum of both together stays the same only as long as nothing else speeds them up or slows them
///   down.
///
/// If it hits several obstacles at once, each of the impulses of hits is divided by their number.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Push {
    /// The obstacle that is pushed.
    pub obstacle: ObstacleId,
    /// The point of the obstacle's material that is pushed.
    pub material: MaterialPoint,
    /// Where the impulse acts, in world space.
    pub point: DVec3,
    /// The impulse, newton seconds, in world space.
    pub impulse: DVec3,
}

/// What happened in a step, beside the new state.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// Events, in the order in which they happened. Empty in most ticks, and then not allocated.
    pub events: Vec<ClimberEvent>,
    /// Impulses for the obstacles that it pushed. Apply them to their bodies before the next physics step, or ignore
    /// them. Not allocated where nothing can be pushed.
    pub pushes: Vec<Push>,
    /// Displacement by contacts, away from where its support and its own movement would have taken it, metres, in world
    /// space.
    pub pushed_out: DVec3,
    /// How deep an obstacle is in the body's core, below the margin, metres. 0 unless the climber is crushed or the
    /// rounds did not suffice.
    pub penetration: f64,
    /// Rounds of the solver in this tick, over all movements; each movement takes at most 8.
    pub rounds: u32,
    /// Number of mode changes in this tick.
    pub mode_changes: u32,
    /// True if the tick's limit of 4 mode changes was reached before a mode moved the body. The handler of the new mode
    /// runs in the next tick.
    pub changes_left: bool,
    /// True if the rounds sufficed: nothing is on the way from where the body was to where it is. Obstacles that the
    /// body began inside of, or is crushed by, do not count. Says nothing if the support was placed elsewhere in this
    /// tick: the body is not swept then, only pushed out of obstacles.
    pub is_clear: bool,
}
