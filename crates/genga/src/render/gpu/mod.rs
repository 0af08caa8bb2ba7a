//! The parts of wgpu that every pass needs: device, bindings, timing, reading back.

pub(crate) mod bindings;
mod device;
pub(crate) mod readback;
pub(crate) mod scope;
pub(crate) mod timing;

pub use device::{Gpu, GpuError, GpuOptions, adapters};
