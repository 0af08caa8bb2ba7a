//! Sculpting in code: implicit shapes, blended, polygonised into even triangles, with sharp
//! borders where the materials of a figure meet.
//!
//! Everything is computed in `f64` by operations that IEEE 754 defines exactly, in a fixed order,
//! so that the result is the same on every machine.

mod features;
mod field;
mod lock;
mod mesh;
mod polygonise;
mod remesh;
mod sweep;
mod unwrap;

pub(super) use features::{Imprinted, Region, imprint, relax};
pub(super) use field::{Field, Solid, gradient, smooth_step};
pub(super) use lock::lock;
pub(super) use polygonise::polygonise;
pub(super) use remesh::remesh;
pub(super) use sweep::{Part, lathe, plate, sheet};
pub(super) use unwrap::Unwrap;
