//! The passes that draw tiles.

use super::draws::Draw;
use super::instances::Instances;
use super::pipelines::Pipelines;
use super::uniforms::FaceUniforms;

/// Begins a pass that draws depth, and nothing else, on a view.
pub(crate) fn begin_depth_pass<'encoder>(
    encoder: &'encoder mut wgpu::CommandEncoder,
    label: &str,
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPass<'encoder> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load,
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}

/// What tiles are drawn with.
pub(crate) struct Drawing<'a> {
    pub uniforms: &'a FaceUniforms,
    pub pipelines: &'a Pipelines,
    pub instances: &'a Instances,
}

impl Drawing<'_> {
    /// Draws casters on the tile whose uniform has this index.
    pub fn record(&self, pass: &mut wgpu::RenderPass<'_>, index: usize, draws: &[Draw]) {
        self.uniforms.bind(pass, index);
        for draw in draws {
            draw.record(pass, self.pipelines, self.instances);
        }
    }
}
