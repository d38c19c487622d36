use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, Buffer, Device, ErrorFilter,
    Queue,
};

use crate::RenderError;

/// A graphics device: a GPU, or Mesa's software in its place.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    adapter: wgpu::AdapterInfo,
    /// Why the device is gone, once it is.
    lost: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// The fastest device there is. `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` choose another one, as
    /// everywhere in wgpu.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`], [`RenderError::Adapter`].
    pub fn new() -> Result<Self, RenderError> {
        let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        }));
        let adapter = adapter.map_err(|error| RenderError::NoAdapter {
            reason: error.to_string(),
        })?;
        let info = adapter.get_info();
        // As large as it can, since creatures may be.
        let limits = wgpu::Limits {
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            max_buffer_size: adapter.limits().max_buffer_size,
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let device = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("clamber"),
            required_limits: limits,
            ..wgpu::DeviceDescriptor::default()
        }));
        let (device, queue) = device.map_err(|error| RenderError::Adapter {
            adapter: info.name.clone(),
            reason: error.to_string(),
        })?;
        let lost = Arc::new(Mutex::new(None));
        let said = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            *said.lock().unwrap_or_else(PoisonError::into_inner) =
                Some(format!("{reason:?}: {message}"));
        });
        Ok(Self {
            device,
            queue,
            adapter: info,
            lost,
        })
    }

    /// The name of the adapter, and the interface that it is used through.
    pub fn name(&self) -> String {
        format!("{} ({})", self.adapter.name, self.adapter.backend)
    }

    /// Runs commands, and gives what the device has to say against them.
    pub(crate) fn checked<T>(&self, commands: impl FnOnce() -> T) -> Result<T, RenderError> {
        let memory = self.device.push_error_scope(ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(ErrorFilter::Validation);
        let internal = self.device.push_error_scope(ErrorFilter::Internal);
        let done = commands();
        let errors = [internal, validation, memory].map(|scope| pollster::block_on(scope.pop()));
        if let Some(reason) = self.lost() {
            return Err(RenderError::Lost(reason));
        }
        match errors.into_iter().flatten().next() {
            None => Ok(done),
            Some(wgpu::Error::OutOfMemory { .. }) => Err(RenderError::OutOfMemory),
            Some(error) => Err(RenderError::Refused(error.to_string())),
        }
    }

    /// Buffers for a shader, bound in their order.
    pub(crate) fn bind(&self, layout: &BindGroupLayout, buffers: &[&Buffer]) -> BindGroup {
        let entries: Vec<BindGroupEntry<'_>> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        self.device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }

    /// Waits until all that was asked for is done.
    pub(crate) fn wait(&self) -> Result<(), RenderError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        match (self.lost(), waited) {
            (Some(reason), _) => Err(RenderError::Lost(reason)),
            (None, Err(error)) => Err(RenderError::Lost(error.to_string())),
            (None, Ok(_)) => Ok(()),
        }
    }

    fn lost(&self) -> Option<String> {
        self.lost
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}
