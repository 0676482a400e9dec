//! The techniques that have a name. A new one is one more row.

use anyhow::{Context as _, Result};
use shadows::{
    ContactHardening, Counter, CubeShadowMapDescriptor, Kernel, MapKind, Method, PcfDescriptor,
    RandomDisk, ShadowMapDescriptor, ShadowVolumeDescriptor, Silhouettes, VogelDisk,
};

use crate::survey::projected::Projected;
use crate::survey::{Baked, Blobs, Survey};
use crate::technique::{Config, Technique};
use host::peers::{WARPED, peer};

/// A technique but for the size of its maps.
#[derive(Debug)]
pub struct Row {
    pub name: &'static str,
    /// Whether it is compared where nothing else is asked for: few, so that this stays quick.
    pub usual: bool,
    /// Makes it, for maps of so many texels a side.
    config: fn(u32) -> Config,
}

impl Row {
    /// The technique with maps of `side` texels a side, or with the row's own size.
    pub fn at(&self, side: u32) -> Technique {
        Technique {
            name: self.name.into(),
            config: (self.config)(side),
        }
    }
}

/// The functions in a row are its own, so the name tells rows apart.
impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// The technique of that name, with maps of `side` texels a side or with its row's own size.
///
/// # Errors
/// If there is none.
pub fn named(name: &str, side: u32) -> Result<Technique> {
    let row = ROWS.iter().find(|row| row.name == name);
    let row = row.with_context(|| format!("{name} is no technique"))?;
    Ok(row.at(side))
}

const fn usual(name: &'static str, config: fn(u32) -> Config) -> Row {
    Row {
        name,
        usual: true,
        config,
    }
}

const fn row(name: &'static str, config: fn(u32) -> Config) -> Row {
    Row {
        name,
        usual: false,
        config,
    }
}

/// All of them, in the order of a report.
pub static ROWS: &[Row] = &[
    usual("cube-hard", |side| cube(side, Kernel::Hard)),
    usual("cube-2x2", |side| cube(side, Kernel::Bilinear)),
    usual("cube-16", |side| cube(side, Kernel::FourTaps)),
    row("cube-hw", |side| cube(side, Kernel::HardwareBilinear)),
    row("cube-3x3", |side| cube(side, Kernel::Weighted3)),
    row("cube-5x5", |side| cube(side, Kernel::Weighted5)),
    row("cube-7x7", |side| cube(side, Kernel::Weighted7)),
    row("cube-disk", |side| cube(side, disk(true))),
    row("cube-disk-full", |side| cube(side, disk(false))),
    row("cube-vogel", |side| cube(side, vogel())),
    row("cube-pcss", |side| cube(side, contact())),
    usual("cube-1024", |_| cube(1024, Kernel::default())),
    usual("cube-cached", cube_cached),
    usual("cube-textbook", cube_textbook),
    usual("flat-hard", |side| flat(side, Kernel::Hard)),
    usual("flat-2x2", |side| flat(side, Kernel::Bilinear)),
    usual("flat-16", |side| flat(side, Kernel::FourTaps)),
    row("flat-hw", |side| flat(side, Kernel::HardwareBilinear)),
    row("flat-3x3", |side| flat(side, Kernel::Weighted3)),
    row("flat-5x5", |side| flat(side, Kernel::Weighted5)),
    row("flat-7x7", |side| flat(side, Kernel::Weighted7)),
    row("flat-disk", |side| flat(side, disk(true))),
    row("flat-disk-full", |side| flat(side, disk(false))),
    row("flat-vogel", |side| flat(side, vogel())),
    row("flat-pcss", |side| flat(side, contact())),
    row("atlas-hard", |side| atlas(side, Kernel::Hard)),
    row("atlas-2x2", |side| atlas(side, Kernel::Bilinear)),
    row("atlas-hw", |side| atlas(side, Kernel::HardwareBilinear)),
    row("atlas-5x5", |side| atlas(side, Kernel::Weighted5)),
    row("atlas-disk", |side| atlas(side, disk(true))),
    usual("volume", |_| Config::Volume(volume())),
    row("volume-auto", |_| {
        Config::Volume(ShadowVolumeDescriptor::default())
    }),
    row("volume-zfail", |_| {
        Config::Volume(ShadowVolumeDescriptor {
            method: Method::ZFail,
            ..volume()
        })
    }),
    row("volume-textbook", |_| {
        Config::Volume(ShadowVolumeDescriptor::textbook())
    }),
    row("volume-cpu", |_| volume_by(Silhouettes::Cpu)),
    row("volume-compute", |_| volume_by(Silhouettes::Compute)),
    row("volume-vertex", |_| volume_by(Silhouettes::Vertex)),
    row("volume-exact-count", |_| {
        Config::Volume(ShadowVolumeDescriptor {
            counter: Counter::Exact,
            ..volume()
        })
    }),
    row("blob", |_| Config::Survey(Survey::Blob(Blobs::Asked))),
    row("blob-decals", |_| {
        Config::Survey(Survey::Blob(Blobs::Decals))
    }),
    row("planar", |_| Config::Survey(Survey::Planar)),
    row("planar-soft", |size| {
        let samples = 64;
        Config::Survey(Survey::PlanarSoft { size, samples })
    }),
    row("projected", |side| {
        Config::Survey(Survey::Projected(Projected::new(side, false)))
    }),
    row("projected-all", |side| {
        Config::Survey(Survey::Projected(Projected::new(side, true)))
    }),
    row("baked", |side| baked(side, 4, 0.0)),
    row("baked-soft", |side| {
        baked(side, 16, ContactHardening::default().light_size)
    }),
    row("peer-bevy-2x2", |side| of_peer("cube/bevy-2x2", side)),
    row("peer-bevy-gaussian", |side| {
        of_peer("cube/bevy-gaussian", side)
    }),
    row("peer-three", |side| of_peer("cube/three-pcf", side)),
    row("peer-wgpu", |side| of_peer("flat/wgpu-example", side)),
    row("peer-bevy-spot-2x2", |side| {
        of_peer("flat/bevy-spot-2x2", side)
    }),
    row("peer-bevy-spot-gaussian", |side| {
        of_peer("flat/bevy-spot-gaussian", side)
    }),
    row("peer-lispsm", |size| Config::Peer {
        peer: &WARPED,
        size,
    }),
    row("peer-bevy-sun-2x2", |side| of_peer("flat/bevy-2x2", side)),
    row("peer-bevy-sun-gaussian", |side| {
        of_peer("flat/bevy-gaussian", side)
    }),
];

