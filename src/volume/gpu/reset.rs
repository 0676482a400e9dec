//! A triangle over the screen that sets all counts back to 0, between two lights of one pass.

use crate::volume::ShadowVolumeDescriptor;
use crate::volume::gpu::counter::{self, Counter};
use crate::volume::light_pass::screen::SCREEN;

const RESET: &str = include_str!("../../../shaders/volume_reset.wgsl");
const LABEL: &str = "shadows volume reset";

/// The shader, which counts in the target at this place.
fn source(location: usize) -> String {
    let reset = RESET.replace("@location(0)", &format!("@location({location})"));
    [SCREEN, &reset].join("\n")
}

/// The pipeline for passes of a descriptor.
pub(crate) fn pipeline(
    device: &wgpu::Device,
    cache: Option<&wgpu::PipelineCache>,
    descriptor: &ShadowVolumeDescriptor<'_>,
) -> wgpu::RenderPipeline {
    let formats = descriptor.color_formats;
    let module = crate::shader::module(device, LABEL, source(formats.len()));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(LABEL),
        bind_group_layouts: &[],
        immediate_size: 0,
    });
    let exact = descriptor.counter == Counter::Exact;
    let target = |format, write_mask| wgpu::ColorTargetState {
        format,
        blend: None,
        write_mask,
    };
    let own = formats.iter();
    let own = own.map(|format| format.map(|format| target(format, wgpu::ColorWrites::empty())));
    let count = exact.then(|| Some(target(counter::FORMAT, wgpu::ColorWrites::RED)));
    let targets: Vec<_> = own.chain(count).collect();
    let entry_point = match exact {
        true => "shadows_volume_reset",
        false => "shadows_volume_untouched",
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(LABEL),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("screen"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: descriptor.depth_stencil_format,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: match exact {
                true => wgpu::StencilState::default(),
                false => zero(),
            },
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: descriptor.sample_count,
            ..Default::default()
        },
        fragment: (!targets.is_empty()).then(|| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &targets,
        }),
        multiview_mask: descriptor.multiview_mask,
        cache,
    })
}

/// Whatever the reference is.
fn zero() -> wgpu::StencilState {
    let face = wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        // Never done, but wgpu sets the reference, which Vulkan wants set, only for what names it.
        fail_op: wgpu::StencilOperation::Replace,
        depth_fail_op: wgpu::StencilOperation::Zero,
        pass_op: wgpu::StencilOperation::Zero,
    };
    wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    #[test]
    fn the_shader_is_valid_at_every_place() {
        for location in 0..3 {
            let module = naga::front::wgsl::parse_str(&super::source(location)).unwrap();
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap();
        }
    }
}
