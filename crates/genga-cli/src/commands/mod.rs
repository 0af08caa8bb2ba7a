//! What each command does.

pub(crate) mod check;
pub(crate) mod info;
pub(crate) mod schema;
pub(crate) mod styles;
