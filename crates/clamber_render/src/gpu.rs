use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, Buffer, Device, ErrorFilter,
    InstanceDescriptor, Limits, PollType, Queue,
};

use crate::RenderError;

/// A graphics device: a GPU, or Mesa's software Vulkan.
#[derive(Debug)]
pub struct Gpu {
    pub(crate) device: Device,
    pub(crate) queue: Queue,
    adapter: wgpu::AdapterInfo,
    /// The reason for the loss of the device, once it is lost.
    lost: Arc<Mutex<Option<String>>>,
    /// The first error outside of `checked`. Without a listener for such errors, the graphics library panics.
    unasked: Arc<Mutex<Option<RenderError>>>,
}

impl Gpu {
    /// Opens the device of the fastest kind: a discrete GPU before an integrated one, and a software device only if
    /// there is no other. The environment variable `WGPU_BACKEND` restricts the choice to some backends, as in all
    /// programs with wgpu.
    ///
    /// # Errors
    /// [`RenderError::NoAdapter`] if there is no device, [`RenderError::Adapter`] if it cannot be opened.
    pub fn new() -> Result<Self, RenderError> {
        Self::with(
            InstanceDescriptor::new_without_display_handle_from_env(),
            |limits| limits,
        )
    }

    /// Opens a device of an instance. `limits` gets the largest limits of the adapter, and returns the limits to use.
    pub(crate) fn with(
        descriptor: InstanceDescriptor,
        limits: impl FnOnce(Limits) -> Limits,
    ) -> Result<Self, RenderError> {
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..wgpu::RequestAdapterOptions::default()
        }));
        let adapter = adapter.map_err(|error| RenderError::NoAdapter {
            reason: error.to_string(),
        })?;
        let info = adapter.get_info();
        // The largest sizes that the adapter allows: creatures may be large.
        let largest = Limits {
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            max_buffer_size: adapter.limits().max_buffer_size,
            max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d,
            ..Limits::default()
        };
        let device = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("clamber"),
            required_limits: limits(largest),
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
        let unasked = Arc::new(Mutex::new(None));
        let said = Arc::clone(&unasked);
        device.on_uncaptured_error(Arc::new(move |error| {
            let mut first = said.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert_with(|| typed(error));
        }));
        Ok(Self {
            device,
            queue,
            adapter: info,
            lost,
            unasked,
        })
    }

    /// The names of the adapter and of its backend.
    pub fn name(&self) -> String {
        format!("{} ({})", self.adapter.name, self.adapter.backend)
    }

    /// Runs commands, and returns the errors of the device.
    pub(crate) fn checked<T>(&self, commands: impl FnOnce() -> T) -> Result<T, RenderError> {
        let memory = self.device.push_error_scope(ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(ErrorFilter::Validation);
        let internal = self.device.push_error_scope(ErrorFilter::Internal);
        let done = commands();
        // Commands after one that lacks memory are invalid, so the lack of memory is reported first.
        let scopes = [internal, validation, memory];
        let [internal, validation, memory] = scopes.map(|scope| pollster::block_on(scope.pop()));
        self.poll(PollType::Poll)?;
        let unasked = self.unasked.lock();
        let unasked = unasked.unwrap_or_else(PoisonError::into_inner).take();
        let error = memory.or(validation).or(internal).map(typed);
        error.or(unasked).map_or(Ok(done), Err)
    }

    /// A bind group of buffers for a shader, with the bindings 0, 1 and so on.
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

    /// Waits until the device has finished all submitted work.
    ///
    /// # Errors
    /// [`RenderError::Lost`] if the device is lost.
    pub fn wait(&self) -> Result<(), RenderError> {
        self.poll(PollType::wait_indefinitely())
    }

    fn poll(&self, how: PollType) -> Result<(), RenderError> {
        if let Some(reason) = self.lost() {
            return Err(RenderError::Lost(reason));
        }
        // The graphics library panics if the device is lost while it waits.
        let polled = catch_unwind(AssertUnwindSafe(|| self.device.poll(how)));
        match (self.lost(), polled) {
            (Some(reason), _) => Err(RenderError::Lost(reason)),
            (None, Err(panic)) => Err(RenderError::Lost(message(panic.as_ref()))),
            (None, Ok(Err(error))) => Err(RenderError::Lost(error.to_string())),
            (None, Ok(Ok(_))) => Ok(()),
        }
    }

    fn lost(&self) -> Option<String> {
        self.lost
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}

/// The message of a panic.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    text.unwrap_or("waiting for it failed").to_owned()
}

fn typed(error: wgpu::Error) -> RenderError {
    match error {
        wgpu::Error::OutOfMemory { .. } => RenderError::OutOfMemory,
        error => RenderError::Refused(error.to_string()),
    }
}
