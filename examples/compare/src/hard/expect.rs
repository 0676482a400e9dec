//! What is expected of a technique on a case.

use shadows::{Counter, ShadowVolumeDescriptor, Silhouettes, wgpu};

use super::cases::Case;
use super::limits::{self, Limit};
use super::{ATLAS_NAMES, FINE, SIXTEEN_BITS};
use crate::technique::{Config, Technique};
use host::gpu::Gpu;

/// What is expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expect {
    /// Not one interior pixel is wrong.
    Exact,
    /// It cannot be right, and is no more wrong than this in any round.
    Limit(Limit),
    /// At most four interior pixels of a million are wrong, for this reason.
    Rare(&'static str),
    /// Streaks of one pixel may be wrong, for this reason: no wrong interior pixel has a wrong
    /// neighbour both beside it and above or below it.
    Streaks(&'static str),
    /// Lit where it should not be, in the situations that are made for it, and only where the
    /// renderer says that its 8-bit counts may have wrapped.
    Wraps,
    /// Not tried.
    Nothing,
}

impl Expect {
    /// In one situation: counts wrap only where that is what is tried.
    pub fn where_it(self, wraps: bool) -> Self {
        match self {
            Self::Wraps if !wraps => Self::Exact,
            other => other,
        }
    }
}

/// What is expected of a technique on a case; `software` is whether the adapter is no GPU.
pub fn expected(case: &Case, technique: &Technique, software: bool) -> Expect {
    let on_hardware = match software {
        true => None,
        false => limits::of_hardware(case.name, &technique.name),
    };
    on_hardware.map_or_else(|| anywhere(case, technique, software), Expect::Limit)
}

fn anywhere(case: &Case, technique: &Technique, software: bool) -> Expect {
    let usual = match &technique.config {
        _ if technique.name == SIXTEEN_BITS && !case.sixteen_bits => return Expect::Nothing,
        _ if FINE.iter().any(|fine| fine.1 == technique.name) && !case.fine => {
            return Expect::Nothing;
        }
        Config::Atlas { .. } if case.frames.is_some() => case.maps,
        _ if case.frames.is_some() || ATLAS_NAMES.contains(&technique.name.as_ref()) => {
            return Expect::Nothing;
        }
        Config::Cube { .. } | Config::Flat { .. } | Config::Atlas { .. } => case.maps,
        Config::Volume(volume) => match (case.volumes, volume.counter) {
            (Expect::Wraps, Counter::Exact) => Expect::Exact,
            (other, _) => other,
        },
        Config::Survey(_) if case.cheap.contains(&technique.name.as_ref()) => Expect::Exact,
        Config::Peer { .. } | Config::Survey(_) => return Expect::Nothing,
    };
    let by_name = limits::of(case.name, &technique.name);
    let by_way = match &technique.config {
        // On a GPU every technique that says nothing else takes the compute way, with its limits.
        Config::Volume(volume) if way(volume, software) == Silhouettes::Compute => {
            limits::of(case.name, "volume-compute")
        }
        _ => None,
    };
    by_name.or(by_way).map_or(usual, Expect::Limit)
}

/// How silhouettes are found, where both ways are possible: as the library's `Auto` decides.
pub fn way(volume: &ShadowVolumeDescriptor<'_>, software: bool) -> Silhouettes {
    match volume.silhouettes {
        Silhouettes::Auto if software => Silhouettes::Cpu,
        Silhouettes::Auto => Silhouettes::Compute,
        other => other,
    }
}

/// Whether the adapter is no GPU.
pub fn is_software(gpu: &Gpu) -> bool {
    gpu.info.device_type == wgpu::DeviceType::Cpu
}
