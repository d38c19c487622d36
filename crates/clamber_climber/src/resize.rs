//! Bodies that grow and shrink among obstacles.

use clamber_mover::{ContactFilters, Mover, Path};
use clamber_world::{Contact, Obstacle, ObstacleId};
use glam::DVec3;

use crate::step::Judge;
use crate::{Climber, ClimberConfig, ClimberError, ClimberMode, StepRules};

/// Length of the tick in which obstacles are queried as they are now, seconds: no obstacle moves in it.
const INSTANT_TICK: f64 = 1.0;

impl Climber {
    /// [`Climber::set_config`] for a body that may be of another size, among obstacles as they are now. The body keeps
    /// its feet on the ground, or its ball on its hold, and grows only where it has room.
    ///
    /// # Errors
    /// As [`Climber::set_config`], and [`ClimberError::NoRoom`] if the new body would be pushed aside farther than it
    /// grows, or would be crushed. The climber is unchanged then.
    pub fn try_resize(
        &mut self,
        config: ClimberConfig,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), ClimberError> {
        self.try_resize_with(config, obstacles, &StepRules::default())
    }

    /// [`Climber::try_resize`] with the rules of its steps: contacts that are not solid by the rule take no room.
    ///
    /// # Errors
    /// As [`Climber::try_resize`].
    pub fn try_resize_with(
        &mut self,
        config: ClimberConfig,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
    ) -> Result<(), ClimberError> {
        let (before, state) = (*self.config(), *self.state());
        self.set_config(config)?;
        let settled = self.room_for(&before, obstacles, rules);
        match settled {
            Ok(position) => {
                let way = position - state.position;
                let moved = crate::ClimberState {
                    position,
                    own_way: state.own_way + way,
                    support: state.support.map(|support| crate::Support {
                        attachment: support.attachment.moved_to(position),
                        ..support
                    }),
                    ..*self.state()
                };
                self.replace_state(moved);
                Ok(())
            }
            Err(error) => {
                // The previous configuration is valid, so this does not fail.
                let _ = self.set_config(before);
                self.replace_state(state);
                Err(error)
            }
        }
    }

    /// A position with room for the body of the current configuration, near the position of the body that `before`
    /// gives.
    fn room_for(
        &mut self,
        before: &ClimberConfig,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        rules: &StepRules<'_>,
    ) -> Result<DVec3, ClimberError> {
        let (config, state) = (*self.config(), *self.state());
        let [old, body] = [before, &config].map(|config| crate::step::body(config, &state));
        if body == old {
            return Ok(state.position);
        }
        let wider = body.radius - old.radius;
        // A ball that hangs below a ledge touches the wall, not the ledge that it holds.
        let rests = state
            .support
            .filter(|_| state.mode != ClimberMode::LedgeHanging);
        let wanted = match rests {
            // The arms get longer or shorter in proportion to the body.
            Some(support) if state.mode == ClimberMode::Hanging && old.radius > 0.0 => {
                let hold = support.attachment.point;
                hold + (state.position - hold) * (body.radius / old.radius)
            }
            Some(support) => state.position + support.normal_in_world() * wider,
            None => state.position,
        };
        let judge = Judge {
            rules,
            config: &config,
            state: &state,
            obstacles,
            dt: INSTANT_TICK,
        };
        let is_solid = |id, obstacle: &dyn Obstacle, contact: &Contact| {
            judge.rule(id, obstacle, contact).solid
        };
        let filters = ContactFilters {
            solid: rules.contact.is_some().then_some(&is_solid),
            ..ContactFilters::default()
        };
        let mut mover = Mover::new(obstacles, INSTANT_TICK, self.mover_memory())?
            .with_filters(filters)
            .with_character(crate::step::among_others(&config));
        let grows = wider > 0.0 || config.body.height > before.body.height;
        // A body that turns with a new gravity needs room as well.
        let turns = config.body.height > 0.0 && config.up() != before.up();
        if !grows && !turns {
            return Ok(mover.slide(&Path::placed(body, wanted)).position);
        }
        let moved = mover.slide(&Path::placed(body, wanted));
        let aside = moved.position.distance(wanted);
        let lacks = moved.missing_room.max(aside);
        let most = wider.max(0.0) + body.margin;
        if moved.missing_room > body.margin || aside > most {
            return Err(ClimberError::NoRoom { lacks });
        }
        // The body must not get to the other side of a thin wall.
        let core = clamber_mover::MoverBody {
            radius: old.radius.min(body.radius),
            ..body.crouched()
        };
        let from = core.core_at(state.position);
        if !mover.is_free(&from, moved.position - state.position) {
            return Err(ClimberError::NoRoom { lacks });
        }
        Ok(moved.position)
    }
}
