//! Everything that needs a shader compiler, a device or pictures, in one program, so that the
//! pipelines compile once.

mod color;
mod geometry;
mod pipelines;
mod ramp;
mod selectors;
mod shaders;
mod transparency;
