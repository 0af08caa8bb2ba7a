//! Everything that needs a shader compiler, a device or pictures, in one program, so that the
//! pipelines compile once.

mod beam_light;
mod beam_outlines;
mod beams;
mod color;
mod contours;
mod edges;
mod errors;
mod geometry;
mod hatching;
mod hatching_pictures;
mod highlight_surfaces;
mod highlights;
mod light_colors;
mod lines;
mod marks;
mod motion;
mod outlines;
mod pipelines;
mod ramp;
mod repeat;
mod selectors;
mod shaders;
mod shading;
mod shadows;
mod shine;
mod snapshots;
mod stipple;
mod transparency;
mod waves;
mod waves_in_scenes;
