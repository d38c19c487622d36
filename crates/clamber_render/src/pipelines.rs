//! The render pipelines of meshes, shadows, the sky and overlays.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendState,
    BufferBindingType, ColorTargetState, ColorWrites, CompareFunction, DepthBiasState,
    DepthStencilState, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayoutDescriptor, PrimitiveState, RenderPipeline, RenderPipelineDescriptor,
    SamplerBindingType, ShaderModule, ShaderStages, StencilState, TextureSampleType,
    TextureViewDimension, VertexBufferLayout, VertexState, VertexStepMode,
};

use crate::Gpu;
use crate::mesh::{POSED_BYTES, STILL_BYTES};
use crate::target::{COLOR, DEPTH, SAMPLES};

/// Bytes of a vertex of an overlay: three vectors of four f32, as in `overlay.wgsl`.
pub(crate) const OVERLAY_BYTES: u64 = 48;

#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) globals: BindGroupLayout,
    pub(crate) shadow_map: BindGroupLayout,
    pub(crate) overlay_globals: BindGroupLayout,
    pub(crate) sky: RenderPipeline,
    pub(crate) mesh: RenderPipeline,
    pub(crate) shadow: RenderPipeline,
    /// For the visible parts of an overlay, and for the parts behind a mesh.
    pub(crate) overlay: [RenderPipeline; 2],
}

/// The settings in which the pipelines differ.
struct Plan<'a> {
    label: &'a str,
    module: &'a ShaderModule,
    groups: &'a [Option<&'a BindGroupLayout>],
    vertex: &'a str,
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    fragment: Option<&'a str>,
    samples: u32,
    compare: CompareFunction,
    writes_depth: bool,
}

impl Pipelines {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        let mesh_module = device.create_shader_module(wgpu::include_wgsl!("shaders/mesh.wgsl"));
        let overlay_module =
            device.create_shader_module(wgpu::include_wgsl!("shaders/overlay.wgsl"));
        let uniform = BindingType::Buffer {
            ty: BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let storage = BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let globals = group(gpu, "globals", &[uniform, storage]);
        let shadow_map = group(
            gpu,
            "shadow map",
            &[
                BindingType::Texture {
                    sample_type: TextureSampleType::Depth,
                    view_dimension: TextureViewDimension::D2,
                    multisampled: false,
                },
                BindingType::Sampler(SamplerBindingType::Comparison),
            ],
        );
        let overlay_globals = group(gpu, "overlay", &[uniform]);
        let posed = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
        let still = wgpu::vertex_attr_array![2 => Float32x4, 3 => Float32x4];
        let over = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
        let layout = |array_stride, attributes| {
            Some(VertexBufferLayout {
                array_stride,
                step_mode: VertexStepMode::Vertex,
                attributes,
            })
        };
        let mesh_buffers = [layout(POSED_BYTES, &posed), layout(STILL_BYTES, &still)];
        let overlay_buffers = [layout(OVERLAY_BYTES, &over)];
        let drawn = Plan {
            label: "mesh",
            module: &mesh_module,
            groups: &[Some(&globals), Some(&shadow_map)],
            vertex: "vertex",
            buffers: &mesh_buffers,
            fragment: Some("fragment"),
            samples: SAMPLES,
            compare: CompareFunction::Greater,
            writes_depth: true,
        };
        let mesh = pipeline(gpu, &drawn);
        let sky = pipeline(
            gpu,
            &Plan {
                label: "sky",
                vertex: "sky_vertex",
                buffers: &[],
                fragment: Some("sky_fragment"),
                compare: CompareFunction::Always,
                writes_depth: false,
                ..drawn
            },
        );
        let shadow = pipeline(
            gpu,
            &Plan {
                label: "shadow",
                groups: &[Some(&globals)],
                vertex: "shadow_vertex",
                fragment: None,
                samples: 1,
                compare: CompareFunction::Less,
                ..drawn
            },
        );
        let over = |label, compare| {
            pipeline(
                gpu,
                &Plan {
                    label,
                    module: &overlay_module,
                    groups: &[Some(&overlay_globals)],
                    vertex: "vertex",
                    buffers: &overlay_buffers,
                    fragment: Some("fragment"),
                    samples: SAMPLES,
                    compare,
                    writes_depth: false,
                },
            )
        };
        let overlay = [
            over("overlay in sight", CompareFunction::GreaterEqual),
            over("overlay behind", CompareFunction::Less),
        ];
        Self {
            globals,
            shadow_map,
            overlay_globals,
            sky,
            mesh,
            shadow,
            overlay,
        }
    }
}

fn group(gpu: &Gpu, label: &str, bindings: &[BindingType]) -> BindGroupLayout {
    let entries: Vec<BindGroupLayoutEntry> = (0..)
        .zip(bindings)
        .map(|(binding, ty)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: *ty,
            count: None,
        })
        .collect();
    gpu.device
        .create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &entries,
        })
}

fn pipeline(gpu: &Gpu, plan: &Plan<'_>) -> RenderPipeline {
    let layout = gpu
        .device
        .create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(plan.label),
            bind_group_layouts: plan.groups,
            immediate_size: 0,
        });
    let targets = [Some(ColorTargetState {
        format: COLOR,
        blend: Some(BlendState::ALPHA_BLENDING),
        write_mask: ColorWrites::ALL,
    })];
    gpu.device
        .create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(plan.label),
            layout: Some(&layout),
            vertex: VertexState {
                module: plan.module,
                entry_point: Some(plan.vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: plan.buffers,
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(plan.writes_depth),
                depth_compare: Some(plan.compare),
                stencil: StencilState::default(),
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState {
                count: plan.samples,
                ..MultisampleState::default()
            },
            fragment: plan.fragment.map(|entry| FragmentState {
                module: plan.module,
                entry_point: Some(entry),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
}
