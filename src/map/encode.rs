//! The passes of a cube map.

use std::sync::atomic::Ordering;

use super::cube::CubeShadowMap;
use super::draws::Draw;
use super::face::CubeFace;
use super::resources::UNIFORM_STRIDE;

impl CubeShadowMap {
    /// Records the passes that the last [`prepare`](Self::prepare) found necessary; once: a second
    /// call before the next `prepare` records nothing. What is recorded must be submitted.
    pub fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
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

    /// Draws one face in a pass of its own.
    pub(super) fn encode_face(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        draws: &[Draw],
    ) {
        let Some(mut pass) = self.begin_pass(encoder, slot, face) else {
            return; // prepare made the texture of every slot with pending faces
        };
        let offset = (slot as u32 * 6 + face.layer()) * UNIFORM_STRIDE as u32;
        pass.set_bind_group(0, &self.face_group, &[offset]);
        for draw in draws {
            draw.record(&mut pass, &self.pipelines, &self.instances);
        }
    }

    /// Begins a pass that clears one face of a light, for a host that draws its own geometry
    /// (skinned, alpha-tested) with [`clip_from_world`](Self::clip_from_world): the map's format,
    /// one sample, the comparison and clear depth of its [`DepthEncoding`](crate::DepthEncoding).
    /// `None` if the light has no texels (see [`Allocation::AtOnce`](crate::Allocation::AtOnce)) or
    /// the last frame had no such light.
    ///
    /// Call it after [`encode`](Self::encode) (or instead of it): what `encode` drew on this face
    /// is cleared, so pass such a host's other casters through its own draws too. The next
    /// `prepare` takes the face's content for unknown and draws it again.
    pub fn begin_face<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        light: usize,
        face: CubeFace,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let &index = self.order.get(light)?;
        let pass = self.begin_pass(encoder, index, face)?;
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
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let texture = self.textures.slot(slot)?;
        texture.cleared.fetch_or(face.bit(), Ordering::Relaxed);
        Some(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&format!("{} {slot} {face:?}", self.label)),
            depth_stencil_attachment: Some(
                self.depth_attachment(&texture.faces[face.layer() as usize]),
            ),
            ..Default::default()
        }))
    }

    /// A view of the texture to be cleared and drawn on.
    pub(super) fn depth_attachment<'view>(
        &self,
        view: &'view wgpu::TextureView,
    ) -> wgpu::RenderPassDepthStencilAttachment<'view> {
        wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(self.encoding.clear_depth()),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }
    }
}
