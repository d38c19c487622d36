//! Overlays on the pictures of a battle.

use std::collections::BTreeMap;
use std::sync::Arc;

use clamber::geometry::Ray;
use clamber::glam::{DVec3, Vec3};
use clamber::mesh::{Part, VertexId};
use clamber::prelude::*;
use clamber::render::{Camera, Image, Overlay, TextSize};
use clamber::rig::JointId;
use clamber::world::rapier3d::prelude::*;
use clamber_colossus::Sense;
use clamber_scenes::battle::{Battle, CREATURE, TICK};

use crate::colors::{MAGENTA, ORANGE, SKY_BLUE, VERMILION, WHITE, YELLOW, opaque, seen_through};
use crate::{OverlayKind, plans};

/// Number of points of the climber's path that are drawn.
const WAY: usize = 90;

/// Number of points of the paths of climber and rocks that are drawn with their sweeps.
const TRAIL: usize = 20;

/// Length of a velocity's arrow: metres per metre a second.
const ARROW: f64 = 0.5;

/// Radius of a dot, as a share of its distance from the eye: about 4 pixels at 720 rows.
const DOT: f64 = 0.005;

/// Share of the skin's area below which a part has no anchor.
const LEAST_AREA: f32 = 0.005;

/// Distance by which overlays on the skin are drawn nearer to the eye, as a share of the creature's height: visible fur
/// and stone reach that far beyond the collider.
const NEARER: f64 = 0.02;

/// The same for joints, which must be visible through the skin.
const THROUGH: f64 = 0.25;

/// A body that moved farther than this in a tick was teleported, metres.
const PUT: f64 = 2.0;

/// A body that moved less than this in a tick lies still, metres: 0.12 m/s.
const STILL: f64 = 0.002;

/// Upper left corner of the text: column and row.
const TEXT_AT: [u32; 2] = [16, 16];

/// Pictures of fewer rows get small text.
const ROWS_FOR_LARGE_TEXT: u32 = 600;

/// The selected kinds of overlays, and their data from earlier ticks.
pub(crate) struct Overlays {
    kinds: Vec<OverlayKind>,
    anchors: Vec<MaterialPoint>,
    /// Height of the creature, metres.
    height: f64,
    /// Distance by which overlays on the skin are drawn nearer to the eye, metres.
    nearer: f64,
    /// The climber's path, at its feet.
    way: Vec<DVec3>,
    /// Positions of the climber's sphere in the last ticks, since it was last teleported; the current one is last.
    climber: Vec<DVec3>,
    /// The same for each rock.
    rocks: Vec<Vec<DVec3>>,
}

impl Overlays {
    pub(crate) fn new(kinds: &[OverlayKind], height: f64) -> Self {
        Self {
            kinds: kinds.to_vec(),
            anchors: Vec::new(),
            height,
            nearer: NEARER * height,
            way: Vec::new(),
            climber: Vec::new(),
            rocks: Vec::new(),
        }
    }

    /// Records a tick. Call it before the first tick and after every one.
    pub(crate) fn watch(&mut self, battle: &Battle<'_>) {
        let config = battle.climber().config();
        let now = battle.climber().state().position;
        let bodies = &battle.world().bodies;
        let rocks = battle.rocks().bodies().iter();
        let rocks = rocks.map(|rock| bodies[*rock].translation().as_dvec3());
        if self.way.is_empty() {
            self.anchors = anchors(battle.surface().mesh());
            self.rocks.resize(battle.rocks().len(), Vec::new());
        }
        follow(&mut self.climber, now);
        for (trail, now) in self.rocks.iter_mut().zip(rocks) {
            follow(trail, now);
        }
        self.way.push(now - config.up() * config.body.radius);
        if self.way.len() > WAY {
            self.way.remove(0);
        }
    }

    pub(crate) fn draw(&self, battle: &Battle<'_>, camera: &Camera) -> Overlay {
        let mut over = Overlay::default();
        let eye = camera.eye;
        for kind in &self.kinds {
            match kind {
                OverlayKind::Joints => joints(&mut over, battle, eye, THROUGH * self.height),
                OverlayKind::Clusters => clusters(&mut over, battle, eye, self.nearer),
                OverlayKind::Contact => contact(&mut over, battle, &self.way),
                OverlayKind::Anchors => self.anchors(&mut over, battle, eye),
                OverlayKind::Sweeps => self.sweeps(&mut over, battle, eye),
                OverlayKind::Rocks => rocks(&mut over, battle),
                OverlayKind::Feet => feet(&mut over, battle),
                OverlayKind::Plan => plans::plan(&mut over, battle, eye, self.nearer),
                OverlayKind::Ways => plans::ways(&mut over, battle, eye, self.nearer),
                // Text is written after the picture is drawn.
                OverlayKind::State | OverlayKind::Brain => {}
            }
        }
        over
    }

