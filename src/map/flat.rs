//! Flat shadow maps for spot and directional lights.

use glam::{Mat4, Vec4};

use super::encoding::DepthEncoding;
use super::flat_descriptor::{FlatLight, ShadowFrame, ShadowMapDescriptor};
use super::gpu::{HostDraw, LightRecord, OneLightKind, PipelineKind, can_pull_casters};
use super::one_light::{OneLightMap, OneLightSettings, TooMany};
use super::plan::FlatPlace;
use super::settings::MapSettings;
use super::statistics::ShadowMapStatistics;
use crate::Radius;
use crate::clock::Clock;
use crate::error::ShadowMapError;

/// The matrix from clip space to the space of a texture: x and y from -1 .. 1 to 0 .. 1, y flipped because
/// the rows of a texture run downwards, and z unchanged because depth in WebGPU's clip space is already in 0
/// .. 1. (The bias matrix in textbooks for OpenGL also halves z.)
///
/// ```
/// use shadows::{glam::Vec3, texture_from_clip};
/// let corner = texture_from_clip().project_point3(Vec3::new(-1.0, 1.0, 0.25));
/// assert_eq!(corner, Vec3::new(0.0, 0.0, 0.25));
/// ```
pub fn texture_from_clip() -> Mat4 {
    Mat4::from_cols(
        Vec4::new(0.5, 0.0, 0.0, 0.0),
        Vec4::new(0.0, -0.5, 0.0, 0.0),
        Vec4::Z,
        Vec4::new(0.5, 0.5, 0.0, 1.0),
    )
}

/// A depth map for one spot or directional light (Williams, "Casting Curved Shadows on Curved
/// Surfaces", 1978).
///
/// Reverse-Z, `Depth32Float` by default: a texel holds `near / d` for a spot and `1 - d / range` for a
/// directional light, `d` along the light's direction, and 0 where there is no caster. Receivers outside the
/// map are lit, as are receivers behind a spot; beyond a spot's range, none is.
///
/// # When it is redrawn
///
/// A map whose content is up to date is left alone. This is detected by comparison, as for a
/// [`CubeShadowMap`](crate::CubeShadowMap): in a frame without changes, 80 bytes per caster are read, and
/// nothing is uploaded.
#[derive(Debug)]
pub struct ShadowMap {
    map: OneLightMap,
    place: FlatPlace,
    statistics: ShadowMapStatistics,
}

