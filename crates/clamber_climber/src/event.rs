use clamber_world::{Attachment, MaterialPoint, ObstacleId};
use glam::DVec3;

use crate::ClimberMode;

/// An event of a tick that concerns a climber.
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
    /// The ground that the climber stood on, or the ledge that it hung from, is too steep now: the obstacle tipped, or
    /// the climber came onto a steeper part. Or the [rule](crate::ContactRule::stand) does not let the climber stand on
    /// that ground.
    Slipped,
    /// Lost its support: the support ended, was removed, went out of reach, left the climber no room, or is refused by
    /// the [rule](crate::ContactRule).
    LostFooting {
        /// The support that was lost.
        from: Attachment,
    },
    /// The climber's support did not move exactly once since the last step: the creature was advanced twice, or the
    /// climber was stepped twice. Sweeps saw only the last move. An obstacle of the game's own also causes this if the
    /// motion that it reports does not begin where the last one ended.
    SkippedTicks {
        /// The obstacle of the support.
        obstacle: ObstacleId,
    },
    /// The ground was pulled away from under the climber's feet.
    Thrown {
        /// Acceleration of the ground away from the feet, metres a second squared beyond gravity.
        acceleration: f64,
        /// The ground that was lost.
        from: Attachment,
    },
    /// Gripped a hold.
    Grabbed {
        /// The obstacle that it grips.
        obstacle: ObstacleId,
        /// The gripped point, in world space.
        point: DVec3,
    },
    /// The climber's hands slipped off a hold or a ledge: it passed them too fast
    /// ([`GripConfig::catch_speed`](crate::GripConfig::catch_speed)), or stamina did not suffice.
    HandsSlipped {
        /// The obstacle that it could not hold.
        obstacle: ObstacleId,
        /// Speed of the climber relative to the hold, metres a second.
        speed: f64,
    },
    /// Climbed around a corner between two faces, convex or concave. Not reported along ledges, nor on the convex
    /// shapes of a physics engine, whose edges count as round. A triangle mesh of the same box has faces.
    TurnedCorner {
        /// Angle between the normals of the previous and the new face of the hold, radians.
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
    /// The climber's stamina was used up, and its grip opened.
    ShakenOff {
        /// The shake at that time, metres a second squared. If it is not above
        /// [`StaminaConfig::shake_threshold`](crate::StaminaConfig::shake_threshold), holding on alone used up the
        /// stamina.
        shake: f64,
        /// The hold that was lost.
        from: Attachment,
    },
    /// Knocked over: off its feet, off its hold, or in the air.
    Tumbled {
        /// The climber's support at that time; `None` if it had none, in the air or sliding.
        from: Option<Attachment>,
        /// The obstacle that dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Pushed off its feet or its hold by a blow that does not make it tumble.
    KnockedOff {
        /// The climber's support at that time.
        from: Attachment,
        /// The obstacle that dealt the blow, if one did.
        by: Option<ObstacleId>,
    },
    /// Obstacles leave the body too little room, or it is still inside an obstacle that it was pressed into.
    Crushed {
        /// The room that is missing beyond the margin, metres.
        depth: f64,
    },
    /// Lost hit points.
    Hurt {
        /// Hit points lost, 0 to 1.
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
        /// Meaning of the event, defined by the mode.
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
/// - The support gets the climber's weight at the supporting point: the climber's mass times gravity, less the
///   support's acceleration along gravity. While both fall freely, the weight is zero. Other climbers that this one
///   carries, on its head or by their hands, weigh on its support as well, if the climber knows its own id
///   ([`StepRules::id`](crate::StepRules::id)).
/// - A hold from which the climber hangs gets the pull of its arms, by the masses of both.
/// - An obstacle that the climber lands on or hits in the air gets the impulse along the contact normal that brings
///   both to the same speed.
/// - An obstacle that the climber runs into gets the same impulse, but at most
///   [`BodyConfig::push_force`](crate::BodyConfig::push_force) times the tick. A climber that slides on ice hits
///   obstacles as in the air.
/// - While the climber slides or tumbles, the obstacles that brake it get the reaction, and so do the obstacles that it
///   bounces off.
/// - The support gets the reaction to all of this while the climber stands or holds on: to running into an obstacle, to
///   starting, stopping and turning, and to a jump off the support. So a passenger does not drive its cart by pushing.
///   A jump gives a light body that another object holds up no more speed than the climber gets. When it jumps off a
///   body that falls with it, the climber gets the share of the jump speed that the two masses leave it. Bodies do not
///   feel the climber's inertia while they carry it: the momentum of both together stays the same only as long as no
///   other force speeds them up or slows them down.
///
/// If the climber hits several obstacles at once, the impulse of each of these hits is divided by their number.
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

/// The results of a step, beside the new state.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct StepReport {
    /// Events, in the order in which they happened. Empty in most ticks, and then not allocated.
    pub events: Vec<ClimberEvent>,
    /// Impulses for the obstacles that the climber pushed. Apply them to their bodies before the next physics step, or
    /// ignore them. Not allocated if no obstacle can be pushed.
    pub pushes: Vec<Push>,
    /// Displacement by contacts, away from where the climber's support and its own movement would have taken it,
    /// metres, in world space.
    pub pushed_out: DVec3,
    /// Depth of an obstacle inside the body's core, below the margin, metres. 0 unless the climber is crushed or the
    /// rounds did not suffice.
    pub penetration: f64,
    /// Rounds of the solver in this tick, over all movements; each movement takes at most 8.
    pub rounds: u32,
    /// Number of mode changes in this tick.
    pub mode_changes: u32,
    /// True if the tick's limit of 4 mode changes was reached before a mode moved the body. The handler of the new mode
    /// runs in the next tick.
    pub changes_left: bool,
    /// True if the rounds sufficed: no obstacle is on the way from the body's previous position to its new one.
    /// Obstacles that the body began inside of, or is crushed by, do not count. The value means nothing if the support
    /// was teleported in this tick: the body is then not swept, only pushed out of obstacles.
    pub is_clear: bool,
}
