//! A failure is logged once, not in each frame. This test has a process of its own, since the log is global.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

#[path = "plugin/common/mod.rs"]
mod common;

use std::sync::Mutex;

use bevy_clamber::prelude::*;
use bevy_math::Vec3;
use bevy_mesh::Mesh;
use bevy_transform::components::Transform;
use common::{add_bindposes, add_mesh, app, limb, limb_mesh, spawn_limb, wait};
use tracing::field::{Field, Visit};
use tracing::{Event, Level, Metadata, Subscriber, span};

static LINES: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Keeps warnings and errors of this crate.
struct Lines;

struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
        if field.name() == "message" {
            self.0 = format!("{value:?}");
        }
    }
}

impl Subscriber for Lines {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN
    }
    fn new_span(&self, _: &span::Attributes<'_>) -> span::Id {
        span::Id::from_u64(1)
    }
    fn record(&self, _: &span::Id, _: &span::Record<'_>) {}
    fn record_follows_from(&self, _: &span::Id, _: &span::Id) {}
    fn event(&self, event: &Event<'_>) {
        let mut message = Message(String::new());
        event.record(&mut message);
        if event.metadata().target().starts_with("bevy_clamber") {
            LINES.lock().unwrap().push(message.0);
        }
    }
    fn enter(&self, _: &span::Id) {}
    fn exit(&self, _: &span::Id) {}
}

/// Number of lines since the last call.
fn lines() -> usize {
    let lines = std::mem::take(&mut *LINES.lock().unwrap());
    println!("{lines:#?}");
    lines.len()
}

#[test]
fn each_failure_is_logged_once() {
    tracing::subscriber::set_global_default(Lines).unwrap();
    let mut app = app(64.0);
    // A broken mesh on two entities.
    let mut broken = limb_mesh();
    broken.insert_attribute(Mesh::ATTRIBUTE_POSITION, vec![[f32::NAN; 3]; 84]);
    let mesh = add_mesh(&mut app, broken);
    let bindposes = add_bindposes(&mut app);
    for _ in 0..2 {
        let limb = spawn_limb(
            &mut app,
            mesh.clone(),
            bindposes.clone(),
            Transform::IDENTITY,
        );
        app.world_mut()
            .entity_mut(limb.mesh)
            .insert(SkinnedCollider::default());
        wait(&mut app, limb.mesh);
    }
    for _ in 0..9 {
        app.update();
    }
    assert_eq!(lines(), 1);
    for timing in [PoseTiming::EachFrame, PoseTiming::EachTick] {
        let collider = SkinnedCollider {
            joints: timing,
            root: timing,
            ..SkinnedCollider::each_frame()
        };
        // A joint that is gone, and a root with a scale of zero.
        let gone = limb(&mut app, Transform::IDENTITY, collider);
        app.world_mut().entity_mut(gone.joints[1]).despawn();
        for _ in 0..20 {
            app.update();
        }
        assert_eq!(lines(), 1, "{timing:?}");
        let flat = limb(&mut app, Transform::IDENTITY, collider);
        let mut root = app.world_mut().get_mut::<Transform>(flat.root).unwrap();
        root.scale = Vec3::ZERO;
        for _ in 0..20 {
            app.update();
        }
        assert_eq!(lines(), 1, "{timing:?}");
        // A teleport that nobody told of, three times.
        let jumping = limb(&mut app, Transform::IDENTITY, collider);
        for _ in 0..3 {
            let mut root = app.world_mut().get_mut::<Transform>(jumping.root).unwrap();
            root.translation.x += 50.0;
            for _ in 0..9 {
                app.update();
            }
        }
        assert_eq!(lines(), 1, "{timing:?}");
        // One that the app tells of.
        let told = limb(&mut app, Transform::IDENTITY, collider);
        let mut root = app.world_mut().get_mut::<Transform>(told.root).unwrap();
        root.translation.x += 50.0;
        let mut surface = app.world_mut().get_mut::<PosedSurface>(told.mesh).unwrap();
        surface.forget_motion();
        for _ in 0..9 {
            app.update();
        }
        assert_eq!(lines(), 0, "{timing:?}");
    }
    // A collider on an entity without a mesh says what it waits for, after a while.
    app.world_mut().spawn(SkinnedCollider::default());
    for _ in 0..64 * 4 {
        app.update();
    }
    assert_eq!(lines(), 0);
    for _ in 0..64 * 9 {
        app.update();
    }
    assert_eq!(lines(), 1);
}