impl ShadowMap {
    /// Creates a map and its texture.
    ///
    /// # Errors
    /// [`ShadowMapError`] if the size or a setting is out of range.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor<'_>,
    ) -> Result<Self, ShadowMapError> {
        descriptor.validate(device)?;
        let label = match descriptor.label {
            Some(label) => format!("shadows map {label}"),
            None => "shadows map".to_owned(),
        };
        let size = descriptor.size;
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
                    label,
                    size,
                    tiles: 1,
                    bias,
                    pipelines: PipelineKind {
                        format,
                        encoding: DepthEncoding::MajorAxis,
                        slope_scale: bias.slope_scale,
                        unclipped_depth: descriptor.unclipped_depth && can_pull_casters(device),
                    },
                    sides,
                },
                reach,
                cache: descriptor.cache,
                cull: true,
                layer_least: None,
            },
        );
        let gpu = &map.gpu;
        Ok(Self {
            place: FlatPlace::new(size, reach, gpu.near_plane(), gpu.unclipped_depth()),
            map,
            statistics: ShadowMapStatistics::default(),
        })
    }

    /// Places the map, decides which casters belong on it and stages the uploads. (Nothing is written through
    /// the queue, which is a parameter only because every `prepare` takes one: uploads are recorded into the
    /// encoder, see [`encode`](Self::encode).)
    ///
    /// # Errors
    /// [`ShadowMapError`] if the light, a caster, the view's distance or the receivers' bounds are out of
    /// range, each on its own or in combination, in `f32`. The map is then unchanged.
    pub fn prepare(
        &mut self,
        device: &wgpu::Device,
        _: &wgpu::Queue,
        frame: &ShadowFrame<'_>,
    ) -> Result<(), ShadowMapError> {
        let clock = Clock::start();
        frame.validate()?;
        self.validate_reach(&frame.light)?;
        self.map.take_casters(device, frame.casters)?;
        let placed = self.place.take_over(frame, self.map.casters());
        if placed.is_err() {
            self.map.refuse();
        }
        placed?;
        let light = self.place.projection();
        let prepared = self.map.prepare(device, light, &[], frame.casters);
        prepared.map_err(|too_many| {
            let TooMany {
                instances,
                size,
                limit,
            } = too_many;
            ShadowMapError::TooManyCasters {
                casters: instances,
                size,
                limit,
            }
        })?;
        let gpu = &mut self.map.gpu;
        let record = match self.place.frame() {
            Some(frame) => LightRecord::flat(frame, gpu.places(), &gpu.tile_texture()),
            None => LightRecord::lit(),
        };
        gpu.write_light(record);
        self.statistics = ShadowMapStatistics::of(&self.map.taken(&clock));
        Ok(())
    }

    /// Records the work that the last [`prepare`](Self::prepare) found necessary: a render pass, and the
    /// light's data for receivers. Does so once: a second call before the next `prepare` records nothing.
    ///
    /// Call it after every `prepare`, whatever the result. Until then, receivers see the previous texels and
    /// light; a map that has never been drawn makes its light appear dark. The recorded work must be
    /// submitted: if the encoder is dropped, the next `prepare` redraws the map
    /// ([`ShadowMapStatistics::encoder_dropped`]).
    ///
    /// Casters that only the host can draw ([`CasterMesh::host_drawn`](crate::CasterMesh::host_drawn)) are
    /// not drawn by this call ([`ShadowMapStatistics::incomplete`]), and the map is redrawn in the next
    /// frame. Hosts with such casters call [`encode_with`](Self::encode_with) instead.
    pub fn encode(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.map.encode(encoder, None);
        self.statistics.incomplete = self.map.incomplete() > 0;
    }

    /// Like [`encode`](Self::encode), but also lets the host draw what only it can (skinned or alpha-tested
    /// meshes): `draw` is called within the pass, after everything else, if such casters touch the map. The
    /// rules for such draws are given at [`ShadowAtlas::encode_with`](crate::ShadowAtlas::encode_with).
    pub fn encode_with(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, &HostDraw<'_>),
    ) {
        self.map.encode(encoder, Some(&mut draw));
    }

    /// Marks the map as outdated: the next [`prepare`](Self::prepare) redraws it. The result of the last one
    /// is discarded.
    ///
    /// For a host that has written to the map's texture, or has lost recorded work in a way that the map
    /// cannot detect: an encoder that is kept but never submitted, or a submission that failed.
    pub fn invalidate(&mut self) {
        self.map.invalidate();
    }

    /// World space to clip space, as of the last [`prepare`](Self::prepare); `None` if nothing casts. It maps
    /// to a left-handed space: triangles that are counter-clockwise seen from the light are clockwise on the
    /// map.
    pub fn clip_from_world(&self) -> Option<Mat4> {
        Some(self.place.frame()?.clip_from_world())
    }

    /// World space to texture coordinates (x and y in 0 .. 1 on the map) and depth, after division
    /// by w: [`texture_from_clip`] times [`clip_from_world`](Self::clip_from_world).
    pub fn texture_from_world(&self) -> Option<Mat4> {
        Some(texture_from_clip() * self.clip_from_world()?)
    }

    /// The texture, of [`MapSettings::format`].
    pub fn texture(&self) -> &wgpu::Texture {
        self.map.gpu.texture()
    }

    /// The map as layer 0 of a 2D array (`texture_2d_array`, `texture_depth_2d_array`), for hosts that sample
    /// it themselves. On wgpu's GL back end it has an additional, unused layer.
    pub fn view(&self) -> &wgpu::TextureView {
        self.map.gpu.layers()
    }

    /// Texels along each side.
    pub fn size(&self) -> u32 {
        self.map.gpu.size()
    }

    /// Statistics of the last [`prepare`](Self::prepare).
    pub fn statistics(&self) -> ShadowMapStatistics {
        self.statistics
    }

    pub(crate) fn reach(&self) -> Radius {
        self.map.reach
    }

    pub(crate) fn light_uniform(&self) -> &wgpu::Buffer {
        self.map.gpu.light()
    }

    /// A directional light's map is made wider by what kernels reach beside what is seen; of texels, a
    /// small map has not that many.
    fn validate_reach(&self, light: &FlatLight) -> Result<(), ShadowMapError> {
        let ((reach, _), size) = (self.map.reach.reach(), self.size());
        match light {
            FlatLight::Directional(_) if 4.0 * (reach + 1.0) > size as f32 => {
                Err(ShadowMapError::ReachOfSize { reach, size })
            }
            _ => Ok(()),
        }
    }
}
