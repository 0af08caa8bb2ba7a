//! Scene files, `*.scene.toml`: which models stand where, and how they are seen, lit and drawn.
//!
//! ```
//! use genga::scene_file::SceneFile;
//!
//! let file = SceneFile::from_toml_str(
//!     r#"
//!     version = 1
//!     style = "american-comic"
//!
//!     [[model]]
//!     file = "hero.glb"
//!     rotation_deg = [0, 20, 0]
//!     clip = "Run"
//!     time = 0.4
//!
//!     [camera]
//!     azimuth_deg = 30
//!     zoom = 1.2
//!     "#,
//! )?;
//! assert_eq!(*file.models[0].file, "hero.glb");
//! # Ok::<(), genga::FileError>(())
//! ```

mod assemble;
mod beam;
mod beam_place;
#[cfg(test)]
mod beam_tests;
mod camera;
mod file;
mod highlight;
mod highlight_place;
#[cfg(test)]
mod highlight_tests;
mod light;
#[cfg(test)]
mod light_tests;
mod merge;
mod model;
mod shading;
#[cfg(test)]
mod tests;
mod wave;
#[cfg(test)]
mod wave_tests;

pub use crate::toml_file::Located;
pub use assemble::Assembled;
pub use beam::BeamEntry;
pub use camera::{CameraEntry, OrbitCamera, PlacedCamera, SceneCamera};
pub use file::{Picture, SceneFile, SceneFileError, json_schema};
pub use highlight::{
    AngleKeyEntry, FreeKeyEntry, HighlightEntry, PanoramaEntry, ProxyEntry, ProxyKind,
};
pub use light::LightEntry;
pub use model::{ClipEntry, ModelEntry, Scale};
pub use shading::ShadingEntry;
pub use wave::{NodeNames, WaveEntry, WaveReference};
