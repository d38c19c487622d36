//! What the scene holds against the climber, by means that owe nothing to it.

use clamber_climber::{Climber, ClimberMode, StepReport};
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::faults::{Faults, Moment};
use super::{CREATURE, TERRAIN};
use crate::{solid_angle, valley};

/// Ticks between two looks at whether the climber is inside the creature, which take longer than the
/// tick itself: they go over all triangles.
const INSIDE_EVERY: u64 = 10;

/// Names of the checks.
pub(super) const DRIFT: &str = "anchor drift, m";
pub(super) const PUSHED_OFF: &str = "pushed off its point, m";
pub(super) const STANDS_OFF: &str = "stands off its point, m";
pub(super) const PUSH_OUT: &str = "push-out while standing, m";
pub(super) const INSIDE: &str = "ticks inside or below";
pub(super) const OUT_OF_REACH: &str = "ticks out of its reach";
pub(super) const NOT_RIDING: &str = "share of ticks not riding";
pub(super) const ROCKS_INSIDE: &str = "rocks inside or below";
pub(super) const FALLS: &str = "falls to the ground";

/// Farthest that a standing climber's contact may be from its material point, metres.
pub(super) const MAX_DRIFT: f64 = 1e-4;

/// Longest push-out of a climber that stands without input, metres.
pub(super) const MAX_PUSH_OUT: f64 = 0.01;

/// Farthest that other skin may push a climber's body off the material point that it stands on, metres: a tenth of its
/// radius, beyond which it has to look for new ground.
pub(super) const MAX_PUSHED_OFF: f64 = 0.04;

/// Farthest that a climber's body may stand off its material point with no skin in between, metres: its contact margin,
/// within which skin is touched.
pub(super) const MAX_STANDS_OFF: f64 = 0.01;

/// Watches a climber from tick to tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// The material point under the climber when it landed or its input ended.
    recorded: Option<MaterialPoint>,
    /// It was on the creature a tick ago.
    was_riding: bool,
    /// How it last left the creature.
    left: Option<String>,
    /// It is on the ground, or was until it was dropped on the creature again.
    is_down: bool,
    /// How often it came to the ground, or out of the valley, once it had been on the creature or dropped there.
    pub(super) falls: u32,
    /// Ticks at which its centre was seen inside the creature or under the ground.
    pub(super) fell_through: u32,
    /// Ticks at which who climbs was farther from its hold than its arms are long.
    pub(super) out_of_reach: u32,
    /// Deepest that the sphere reached into the skin while it stood without input, metres.
    pub(super) deepest: f64,
    /// Farthest that other skin pushed its body off its material point while it stood without input, metres.
    pub(super) pushed_off: f64,
    /// Farthest that it stood off its material point with no skin in between, metres.
    pub(super) stands_off: f64,
    /// The first fault of every check.
    pub(super) faults: Faults,
}

/// A climber after a tick.
#[derive(Clone, Copy)]
pub(super) struct Watched<'a> {
    pub(super) climber: &'a Climber,
    pub(super) report: &'a StepReport,
    /// It had no input.
    pub(super) idle: bool,
    /// It climbs, rather than rides.
    pub(super) climbs: bool,
}

