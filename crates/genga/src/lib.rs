//! **Genga** draws 3-D scenes as anime and American comics, in real time, on any [`wgpu`] device.
//!
//! Data flows one way: [`import`] → [`scene`] → [`render`], guided by a [`style`]. The library
//! opens no window, keeps no global state and makes no device behind your back.

#[cfg(feature = "export")]
pub mod export;
#[cfg(feature = "import")]
pub mod import;
pub mod render;
pub mod scene;
pub mod scene_file;
pub mod shapes;
pub mod style;
mod toml_file;

pub use toml_file::FileError;
