//! Skinning on the GPU: a compute pass from rest vertices and a palette to posed vertices.

use bytemuck::cast_slice;
use clamber_surface::rig::Palette;
use wgpu::{
    BindGroup, Buffer, BufferDescriptor, BufferUsages, CommandEncoder, ComputePassDescriptor,
    ComputePipeline, ComputePipelineDescriptor,
};

use crate::mesh::{Mesh, PALETTE_BYTES, POSED_BYTES, Skin};
use crate::{Gpu, RenderError};

/// Number of vertices in a workgroup. `skin.wgsl` has the same value.
const GROUP: u32 = 64;

/// Largest number of workgroups along the first axis: within the limit of every device. `skin.wgsl` has the same value.
const ROW: u32 = 32_768;

#[derive(Debug)]
pub(crate) struct Skinning {
    pipeline: ComputePipeline,
}

/// The buffers of one posed instance of a mesh.
#[derive(Debug)]
pub(crate) struct Posed {
    pub(crate) vertices: Buffer,
    palette: Buffer,
    group: BindGroup,
    joint_count: usize,
}

impl Skinning {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let module = gpu
            .device
            .create_shader_module(wgpu::include_wgsl!("shaders/skin.wgsl"));
        let pipeline = gpu
            .device
            .create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some("skin"),
                layout: None,
                module: &module,
                entry_point: Some("skin"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            });
        Self { pipeline }
    }

    /// Creates the buffers for one instance of a mesh.
    pub(crate) fn posed(&self, gpu: &Gpu, mesh: &Mesh, skin: &Skin) -> Posed {
        let vertices = gpu.device.create_buffer(&BufferDescriptor {
            label: Some("posed"),
            size: u64::from(mesh.vertex_count.max(1)) * POSED_BYTES,
            usage: BufferUsages::VERTEX | BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let palette = gpu.device.create_buffer(&BufferDescriptor {
            label: Some("palette"),
            size: skin.joint_count.max(1) as u64 * PALETTE_BYTES,
            usage: BufferUsages::STORAGE | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let buffers = [
            &mesh.rest,
            &skin.ends,
            &skin.influences,
            &palette,
            &vertices,
        ];
        let group = gpu.bind(&self.pipeline.get_bind_group_layout(0), &buffers);
        Posed {
            vertices,
            palette,
            group,
            joint_count: skin.joint_count,
        }
    }

    /// Poses an instance, and returns the number of uploaded bytes.
    pub(crate) fn run(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        posed: &Posed,
        vertex_count: u32,
        palette: &Palette,
    ) -> Result<u64, RenderError> {
        let matrices = palette.matrices();
        if matrices.len() != posed.joint_count {
            return Err(RenderError::Frame(format!(
                "a palette of {} joints for a mesh with {}",
                matrices.len(),
                posed.joint_count
            )));
        }
        let rows: Vec<[[f32; 4]; 3]> = matrices.iter().map(|matrix| matrix.rows).collect();
        gpu.queue.write_buffer(&posed.palette, 0, cast_slice(&rows));
        let groups = vertex_count.div_ceil(GROUP);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("skin"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &posed.group, &[]);
        pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        Ok(rows.len() as u64 * PALETTE_BYTES)
    }
}