impl Watch {
    /// Looks at one tick. Gives the drift: of a rider that stood through all of the tick without input; of one who climbs
    /// or holds on, and may be shoved where creases close, how far its contact is from its own material point.
    pub(super) fn tick(
        &mut self,
        moment: &Moment<'_>,
        palette: &Palette,
        watched: &Watched<'_>,
    ) -> Option<f64> {
        let Watched { climber, idle, .. } = *watched;
        let surface = moment.surface;
        let state = climber.state();
        let center = state.position;
        self.look_inside(moment, center);
        self.look_at_leaving(moment, watched);
        let support = state.support.filter(|s| s.attachment.obstacle == CREATURE);
        let holds = state.mode.is_holding();
        if holds || watched.climbs {
            self.recorded = None;
            let support = support?;
            let place = reference_position(surface, palette, &support.attachment.material);
            let place = place.unwrap_or(DVec3::INFINITY);
            if center.distance(place) > reach(climber) {
                self.out_of_reach += 1;
                self.faults
                    .note(OUT_OF_REACH, || moment.describe("out of reach", center));
            }
            let drift = support.attachment.point.distance(place);
            if drift > MAX_DRIFT {
                let what = format!("hold {drift:.1e} m from its material point");
                self.faults.note(DRIFT, || moment.describe(&what, center));
            }
            return Some(drift);
        }
        let Some(support) = support.filter(|_| idle) else {
            self.recorded = None;
            return None;
        };
        let Some(recorded) = self.recorded else {
            self.recorded = Some(support.attachment.material);
            return None;
        };
        let radius = climber.config().body.radius;
        if let Some(nearest) = surface.closest_point(center, radius) {
            self.deepest = self.deepest.max(radius - nearest.distance);
        }
        let off = Off::measure(surface, palette, &recorded, center, radius);
        let contact = support.attachment.point.distance(off.point);
        let drift = contact.max(off.sunk);
        if drift > MAX_DRIFT {
            let what = format!(
                "contact {contact:.1e} m from its material point, body {:.1e} m deep in it",
                off.sunk
            );
            self.faults.note(DRIFT, || moment.describe(&what, center));
            // A point that is lost is lost once. A creep that is not yet a fault adds up.
            self.recorded = Some(support.attachment.material);
            return Some(drift);
        }
        self.pushed_off = self.pushed_off.max(off.pushed);
        if off.pushed > MAX_PUSHED_OFF {
            let what = format!("pushed off by {:.3} m", off.pushed);
            self.faults
                .note(PUSHED_OFF, || moment.describe(&what, center));
        }
        self.stands_off = self.stands_off.max(off.gap);
        if off.gap > MAX_STANDS_OFF {
            let what = format!("stands off by {:.3} m", off.gap);
            self.faults
                .note(STANDS_OFF, || moment.describe(&what, center));
        }
        let push_out = watched.report.pushed_out.length();
        if push_out > MAX_PUSH_OUT {
            let what = format!("pushed out by {push_out:.3} m");
            self.faults
                .note(PUSH_OUT, || moment.describe(&what, center));
        }
        Some(drift)
    }

    fn look_inside(&mut self, moment: &Moment<'_>, center: DVec3) {
        let look = moment.tick.is_multiple_of(INSIDE_EVERY);
        let below =
            valley::contains(center.x, center.z) && center.y < valley::height(center.x, center.z);
        if below || look && is_inside(moment.surface, center) {
            self.fell_through += 1;
            let what = if below { "below the ground" } else { "inside" };
            self.faults.note(INSIDE, || moment.describe(what, center));
        }
    }

    /// Remembers how it left the creature, and what it fell for once it is on the ground.
    fn look_at_leaving(&mut self, moment: &Moment<'_>, watched: &Watched<'_>) {
        let state = watched.climber.state();
        let stands_on = state.support.map(|support| support.attachment.obstacle);
        let rides = stands_on == Some(CREATURE);
        if self.was_riding && !rides {
            let what = format!("left the creature, {:?}", watched.report.events);
            let left = moment.describe(&what, state.position);
            self.faults.note(NOT_RIDING, || left.clone());
            self.left = Some(left);
        }
        if stands_on == Some(TERRAIN) {
            self.fell(moment, state.position);
        }
        self.is_down &= !rides;
        self.was_riding = rides;
    }

    /// It is on the ground, or out of the valley.
    pub(super) fn fell(&mut self, moment: &Moment<'_>, place: DVec3) {
        if std::mem::replace(&mut self.is_down, true) {
            return;
        }
        self.falls += 1;
        let left = self.left.take();
        self.faults.note(FALLS, || {
            left.unwrap_or_else(|| moment.describe("never came to stand on the creature", place))
        });
    }

