//! A shadow technique as data: a name, and the descriptors of what makes and reads its shadows.

use std::borrow::Cow;

use shadows::{
    CubeShadowMapDescriptor, Kernel, LightKinds, MapKind, PcfDescriptor, ShadowMapDescriptor,
    ShadowVolumeDescriptor,
};

use crate::survey::Survey;
use host::peers::{Peer, PeerLight};
use host::scene::LightKind;

/// A way to make shadows. Maps are drawn and silhouettes found anew every frame unless said
/// otherwise, as if everything moved.
#[derive(Clone, Debug)]
pub struct Technique {
    /// On the command line, in reports and of files.
    pub name: Cow<'static, str>,
    pub config: Config,
}

/// What a technique is made from. Labels, and what volumes need to know of the host's depth buffer,
/// are filled in when it is made.
#[derive(Clone, Debug)]
pub enum Config {
    Cube {
        map: CubeShadowMapDescriptor<'static>,
        sampler: PcfDescriptor<'static>,
    },
    Flat {
        map: ShadowMapDescriptor<'static>,
        sampler: PcfDescriptor<'static>,
    },
    /// Lights of any kind in one atlas, which is drawn anew every frame unless `kept`.
    Atlas {
        /// Texels along a tile: of a single light; of many at most.
        size: u32,
        kept: bool,
        sampler: PcfDescriptor<'static>,
    },
    Volume(ShadowVolumeDescriptor<'static>),
    /// Another engine's map and receiver in our rendition, for comparison: no part of the library.
    Peer {
        peer: &'static Peer,
        size: u32,
    },
    /// A cheap or a baked one.
    Survey(Survey),
}

impl Technique {
    /// The same for these kinds of light: as a host does, an atlas's receivers are told which there are.
    pub fn for_kinds(&self, kinds: &[LightKind]) -> Self {
        let mut own = self.clone();
        if let Config::Atlas { sampler, .. } = &mut own.config {
            sampler.map = MapKind::Atlas(LightKinds {
                point: kinds.contains(&LightKind::Point),
                spot: kinds.contains(&LightKind::Spot),
                directional: kinds.contains(&LightKind::Directional),
            });
        }
        own
    }
}

impl Config {
    /// Whether it can shadow this kind of light.
    pub fn applies_to(&self, light: LightKind) -> bool {
        match self {
            Self::Cube { .. } => light != LightKind::Directional,
            Self::Flat { .. } => light != LightKind::Point,
            Self::Volume(_) | Self::Atlas { .. } | Self::Survey(_) => true,
            Self::Peer { peer, .. } => match peer.light {
                PeerLight::Point => light == LightKind::Point,
                PeerLight::Spot => light == LightKind::Spot,
                PeerLight::Directional => light == LightKind::Directional,
                PeerLight::SpotOrDirectional => light != LightKind::Point,
            },
        }
    }

    /// Whether casters with a mask, which the host alone can draw, cast: it draws them into these maps.
    pub fn draws_masks(&self) -> bool {
        matches!(
            self,
            Self::Cube { .. } | Self::Flat { .. } | Self::Atlas { .. }
        )
    }

    /// Why it cannot shadow the lights that it does not apply to.
    pub fn limit(&self) -> &'static str {
        match self {
            Self::Cube { .. } => {
                "cube shadow maps need a point light, and this one is directional (w = 0)"
            }
            Self::Flat { .. } => {
                "flat shadow maps need a spot or directional light, and this one is a point \
                 (--light-kind makes it another)"
            }
            Self::Volume(_) | Self::Atlas { .. } | Self::Survey(_) => "",
            Self::Peer { peer, .. } => match peer.light {
                PeerLight::Point => "it is for point lights, and this one is none",
                PeerLight::Spot => "it is for spots, and this light is none (--light-kind spot)",
                PeerLight::Directional => {
                    "it is for directional lights, and this one is none (--light-kind directional)"
                }
                PeerLight::SpotOrDirectional => {
                    "it is for spots and directional lights, and this one is a point \
                     (--light-kind makes it another)"
                }
            },
        }
    }

    /// Whether it keeps what did not move from frame to frame.
    pub fn keeps(&self) -> bool {
        match self {
            Self::Cube { map, .. } => map.cache,
            Self::Flat { map, .. } => map.cache,
            Self::Atlas { kept, .. } => *kept,
            Self::Volume(volume) => volume.keep_between_frames,
            Self::Peer { .. } | Self::Survey(_) => false,
        }
    }

    /// As a host would have it: what does not move is kept, as by default.
    pub fn kept(&self) -> Self {
        let mut kept = self.clone();
        match &mut kept {
            Self::Cube { map, .. } => map.cache = true,
            Self::Flat { map, .. } => map.cache = true,
            Self::Atlas { kept, .. } => *kept = true,
            Self::Volume(volume) => volume.keep_between_frames = true,
            Self::Peer { .. } | Self::Survey(_) => {}
        }
        kept
    }

    /// Whether another light, or another place of it, takes longer than a frame.
    pub fn is_of_one_light(&self) -> bool {
        matches!(self, Self::Survey(Survey::Baked(_)))
    }

    /// The kernel by which the map is read, if there is a map.
    pub fn kernel(&self) -> Option<Kernel> {
        match self {
            Self::Cube { sampler, .. } if sampler.textbook => Some(Kernel::Hard),
            Self::Cube { sampler, .. }
            | Self::Flat { sampler, .. }
            | Self::Atlas { sampler, .. } => Some(sampler.kernel),
            Self::Volume(_) | Self::Peer { .. } | Self::Survey(_) => None,
        }
    }
}
