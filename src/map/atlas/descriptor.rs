//! Parameters of an atlas, and its input for each frame.

use std::num::NonZeroU32;

use super::{Cascades, DepthBounds, MapSettings, StaticLayers};
use crate::error::ShadowAtlasError;
use crate::map::encoding::texel_bytes;
use crate::map::plan::TileSize;
use crate::mesh::{Bounds, Caster};
use crate::scene::CasterFilter;
use crate::{DirectionalLight, Light, PointLight, SpotLight, View};

/// Texels along the smallest tile.
pub(crate) const LEAST_TILE: u32 = 16;

/// Layers of which shaders can be told.
const MOST_LAYERS: u32 = 1 << 12;

/// Parameters of a [`ShadowAtlas`](crate::ShadowAtlas).
#[derive(Clone, Debug)]
pub struct ShadowAtlasDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Texels along a side of a layer, which is also the largest size of a tile: a power of two from 16 to
    /// 8192, up to the device's `max_texture_dimension_2d`. Default 1024, the largest size that lights
    /// request by default. Layers are created when lights need them.
    pub layer_size: u32,
    /// Bytes that layers may take, rounded down to whole layers, but at least one. Default 256 MiB: 64 layers
    /// of 1024 texels in 32 bits. Layers of static casters ([`static_layers`](Self::static_layers)) come on
    /// top, at most as much again.
    pub memory: u64,
    /// How depths are stored, drawn and compared.
    pub settings: MapSettings,
    /// The maximum number of tiles drawn per `prepare`, at least 1; default no limit. See
    /// [`ShadowAtlas::max_age`](crate::ShadowAtlas::max_age) for the order, the longest wait, and what the
    /// budget does not include.
    pub max_tiles_per_frame: Option<u32>,
    /// Whether static casters are cached in layers under those that move. Default [`StaticLayers::Auto`].
    pub static_layers: StaticLayers,
}

impl Default for ShadowAtlasDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            layer_size: 1024,
            memory: 256 << 20,
            settings: MapSettings::default(),
            max_tiles_per_frame: None,
            static_layers: StaticLayers::default(),
        }
    }
}

impl ShadowAtlasDescriptor<'_> {
    pub(super) fn validate(&self, device: &wgpu::Device) -> Result<(), ShadowAtlasError> {
        let limit = device.limits().max_texture_dimension_2d.min(8192);
        let size = self.layer_size;
        if !size.is_power_of_two() || !(LEAST_TILE..=limit).contains(&size) {
            return Err(ShadowAtlasError::LayerSize {
                size,
                least: LEAST_TILE,
                limit,
            });
        }
        self.settings.validate()?;
        let (memory, layer) = (self.memory, self.layer_bytes());
        if memory < layer {
            return Err(ShadowAtlasError::Memory { memory, layer });
        }
        if self.max_tiles_per_frame == Some(0) {
            return Err(ShadowAtlasError::Budget);
        }
        Ok(())
    }

    /// As many layers as memory and the device have room for.
    pub(super) fn most_layers(&self, device: &wgpu::Device) -> u32 {
        let limit = device.limits().max_texture_array_layers.min(MOST_LAYERS);
        // wgpu's GL back end may want one more: `gl::array_layers`.
        let limit = limit - u32::from(crate::gl::is_gl(device));
        (self.memory / self.layer_bytes()).min(u64::from(limit)) as u32
    }

    fn layer_bytes(&self) -> u64 {
        u64::from(self.layer_size).pow(2) * texel_bytes(self.settings.format)
    }
}

/// A light of an atlas, and the size of its tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtlasLight {
    light: Light,
    cascades: Cascades,
    size: TileSize,
    pinned: bool,
    filter: CasterFilter,
}

impl AtlasLight {
    /// A point light or a spot, with tiles of 64 to 1024 texels according to its importance on screen.
    pub fn new(light: impl Into<LocalLight>) -> Self {
        let light: LocalLight = light.into();
        Self {
            light: light.0,
            cascades: Cascades::default(),
            size: TileSize::Auto {
                least: 64,
                most: 1024,
            },
            pinned: false,
            filter: CasterFilter::ALL,
        }
    }

    /// A directional light with cascades for each view of the frame, of 1024 texels, or at least 256 if space
    /// runs short. In a frame without views it has one tile, fitted to all casters (and receivers, if the
    /// frame specifies them).
    pub fn directional(light: DirectionalLight, cascades: Cascades) -> Self {
        Self {
            light: light.into(),
            cascades,
            size: TileSize::Auto {
                least: 256,
                most: 1024,
            },
            pinned: false,
            filter: CasterFilter::ALL,
        }
    }

