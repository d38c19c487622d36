use bytemuck::cast_slice;
use clamber_surface::rig::Palette;
use glam::dcamera::rh::proj::directx::orthographic;
use glam::dcamera::rh::view::look_to_mat4;
use glam::{DMat3, DMat4, DVec3, DVec4, Mat4, Vec3};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindingResource, BufferDescriptor,
    BufferUsages, Color, CommandEncoder, CompareFunction, IndexFormat, LoadOp, Operations,
    RenderPass, RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor,
    SamplerDescriptor, StoreOp,
};

use crate::mesh::{Mesh, POSED_BYTES, buffer};
use crate::pipelines::Pipelines;
use crate::skinning::{Posed, Skinning};
use crate::target::{SHADOW, Target, read, readback_bytes};
use crate::{Drawn, Frame, Gpu, Image, RenderError, RenderMesh, RenderMeshId};

/// Opacity factor of the parts of an overlay that are behind a mesh: 0 hides them, 1 shows no difference.
const BEHIND: f32 = 0.22;

/// Draws frames into pictures of one size.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    pipelines: Pipelines,
    skinning: Skinning,
    target: Target,
    shadow_group: BindGroup,
    meshes: Vec<Mesh>,
    /// For each mesh, its posed instances: as many as one frame has shown at most.
    posed: Vec<Vec<Posed>>,
    uploaded: u64,
}

impl Renderer {
    /// A renderer for pictures of a size in pixels.
    ///
    /// # Errors
    /// [`RenderError::Frame`] for a size of 0, or too large for the device. [`RenderError::Lost`],
    /// [`RenderError::OutOfMemory`] and [`RenderError::Refused`] as for [`Renderer::draw`].
    pub fn new(gpu: Gpu, width: u32, height: u32) -> Result<Self, RenderError> {
        let limits = gpu.device.limits();
        let most = limits.max_texture_dimension_2d;
        let fits = [width, height].iter().all(|side| (1..=most).contains(side));
        if !fits || readback_bytes(width, height) > limits.max_buffer_size {
            return Err(RenderError::Frame(format!(
                "a picture of {width} x {height}: on this device each side must be from 1 to {most} pixels, \
                 and all of it at most {} bytes",
                limits.max_buffer_size
            )));
        }
        let (pipelines, skinning, target) = gpu.checked(|| {
            let target = Target::new(&gpu, width, height);
            (Pipelines::new(&gpu), Skinning::new(&gpu), target)
        })?;
        let shadow_group = gpu.checked(|| shadow_group(&gpu, &pipelines, &target))?;
        Ok(Self {
            gpu,
            pipelines,
            skinning,
            target,
            shadow_group,
            meshes: Vec::new(),
            posed: Vec::new(),
            uploaded: 0,
        })
    }

    /// Uploads a mesh to the device. The mesh stays there until the renderer is dropped.
    ///
    /// # Errors
    /// [`RenderError::Mesh`] for data that is not consistent, not finite, or too large for the device.
    /// [`RenderError::Lost`], [`RenderError::OutOfMemory`] and [`RenderError::Refused`] as for [`Renderer::draw`].
    pub fn add_mesh(&mut self, source: &RenderMesh<'_>) -> Result<RenderMeshId, RenderError> {
        let mesh = self.gpu.checked(|| Mesh::new(&self.gpu, source))??;
        let id = RenderMeshId(self.meshes.len() as u32);
        self.meshes.push(mesh);
        self.posed.push(Vec::new());
        Ok(id)
    }

    /// Draws a picture and reads it back.
    ///
    /// # Errors
    /// [`RenderError::Frame`] for a frame that cannot be drawn: a camera without a direction, an unknown mesh, a
    /// palette with another number of joints, or too much data for the device. [`RenderError::Lost`] if the device
    /// is lost, [`RenderError::OutOfMemory`] if it has no memory left, [`RenderError::Refused`] for other errors of
    /// the graphics library.
    pub fn draw(&mut self, frame: &Frame<'_>) -> Result<Image, RenderError> {
        let encoder = self.encoded(frame)?;
        self.submit(encoder, |encoder| self.target.copy_out(encoder))?;
        self.target.read(&self.gpu)
    }

    /// Draws a picture without reading it back, and does not wait for it. With [`Gpu::wait`] it measures the
    /// cost of drawing.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    #[doc(hidden)]
    pub fn draw_unread(&mut self, frame: &Frame<'_>) -> Result<(), RenderError> {
        let encoder = self.encoded(frame)?;
        self.submit(encoder, |_| {})
    }

