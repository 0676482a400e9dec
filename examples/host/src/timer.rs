//! How long GPU work takes: timestamps where they can be trusted, wall time elsewhere.

use std::time::Instant;

use shadows::wgpu;

use super::gpu::Gpu;

/// By what a time was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Between two timestamps on the GPU: the GPU's share alone.
    Gpu,
    /// From the first command recorded until the device reports all of it done.
    Wall,
}

impl Clock {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Wall => "wall",
        }
    }
}

/// Measures what is recorded into an encoder.
pub struct Timer {
    timestamps: Option<Timestamps>,
}

struct Timestamps {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    period: f64,
}

/// The feature the GPU clock needs.
const FEATURE: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;

impl Timer {
    /// With GPU timestamps on a real GPU that has them. Software drivers write timestamps when
    /// commands are queued rather than done, and so does GL here and there: wall time there.
    pub fn new(gpu: &Gpu) -> Self {
        let real =
            gpu.info.device_type != wgpu::DeviceType::Cpu && gpu.info.backend != wgpu::Backend::Gl;
        Self::with_timestamps(gpu, real && gpu.device.features().contains(FEATURE))
    }

    /// With or without timestamps; with them the device must have the feature.
    pub fn with_timestamps(gpu: &Gpu, timestamps: bool) -> Self {
        Self {
            timestamps: timestamps.then(|| Timestamps::new(gpu)),
        }
    }

    /// The clock in use.
    pub fn clock(&self) -> Clock {
        match self.timestamps {
            Some(_) => Clock::Gpu,
            None => Clock::Wall,
        }
    }

    /// Records, submits and waits; milliseconds by [`Self::clock`].
    pub fn time(&self, gpu: &Gpu, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> f64 {
        match &self.timestamps {
            Some(timestamps) => timestamps.time(gpu, record),
            None => {
                let start = Instant::now();
                gpu.run(record);
                start.elapsed().as_secs_f64() * 1e3
            }
        }
    }
}

impl Timestamps {
    fn new(gpu: &Gpu) -> Self {
        Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timer"),
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timer"),
                size: 16,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
            period: f64::from(gpu.queue.get_timestamp_period()),
        }
    }

    fn time(&self, gpu: &Gpu, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> f64 {
        gpu.run(|encoder| {
            encoder.write_timestamp(&self.queries, 0);
            record(encoder);
            encoder.write_timestamp(&self.queries, 1);
            encoder.resolve_query_set(&self.queries, 0..2, &self.resolved, 0);
        });
        let bytes = gpu.read_buffer(&self.resolved);
        let ticks: Vec<u64> = bytes
            .chunks_exact(8)
            .map(|chunk| {
                chunk
                    .iter()
                    .rev()
                    .fold(0, |n, &byte| n << 8 | u64::from(byte))
            })
            .collect();
        // The counter may wrap between the two.
        ticks[1].wrapping_sub(ticks[0]) as f64 * self.period * 1e-6
    }
}
