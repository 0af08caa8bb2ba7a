//! What the picture tests share: one device and renderer for the whole test program, scenes made
//! in code, cameras and meshes in f64 to compare with, and comparison of pictures.
//!
//! The tests need a graphics adapter; Mesa's lavapipe is enough. Without one they fail.

pub mod compare;
pub mod edges;
pub mod eye;
pub mod gpu;
pub mod hatching;
pub mod highlight_proofs;
pub mod highlights;
pub mod lines;
pub mod pixels;
pub mod reference;
pub mod scenes;
pub mod snapshots;
pub mod waves;

pub use compare::{Difference, Tolerance, difference};
pub use eye::Eye;
pub use gpu::{Shared, draw, draw_layers, draw_posed, shared};
pub use pixels::Pixels;
pub use scenes::{Builder, orbit_view, ortho_view, perspective_view, style};
