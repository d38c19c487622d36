use bevy_ecs::entity::MapEntities;
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_reflect::prelude::*;
use bevy_time::{Time, Virtual};
use clamber_climber::Knockback;
use clamber_world::ObstacleId;

/// The input of the player of a [`Climber`](crate::Climber). Any input crate, network or bot can fill it, in any
/// schedule.
///
/// Directions are used as they are at each tick. A press of `jump` is kept until a tick comes, and only that tick gets
/// it, however many frames there are in a tick, or ticks in a frame; it is then set to false. A button that is down in
/// any frame since the last tick counts as down in the next one, so that a short tap is not lost. Presses and blows
/// while the game is paused are forgotten, however it is paused: `Time<Virtual>` stands still, or ticks pass without
/// [`ClamberSystems::Climb`](crate::ClamberSystems::Climb).
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ClimberInput {
    /// Direction to walk or climb in, in world space. Its length is the share of full speed; more than 1 counts as 1.
    /// The component along up is ignored. On a hold, it says where to climb when it is pressed, or turned by more than
    /// 20 degrees: towards a wall is up, away from it down, and under a ceiling it is the direction itself. While it is
    /// held, the climber goes on in one direction, over bumps, round edges, and from a wall onto its ceiling
    /// ([`HoldingMemory`](clamber_climber::HoldingMemory)).
    pub walk: Vec3,
    /// Direction to climb in, in world space, on holds and ledges. Zero: `walk` is used instead.
    pub climb: Vec3,
    /// Set it to true when the jump button is pressed.
    pub jump: bool,
    /// True as long as the jump button is down. Used only with
    /// [`GroundConfig::jump_release_gravity`](clamber_climber::GroundConfig::jump_release_gravity) above 1.
    pub jump_held: bool,
    /// True as long as the grip button is down: grips what is in reach and holds on. False lets go.
    pub grip: bool,
    /// True as long as the crouch button is down: in every mode, a body with a height
    /// ([`BodyConfig::height`](clamber_climber::BodyConfig::height)) is its lower ball alone. Released, it is the whole
    /// capsule again where there is room. A body without a height does not change.
    pub crouch: bool,
    /// The game's own buttons, one bit each, for its [`ClimberModes`](crate::ClimberModes).
    pub actions: u32,
    /// Where the player aims: a direction in world space, for the game's [`ClimberModes`](crate::ClimberModes).
    pub aim: Vec3,
    /// The blows that struck the climber since the last tick, as one; see [`ClimberInput::strike`]. The fighter of an
    /// arena ignores it.
    #[entities]
    pub blow: Option<ClimberBlow>,
}

/// A blow that strikes a climber.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect, MapEntities)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub struct ClimberBlow {
    /// Change of the climber's velocity, in world space, metres a second.
    pub velocity: Vec3,
    /// Hit points that it costs, 0 to 1. Ignored without
    /// [`ClimberConfig::health`](clamber_climber::ClimberConfig::health).
    pub damage: f32,
    /// The dealer of the blow. Events repeat it.
    #[entities]
    pub by: Option<Entity>,
}

impl ClimberInput {
    /// Strikes the climber in the next tick. Several blows before it add up; the last dealer that is known counts. If
    /// one of them is out of range, none has an effect.
    ///
    /// An arena ignores blows in the input of its fighters: there, the game gives an `Order::Strike` by
    /// `FightArena::order`.
    pub fn strike(&mut self, blow: ClimberBlow) {
        self.blow = Some(sum(self.blow, blow));
    }
}

/// Two blows in one tick.
fn sum(earlier: Option<ClimberBlow>, later: ClimberBlow) -> ClimberBlow {
    earlier.map_or(later, |earlier| {
        let damages = [earlier.damage, later.damage];
        // The climber refuses NaN, as it would have refused the one that is out of range.
        let are_sane = damages.iter().all(|damage| (0.0..=1.0).contains(damage));
        let damage = if are_sane {
            damages.iter().sum::<f32>().min(1.0)
        } else {
            f32::NAN
        };
        ClimberBlow {
            velocity: earlier.velocity + later.velocity,
            damage,
            by: later.by.or(earlier.by),
        }
    })
}

/// The buttons that were pressed since the last tick, and the blows.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct LatchedInput {
    jump: bool,
    jump_held: bool,
    grip: bool,
    crouch: bool,
    actions: u32,
    blow: Option<ClimberBlow>,
}

impl LatchedInput {
    fn latch(&mut self, input: &mut ClimberInput) {
        self.jump |= std::mem::take(&mut input.jump);
        self.jump_held |= input.jump_held;
        self.grip |= input.grip;
        self.crouch |= input.crouch;
        self.actions |= input.actions;
        if let Some(blow) = input.blow.take() {
            self.blow = Some(sum(self.blow, blow));
        }
    }

    /// The input of a tick, and the blow that struck the climber before it. Presses and blows are used up.
    pub(crate) fn take(
        &mut self,
        input: &mut ClimberInput,
    ) -> (clamber_climber::ClimberInput, Option<Knockback>) {
        self.latch(input);
        let latched = std::mem::take(self);
        let knockback = latched.blow.map(|blow| Knockback {
            velocity: blow.velocity.as_dvec3(),
            damage: blow.damage.into(),
            by: blow.by.map(|by| ObstacleId(by.to_bits())),
        });
        let taken = clamber_climber::ClimberInput {
            walk: input.walk.as_dvec3(),
            climb: input.climb.as_dvec3(),
            jump: latched.jump,
            jump_held: latched.jump_held,
            grip: latched.grip,
            crouch: latched.crouch,
            actions: latched.actions,
            aim: input.aim.as_dvec3(),
        };
        (taken, knockback)
    }
}

/// The ticks since the last frame.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct PassedTicks {
    /// A tick has passed.
    any: bool,
    /// One of them has stepped climbers, or an arena.
    climbed: bool,
}

/// Runs in each tick.
pub(super) fn count_ticks(mut passed: ResMut<PassedTicks>) {
    passed.any = true;
}

/// Runs in each tick that steps climbers.
pub(super) fn count_climbs(mut passed: ResMut<PassedTicks>) {
    passed.climbed = true;
}

/// Runs once a frame, before the fixed loop.
pub(super) fn latch(
    time: Res<Time<Virtual>>,
    mut passed: ResMut<PassedTicks>,
    mut climbers: Query<(&mut ClimberInput, &mut LatchedInput)>,
) {
    let passed = std::mem::take(&mut *passed);
    // The ticks since the last frame have not taken what was latched before it.
    let was_paused = passed.any && !passed.climbed;
    let is_paused = time.is_paused() || time.effective_speed_f64() == 0.0;
    for (mut input, mut latched) in &mut climbers {
        if was_paused {
            *latched = LatchedInput::default();
        }
        latched.latch(input.bypass_change_detection());
        if is_paused {
            *latched = LatchedInput::default();
        }
    }
}
