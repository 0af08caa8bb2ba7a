//! Bringing buffers and textures back to the CPU.

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};
use std::task::{Poll, Waker};

use crate::render::RenderError;

/// The bytes of a mappable buffer, once everything submitted before has run.
pub(crate) async fn map(
    device: &wgpu::Device,
    buffer: &wgpu::Buffer,
) -> Result<Vec<u8>, RenderError> {
    struct State {
        result: Mutex<Option<Result<(), wgpu::BufferAsyncError>>>,
        waker: Mutex<Option<Waker>>,
        done: AtomicBool,
    }
    let state = Arc::new(State {
        result: Mutex::new(None),
        waker: Mutex::new(None),
        done: AtomicBool::new(false),
    });
    let shared = Arc::clone(&state);
    buffer.slice(..).map_async(wgpu::MapMode::Read, move |result| {
        if let Ok(mut slot) = shared.result.lock() {
            *slot = Some(result);
        }
        shared.done.store(true, Ordering::Release);
        if let Some(waker) = shared.waker.lock().ok().and_then(|mut w| w.take()) {
            waker.wake();
        }
    });
    // Natively this waits and calls back; in a browser it does nothing and the callback wakes us.
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .map_err(|e| RenderError::DeviceLost { message: e.to_string() })?;
    std::future::poll_fn(|context| {
        if let Ok(mut waker) = state.waker.lock() {
            *waker = Some(context.waker().clone());
        }
        if state.done.load(Ordering::Acquire) { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
    let result = state.result.lock().ok().and_then(|mut slot| slot.take());
    match result {
        Some(Ok(())) => {}
        Some(Err(e)) => return Err(RenderError::DeviceLost { message: e.to_string() }),
        None => return Err(RenderError::DeviceLost { message: "no answer".to_owned() }),
    }
    let bytes = buffer.slice(..).get_mapped_range().to_vec();
    buffer.unmap();
    Ok(bytes)
}

/// A copy of a texture on its way to the CPU.
pub(crate) struct TextureRead {
    buffer: wgpu::Buffer,
    row_bytes: usize,
    padded_row_bytes: usize,
    rows: usize,
}

impl TextureRead {
    /// Records the copy of the texture's `size` texels from `origin` on.
    pub(crate) fn record(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        aspect: wgpu::TextureAspect,
        origin: [u32; 2],
        size: [u32; 2],
    ) -> Self {
        let texel = texture.format().block_copy_size(Some(aspect)).unwrap_or(4);
        let row = size[0] * texel;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read back"),
            size: u64::from(padded) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: origin[0], y: origin[1], z: 0 },
                aspect,
            },
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded),
                    rows_per_image: Some(size[1]),
                },
            },
            wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        );
        Self {
            buffer,
            row_bytes: row as usize,
            padded_row_bytes: padded as usize,
            rows: size[1] as usize,
        }
    }

    /// The rows without padding, top to bottom.
    pub(crate) async fn finish(self, device: &wgpu::Device) -> Result<Vec<u8>, RenderError> {
        let bytes = map(device, &self.buffer).await?;
        if self.row_bytes == self.padded_row_bytes {
            return Ok(bytes);
        }
        let mut rows = Vec::with_capacity(self.row_bytes * self.rows);
        for row in bytes.chunks_exact(self.padded_row_bytes) {
            rows.extend_from_slice(&row[..self.row_bytes]);
        }
        Ok(rows)
    }
}
