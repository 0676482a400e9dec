//! The passes of a cube map.

use std::sync::atomic::Ordering;

use super::cube::CubeShadowMap;
use super::draws::Draw;
use super::face::CubeFace;
use super::resources::UNIFORM_STRIDE;

impl CubeShadowMap {
    /// Records the passes that the last [`prepare`](Self::prepare) found necessary; once: a second
    /// call before the next `prepare` records nothing. What is recorded must be submitted.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        // A bind group that was made before there were texels, and is not made again, says lit.
        for view in self.textures.blank() {
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(&self.label),
                depth_stencil_attachment: Some(depth_attachment(view, self.clear())),
                ..Default::default()
            }));
        }
        for (index, slot) in self.slots.iter().enumerate() {
            let pending = slot.pending.swap(0, Ordering::Relaxed);
            if let Some(joint) = &self.joint {
                self.encode_joint(encoder, index, pending, joint);
                slot.encoded.fetch_or(pending, Ordering::Relaxed);
                continue;
            }
            for face in CubeFace::ALL {
                if pending & face.bit() == 0 {
                    continue;
                }
                let draws = self.draws.of(index, face.layer() as usize);
                self.encode_face(encoder, index, face, draws);
                slot.encoded.fetch_or(face.bit(), Ordering::Relaxed);
            }
        }
    }

    /// Draws one face in a pass of its own, over what stands still on it.
    pub(super) fn encode_face(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        draws: &[Draw],
    ) {
        let load = match self.encode_layer(encoder, slot, face) {
            true if draws.is_empty() => return,
            true => wgpu::LoadOp::Load,
            false => self.clear(),
        };
        // Prepare made the texture of every slot with pending faces.
        if let Some(mut pass) = self.begin_pass(encoder, slot, face, load) {
            self.draw_face(&mut pass, slot, face, draws);
        }
    }

    pub(super) fn draw_face(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        slot: usize,
        face: CubeFace,
        draws: &[Draw],
    ) {
        let offset = (slot as u32 * 6 + face.layer()) * UNIFORM_STRIDE as u32;
        pass.set_bind_group(0, &self.face_group, &[offset]);
        for draw in draws {
            draw.record(pass, &self.pipelines, &self.instances);
        }
    }

    /// Begins a pass that clears one face of a light, for a host that draws its own geometry
    /// (skinned, alpha-tested) with [`clip_from_world`](Self::clip_from_world): the map's format,
    /// one sample, the comparison and clear depth of its [`DepthEncoding`](crate::DepthEncoding), and
    /// unclipped depth where the device has it, so that what is nearer than the near plane casts.
    /// `None` if the light has no texels (see [`Allocation::AtOnce`](crate::Allocation::AtOnce)) or
    /// the last frame had no such light.
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew on this face
    /// is cleared, so pass such a host's other casters through its own draws too. The next
    /// `prepare` takes the face's content for unknown and draws it again.
    pub fn begin_face<'encoder>(
        &mut self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        light: usize,
        face: CubeFace,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let &index = self.order.get(light)?;
        let pass = self.begin_pass(encoder, index, face, self.clear())?;
        let slot = &self.slots[index];
        slot.pending.fetch_and(!face.bit(), Ordering::Relaxed);
        slot.touched.fetch_or(face.bit(), Ordering::Relaxed);
        Some(pass)
    }

    pub(super) fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        load: wgpu::LoadOp<f32>,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let texture = self.textures.slot(slot)?;
        texture.cleared.fetch_or(face.bit(), Ordering::Relaxed);
        let view = &texture.faces[face.layer() as usize];
        Some(self.begin_depth_pass(encoder, slot, face, view, load))
    }

    /// Begins a pass on a face, or on the layer under it.
    pub(super) fn begin_depth_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        view: &wgpu::TextureView,
        load: wgpu::LoadOp<f32>,
    ) -> wgpu::RenderPass<'encoder> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&format!("{} {slot} {face:?}", self.label)),
            depth_stencil_attachment: Some(depth_attachment(view, load)),
            ..Default::default()
        })
    }

    pub(super) fn clear(&self) -> wgpu::LoadOp<f32> {
        wgpu::LoadOp::Clear(self.encoding.clear_depth())
    }
}

/// A view to be drawn on.
pub(super) fn depth_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}
