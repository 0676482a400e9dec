//! Omnidirectional shadow maps.

use glam::Mat4;

use super::cube_descriptor::{CubeFrame, CubeShadowMapDescriptor};
use super::encoding::DepthEncoding;
use super::gpu::{
    HostDraw, LightRecord, OneLightKind, PipelineKind, Tiles, can_pull_casters, cube_view,
};
use super::one_light::{OneLightMap, OneLightSettings, TooMany};
use super::projection::{CubeFace, LightProjection, TileProjection};
use super::settings::MapSettings;
use super::statistics::{CubeStatistics, TileStatistics};
use crate::clock::Clock;
use crate::error::CubeShadowMapError;
use crate::{PointLight, Radius, gl};

/// An omnidirectional depth map for one point light: six faces, each drawn only if it has casters and only
/// when they have changed. For all lights of a scene, use a [`ShadowAtlas`](crate::ShadowAtlas).
///
/// By default `Depth32Float`, infinite reverse-Z: a texel holds `near / d`, where `d` is the distance along
/// the face's major axis, and 0 where there is no caster. For any plane, this is linear over a face, which
/// lets [`PcfSampler`](crate::PcfSampler) compare every tap with the receiver's own plane. (Cube maps for
/// point lights: Gerasimov, "Omnidirectional Shadow Mapping", GPU Gems, 2004.)
///
/// # What is redrawn
///
/// A face is redrawn only if the light, its casters, their transforms or the revisions of their meshes have
/// changed since it was last drawn. The map detects this by comparison, so there is no flag to set. The one
/// exception is a mesh that the host deforms in its own buffer: call
/// [`CasterMesh::bump_revision`](crate::CasterMesh::bump_revision) for it. The order of the casters does not
/// matter.
///
/// A static scene costs the CPU one comparison of 80 bytes per caster and the GPU nothing. A moving caster
/// costs one culling test and the redrawing of the faces it leaves or enters. A moving light finds its
/// casters through a tree (boxes over the casters in Morton order), which is kept between frames when that
/// pays off. `docs/benches.md` lists the time of `prepare` for 100 to 100,000 casters, and compares the tree
/// with a linear search and a compute shader.
///
/// # Accuracy
///
/// Accuracy grows with resolution. For the 64 spheres of the example `compare` (1280x720 pixels, one bilinear
/// tap), 0.28 % of the pixels are wrong with 512 texels per face, 0.14 % with 1024 and 0.07 % with 2048. All
/// of them lie at shadow edges.
#[derive(Debug)]
pub struct CubeShadowMap {
    map: OneLightMap,
    /// `None` on the GL back end.
    cube: Option<wgpu::TextureView>,
    statistics: CubeStatistics,
}

