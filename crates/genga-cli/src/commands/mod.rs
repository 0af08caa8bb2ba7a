//! What each command does.

pub(crate) mod adapters;
pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod info;
pub(crate) mod render;
pub(crate) mod schema;
pub(crate) mod styles;
pub(crate) mod turntable;