    /// Writes the text onto the picture.
    pub(crate) fn write(&self, battle: &Battle<'_>, image: &mut Image) {
        let size = if image.height < ROWS_FOR_LARGE_TEXT {
            TextSize::Small
        } else {
            TextSize::Large
        };
        let mut texts = Vec::new();
        if self.kinds.contains(&OverlayKind::State) {
            texts.push(state(battle));
        }
        if self.kinds.contains(&OverlayKind::Brain) {
            texts.push(brain(battle));
        }
        image.text(TEXT_AT, size, &texts.join("\n\n"));
    }

    fn anchors(&self, over: &mut Overlay, battle: &Battle<'_>, eye: DVec3) {
        let motion = |point: &MaterialPoint| battle.surface().motion(point, TICK);
        let mut show = |motion: PointMotion, width: f32, arrow, point| {
            let [from, to] = [DVec3::ZERO, motion.velocity * ARROW]
                .map(|along| nearer(motion.position + along, eye, self.nearer));
            over.arrow(from, to - from, width, opaque(arrow));
            dot(over, from, eye, f64::from(width) / 3.0, point);
        };
        for motion in self.anchors.iter().filter_map(motion) {
            show(motion, 3.0, SKY_BLUE, YELLOW);
        }
        let support = battle.climber().state().support;
        let support = support.filter(|support| support.attachment.obstacle == CREATURE);
        if let Some(motion) = support.and_then(|support| motion(&support.attachment.material)) {
            show(motion, 4.5, MAGENTA, MAGENTA);
        }
    }

    fn sweeps(&self, over: &mut Overlay, battle: &Battle<'_>, eye: DVec3) {
        let radius = battle.climber().config().body.radius;
        self.sweep(over, &self.climber, radius, eye, WHITE);
        if let Some(support) = battle.climber().state().support {
            dot(over, support.attachment.point, eye, 1.0, VERMILION);
        }
        let world = battle.world();
        for (trail, rock) in self.rocks.iter().zip(battle.rocks().bodies()) {
            for collider in world.bodies[*rock].colliders() {
                let radius = inner_radius(world.colliders[*collider].shape());
                if self.sweep(over, trail, radius, eye, YELLOW) {
                    for point in touching(world, *collider) {
                        dot(over, point, eye, 1.0, VERMILION);
                    }
                }
            }
        }
    }

    /// Draws a ball's path, and its sweep of the last tick; returns false if the ball lies still.
    fn sweep(
        &self,
        over: &mut Overlay,
        trail: &[DVec3],
        radius: f64,
        eye: DVec3,
        color: [f32; 3],
    ) -> bool {
        let [.., from, to] = *trail else {
            return false;
        };
        if from.distance(to) < STILL {
            return false;
        }
        over.path(trail, 2.0, seen_through(color, 0.5));
        over.capsule(from, to, radius, 1.5, opaque(color));
        // The arrow is drawn in front of the ball.
        let [from, to] = [from, to].map(|end| nearer(end, eye, 2.0 * self.nearer));
        over.arrow(from, to - from, 4.0, opaque(color));
        true
    }
}

/// Adds a position to a trail, which begins anew after a teleport.
fn follow(trail: &mut Vec<DVec3>, now: DVec3) {
    if trail.last().is_some_and(|last| last.distance(now) > PUT) {
        trail.clear();
    }
    trail.push(now);
    if trail.len() > TRAIL {
        trail.remove(0);
    }
}

/// Moves a point nearer to the eye by `by` metres, at most by half of its distance. The point stays at the same pixel.
pub(crate) fn nearer(place: DVec3, eye: DVec3, by: f64) -> DVec3 {
    let distance = (place - eye).length();
    eye + (place - eye) * (1.0 - (by / distance).min(0.5))
}