    /// Bytes that were uploaded for the last picture: palettes, matrices, uniforms and overlays.
    #[doc(hidden)]
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// The device of this renderer.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Positions of a skinned mesh's vertices as the device poses and draws them, in model space.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    #[doc(hidden)]
    pub fn posed_positions(
        &mut self,
        mesh: RenderMeshId,
        palette: &Palette,
    ) -> Result<Vec<Vec3>, RenderError> {
        self.make_room(mesh, 0)?;
        let (found, posed) = self.posed_mesh(mesh, 0);
        let size = posed.vertices.size();
        let (copy, encoder) = self.gpu.checked(|| {
            let copy = self.gpu.device.create_buffer(&BufferDescriptor {
                label: Some("posed, to be read"),
                size,
                usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            (copy, self.posing(found, posed, palette))
        })?;
        self.submit(encoder?, |encoder| {
            encoder.copy_buffer_to_buffer(&posed.vertices, 0, &copy, 0, size);
        })?;
        let bytes = read(&self.gpu, &copy)?;
        let vertices = bytes.chunks_exact(POSED_BYTES as usize);
        Ok(vertices
            .take(found.vertex_count as usize)
            .map(|vertex| {
                let at = |axis: usize| {
                    let bytes = &vertex[axis * 4..axis * 4 + 4];
                    f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
                };
                Vec3::new(at(0), at(1), at(2))
            })
            .collect())
    }

    /// Poses a skinned mesh on the device, and does not wait for it. With [`Gpu::wait`] it measures the cost of posing.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    #[doc(hidden)]
    pub fn pose_unread(
        &mut self,
        mesh: RenderMeshId,
        palette: &Palette,
    ) -> Result<(), RenderError> {
        self.make_room(mesh, 0)?;
        let (found, posed) = self.posed_mesh(mesh, 0);
        let encoder = self.gpu.checked(|| self.posing(found, posed, palette))?;
        self.submit(encoder?, |_| {})
    }

    fn check(&self, frame: &Frame<'_>) -> Result<(), RenderError> {
        let wrong = |what: &str| Err(RenderError::Frame(what.into()));
        if !frame.camera.is_valid() {
            return wrong(
                "the camera is not finite, its view is zero or along `up`, or its angle is out of range",
            );
        }
        let light = &frame.light;
        let lit = light.to_sun.is_finite() && light.to_sun.length_squared() > 0.0;
        let shadow = light.shadow_center.is_finite() && light.shadow_radius > 0.0;
        let air = light.fog >= 0.0 && light.fog.is_finite();
        if !lit || !shadow || !air || !light.shadow_radius.is_finite() {
            return wrong("the light has no direction, or its shadow or fog is out of range");
        }
        let limits = self.gpu.device.limits();
        let most = limits
            .max_buffer_size
            .min(limits.max_storage_buffer_binding_size)
            / 64;
        if frame.drawn.len() as u64 > most {
            return wrong(&format!(
                "{} meshes, but this device takes at most {most}: join some of them",
                frame.drawn.len()
            ));
        }
        for drawn in &frame.drawn {
            let Some(mesh) = self.meshes.get(drawn.mesh.0 as usize) else {
                return wrong("it shows a mesh of another renderer");
            };
            if !drawn.world_from_model.is_valid() {
                return wrong("the `world_from_model` of a mesh is not valid");
            }
            if drawn.palette.is_some() && mesh.skin.is_none() {
                return wrong("a palette for a mesh without joints");
            }
        }
        Ok(())
    }

    /// Makes room for instances 0 to `number` of a skinned mesh.
    fn make_room(&mut self, mesh: RenderMeshId, number: usize) -> Result<(), RenderError> {
        let index = mesh.0 as usize;
        let unknown = || RenderError::Frame("it shows a mesh of another renderer".into());
        let found = self.meshes.get(index).ok_or_else(unknown)?;
        let skin = found.skin.as_ref();
        let skin = skin.ok_or_else(|| RenderError::Frame("the mesh has no joints".into()))?;
        while self.posed[index].len() <= number {
            let room = self
                .gpu
                .checked(|| self.skinning.posed(&self.gpu, found, skin))?;
            self.posed[index].push(room);
        }
        Ok(())
    }

    /// For each mesh of the frame, the number of its posed instance.
    fn places(&mut self, frame: &Frame<'_>) -> Result<Vec<usize>, RenderError> {
        let mut used = vec![0; self.meshes.len()];
        let mut places = Vec::with_capacity(frame.drawn.len());
        for drawn in &frame.drawn {
            let used = &mut used[drawn.mesh.0 as usize];
            places.push(*used);
            if drawn.palette.is_some() {
                self.make_room(drawn.mesh, *used)?;
                *used += 1;
            }
        }
        Ok(places)
    }

    fn posed_mesh(&self, mesh: RenderMeshId, number: usize) -> (&Mesh, &Posed) {
        let index = mesh.0 as usize;
        (&self.meshes[index], &self.posed[index][number])
    }

    fn posing(
        &self,
        mesh: &Mesh,
        posed: &Posed,
        palette: &Palette,
    ) -> Result<CommandEncoder, RenderError> {
        let mut encoder = self.encoder();
        let count = mesh.vertex_count;
        self.skinning
            .run(&self.gpu, &mut encoder, posed, count, palette)?;
        Ok(encoder)
    }

    fn encoder(&self) -> CommandEncoder {
        let descriptor = wgpu::CommandEncoderDescriptor::default();
        self.gpu.device.create_command_encoder(&descriptor)
    }

    fn encoded(&mut self, frame: &Frame<'_>) -> Result<CommandEncoder, RenderError> {
        self.check(frame)?;
        let places = self.places(frame)?;
        let encoded = self.gpu.checked(|| self.encode(frame, &places))?;
        let (encoder, uploaded) = encoded?;
        self.uploaded = uploaded;
        Ok(encoder)
    }

    /// Submits commands; `after` adds more commands first.
    fn submit(
        &self,
        mut encoder: CommandEncoder,
        after: impl FnOnce(&mut CommandEncoder),
    ) -> Result<(), RenderError> {
        self.gpu.checked(|| {
            after(&mut encoder);
            self.gpu.queue.submit([encoder.finish()]);
        })
    }

    fn encode(
        &self,
        frame: &Frame<'_>,
        places: &[usize],
    ) -> Result<(CommandEncoder, u64), RenderError> {
        let mut encoder = self.encoder();
        let mut uploaded = 0;
        for (drawn, place) in frame.drawn.iter().zip(places) {
            let index = drawn.mesh.0 as usize;
            if let Some(palette) = drawn.palette {
                let (mesh, posed) = (&self.meshes[index], &self.posed[index][*place]);
                uploaded += self.skinning.run(
                    &self.gpu,
                    &mut encoder,
                    posed,
                    mesh.vertex_count,
                    palette,
                )?;
            }
        }
        let uniform = BufferUsages::UNIFORM;
        let aspect = f64::from(self.target.width) / f64::from(self.target.height);
        let clip_from_view = frame.camera.clip_from_view(aspect);
        let globals = globals(frame, clip_from_view);
        let instances: Vec<[f32; 16]> = frame
            .drawn
            .iter()
            .map(|drawn| view_from_model(drawn, frame.camera.eye).to_cols_array())
            .collect();
        uploaded += (globals.len() * 4 + instances.len() * 64) as u64;
        let globals = buffer(&self.gpu, "globals", cast_slice(&globals), uniform);
        let instances = buffer(
            &self.gpu,
            "instances",
            cast_slice(&instances),
            BufferUsages::STORAGE,
        );
        let globals = self
            .gpu
            .bind(&self.pipelines.globals, &[&globals, &instances]);
        {
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("shadow"),
                depth_stencil_attachment: Some(depth(&self.target.shadow, 1.0)),
                ..RenderPassDescriptor::default()
            });
            pass.set_pipeline(&self.pipelines.shadow);
            pass.set_bind_group(0, &globals, &[]);
            self.draw_meshes(&mut pass, frame, places);
        }
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: &self.target.color,
                depth_slice: None,
                resolve_target: Some(&self.target.resolved_view),
                ops: Operations {
                    load: LoadOp::Clear(Color::BLACK),
                    store: StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(depth(&self.target.depth, 0.0)),
            ..RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, &globals, &[]);
        pass.set_bind_group(1, &self.shadow_group, &[]);
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..3, 0..1);
        pass.set_pipeline(&self.pipelines.mesh);
        self.draw_meshes(&mut pass, frame, places);
        uploaded += self.draw_overlay(&mut pass, frame, clip_from_view)?;
        drop(pass);
        Ok((encoder, uploaded))
    }

    fn draw_meshes(&self, pass: &mut RenderPass<'_>, frame: &Frame<'_>, places: &[usize]) {
        for (number, (drawn, place)) in (0..).zip(frame.drawn.iter().zip(places)) {
            let index = drawn.mesh.0 as usize;
            let mesh = &self.meshes[index];
            let vertices = match drawn.palette {
                Some(_) => &self.posed[index][*place].vertices,
                None => &mesh.rest,
            };
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.set_vertex_buffer(1, mesh.still.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, number..number + 1);
        }
    }

    fn draw_overlay(
        &self,
        pass: &mut RenderPass<'_>,
        frame: &Frame<'_>,
        clip: DMat4,
    ) -> Result<u64, RenderError> {
        if frame.overlay.is_empty() {
            return Ok(0);
        }
        let vertices = frame.overlay.vertices(frame.camera.eye);
        let contents = cast_slice(&vertices);
        let most = self.gpu.device.limits().max_buffer_size;
        if contents.len() as u64 > most {
            return Err(RenderError::Frame(format!(
                "an overlay of {} bytes, but this device takes {most}: draw fewer lines and triangles",
                contents.len()
            )));
        }
        let over = buffer(&self.gpu, "overlay", contents, BufferUsages::VERTEX);
        pass.set_vertex_buffer(0, over.slice(..));
        for (pipeline, opacity) in self.pipelines.overlay.iter().zip([1.0, BEHIND]) {
            let mut globals = clip.as_mat4().to_cols_array().to_vec();
            let (width, height) = (self.target.width as f32, self.target.height as f32);
            globals.extend([width, height, opacity, 0.0]);
            let globals = cast_slice(&globals);
            let globals = buffer(&self.gpu, "overlay", globals, BufferUsages::UNIFORM);
            let globals = self.gpu.bind(&self.pipelines.overlay_globals, &[&globals]);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &globals, &[]);
            pass.draw(0..vertices.len() as u32, 0..1);
        }
        Ok(contents.len() as u64 + 2 * 80)
    }
}

