//! GPU time of each pass by timestamp queries.

use super::readback;
use crate::render::RenderError;

/// Records one pair of timestamps per pass; does nothing on devices without them.
pub(crate) struct Timer {
    queries: Option<wgpu::QuerySet>,
    names: Vec<&'static str>,
}

/// Most passes that one frame can time.
const CAPACITY: u32 = 32;

impl Timer {
    /// A timer that measures, if the device can.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let queries = device.features().contains(wgpu::Features::TIMESTAMP_QUERY).then(|| {
            device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timer"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * CAPACITY,
            })
        });
        Self { queries, names: Vec::new() }
    }

    /// A timer that measures nothing.
    pub(crate) fn off() -> Self {
        Self { queries: None, names: Vec::new() }
    }

    fn next(&mut self, name: &'static str) -> Option<(&wgpu::QuerySet, u32)> {
        let queries = self.queries.as_ref()?;
        let index = self.names.len() as u32;
        if index >= CAPACITY {
            return None;
        }
        self.names.push(name);
        Some((queries, 2 * index))
    }

    /// For a render pass of that name.
    pub(crate) fn render(
        &mut self,
        name: &'static str,
    ) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        self.next(name).map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// For a compute pass of that name.
    pub(crate) fn compute(
        &mut self,
        name: &'static str,
    ) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        self.next(name).map(|(query_set, first)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        })
    }

    /// Ends the recording: the buffer to read once the commands have run.
    pub(crate) fn resolve(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Option<wgpu::Buffer> {
        let queries = self.queries.as_ref()?;
        let count = 2 * self.names.len() as u32;
        let size = u64::from(count.max(1)) * 8;
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps"),
            size,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let readable = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("timestamps to read"),
            size,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.resolve_query_set(queries, 0..count, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &readable, 0, size);
        Some(readable)
    }

    /// Names and milliseconds of the passes, and the milliseconds from the first one's beginning
    /// to the last one's end.
    pub(crate) async fn read(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        buffer: &wgpu::Buffer,
    ) -> Result<(Vec<(&'static str, f64)>, f64), RenderError> {
        let bytes = readback::map(device, buffer).await?;
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
        let to_ms = f64::from(queue.get_timestamp_period()) * 1e-6;
        let passes = self.names.iter().zip(ticks.chunks_exact(2));
        let passes = passes.map(|(&name, t)| (name, t[1].saturating_sub(t[0]) as f64 * to_ms));
        let used = &ticks[..2 * self.names.len()];
        let span = used.iter().max().zip(used.iter().min()).map_or(0, |(max, min)| max - min);
        Ok((passes.collect(), span as f64 * to_ms))
    }
}
