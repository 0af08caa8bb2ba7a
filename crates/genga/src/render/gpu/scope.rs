//! Error scopes: what the driver refuses becomes a [`RenderError`] instead of a panic.

use std::{
    pin::pin,
    task::{Context, Poll, Waker},
};

use crate::render::RenderError;

/// Runs `work`, which makes GPU objects; gives back the first error that wgpu reports.
pub(crate) fn checked<T>(
    device: &wgpu::Device,
    work: impl FnOnce() -> Result<T, RenderError>,
) -> Result<T, RenderError> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    let errors = [poll_once(validation.pop()), poll_once(memory.pop())];
    let result = result?;
    match errors.into_iter().flatten().next() {
        None => Ok(result),
        Some(wgpu::Error::OutOfMemory { .. }) => Err(RenderError::OutOfMemory),
        Some(other) => Err(RenderError::Driver { message: other.to_string() }),
    }
}

/// Natively a scope is ready at once; in a browser its errors arrive later, at the device's own
/// handler.
fn poll_once(future: impl Future<Output = Option<wgpu::Error>>) -> Option<wgpu::Error> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(error) => error,
        Poll::Pending => None,
    }
}