impl CubeShadowMap {
    /// Creates a map and its texture.
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if the size or a setting is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &CubeShadowMapDescriptor<'_>,
    ) -> Result<Self, CubeShadowMapError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(label) => format!("shadows cube map {label}"),
            None => "shadows cube map".to_owned(),
        };
        let MapSettings {
            format,
            bias,
            sides,
            reach,
        } = descriptor.settings;
        let map = OneLightMap::new(
            device,
            OneLightSettings {
                kind: OneLightKind {
                    label: label.clone(),
                    size: descriptor.size,
                    tiles: 6,
                    bias,
                    pipelines: PipelineKind {
                        format,
                        encoding: descriptor.encoding,
                        slope_scale: bias.slope_scale,
                        unclipped_depth: can_pull_casters(device),
                    },
                    sides,
                },
                reach,
                cache: descriptor.cache,
                cull: descriptor.cull_casters,
                layer_least: descriptor.layer_least(device),
            },
        );
        Ok(Self {
            cube: (!gl::is_gl(device)).then(|| cube_view(map.gpu.texture(), &label)),
            map,
            statistics: CubeStatistics::default(),
        })
    }

    /// Decides which casters belong to which faces and which faces to draw, and stages the uploads. (Nothing
    /// is written through the queue, which is a parameter only because every `prepare` takes one: uploads are
    /// recorded into the encoder, see [`encode`](Self::encode).)
    ///
    /// # Errors
    /// [`CubeShadowMapError`] if the light or a caster is out of range, or if there are too many casters. The
    /// result of an earlier `prepare` then remains in force.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _: &wgpu::Queue,
        frame: &CubeFrame<'_>,
    ) -> Result<(), CubeShadowMapError> {
        let clock = Clock::start();
        frame.light.validate()?;
        self.map.take_casters(device, frame.casters)?;
        let light = LightProjection::Point(frame.light);
        let prepared = self
            .map
            .prepare(device, light, frame.view.as_slice(), frame.casters);
        prepared.map_err(|too_many| {
            let TooMany {
                instances,
                size,
                limit,
            } = too_many;
            CubeShadowMapError::TooManyCasters {
                instances,
                size,
                limit,
            }
        })?;
        let record = self.light_record(&frame.light);
        self.map.gpu.write_light(record);
        self.statistics = CubeStatistics::of(&self.map.taken(&clock));
        Ok(())
    }

    /// Records the work that the last [`prepare`](Self::prepare) found necessary: render passes, and the
    /// light's data for receivers. Does so once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever the result. Until then, receivers see the previous texels and
    /// light; a map that has never been drawn makes its light appear dark. The recorded work must be
    /// submitted: if the encoder is dropped, the next `prepare` redraws everything
    /// ([`CubeStatistics::encoder_dropped`](crate::CubeStatistics)).
    ///
    /// Casters that only the host can draw ([`CasterMesh::host_drawn`](crate::CasterMesh::host_drawn)) are
    /// not drawn by this call. Faces that lack them are counted
    /// ([`CubeStatistics::faces_incomplete`](crate::CubeStatistics)) and redrawn in the next frame. Hosts
    /// with such casters call [`encode_with`](Self::encode_with) instead.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.map.encode(encoder, None);
        self.statistics.faces_incomplete = self.map.incomplete();
    }

    /// Like [`encode`](Self::encode), but also lets the host draw what only it can (skinned or alpha-tested
    /// meshes): `draw` is called within the pass of each face that such casters touch, after everything else
    /// on that face. The rules for such draws are given at
    /// [`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with); the depth comparison and the clear value
    /// are those of the map's [`DepthEncoding`](crate::DepthEncoding).
    pub fn encode_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &HostDraw<'_>),
    ) {
        self.map.encode(encoder, Some(&mut draw));
    }

    /// Marks every face as outdated: the next [`prepare`](Self::prepare) redraws all faces that the view
    /// shows. The result of the last one is discarded.
    ///
    /// For a host that has written to the map's texture, or has lost recorded work in a way that the map
    /// cannot detect: an encoder that is kept but never submitted, or a submission that failed.
    pub fn invalidate(&mut self) {
        self.map.invalidate();
    }

    /// The matrix of a face from world space to clip space, as of the last [`prepare`](Self::prepare); `None`
    /// before the first. It maps to a left-handed space: triangles that are counter-clockwise seen from the
    /// light are clockwise on the face.
    pub fn clip_from_world(&self, face: CubeFace) -> Option<Mat4> {
        let slot = self.map.slot();
        let tile = face.layer() as usize;
        let shown = slot.tiles.get(tile)?.shown;
        let projection = shown.or_else(|| slot.projection(tile))?;
        let from_light = projection.clip_from_light(tile, self.map.gpu.near_plane());
        Some(from_light * Mat4::from_translation(-projection.origin()))
    }

    /// The texture: six layers in the order of [`CubeFace::ALL`]. On wgpu's GL back end it has an additional,
    /// unused layer.
    pub fn texture(&self) -> &wgpu::Texture {
        self.map.gpu.texture()
    }

    /// The map as a cube texture, for hosts that sample it themselves.
    ///
    /// # Errors
    /// [`CubeShadowMapError::CubeView`] on wgpu's GL back end, which can read a texture either as layers, as
    /// receivers do, or as a cube, but not both.
    pub fn view(&self) -> Result<&wgpu::TextureView, CubeShadowMapError> {
        self.cube.as_ref().ok_or(CubeShadowMapError::CubeView)
    }

    /// One face as a 2D texture.
    pub fn face_view(&self, face: CubeFace) -> &wgpu::TextureView {
        self.map.gpu.tile(face.layer() as usize)
    }

    /// Texels along each side of a face.
    pub fn size(&self) -> u32 {
        self.map.gpu.size()
    }

    /// What the texels hold.
    pub fn encoding(&self) -> DepthEncoding {
        self.map.gpu.encoding()
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> CubeStatistics {
        self.statistics
    }

    /// Statistics of one face in the last [`prepare`](Self::prepare); `None` before the first.
    pub fn face_statistics(&self, face: CubeFace) -> Option<TileStatistics> {
        self.map.tile(face.layer() as usize)
    }

    pub(crate) fn reach(&self) -> Radius {
        self.map.reach
    }

    pub(crate) fn light_uniform(&self) -> &wgpu::Buffer {
        self.map.gpu.light()
    }

    /// All faces, as receivers read them.
    pub(crate) fn layers(&self) -> &wgpu::TextureView {
        self.map.gpu.layers()
    }

    /// What receivers are told of the light: the one that the faces show, which is last frame's while
    /// the view hides all that changed.
    fn light_record(&self, wanted: &PointLight) -> LightRecord {
        let slot = self.map.slot();
        let shown = slot.tiles.first().and_then(|tile| match tile.shown? {
            TileProjection::Face(light) => Some(light),
            TileProjection::Flat(_) => None,
        });
        let Some(light) = shown else {
            return LightRecord::DARK;
        };
        let near = self.map.gpu.near_plane().of_point(&light);
        let tiles = match slot.casting == 0 && light == *wanted {
            true => Tiles::NoCaster,
            false => self.map.gpu.places(),
        };
        LightRecord::point(&light, near, tiles, &self.map.gpu.tile_texture())
    }
}
