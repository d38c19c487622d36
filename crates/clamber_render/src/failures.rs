//! Tests that lost devices, devices out of memory, and devices with too low limits cause errors, never panics.

use std::io::Write;

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::Influence;
use clamber_surface::rig::{JointId, Palette};
use glam::{DVec3, Vec3};
use wgpu::{InstanceDescriptor, Limits};

use crate::target::Target;
use crate::{
    Camera, Drawn, Frame, Gpu, Light, Overlay, RenderError, RenderMesh, RenderMeshId, Renderer,
    SkinSource,
};

#[path = "../tests/all/common/mod.rs"]
mod common;

/// Adds a mesh of `vertices` vertices on one joint.
fn add(renderer: &mut Renderer, vertices: usize) -> Result<RenderMeshId, RenderError> {
    let influence = Influence {
        joint: JointId(0),
        weight: 1.0,
    };
    let corner = |index: usize| Vec3::new((index % 2) as f32, (index / 2 % 2) as f32, 0.0);
    let ends: Vec<u32> = (1..=vertices as u32).collect();
    renderer.add_mesh(&RenderMesh {
        positions: &(0..vertices).map(corner).collect::<Vec<_>>(),
        triangles: &[[0, 1, 2]],
        skin: Some(SkinSource {
            influences: &vec![influence; vertices],
            ends: &ends,
            joint_count: 1,
        }),
        ..RenderMesh::default()
    })
}

fn frame(mesh: RenderMeshId, palette: &Palette) -> Frame<'_> {
    let drawn = Drawn {
        mesh,
        world_from_model: Similarity::IDENTITY,
        palette: Some(palette),
    };
    Frame {
        camera: Camera::new(DVec3::Z * 3.0, DVec3::ZERO),
        light: Light::over(DVec3::ZERO, 3.0),
        drawn: vec![drawn],
        overlay: Overlay::default(),
    }
}

fn palette() -> Palette {
    Palette::from_matrices([Affine::IDENTITY])
}

#[test]
fn a_device_that_is_lost_is_an_error_from_then_on() {
    let Some(gpu) = common::gpu("lost") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, 32, 32).unwrap();
    let mesh = add(&mut renderer, 3).unwrap();
    let palette = palette();
    let mut frame = frame(mesh, &palette);
    renderer.draw(&frame).unwrap();
    renderer.gpu().device.destroy();
    // The second instance and the overlay need new buffers.
    frame.drawn.push(frame.drawn[0]);
    let red = [1.0, 0.0, 0.0, 1.0];
    frame.overlay.line(DVec3::ZERO, DVec3::X, 2.0, red);
    // In the second round, the renderer knows the loss already.
    for _ in 0..2 {
        let results = [
            renderer.draw(&frame).map(drop),
            renderer.draw_unread(&frame),
            add(&mut renderer, 3).map(drop),
            renderer.posed_positions(mesh, &palette).map(drop),
            renderer.pose_unread(mesh, &palette),
            renderer.gpu().wait(),
        ];
        for (index, result) in results.into_iter().enumerate() {
            assert!(
                matches!(result, Err(RenderError::Lost(_))),
                "{index}: {result:?}"
            );
        }
    }
}

#[test]
fn a_device_lost_before_there_is_a_renderer_is_an_error() {
    let Some(gpu) = common::gpu("lost before") else {
        return;
    };
    gpu.device.destroy();
    let result = Renderer::new(gpu, 32, 32).map(drop);
    assert!(matches!(result, Err(RenderError::Lost(_))), "{result:?}");
}

#[test]
fn a_device_out_of_memory_is_an_error_and_can_draw_again() {
    let Some(gpu) = common::gpu("out of memory") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, 32, 32).unwrap();
    let mesh = add(&mut renderer, 3).unwrap();
    let palette = palette();
    let frame = frame(mesh, &palette);
    let before = renderer.draw(&frame).unwrap();
    let side = renderer.gpu().device.limits().max_texture_dimension_2d;
    // Eight targets of the largest size exceed the memory of all but the largest devices.
    let mut held = Vec::new();
    let error = loop {
        let gpu = renderer.gpu();
        match gpu.checked(|| Target::new(gpu, side, side)) {
            Ok(target) if held.len() < 8 => held.push(target),
            Ok(_) => {
                let line = format!("SKIPPED out of memory: {} has too much of it\n", gpu.name());
                let _ = std::io::stderr().write_all(line.as_bytes());
                return;
            }
            Err(error) => break error,
        }
    };
    assert!(matches!(error, RenderError::OutOfMemory), "{error:?}");
    assert!(error.to_string().contains("smaller pictures"), "{error}");
    drop(held);
    assert_eq!(renderer.draw(&frame).unwrap(), before);
    add(&mut renderer, 3).unwrap();
}

#[test]
fn data_too_large_for_the_device_is_an_error_that_says_what_to_do() {
    if common::gpu("limits").is_none() {
        return;
    }
    let small = |limits| Limits {
        max_buffer_size: 40_000,
        max_storage_buffer_binding_size: 3_200,
        ..limits
    };
    let gpu = || {
        let descriptor = InstanceDescriptor::new_without_display_handle_from_env();
        Gpu::with(descriptor, small).unwrap()
    };
    for (width, height) in [(101, 100), (100, 1), (1 << 20, 1)] {
        let result = Renderer::new(gpu(), width, height).map(drop);
        if width == 100 {
            result.unwrap();
        } else {
            assert!(matches!(result, Err(RenderError::Frame(_))), "{result:?}");
        }
    }
    let mut renderer = Renderer::new(gpu(), 32, 32).unwrap();
    let mesh = add(&mut renderer, 100).unwrap();
    let palette = palette();
    let good = frame(mesh, &palette);
    let before = renderer.draw(&good).unwrap();

    let triangles = vec![[0; 3]; 4_000];
    let result = renderer.add_mesh(&RenderMesh {
        positions: &[Vec3::ZERO],
        triangles: &triangles,
        ..RenderMesh::default()
    });
    let joints = renderer.add_mesh(&RenderMesh {
        skin: Some(SkinSource {
            joint_count: 67,
            ..SkinSource::default()
        }),
        ..RenderMesh::default()
    });
    for result in [add(&mut renderer, 101), result, joints] {
        let text = format!("{result:?}");
        assert!(matches!(result, Err(RenderError::Mesh(_))), "{text}");
        assert!(text.contains("split it"), "{text}");
    }
    let mut lines = good.clone();
    for _ in 0..200 {
        lines.overlay.line(DVec3::ZERO, DVec3::X, 1.0, [1.0; 4]);
    }
    let mut many = good.clone();
    many.drawn = vec![good.drawn[0]; 51];
    for frame in [lines, many] {
        let result = renderer.draw(&frame).map(drop);
        assert!(matches!(result, Err(RenderError::Frame(_))), "{result:?}");
    }
    assert_eq!(renderer.draw(&good).unwrap(), before);
}

#[test]
fn an_error_outside_of_checked_is_returned_by_the_next_check() {
    let Some(gpu) = common::gpu("unasked") else {
        return;
    };
    let most = gpu.device.limits().max_buffer_size;
    let _refused = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("too large"),
        size: most + 4,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    });
    let told = gpu.checked(|| ());
    assert!(matches!(told, Err(RenderError::Refused(_))), "{told:?}");
    gpu.checked(|| ()).unwrap();
}