/// Draws a dot that has about the same size at any distance.
pub(crate) fn dot(over: &mut Overlay, at: DVec3, eye: DVec3, size: f64, color: [f32; 3]) {
    let radius = (at - eye).length() * DOT * size;
    for side in 0..8u32 {
        let sign = |bit: u32| {
            if side >> bit & 1 == 0 {
                radius
            } else {
                -radius
            }
        };
        let tips = [DVec3::X * sign(0), DVec3::Y * sign(1), DVec3::Z * sign(2)];
        over.triangle(tips.map(|tip| at + tip), opaque(color));
    }
}

/// A point on each part of the skin at rest: the first hit of a ray from outside through the part's middle. The ray
/// comes from the side to which the part faces, and from the side away from the creature's middle.
fn anchors(mesh: &Arc<ColliderMesh>) -> Vec<MaterialPoint> {
    let surface = SkinnedSurface::new(Arc::clone(mesh));
    let far = 4.0 * mesh.radius();
    let parts: Vec<Side> = mesh.parts().iter().map(|part| side(mesh, part)).collect();
    let area: f32 = parts.iter().map(|part| part.area).sum();
    let middle = parts
        .iter()
        .map(|part| part.middle * part.area)
        .sum::<Vec3>()
        / area;
    let found = parts.iter().filter(|part| part.area >= LEAST_AREA * area);
    let found = found.filter_map(|part| {
        let away = (part.middle - middle) / mesh.radius();
        let outward = (part.normal / part.area + away).normalize_or(Vec3::Y);
        let ray = Ray::new(part.middle + outward * far, -outward)?;
        let hit = surface.in_model().cast_ray(&ray, 2.0 * far)?;
        Some(MaterialPoint::on_triangle(hit.triangle, hit.barycentric))
    });
    found.collect()
}

/// A part of the skin at rest.
struct Side {
    area: f32,
    middle: Vec3,
    /// Sum of its triangles' normals, weighted by their areas.
    normal: Vec3,
}

fn side(mesh: &ColliderMesh, part: &Part) -> Side {
    let mut side = Side {
        area: 0.0,
        middle: Vec3::ZERO,
        normal: Vec3::ZERO,
    };
    for triangle in &part.triangles {
        let corners = mesh.triangles()[triangle.index()];
        let [a, b, c] = corners.map(|vertex| mesh.positions()[vertex.index()]);
        let normal = (b - a).cross(c - a) / 2.0;
        side.normal += normal;
        side.area += normal.length();
        side.middle += (a + b + c) / 3.0 * normal.length();
    }
    side.middle /= side.area.max(f32::MIN_POSITIVE);
    side
}

fn joints(over: &mut Overlay, battle: &Battle<'_>, eye: DVec3, by: f64) {
    let root = battle.surface().world_from_model();
    let skeleton = &battle.creature().skeleton;
    let at = |joint: JointId| {
        let frame = battle.palette().model_from_joint(joint)?;
        Some(nearer(root.transform_point(frame.translation), eye, by))
    };
    for (index, joint) in (0..).zip(skeleton.joints()) {
        let Some(place) = at(JointId(index)) else {
            continue;
        };
        if let Some(parent) = joint.parent.and_then(at) {
            over.line(parent, place, 3.0, [1.0, 0.75, 0.1, 0.9]);
        }
        dot(over, place, eye, 1.0, VERMILION);
    }
}

/// Draws the triangles that face the eye, and the borders between clusters.
fn clusters(over: &mut Overlay, battle: &Battle<'_>, eye: DVec3, by: f64) {
    let surface = battle.surface();
    for cluster in surface.clusters() {
        let (color, fill, border) = if cluster.skinned {
            (ORANGE, 0.6, 1.0)
        } else {
            (SKY_BLUE, 0.22, 0.45)
        };
        // Per edge: its ends, and the number of triangles of the cluster that have it.
        let mut edges: BTreeMap<[VertexId; 2], ([DVec3; 2], u32)> = BTreeMap::new();
        for triangle in cluster.triangles {
            let Some(corners) = posed(surface, *triangle) else {
                continue;
            };
            let [a, b, c] = corners;
            if (b - a).cross(c - a).dot(eye - a) <= 0.0 {
                continue;
            }
            let corners = corners.map(|corner| nearer(corner, eye, by));
            over.triangle(corners, seen_through(color, fill));
            let vertices = surface.mesh().triangles()[triangle.index()];
            for [from, to] in [[0, 1], [1, 2], [2, 0]] {
                let mut edge = [vertices[from], vertices[to]];
                edge.sort_unstable();
                let places = [corners[from], corners[to]];
                edges.entry(edge).or_insert((places, 0)).1 += 1;
            }
        }
        for ([from, to], count) in edges.into_values() {
            if count == 1 {
                over.line(from, to, 1.5, seen_through(color, border));
            }
        }
    }
}

