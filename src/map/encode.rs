//! The passes of a cube map.

use super::cube::CubeShadowMap;
use super::draws::Draw;
use super::face::CubeFace;
use super::resources::UNIFORM_STRIDE;
use super::slot::Slot;

impl CubeShadowMap {
    /// Records what the last [`prepare`](Self::prepare) found necessary: its passes, and what it tells
    /// receivers of the lights. Once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever that found. Until it is called, receivers see texels and
    /// lights as they were; of a map that was never drawn they see all lights dark. What is recorded
    /// must be submitted: if its encoder is dropped, the `prepare` after that draws everything again
    /// ([`CubeStatistics::encoder_dropped`](crate::CubeStatistics)).
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let mut recorded = self.uploads.record(encoder);
        for view in self.textures.to_be_cleared() {
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some(&self.label),
                depth_stencil_attachment: Some(depth_attachment(view, self.clear())),
                ..Default::default()
            }));
            recorded = true;
        }
        self.textures.placeholder_cleared();
        for index in 0..self.slots.len() {
            let pending = self.slots[index].pending;
            self.encode_faces(encoder, index, pending);
            self.slots[index].encoded(pending);
            recorded |= pending != 0;
        }
        if recorded {
            self.submissions.watch(encoder);
        }
    }

    /// Draws the pending faces of a slot, each in its pass.
    fn encode_faces(&self, encoder: &mut wgpu::CommandEncoder, index: usize, pending: u8) {
        for face in CubeFace::ALL {
            if pending & face.bit() != 0 {
                let draws = self.draws.of(index, face.layer() as usize);
                self.encode_face(encoder, index, face, draws);
            }
        }
    }

    /// Takes nothing for drawn: the next [`prepare`](Self::prepare) has every face drawn again that the
    /// view shows, whatever the budget. What the last one found is forgotten.
    ///
    /// For a host that has written to the map's textures, or has lost what was recorded in a way that
    /// the map cannot see: an encoder that is kept but never submitted, a submission that failed.
    pub fn invalidate(&mut self) {
        self.slots.iter_mut().for_each(Slot::doubt_texels);
        self.textures.doubt();
        self.forget_uploads();
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
    /// unclipped depth where the device has it, so that what is nearer than the near plane casts. On
    /// wgpu's GL back end, let the fragment shader write clip z times its position's w as `frag_depth`:
    /// the rasteriser's own depth has too few digits there (see [`Support`](crate::Support)).
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
        // A host that calls this instead of `encode` tells receivers of the light through it.
        if self.uploads.record(encoder) {
            self.submissions.watch(encoder);
        }
        let pass = self.begin_pass(encoder, index, face, self.clear())?;
        self.slots[index].touched(face);
        Some(pass)
    }

    pub(super) fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        slot: usize,
        face: CubeFace,
        load: wgpu::LoadOp<f32>,
    ) -> Option<wgpu::RenderPass<'encoder>> {
        let view = &self.textures.slot(slot)?.faces[face.layer() as usize];
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
