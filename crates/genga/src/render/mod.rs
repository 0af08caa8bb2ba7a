//! The renderer: scene and style → picture, on any wgpu device.
//!
//! [`Renderer::prepare`] uploads a scene under a style, [`Renderer::set_pose`] moves it,
//! [`Renderer::render`] draws it into a texture and [`Renderer::picture`] into memory. Programs
//! without a device of their own get one from [`Gpu::headless`].

mod error;
mod frame;
mod generated;
mod gpu;
mod highlights;
mod layouts;
mod passes;
mod picture;
mod prepare;
mod renderer;
mod targets;
mod view;
mod wave_targets;

pub use error::RenderError;
pub use gpu::{Gpu, GpuError, GpuOptions, adapters};
pub use highlights::HighlightState;
pub use picture::{Layer, LayerData, LayerKind, MAX_PICTURE_SIDE, Picture};
pub use prepare::Prepared;
pub use renderer::{FrameTimes, PassTime, Renderer, Workload};
pub use view::{Orbit, View, ViewCamera};
