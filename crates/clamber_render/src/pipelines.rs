//! The render pipelines of meshes, shadows, the sky and overlays.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendState,
    BufferBindingType, ColorTargetState, ColorWrites, CompareFunction, DepthBiasState,
    DepthStencilState, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayoutDescriptor, PrimitiveState, RenderPipeline, RenderPipelineDescriptor,
    SamplerBindingType, ShaderModule, ShaderStages, StencilState, TextureSampleType,
    TextureViewDimension, VertexAttribute, VertexBufferLayout, VertexState, VertexStepMode,
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
        let texture = BindingType::Texture {
            sample_type: TextureSampleType::Depth,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = BindingType::Sampler(SamplerBindingType::Comparison);
        let globals = group(gpu, "globals", &[uniform, storage]);
        let shadow_map = group(gpu, "shadow map", &[texture, sampler]);
        let overlay_globals = group(gpu, "overlay", &[uniform]);
        let [mesh, sky, shadow] = of_meshes(gpu, &globals, &shadow_map);
        Self {
            sky,
            mesh,
            shadow,
            overlay: of_overlays(gpu, &overlay_globals),
            globals,
            shadow_map,
            overlay_globals,
        }
    }
}

/// The pipelines of meshes, of the sky and of shadows.
fn of_meshes(
    gpu: &Gpu,
    globals: &BindGroupLayout,
    shadow_map: &BindGroupLayout,
) -> [RenderPipeline; 3] {
    let shader = wgpu::include_wgsl!("shaders/mesh.wgsl");
    let module = gpu.device.create_shader_module(shader);
    let posed = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4];
    let still = wgpu::vertex_attr_array![2 => Float32x4, 3 => Float32x4];
    let mesh = Plan {
        label: "mesh",
        module: &module,
        groups: &[Some(globals), Some(shadow_map)],
        vertex: "vertex",
        buffers: &[layout(POSED_BYTES, &posed), layout(STILL_BYTES, &still)],
        fragment: Some("fragment"),
        samples: SAMPLES,
        compare: CompareFunction::Greater,
        writes_depth: true,
    };
    let sky = Plan {
        label: "sky",
        vertex: "sky_vertex",
        buffers: &[],
        fragment: Some("sky_fragment"),
        compare: CompareFunction::Always,
        writes_depth: false,
        ..mesh
    };
    let shadow = Plan {
        label: "shadow",
        groups: &[Some(globals)],
        vertex: "shadow_vertex",
        fragment: None,
        samples: 1,
        compare: CompareFunction::Less,
        ..mesh
    };
    [&mesh, &sky, &shadow].map(|plan| pipeline(gpu, plan))
}

/// The pipelines of the visible parts of an overlay, and of the parts behind a mesh.
fn of_overlays(gpu: &Gpu, globals: &BindGroupLayout) -> [RenderPipeline; 2] {
    let shader = wgpu::include_wgsl!("shaders/overlay.wgsl");
    let module = gpu.device.create_shader_module(shader);
    let vertices = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
    let visible = Plan {
        label: "overlay in sight",
        module: &module,
        groups: &[Some(globals)],
        vertex: "vertex",
        buffers: &[layout(OVERLAY_BYTES, &vertices)],
        fragment: Some("fragment"),
        samples: SAMPLES,
        compare: CompareFunction::GreaterEqual,
        writes_depth: false,
    };
    let behind = Plan {
        label: "overlay behind",
        compare: CompareFunction::Less,
        ..visible
    };
    [&visible, &behind].map(|plan| pipeline(gpu, plan))
}

fn layout(array_stride: u64, attributes: &[VertexAttribute]) -> Option<VertexBufferLayout<'_>> {
    Some(VertexBufferLayout {
        array_stride,
        step_mode: VertexStepMode::Vertex,
        attributes,
    })
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