fn shadow_group(gpu: &Gpu, pipelines: &Pipelines, target: &Target) -> BindGroup {
    let sampler = gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("shadow"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(CompareFunction::LessEqual),
        ..SamplerDescriptor::default()
    });
    gpu.device.create_bind_group(&BindGroupDescriptor {
        label: Some("shadow map"),
        layout: &pipelines.shadow_map,
        entries: &[
            BindGroupEntry {
                binding: 0,
                resource: BindingResource::TextureView(&target.shadow),
            },
            BindGroupEntry {
                binding: 1,
                resource: BindingResource::Sampler(&sampler),
            },
        ],
    })
}

fn depth(view: &wgpu::TextureView, clear: f32) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations {
            load: LoadOp::Clear(clear),
            store: StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// The matrix from model space to world space relative to the eye.
fn view_from_model(drawn: &Drawn<'_>, eye: DVec3) -> Mat4 {
    let root = &drawn.world_from_model;
    let axes = DMat3::from_quat(root.rotation) * root.scale;
    let shift = root.translation - eye;
    let column = |axis: DVec3| axis.extend(0.0);
    DMat4::from_cols(
        column(axes.x_axis),
        column(axes.y_axis),
        column(axes.z_axis),
        DVec4::from((shift, 1.0)),
    )
    .as_mat4()
}

/// The uniforms of a frame, in the layout of the shader.
fn globals(frame: &Frame<'_>, clip_from_view: DMat4) -> Vec<f32> {
    let light = &frame.light;
    let to_sun = light.to_sun.as_dvec3().normalize();
    let radius = light.shadow_radius;
    let center = light.shadow_center - frame.camera.eye;
    let up = to_sun.any_orthonormal_vector();
    let view = look_to_mat4(center + to_sun * (2.0 * radius), -to_sun, up);
    let flat = orthographic(-radius, radius, -radius, radius, 0.0, 4.0 * radius);
    let shadow_from_view = (flat * view).as_mat4();
    let sun = to_sun.as_vec3();
    let mut globals = Vec::with_capacity(56);
    globals.extend(clip_from_view.as_mat4().to_cols_array());
    globals.extend(clip_from_view.inverse().as_mat4().to_cols_array());
    globals.extend(shadow_from_view.to_cols_array());
    globals.extend([sun.x, sun.y, sun.z, 0.0]);
    globals.extend([light.fog, 1.0 / SHADOW as f32, 0.0, 0.0]);
    globals
}