    /// It is dropped on the creature again.
    pub(super) fn dropped(&mut self) {
        (self.is_down, self.left) = (false, None);
    }
}

/// How far a rider's body is off its material point. Not a drift: the climber stays on its point and leans, as it is
/// meant to, where folding skin leaves its ball no room there.
#[derive(Clone, Copy, Debug)]
struct Off {
    /// Where the point is, in the world.
    point: DVec3,
    /// How deep the point is in the body, metres.
    sunk: f64,
    /// By how much the body is away from it with nothing in between, metres.
    gap: f64,
    /// By how much other skin keeps the body away from it, metres.
    pushed: f64,
}

impl Off {
    /// Skin pushes a body off its point if the ball touches skin now, and would overlap skin if it stood upright on its
    /// point. A body that is off its point for any other reason does not.
    fn measure(
        surface: &SkinnedSurface,
        palette: &Palette,
        recorded: &MaterialPoint,
        center: DVec3,
        radius: f64,
    ) -> Self {
        let Some(point) = reference_position(surface, palette, recorded) else {
            return Self {
                point: DVec3::INFINITY,
                sunk: 0.0,
                gap: f64::INFINITY,
                pushed: 0.0,
            };
        };
        let off = center.distance(point) - radius;
        let is_pushed = off > MAX_DRIFT
            && touches(surface, center, radius + MAX_DRIFT)
            && reference_normal(surface, palette, recorded).is_some_and(|normal| {
                touches(surface, point + normal * radius, radius - MAX_DRIFT)
            });
        let (gap, pushed) = if is_pushed { (0.0, off) } else { (off, 0.0) };
        Self {
            point,
            sunk: (-off).max(0.0),
            gap: gap.max(0.0),
            pushed,
        }
    }
}

fn touches(surface: &SkinnedSurface, center: DVec3, radius: f64) -> bool {
    surface.closest_point(center, radius).is_some()
}

/// How far a climber's centre may be from what it stands on or holds, metres.
fn reach(climber: &Climber) -> f64 {
    let config = climber.config();
    let body = config.body.radius + config.grip.map_or(0.0, |grip| grip.reach);
    let ledge = config
        .ledge
        .map_or(0.0, |ledge| ledge.reach_up + ledge.reach);
    match climber.state().mode {
        ClimberMode::Hanging => config.hang.arm_length.max(body) * 1.5,
        ClimberMode::LedgeHanging => body + ledge,
        _ => body,
    }
}

/// Corners of a material point's triangle in the world, in f64 from the palette on: none of the surface's own skinning,
/// interpolation or carrying.
fn reference_corners(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<[DVec3; 3]> {
    let corners = surface.mesh().triangles().get(point.key as usize)?;
    let mut places = [DVec3::ZERO; 3];
    for (place, vertex) in places.iter_mut().zip(corners) {
        let in_model = skin_vertex_reference(surface.mesh(), palette.matrices(), *vertex)?;
        *place = surface.world_from_model().transform_point(in_model);
    }
    Some(places)
}

/// Where a material point of the creature is.
fn reference_position(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<DVec3> {
    let corners = reference_corners(surface, palette, point)?;
    let weighted = corners.iter().zip(point.coordinates).map(|(c, w)| *c * w);
    Some(weighted.fold(DVec3::ZERO, |sum, part| sum + part))
}

/// Unit normal of the skin at a material point; `None` where the triangle has collapsed.
fn reference_normal(
    surface: &SkinnedSurface,
    palette: &Palette,
    point: &MaterialPoint,
) -> Option<DVec3> {
    let [a, b, c] = reference_corners(surface, palette, point)?;
    (b - a).cross(c - a).try_normalize()
}

/// True if a point of the world is inside the creature.
fn is_inside(surface: &SkinnedSurface, point: DVec3) -> bool {
    let in_model = surface.world_from_model().inverse_transform_point(point);
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    solid_angle::is_inside(&positions, surface.mesh(), in_model)
}

#[cfg(test)]
mod tests;
