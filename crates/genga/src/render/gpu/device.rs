use std::sync::{Arc, Mutex};

use thiserror::Error;

/// How to choose a device for a program that has none of its own.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// A part of the adapter's name, whatever its case; `None` takes the fastest one.
    pub adapter: Option<String>,
    /// Ask for timestamp queries where the adapter has them.
    pub timestamps: bool,
}

/// A device without a window. Programs that have a wgpu device of their own do not need it.
#[derive(Debug)]
pub struct Gpu {
    /// The adapter that the device was made from.
    pub adapter: wgpu::Adapter,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    fault: Arc<Mutex<Option<String>>>,
}

/// Why there is no device.
#[derive(Clone, Debug, Error)]
pub enum GpuError {
    /// There is no adapter at all.
    #[error(
        "no graphics adapter found: install a Vulkan driver (on Debian and Ubuntu \
         `apt-get install mesa-vulkan-drivers` gives one that needs no GPU)"
    )]
    NoAdapter,
    /// No adapter has that name.
    #[error("no graphics adapter matches '{wanted}'; there are: {available}")]
    UnknownAdapter {
        /// The name that was asked for.
        wanted: String,
        /// The names that there are.
        available: String,
    },
    /// The driver gave no device.
    #[error("the graphics adapter '{adapter}' gave no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        ..wgpu::InstanceDescriptor::new_without_display_handle_from_env()
    })
}

/// All adapters of this machine, the fastest kind first.
pub async fn adapters() -> Vec<wgpu::Adapter> {
    let mut adapters = instance().enumerate_adapters(wgpu::Backends::PRIMARY).await;
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    adapters
}

impl Gpu {
    /// A device on the adapter that `options` names, or on the fastest one.
    ///
    /// It has WebGPU's default limits, except for texture size, where it has all that the adapter
    /// offers.
    ///
    /// # Errors
    /// No adapter, none of that name, or no device from the driver.
    pub async fn headless(options: &GpuOptions) -> Result<Self, GpuError> {
        let adapters = adapters().await;
        let wanted = options.adapter.as_deref().map(str::to_lowercase);
        let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
        let adapter = adapters
            .into_iter()
            .find(|a| wanted.as_ref().is_none_or(|w| a.get_info().name.to_lowercase().contains(w)));
        let Some(adapter) = adapter else {
            return Err(match wanted {
                Some(wanted) if !names.is_empty() => {
                    GpuError::UnknownAdapter { wanted, available: names.join(", ") }
                }
                _ => GpuError::NoAdapter,
            });
        };
        Self::from_adapter(adapter, options.timestamps).await
    }

    async fn from_adapter(adapter: wgpu::Adapter, timestamps: bool) -> Result<Self, GpuError> {
        let offered = adapter.limits();
        let required_limits = wgpu::Limits {
            max_texture_dimension_2d: offered.max_texture_dimension_2d,
            ..wgpu::Limits::default()
        };
        let optional =
            if timestamps { wgpu::Features::TIMESTAMP_QUERY } else { wgpu::Features::empty() };
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("genga"),
                required_features: adapter.features() & optional,
                required_limits: required_limits.or_worse_values_from(&offered),
                ..Default::default()
            })
            .await
            .map_err(|e| GpuError::NoDevice {
                adapter: adapter.get_info().name,
                reason: e.to_string(),
            })?;
        // The default handler panics; a renderer reports.
        let fault = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            log::error!("graphics driver: {error}");
            if let Ok(mut slot) = slot.lock() {
                slot.get_or_insert_with(|| error.to_string());
            }
        }));
        let slot = Arc::clone(&fault);
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed
                && let Ok(mut slot) = slot.lock()
            {
                slot.get_or_insert_with(|| format!("the device was lost: {message}"));
            }
        });
        Ok(Self { adapter, device, queue, fault })
    }

    /// Name, driver and kind of the adapter.
    #[must_use]
    pub fn info(&self) -> wgpu::AdapterInfo {
        self.adapter.get_info()
    }

    /// Whether the processor draws, not a GPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info().device_type == wgpu::DeviceType::Cpu
    }

    /// What the driver complained about since the last call, if anything.
    #[must_use]
    pub fn take_fault(&self) -> Option<String> {
        self.fault.lock().ok().and_then(|mut fault| fault.take())
    }
}