/// Another engine's receiver and map in our rendition.
fn of_peer(name: &str, size: u32) -> Config {
    Config::Peer {
        peer: peer(name),
        size,
    }
}

/// A cube map read through a kernel, every face drawn every frame.
pub fn cube(side: u32, kernel: Kernel) -> Config {
    Config::Cube {
        map: CubeShadowMapDescriptor {
            size: side,
            cache: false,
            ..Default::default()
        },
        sampler: PcfDescriptor {
            kernel,
            ..Default::default()
        },
    }
}

/// Faces that have not changed are not drawn again.
fn cube_cached(side: u32) -> Config {
    Config::Cube {
        map: CubeShadowMapDescriptor {
            size: side,
            ..Default::default()
        },
        sampler: PcfDescriptor::default(),
    }
}

/// A cube map as textbooks have it.
fn cube_textbook(side: u32) -> Config {
    let map = CubeShadowMapDescriptor {
        size: side,
        ..CubeShadowMapDescriptor::textbook()
    };
    Config::Cube {
        sampler: PcfDescriptor {
            kernel: Kernel::Hard,
            map: MapKind::Cube(map.encoding),
            textbook: true,
            ..Default::default()
        },
        map,
    }
}

/// A flat map read through a kernel, drawn every frame.
pub fn flat(side: u32, kernel: Kernel) -> Config {
    Config::Flat {
        map: ShadowMapDescriptor {
            size: side,
            cache: false,
            ..Default::default()
        },
        sampler: PcfDescriptor {
            kernel,
            map: MapKind::FLAT,
            ..Default::default()
        },
    }
}

/// All lights in one atlas, every tile drawn every frame.
fn atlas(size: u32, kernel: Kernel) -> Config {
    Config::Atlas {
        size,
        kept: false,
        sampler: PcfDescriptor {
            kernel,
            map: MapKind::ATLAS,
            ..Default::default()
        },
    }
}

/// Every frame pays for its silhouettes, as a frame of a moving light does.
pub fn volume() -> ShadowVolumeDescriptor<'static> {
    ShadowVolumeDescriptor {
        keep_between_frames: false,
        ..Default::default()
    }
}

/// A light map of all that there is, by so many rays a texel; the light's radius in world units, or 0.
fn baked(texels: u32, samples: u32, radius: f32) -> Config {
    Config::Survey(Survey::Baked(Baked::new(texels, samples, radius)))
}

fn volume_by(silhouettes: Silhouettes) -> Config {
    Config::Volume(ShadowVolumeDescriptor {
        silhouettes,
        ..volume()
    })
}

fn disk(early_out: bool) -> Kernel {
    Kernel::RandomDisk(RandomDisk {
        early_out,
        ..Default::default()
    })
}

fn vogel() -> Kernel {
    Kernel::Vogel(VogelDisk::default())
}

fn contact() -> Kernel {
    Kernel::ContactHardening(ContactHardening::default())
}
