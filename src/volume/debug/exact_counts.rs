//! The view of exact counts: in colours, sample by sample.

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;

use crate::error::ScreenPassError;
use crate::volume::ExactCount;
use crate::volume::debug::colors::DebugColors;
use crate::volume::debug::views::VolumeDebugDescriptor;
use crate::volume::gpu::buffers::window;
use crate::volume::gpu::grown::spread;
use crate::volume::gpu::layout::{bind as bind_uniform, uniform};
use crate::volume::light_pass::checks::check_readable_samples;
use crate::volume::light_pass::read::Read;
use crate::volume::light_pass::screen::{On, SCREEN, ScreenPipeline};
use crate::volume::multiview::Multiview;

const COUNTS: &str = include_str!("../../../shaders/volume_debug_counts.wgsl");
const SAMPLES: &str = include_str!("../../../shaders/volume_debug_counts_samples.wgsl");

/// `Range` in `volume_debug_counts.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct Range {
    color: [f32; 4],
    least: f32,
    most: f32,
    padding: [f32; 2],
}

/// The pipeline, and the colours of all counts but 0.
#[derive(Debug)]
pub(crate) struct ExactCounts {
    pipeline: wgpu::RenderPipeline,
    ranges: wgpu::BindGroup,
    /// Bytes from one range to the next.
    step: u32,
    count: u32,
    samples: u32,
}

impl ExactCounts {
    /// `None` where no shader can read counts of so many samples, of which there are then none.
    pub fn new(
        device: &wgpu::Device,
        label: &str,
        descriptor: &VolumeDebugDescriptor<'_>,
    ) -> Option<Self> {
        let samples = descriptor.sample_count;
        check_readable_samples(device, samples, "VolumeDebug").ok()?;
        let multisampled = samples > 1;
        let one = Multiview::default();
        let counts = Read::of(samples, one).layout(device, label);
        let of_ranges = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(label),
            entries: &[uniform(0, wgpu::ShaderStages::FRAGMENT, size_of::<Range>())],
        });
        let pipeline = ScreenPipeline {
            label,
            source: source(multisampled),
            fragment: "shadows_volume_debug_counts",
            layout: &[Some(&counts), Some(&of_ranges)],
            target: Some(descriptor.color_format.into()),
            depth_stencil_format: Some(descriptor.depth_stencil_format),
            sample_count: samples,
            multiview: one,
            on: On::Everything,
        };
        let list = ranges(&descriptor.colors);
        let step = window::<Range>(&device.limits());
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: &spread(&list, step),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sizes = [(&buffer, size_of::<Range>())];
        Some(Self {
            pipeline: pipeline.make(device),
            ranges: bind_uniform(device, label, &of_ranges, &sizes, &[]),
            step,
            count: list.len() as u32,
            samples,
        })
    }

    /// Colours what is counted.
    ///
    /// # Errors
    /// [`ScreenPassError::Source`] if the counts have another number of samples,
    /// [`ScreenPassError::Multiview`] if they are of several views.
    pub fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        counts: &ExactCount,
    ) -> Result<(), ScreenPassError> {
        let (found, needed) = (counts.texture().sample_count(), self.samples);
        if found != needed {
            return Err(ScreenPassError::Source { found, needed });
        }
        counts.check_multiview(Multiview::default())?;
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, counts.group(), &[]);
        for range in 0..self.count {
            pass.set_bind_group(1, &self.ranges, &[range * self.step]);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }
}

/// The shader that colours counts.
pub(crate) fn source(multisampled: bool) -> String {
    match multisampled {
        false => [SCREEN, COUNTS].join("\n"),
        true => [SCREEN, SAMPLES].join("\n"),
    }
}

/// One for each count with a colour of its own. A count that is below 0 is what the stencil takes for one of
/// 248 and more; here, no number is taken for another.
fn ranges(colors: &DebugColors) -> Vec<Range> {
    let last = colors.counts.len() - 1;
    let range = |color, [least, most]: [f32; 2]| Range {
        color,
        least,
        most,
        padding: [0.0; 2],
    };
    let counted = colors.counts.iter().enumerate().map(|(place, &color)| {
        let count = (place + 1) as f32;
        range(color, [count, if place == last { f32::MAX } else { count }])
    });
    let negative = range(colors.negative, [f32::MIN, -1.0]);
    counted.chain([negative]).collect()
}
