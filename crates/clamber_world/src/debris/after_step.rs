//! After the step: puts bodies that skin entered back in front of it, and moves bodies around which skin appeared out
//! of the creature.

use clamber_surface::surface::{SkinnedSurface, SurfaceHit};
use glam::DVec3;
use rapier3d::dynamics::RigidBodySet;
use rapier3d::geometry::{BroadPhaseBvh, ColliderSet, NarrowPhase};

use super::enclosed::is_enclosed;
use super::let_through::{Immovable, is_outside};
use super::passage::Passage;
use super::piece::Piece;
use super::pieces::check_tick;
use super::put_out::{Skin, State};
use super::seen::Seen;
use super::{Debris, DebrisError, DebrisReport};
use crate::ObstacleId;

impl Debris {
    /// Puts bodies that skin entered during the step back in front of it, and makes them at least as fast as the skin.
    /// If this would press a body into something immovable, skin passes through the body instead, from then on until
    /// the body is outside. Bodies around which skin appeared are moved further out of the creature.
    ///
    /// # Errors
    /// As for [`Debris::before_step`]. On [`DebrisError::OutOfReach`], earlier bodies have been moved already, and
    /// their report is lost.
    pub fn after_step(
        &mut self,
        surfaces: &[(ObstacleId, &SkinnedSurface)],
        bodies: &mut RigidBodySet,
        colliders: &ColliderSet,
        broad_phase: &BroadPhaseBvh,
        narrow_phase: &NarrowPhase,
        dt: f64,
    ) -> Result<DebrisReport, DebrisError> {
        check_tick(dt)?;
        self.set_order(surfaces)?;
        let mut report = DebrisReport {
            enclosed: self.enclosed,
            ..DebrisReport::default()
        };
        let mut tick = Tick {
            origin: self.origin,
            immovable: Immovable {
                colliders,
                broad_phase,
                narrow_phase,
                skin: &self.owners,
            },
            seen: &self.seen,
            hits: &mut self.hits,
            dt,
        };
        for piece in &mut self.pieces {
            let near = piece.patches.iter().any(|(_, patch)| !patch.is_empty());
            report.near += u32::from(near);
            for (obstacle, index) in &self.order {
                let surface = (*obstacle, surfaces[*index].1);
                let kept = tick.keep(piece, surface, bodies, &mut report);
                kept.ok_or(DebrisError::OutOfReach {
                    body: piece.body,
                    obstacle: *obstacle,
                })?;
            }
            piece.left_at = bodies.get(piece.body).map(|body| *body.position());
        }
        Ok(report)
    }
}

/// Data that all bodies of a tick share.
struct Tick<'a> {
    /// World position of rapier's origin.
    origin: DVec3,
    immovable: Immovable<'a>,
    seen: &'a [(ObstacleId, Seen)],
    hits: &'a mut Vec<SurfaceHit>,
    dt: f64,
}