/// The corners of a triangle in world space.
pub(crate) fn posed(surface: &SkinnedSurface, triangle: TriangleId) -> Option<[DVec3; 3]> {
    let corners = surface.mesh().triangles().get(triangle.index())?;
    let [a, b, c] = corners.map(|vertex| surface.in_model().position(vertex));
    let root = surface.world_from_model();
    Some([a?, b?, c?].map(|corner| root.transform_point_f32(corner)))
}

fn contact(over: &mut Overlay, battle: &Battle<'_>, way: &[DVec3]) {
    over.path(way, 2.5, [1.0, 1.0, 1.0, 0.8]);
    let support = battle.climber().state().support;
    let Some(support) = support.filter(|support| support.attachment.obstacle == CREATURE) else {
        return;
    };
    let triangle = support.attachment.material.triangle();
    if let Some(corners) = triangle.and_then(|triangle| posed(battle.surface(), triangle)) {
        over.triangle(corners, [0.1, 1.0, 0.3, 0.55]);
        let [a, b, c] = corners;
        over.path(&[a, b, c, a], 3.0, [0.1, 1.0, 0.3, 1.0]);
    }
    over.sphere(support.attachment.point, 0.08, 2.0, [1.0, 0.1, 0.1, 1.0]);
}

/// Radius of the largest ball inside a rock.
fn inner_radius(shape: &dyn Shape) -> f64 {
    f64::from(match shape.as_typed_shape() {
        TypedShape::Ball(ball) => ball.radius,
        TypedShape::Capsule(capsule) => capsule.radius,
        TypedShape::Cuboid(cuboid) => cuboid.half_extents.min_element(),
        _ => 0.0,
    })
}

/// The deepest contact point of a collider with each other one.
fn touching(world: &PhysicsWorld, collider: ColliderHandle) -> Vec<DVec3> {
    let pairs = world.narrow_phase.contact_pairs_with(collider);
    let pairs = pairs.filter(|pair| pair.has_any_active_contact());
    let points = pairs.filter_map(|pair| {
        let first = world.colliders.get(pair.collider1)?.position();
        let (_, contact) = pair.find_deepest_contact()?;
        Some(first.transform_point(contact.local_p1).as_dvec3())
    });
    points.collect()
}

fn rocks(over: &mut Overlay, battle: &Battle<'_>) {
    for (_, collider) in battle.world().colliders.iter() {
        // Patches of skin are the only shapes here that have parts, apart from the ground.
        let Some(patch) = collider
            .shape()
            .as_composite_shape()
            .filter(|_| collider.is_enabled())
        else {
            continue;
        };
        for part in patch.bvh().leaves(|_| true) {
            patch.map_part_at(part, &mut |_, shape, _| {
                let Some(triangle) = shape.as_triangle() else {
                    return;
                };
                let at = |corner: Vec3| collider.position().transform_point(corner).as_dvec3();
                let corners = [at(triangle.a), at(triangle.b), at(triangle.c)];
                over.triangle(corners, [0.1, 0.5, 1.0, 0.35]);
                over.path(
                    &[corners[0], corners[1], corners[2], corners[0]],
                    1.5,
                    [0.3, 0.7, 1.0, 0.9],
                );
            });
        }
    }
}