    /// The same light with tiles of another size.
    pub fn with_size(self, size: TileSize) -> Self {
        Self { size, ..self }
    }

    /// The same light, drawn regardless of the budget
    /// ([`max_tiles_per_frame`](ShadowAtlasDescriptor::max_tiles_per_frame)).
    pub fn pinned(self) -> Self {
        Self {
            pinned: true,
            ..self
        }
    }

    /// The same light, restricted to casters on any of these layers, one bit each ([`Caster::layers`]).
    pub fn with_layers(mut self, layers: u32) -> Self {
        self.filter.layers = layers;
        self
    }

    /// The same light, without the shadows of casters of this owner ([`Caster::owner`]), such as a lamp's own
    /// shade.
    pub fn owned_by(mut self, owner: NonZeroU32) -> Self {
        self.filter.owner = Some(owner);
        self
    }

    /// The light.
    pub fn light(&self) -> Light {
        self.light
    }

    pub(super) fn cascades(&self) -> &Cascades {
        &self.cascades
    }

    pub(super) fn size(&self) -> TileSize {
        self.size
    }

    pub(super) fn filter(&self) -> CasterFilter {
        self.filter
    }

    pub(super) fn is_pinned(&self) -> bool {
        self.pinned
    }
}

/// A light with a position: a [`PointLight`] or a [`SpotLight`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalLight(Light);

impl From<PointLight> for LocalLight {
    fn from(light: PointLight) -> Self {
        Self(light.into())
    }
}

impl From<SpotLight> for LocalLight {
    fn from(light: SpotLight) -> Self {
        Self(light.into())
    }
}

/// One of a frame's cameras, and the size of its picture.
#[derive(Clone, Copy, Debug)]
pub struct AtlasView<'a> {
    /// The camera.
    pub view: &'a View,
    /// Width of its picture in pixels; greater than 0.
    pub width: u32,
    /// See `width`.
    pub height: u32,
    /// The range of depths visible in the picture, if the host knows it: cascades then divide only that
    /// range.
    pub depth_bounds: Option<DepthBounds>,
}

impl<'a> AtlasView<'a> {
    /// A camera, and the width and height of its picture in pixels.
    pub fn new(view: &'a View, width: u32, height: u32) -> Self {
        Self {
            view,
            width,
            height,
            depth_bounds: None,
        }
    }
}

/// The input of a [`ShadowAtlas`](crate::ShadowAtlas) for one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct AtlasFrame<'a> {
    /// The lights; shaders identify them by their index here. Lights from the last frame keep their tiles
    /// even if their index has changed.
    pub lights: &'a [AtlasLight],
    /// Everything that may cast; the atlas itself leaves out what a light cannot reach. The order does not
    /// matter, but a caster at another index than in the last frame counts as moved: remove casters with
    /// `swap_remove` rather than `remove`.
    pub casters: &'a [Caster],
    /// The cameras of the frame. They determine the size of tiles without a fixed size, which tiles can be
    /// postponed because no kernel reads them for anything visible, and where cascades lie. If empty,
    /// everything counts as visible.
    pub views: &'a [AtlasView<'a>],
    /// Bounds of all receivers in world space: a directional light's tiles cover only those. `None`:
    /// receivers may be anywhere.
    pub receivers: Option<Bounds>,
}

impl AtlasFrame<'_> {
    pub(super) fn validate(&self, layer_size: u32) -> Result<(), ShadowAtlasError> {
        for (index, light) in self.lights.iter().enumerate() {
            let of_light = |source| ShadowAtlasError::Light { index, source };
            light.light.validate().map_err(of_light)?;
            let of_size = |source| ShadowAtlasError::TileSize { index, source };
            light
                .size
                .validate(LEAST_TILE, layer_size)
                .map_err(of_size)?;
            if let Light::Directional(_) = light.light {
                let of_cascades = |source| ShadowAtlasError::Cascades { index, source };
                light.cascades.validate().map_err(of_cascades)?;
            }
        }
        for (index, view) in self.views.iter().enumerate() {
            let (width, height) = (view.width, view.height);
            if width == 0 || height == 0 {
                return Err(ShadowAtlasError::Pixels {
                    index,
                    width,
                    height,
                });
            }
            if let Some(bounds) = view.depth_bounds {
                let of_bounds = |source| ShadowAtlasError::DepthBounds { index, source };
                bounds.validate().map_err(of_bounds)?;
            }
        }
        match self.receivers {
            Some(Bounds { min, max })
                if !(min.is_finite() && max.is_finite() && min.cmple(max).all()) =>
            {
                let (min, max) = (min.to_array(), max.to_array());
                Err(ShadowAtlasError::Receivers { min, max })
            }
            _ => Ok(()),
        }
    }
}
