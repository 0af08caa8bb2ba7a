use genga::render::{GpuError, adapters};
use serde::Serialize;

use crate::args::AdaptersArgs;
use crate::console;
use crate::failure::{Failure, Outcome};
use crate::text::{one_line, table};

/// Lists what can draw.
pub(crate) fn run(args: &AdaptersArgs) -> Outcome {
    let adapters = pollster::block_on(adapters());
    let found: Vec<AdapterInfo> = adapters.iter().map(AdapterInfo::of).collect();
    if args.json {
        let text = serde_json::to_string_pretty(&found).map_err(Failure::message)?;
        console::print(&format!("{text}\n"))?;
    }
    if found.is_empty() {
        return Err(Failure::message(GpuError::NoAdapter));
    }
    if !args.json {
        console::print(&found.iter().map(AdapterInfo::text).collect::<Vec<_>>().join("\n"))?;
    }
    Ok(())
}

/// What people need to know of an adapter.
#[derive(Debug, Serialize)]
pub(crate) struct AdapterInfo {
    pub(crate) name: String,
    pub(crate) backend: String,
    pub(crate) kind: &'static str,
    pub(crate) driver: String,
    largest_texture: u32,
    largest_storage_binding: u64,
    largest_buffer: u64,
    timestamps: bool,
}

impl AdapterInfo {
    pub(crate) fn of(adapter: &wgpu::Adapter) -> Self {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        Self {
            name: info.name,
            backend: info.backend.to_string(),
            kind: match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "discrete GPU",
                wgpu::DeviceType::IntegratedGpu => "integrated GPU",
                wgpu::DeviceType::VirtualGpu => "virtual GPU",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "other",
            },
            driver: [info.driver, info.driver_info].join(" ").trim().to_owned(),
            largest_texture: limits.max_texture_dimension_2d,
            largest_storage_binding: limits.max_storage_buffer_binding_size,
            largest_buffer: limits.max_buffer_size,
            timestamps: adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY),
        }
    }

    fn text(&self) -> String {
        let row = |label: &str, value: String| vec![format!("  {label}"), value];
        let mebibytes = |bytes: u64| format!("{} MiB", bytes >> 20);
        let rows = [
            row("type", self.kind.to_owned()),
            row("backend", self.backend.clone()),
            row("driver", one_line(&self.driver)),
            row("largest texture", format!("{0} × {0}", self.largest_texture)),
            row("largest buffer", mebibytes(self.largest_buffer)),
            row("largest binding", mebibytes(self.largest_storage_binding)),
            row("timestamps", if self.timestamps { "yes" } else { "no" }.to_owned()),
        ];
        format!("{}\n{}", one_line(&self.name), table(&rows))
    }
}
