//! Linked WGSL and the Rust twins of its structs, made by `cargo xtask shaders`.

#[allow(
    dead_code,
    clippy::unreadable_literal,
    reason = "generated: every constant and struct of the shaders, used or not"
)]
#[rustfmt::skip]
mod structs;

pub(crate) use structs::*;
