//! The textures that pictures are drawn into, and reading a picture back.

use std::sync::mpsc;

use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, CommandEncoder, Extent3d, Origin3d,
    TexelCopyBufferInfo, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect,
    TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView,
};

use crate::{Gpu, Image, RenderError};

/// Format of the picture: four bytes a pixel, in sRGB, as in [`Image`].
pub(crate) const COLOR: TextureFormat = TextureFormat::Rgba8UnormSrgb;
/// Format of the depth buffer and of the shadow map.
pub(crate) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Number of samples of a pixel, against jagged edges.
pub(crate) const SAMPLES: u32 = 4;

/// Number of texels along a side of the shadow map. More texels make shadows sharper, but are slower in software.
pub(crate) const SHADOW: u32 = 2048;

/// Alignment of a picture's rows in a buffer, bytes; the graphics library requires it.
const ROW_ALIGNMENT: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) color: TextureView,
    pub(crate) depth: TextureView,
    pub(crate) shadow: TextureView,
    resolved: Texture,
    pub(crate) resolved_view: TextureView,
    readback: Buffer,
}

impl Target {
    pub(crate) fn new(gpu: &Gpu, width: u32, height: u32) -> Self {
        let texture = |label, width, height, samples, format, usage| {
            gpu.device.create_texture(&TextureDescriptor {
                label: Some(label),
                size: extent(width, height),
                mip_level_count: 1,
                sample_count: samples,
                dimension: TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let view = |texture: &Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let color = texture("color", width, height, SAMPLES, COLOR, attachment);
        let depth = texture("depth", width, height, SAMPLES, DEPTH, attachment);
        let sampled = attachment | TextureUsages::TEXTURE_BINDING;
        let shadow = texture("shadow", SHADOW, SHADOW, 1, DEPTH, sampled);
        let copied = attachment | TextureUsages::COPY_SRC;
        let resolved = texture("picture", width, height, 1, COLOR, copied);
        let readback = gpu.device.create_buffer(&BufferDescriptor {
            label: Some("readback"),
            size: readback_bytes(width, height),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            width,
            height,
            color: view(&color),
            depth: view(&depth),
            shadow: view(&shadow),
            resolved_view: view(&resolved),
            resolved,
            readback,
        }
    }

    pub(crate) fn copy_out(&self, encoder: &mut CommandEncoder) {
        encoder.copy_texture_to_buffer(
            TexelCopyTextureInfo {
                texture: &self.resolved,
                mip_level: 0,
                origin: Origin3d::ZERO,
                aspect: TextureAspect::All,
            },
            TexelCopyBufferInfo {
                buffer: &self.readback,
                layout: TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row_bytes(self.width)),
                    rows_per_image: None,
                },
            },
            extent(self.width, self.height),
        );
    }

    /// Waits for the commands to finish, and reads the picture.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Image, RenderError> {
        let rows = read(gpu, &self.readback)?;
        let used = self.width as usize * 4;
        let pixels = rows
            .chunks_exact(row_bytes(self.width) as usize)
            .flat_map(|row| &row[..used])
            .copied()
            .collect();
        Ok(Image {
            width: self.width,
            height: self.height,
            pixels,
        })
    }
}

/// Reads all bytes of a buffer that can be mapped, after waiting for the device.
pub(crate) fn read(gpu: &Gpu, buffer: &Buffer) -> Result<Vec<u8>, RenderError> {
    let (sender, receiver) = mpsc::channel();
    gpu.checked(|| {
        buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
            // `send` fails if the device was lost, since the receiver has been dropped then.
            let _ = sender.send(mapped);
        });
    })?;
    gpu.wait()?;
    let refused = |reason: String| RenderError::Refused(reason);
    match receiver.try_recv() {
        Ok(Ok(())) => {}
        Ok(Err(error)) => return Err(refused(error.to_string())),
        Err(error) => return Err(refused(error.to_string())),
    }
    gpu.checked(|| {
        let view = buffer.get_mapped_range(..);
        let bytes = view.map(|view| view.to_vec());
        buffer.unmap();
        bytes.map_err(|error| refused(error.to_string()))
    })?
}

fn extent(width: u32, height: u32) -> Extent3d {
    Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

/// Size of the buffer through which a picture is read back, bytes.
pub(crate) fn readback_bytes(width: u32, height: u32) -> u64 {
    u64::from(row_bytes(width)) * u64::from(height)
}

fn row_bytes(width: u32) -> u32 {
    (width * 4).next_multiple_of(ROW_ALIGNMENT)
}
