//! One file a pass; each has its shader under `shaders/passes/` by the same name.

pub(crate) mod beams;
pub(crate) mod candidates;
pub(crate) mod composite;
pub(crate) mod deform;
pub(crate) mod depth;
pub(crate) mod detect;
pub(crate) mod gbuffer;
pub(crate) mod link;
pub(crate) mod paint;
pub(crate) mod plain;
pub(crate) mod reference;
pub(crate) mod seams;
pub(crate) mod shadow;
pub(crate) mod speed_lines;
pub(crate) mod strokes;
pub(crate) mod surface;
pub(crate) mod walk;
pub(crate) mod waves;
