//! Checks of the climber, computed independently of the climber and mostly of the surface's queries.

use clamber_climber::{Climber, ClimberEvent, ClimberMode, StepReport};
use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;

use super::faults::{Faults, Moment};
use super::{CREATURE, TERRAIN};
use crate::{solid_angle, valley};

/// Ticks between two checks of whether the climber is inside the creature. Such a check goes over all
/// triangles and takes longer than the tick itself.
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

/// Largest distance of a standing climber's contact from its material point, metres.
pub(super) const MAX_DRIFT: f64 = 1e-4;

/// Longest push-out of a climber that stands without input, metres.
pub(super) const MAX_PUSH_OUT: f64 = 0.01;

/// Largest distance by which other skin may push a climber's body off the material point that it stands on, metres: a
/// tenth of the body's radius. Beyond it the climber has to find new ground.
pub(super) const MAX_PUSHED_OFF: f64 = 0.04;

/// Largest gap between a climber's body and its material point with no skin in between, metres: the contact margin,
/// within which the body counts as touching.
pub(super) const MAX_STANDS_OFF: f64 = 0.01;

/// Checks a climber from tick to tick.
#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    /// The material point under the climber when it landed or its input ended.
    recorded: Option<MaterialPoint>,
    /// The climber was on the creature a tick ago.
    was_riding: bool,
    /// Description of how the climber last left the creature.
    left: Option<String>,
    /// The climber came to the ground, and has not been on the creature since.
    is_down: bool,
    /// How often the climber came to the ground or out of the valley. A start on the ground counts as well.
    pub(super) falls: u32,
    /// Ticks at which the climber's centre was found inside the creature or under the ground.
    pub(super) fell_through: u32,
    /// Ticks at which a climber that climbs or holds on was farther from its hold than it can reach.
    pub(super) out_of_reach: u32,
    /// Largest depth of the climber's sphere in the skin while it stood without input, metres.
    pub(super) deepest: f64,
    /// Largest distance by which other skin pushed the body off its material point while it stood without input,
    /// metres.
    pub(super) pushed_off: f64,
    /// Largest gap between the body and its material point with no skin in between, while it stood without input,
    /// metres.
    pub(super) stands_off: f64,
    /// The first fault of every check.
    pub(super) faults: Faults,
}

/// A climber after a tick.
#[derive(Clone, Copy)]
pub(super) struct Watched<'a> {
    pub(super) climber: &'a Climber,
    pub(super) report: &'a StepReport,
    /// The climber had no input, and did not slide.
    pub(super) idle: bool,
    /// The climber climbs (the story `climb`) rather than rides.
    pub(super) climbs: bool,
}

impl Watch {
    /// Checks one tick, and returns the drift, metres, where it is defined.
    ///
    /// For a rider that stands without input: the distance of its contact from the recorded material point, or the
    /// depth of its body in that point if larger. For a climber that climbs or holds on, and may be shoved where
    /// creases close: the distance of its contact from its own material point.
    pub(super) fn tick(
        &mut self,
        moment: &Moment<'_>,
        palette: &Palette,
        watched: &Watched<'_>,
    ) -> Option<f64> {
        let Watched { climber, idle, .. } = *watched;
        let surface = moment.surface();
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
        // It may slip and land on another point within one tick.
        let landed = |event: &ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
        let kept = self
            .recorded
            .filter(|_| !watched.report.events.iter().any(landed));
        let Some(recorded) = kept else {
            self.recorded = Some(support.attachment.material);
            return None;
        };
        let push_out = watched.report.pushed_out.length();
        if push_out > MAX_PUSH_OUT {
            let what = format!("pushed out by {push_out:.3} m");
            self.faults
                .note(PUSH_OUT, || moment.describe(&what, center));
        }
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
            // A lost point counts once. Drift below the limit accumulates against the recorded point.
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
        Some(drift)
    }

    fn look_inside(&mut self, moment: &Moment<'_>, center: DVec3) {
        let look = moment.tick.is_multiple_of(INSIDE_EVERY);
        let below =
            valley::contains(center.x, center.z) && center.y < valley::height(center.x, center.z);
        if below || look && is_inside(moment.surface(), center) {
            self.fell_through += 1;
            let what = if below { "below the ground" } else { "inside" };
            self.faults.note(INSIDE, || moment.describe(what, center));
        }
    }

    /// Notes how the climber left the creature, and the fall when it comes to the ground.
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

    /// The climber is on the ground or out of the valley: counts a fall, if it is a new one.
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

    /// The climber is dropped on the creature again.
    pub(super) fn dropped(&mut self) {
        (self.is_down, self.left) = (false, None);
    }
}

/// How far a rider's body is off its material point. A distance is not a drift: where folding skin leaves its ball no
/// room at the point, the climber stays attached to the point and leans away, by design.
#[derive(Clone, Copy, Debug)]
struct Off {
    /// Position of the point in the world.
    point: DVec3,
    /// Depth of the point in the body, metres.
    sunk: f64,
    /// Distance of the body from the point with no skin in between, metres.
    gap: f64,
    /// Distance of the body from the point because of other skin, metres.
    pushed: f64,
}

impl Off {
    /// Measures a body at `center`. It counts as pushed off its point if the ball touches skin now, and would overlap
    /// skin if it stood upright on the point. Any other distance is a gap.
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

/// Share of its radius by which a climber's arms give before it loses its hold: the climber's own bound.
const GIVE: f64 = 0.25;

/// Largest distance of a climber's centre from the point that it stands on or holds, metres, in its mode.
fn reach(climber: &Climber) -> f64 {
    let config = climber.config();
    let body = config.body.radius + config.grip.map_or(0.0, |grip| grip.reach);
    let ledge = config
        .ledge
        .map_or(0.0, |ledge| ledge.reach_up + ledge.reach);
    match climber.state().mode {
        ClimberMode::Hanging => config.hang.arm_length.max(body) * 1.5,
        ClimberMode::LedgeHanging => body + ledge,
        ClimberMode::Holding => body + GIVE * config.body.radius,
        _ => body,
    }
}

/// Corners of a material point's triangle in the world, computed in f64 from the palette, without the surface's own
/// skinning, interpolation or carrying. `None` if there is no such triangle.
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

/// Position of a material point of the creature in the world, from [`reference_corners`].
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
    solid_angle::is_inside_skin(&positions, surface, in_model)
}

#[cfg(test)]
mod tests;