impl Tick<'_> {
    /// Handles a body and one surface, as their passage says. `None` if the body is out of reach of the surface.
    fn keep(
        &mut self,
        piece: &mut Piece,
        (obstacle, surface): (ObstacleId, &SkinnedSurface),
        bodies: &mut RigidBodySet,
        report: &mut DebrisReport,
    ) -> Option<()> {
        let body = bodies.get(piece.body).filter(|body| body.is_enabled());
        let Some(body) = body else {
            return Some(());
        };
        let (start, end) = (*piece.start(), *body.position());
        let known = piece.index_of(obstacle).ok();
        if let Some(at) = known {
            let patch = &mut piece.patches[at].1;
            match patch.passage {
                Passage::LetThrough => {
                    let (shapes, origin) = ((&piece.core, &piece.hull), self.origin);
                    if is_outside(surface, shapes, [&start, &end], origin, self.hits)? {
                        patch.passage = Passage::Closed;
                    }
                    report.caught += u32::from(patch.passage.is_let_through());
                    return Some(());
                }
                Passage::PutOut(_) => {
                    self.put_out(piece, at, surface, bodies, report);
                    return Some(());
                }
                Passage::Closed => {}
            }
            // Rapier lets a kinematic body press a dynamic body into a fixed one.
            if !patch.is_empty()
                && let Some(place) =
                    (self.immovable).pressed(bodies, body, &piece.core, &start, self.dt)
            {
                patch.passage = Passage::LetThrough;
                report.caught += 1;
                if let Some(body) = bodies.get_mut(piece.body) {
                    body.set_translation(place, true);
                }
                return Some(());
            }
        }
        let kept = piece.keep_out(obstacle, surface, &end, self.origin, self.dt)?;
        let Some((normal, skin)) = kept.pushed else {
            return Some(());
        };
        if let Some(at) = known {
            let patch = &mut piece.patches[at].1;
            let blocked = self
                .immovable
                .blocks(bodies, &piece.core, &end, kept.shift)
                .is_some();
            // A fold of the skin closes on the body, so that the body has no way out.
            if blocked || !kept.free {
                patch.passage = Passage::LetThrough;
            }
            if blocked {
                report.caught += 1;
                return Some(());
            }
        }
        report.caught += u32::from(!kept.free);
        if let Some(body) = bodies.get_mut(piece.body) {
            report.put_back += 1;
            let place = body.translation() + kept.shift.as_vec3();
            let velocity = body.linvel().as_dvec3();
            let short = (skin - velocity).dot(normal).max(0.0);
            body.set_translation(place, true);
            body.set_linvel((velocity + normal * short).as_vec3(), true);
        }
        Some(())
    }

    /// Moves a body further out of a surface. If an immovable collider is in its way, or it does not come out in time,
    /// it is let through.
    fn put_out(
        &mut self,
        piece: &mut Piece,
        at: usize,
        surface: &SkinnedSurface,
        bodies: &mut RigidBodySet,
        report: &mut DebrisReport,
    ) {
        let (obstacle, patch) = &mut piece.patches[at];
        let Passage::PutOut(way) = &mut patch.passage else {
            return;
        };
        let Some(body) = bodies.get(piece.body) else {
            return;
        };
        let (end, velocity) = (*body.position(), body.linvel().as_dvec3());
        let known = self.seen.binary_search_by_key(obstacle, |(id, _)| *id);
        let jumped = known.is_ok_and(|known| self.seen[known].1.jumped);
        let skin = if jumped && surface.was_teleported() {
            Skin::Placed
        } else {
            Skin::Moved
        };
        let (surface_now, moved) = ((surface, skin), (&end, velocity));
        let leg = way.go_on(surface_now, &piece.core, moved, self.origin, self.dt);
        let leg = leg.filter(|leg| {
            let (immovable, core) = (&self.immovable, &piece.core);
            let blocked =
                leg.rest != DVec3::ZERO && immovable.blocks(bodies, core, &end, leg.rest).is_some();
            leg.state != State::Held && !blocked
        });
        if let Some(leg) = &leg
            && let Some(body) = bodies.get_mut(piece.body)
        {
            body.set_translation(end.translation + leg.shift.as_vec3(), true);
            body.set_linvel((velocity + leg.push).as_vec3(), true);
            if leg.state == State::Out {
                // A body that is inside other skin by now is not out.
                let [a, b] = piece.core.ends_at(body.position());
                let middle = (a + b) * 0.5 + self.origin;
                let middle = surface
                    .world_from_model()
                    .inverse_transform_point_f32(middle);
                let is_in = is_enclosed(surface.in_model(), middle, self.hits);
                patch.passage = if is_in {
                    Passage::LetThrough
                } else {
                    Passage::Closed
                };
            }
        } else {
            patch.passage = Passage::LetThrough;
        }
        report.put_out += u32::from(patch.passage.is_put_out());
        report.caught += u32::from(patch.passage.is_let_through());
    }
}