/// The battle's state as text, one value a line.
fn state(battle: &Battle<'_>) -> String {
    let surface = battle.surface();
    let mesh = surface.mesh();
    let state = battle.climber().state();
    let on_skin = state
        .support
        .filter(|support| support.attachment.obstacle == CREATURE);
    let doing = match on_skin {
        None if state.support.is_none() => verb(state.mode).to_owned(),
        None => format!("{} the ground", verb(state.mode)),
        Some(support) => {
            let triangle = support.attachment.material.triangle();
            let joint = triangle.and_then(|triangle| mesh.joint_of(triangle));
            let joints = battle.creature().skeleton.joints();
            let joint = joint.and_then(|joint| joints.get(joint.index()));
            let tag = triangle.and_then(|triangle| mesh.tags().get(triangle.index()));
            let kind = tag.map(|tag| tag.kind);
            format!(
                "{} {} of {}",
                verb(state.mode),
                match kind {
                    Some(SurfaceKind::Fur) => "fur",
                    Some(SurfaceKind::Stone) => "stone",
                    _ => "skin",
                },
                joint.map_or("the creature", |joint| &joint.name)
            )
        }
    };
    let motion = on_skin.and_then(|support| surface.motion(&support.attachment.material, TICK));
    let speeds = match motion {
        Some(motion) => format!(
            "speed    {:5.2} m/s over the skin\nskin     {:5.2} m/s",
            (state.velocity - motion.velocity).length(),
            motion.velocity.length()
        ),
        None => format!(
            "speed    {:5.2} m/s\nskin         -",
            state.velocity.length()
        ),
    };
    let tick = surface.diagnostics();
    let skinned = 100.0 * tick.vertices_skinned as f64 / tick.vertices.max(1) as f64;
    format!(
        "time     {:5.2} s, tick {}\nclimber  {doing}\n{}{speeds}\nskinned  {skinned:5.1} % of vertices\n\
         rocks    {:2}",
        battle.tick() as f64 * TICK,
        battle.tick(),
        strength(battle),
        battle.rocks().len()
    )
}

/// Draws the soles of the feet; standing feet have another colour than feet in the air.
fn feet(over: &mut Overlay, battle: &Battle<'_>) {
    let Some(life) = battle.life() else {
        return;
    };
    for (leg, corners) in (0..).map_while(|leg| Some((leg, life.sole(leg)?))) {
        let [a, b, c, d] = corners;
        let color = if life.state().is_planted(leg) {
            SKY_BLUE
        } else {
            ORANGE
        };
        over.triangle([a, b, c], seen_through(color, 0.4));
        over.triangle([a, c, d], seen_through(color, 0.4));
        over.path(&[a, b, c, d, a], 4.0, opaque(color));
    }
}

/// The brain of the creature as text: its state, its moods, and the senses whose value is finite and not 0.
fn brain(battle: &Battle<'_>) -> String {
    let Some(life) = battle.life() else {
        return "no brain: a timetable".to_owned();
    };
    let (brain, state) = (life.kind().brain(), life.state());
    let seconds = f64::from(state.brain().ticks_in_state(brain)) * brain.tick();
    let mut text = format!(
        "state    {} for {seconds:.1} s\n",
        brain.path(state.current())
    );
    if let Some((_, phase)) = life.attack() {
        text += &format!("attack   {phase:?}\n");
    }
    for (index, name) in brain.moods().enumerate() {
        let mood = state.brain().mood(brain, index);
        text += &format!("{name:<9}{}\n", bar(mood));
    }
    let senses = Sense::all().map(|sense| (sense, state.senses().get(sense)));
    let felt = senses.filter(|(_, value)| *value != 0.0 && value.is_finite());
    for (sense, value) in felt {
        text += &format!("{:<20}{value:8.2}\n", sense.name());
    }
    text
}

/// A share from 0 to 1 as a bar of text.
fn bar(share: f64) -> String {
    /// Number of characters of a full bar.
    const CELLS: f64 = 20.0;
    let full = (share * CELLS).ceil() as usize;
    format!("[{:<width$}]", "#".repeat(full), width = CELLS as usize)
}

/// The remaining stamina and hit points, and the shake of the hold, if the climber is configured for them.
fn strength(battle: &Battle<'_>) -> String {
    let (config, state) = (battle.climber().config(), battle.climber().state());
    let mut lines = String::new();
    if config.stamina.is_some() {
        lines += &format!("stamina  {}\n", bar(state.stamina));
    }
    if config.health.is_some() {
        lines += &format!("health   {}\n", bar(state.hit_points));
    }
    if config.stamina.is_some() {
        lines += &format!("shake    {:5.2} m/s2\n", state.shake.length());
    }
    lines
}

/// A mode as a verb, with a preposition if the climber has a support.
fn verb(mode: ClimberMode) -> &'static str {
    match mode {
        ClimberMode::Standing => "stands on",
        ClimberMode::Sliding => "slides",
        ClimberMode::Holding => "holds on to",
        ClimberMode::Hanging | ClimberMode::LedgeHanging => "hangs from",
        ClimberMode::Falling => "falls",
        ClimberMode::Custom(_) => "falls",
        ClimberMode::Tumbling => "tumbles",
    }
}
