//! **Genga** draws 3-D scenes as anime and American comics, in real time, on any [`wgpu`] device.
//!
//! Data flows one way: [`import`] → [`scene`] → [`render`], guided by a [`style`]. The library
//! opens no window, keeps no global state and makes no device behind your back.
//!
//! ```no_run
//! use genga::render::{Gpu, GpuOptions, Orbit, Renderer, View, ViewCamera};
//! use genga::{scene::Pose, style::Style};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = genga::import::load("knight.glb".as_ref())?.scene;
//! let gpu = pollster::block_on(Gpu::headless(&GpuOptions::default()))?;
//! let renderer = Renderer::new(&gpu.device, &gpu.queue)?;
//! let prepared = renderer.prepare(&scene, &Style::find("american-comic")?)?;
//!
//! let points = scene.extremes(&Pose::rest(&scene));
//! let camera = ViewCamera::orbit_points(&points, &Orbit::default(), 4.0 / 3.0);
//! let view = View::new(camera, [800, 600]);
//! let picture = pollster::block_on(renderer.picture(&prepared, &view, &[], &mut |_, _| {}))?;
//! # Ok(())
//! # }
//! ```
//!
//! `examples/render_to_texture.rs` draws into a texture of the caller's own device.

#[cfg(feature = "export")]
pub mod export;
#[cfg(feature = "import")]
pub mod import;
pub mod render;
pub mod scene;
pub mod scene_file;
pub mod shapes;
mod srgb;
pub mod style;
mod toml_file;

pub use toml_file::FileError;

/// The README's program must compile.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
pub struct Readme;
