//! Every configuration of a `PcfSampler`, and hosts that ask it.
#![allow(dead_code)] // each test uses its own part

use shadows::{
    DepthEncoding, FlatLights, Gather, Kernel, LightKinds, MapKind, PcfDescriptor, PcfSampler, wgpu,
};

pub fn made(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    descriptor: &PcfDescriptor<'_>,
) -> PcfSampler {
    PcfSampler::new(device, queue, descriptor).unwrap()
}

/// The kernels that differ with and without gathers.
pub const SQUARES: [Kernel; 5] = [
    Kernel::Bilinear,
    Kernel::FourTaps,
    Kernel::Weighted3,
    Kernel::Weighted5,
    Kernel::Weighted7,
];

/// How a map is made and read: all that a sampler's text depends on but its kernel.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    pub name: &'static str,
    pub map: MapKind,
    pub gather: Gather,
    /// Whether the device's samplers have borders.
    pub border: bool,
}

const CUBE: Way = Way {
    name: "cube",
    map: MapKind::CUBE,
    gather: Gather::Auto,
    border: false,
};

const LINEAR: Way = Way {
    name: "cube-linear",
    map: MapKind::Cube(DepthEncoding::LinearDistance),
    ..CUBE
};

const FLAT: Way = Way {
    name: "flat",
    map: MapKind::FLAT,
    ..CUBE
};

const SPOT: Way = Way {
    name: "flat-spot",
    map: MapKind::Flat(FlatLights::Spot),
    ..FLAT
};

const SUN: Way = Way {
    name: "flat-directional",
    map: MapKind::Flat(FlatLights::Directional),
    ..FLAT
};

const ATLAS: Way = Way {
    name: "atlas",
    map: MapKind::ATLAS,
    ..CUBE
};

const NO_KINDS: LightKinds = LightKinds {
    point: false,
    spot: false,
    directional: false,
};

/// All of them.
pub const WAYS: [Way; 17] = [
    CUBE,
    LINEAR,
    // Where gathers are not there, or wrong.
    Way {
        name: "cube-fetches",
        gather: Gather::Never,
        ..CUBE
    },
    Way {
        name: "cube-linear-fetches",
        gather: Gather::Never,
        ..LINEAR
    },
    FLAT,
    Way {
        name: "flat-fetches",
        gather: Gather::Never,
        ..FLAT
    },
    // What a device with the feature for it takes.
    Way {
        name: "flat-border",
        border: true,
        ..FLAT
    },
    // What hosts take who know which light it is.
    SPOT,
    Way {
        name: "flat-spot-border",
        border: true,
        ..SPOT
    },
    SUN,
    Way {
        name: "flat-directional-border",
        border: true,
        ..SUN
    },
    Way {
        name: "flat-border-fetches",
        gather: Gather::Never,
        border: true,
        ..FLAT
    },
    ATLAS,
    Way {
        name: "atlas-point",
        map: MapKind::Atlas(LightKinds {
            point: true,
            ..NO_KINDS
        }),
        ..ATLAS
    },
    Way {
        name: "atlas-spot",
        map: MapKind::Atlas(LightKinds {
            spot: true,
            ..NO_KINDS
        }),
        ..ATLAS
    },
    Way {
        name: "atlas-directional",
        map: MapKind::Atlas(LightKinds {
            directional: true,
            ..NO_KINDS
        }),
        ..ATLAS
    },
    Way {
        name: "atlas-fetches",
        gather: Gather::Never,
        ..ATLAS
    },
];

impl Way {
    pub fn device(&self) -> (wgpu::Device, wgpu::Queue) {
        let required_features = match self.border {
            true => wgpu::Features::ADDRESS_MODE_CLAMP_TO_BORDER,
            false => wgpu::Features::empty(),
        };
        wgpu::Device::noop(&wgpu::DeviceDescriptor {
            required_features,
            ..Default::default()
        })
    }

    pub fn descriptor(&self, kernel: Kernel) -> PcfDescriptor<'static> {
        PcfDescriptor {
            kernel,
            map: self.map,
            gather: self.gather,
            ..Default::default()
        }
    }

    /// The kernels whose text is not that of another way.
    pub fn kernels(&self) -> impl Iterator<Item = Kernel> {
        let all: &[Kernel] = match self.gather {
            Gather::Never => &SQUARES,
            _ => &Kernel::ALL,
        };
        let map = self.map;
        let read = move |kernel: &Kernel| kernel.reads(map);
        all.iter().copied().filter(read)
    }
}

/// What a sampler can be made for, on a device without any feature.
pub fn descriptors() -> Vec<PcfDescriptor<'static>> {
    let ways = WAYS.iter().filter(|way| !way.border);
    ways.flat_map(|way| way.kernels().map(|kernel| way.descriptor(kernel)))
        .collect()
}

/// The samplers of all configurations, but for the textbook's.
pub fn samplers() -> Vec<(PcfDescriptor<'static>, PcfSampler)> {
    let of = |way: &Way| {
        let (device, queue) = way.device();
        let descriptors = way.kernels().map(|kernel| way.descriptor(kernel));
        descriptors
            .map(|descriptor| {
                let sampler = made(&device, &queue, &descriptor);
                (descriptor, sampler)
            })
            .collect::<Vec<_>>()
    };
    WAYS.iter().flat_map(of).collect()
}

/// The textbook's.
pub fn textbooks() -> Vec<(PcfDescriptor<'static>, PcfSampler)> {
    let (device, queue) = CUBE.device();
    let descriptor = PcfDescriptor {
        kernel: Kernel::Hard,
        map: MapKind::Cube(DepthEncoding::LinearDistance),
        textbook: true,
        ..Default::default()
    };
    let sampler = made(&device, &queue, &descriptor);
    vec![(descriptor, sampler)]
}

/// Whether shaders name a light.
pub fn takes_light(descriptor: &PcfDescriptor<'_>) -> bool {
    matches!(descriptor.map, MapKind::Atlas(_))
}

/// A fragment shader that asks for the visibility at its position; `module` is what stands before
/// the function's name.
pub fn host_of(descriptor: &PcfDescriptor<'_>, module: &str) -> String {
    let pixel = match descriptor.kernel.uses_pixel() {
        true => ", pixel.xy",
        false => "",
    };
    let light = if takes_light(descriptor) { "3u, " } else { "" };
    let name = visibility_name(descriptor.map);
    format!(
        "
@fragment
fn host(@builtin(position) pixel: vec4f, @location(0) position: vec3f) -> @location(0) vec4f {{
    return vec4f({module}{name}({light}position{pixel}));
}}
"
    )
}

/// The same where the module is pasted.
pub fn host(descriptor: &PcfDescriptor<'_>) -> String {
    host_of(descriptor, "")
}

/// Another that knows its normal, and asks in a branch.
pub fn given_host(descriptor: &PcfDescriptor<'_>) -> String {
    let pixel = match descriptor.kernel.uses_pixel() && !descriptor.textbook {
        true => ", pixel.xy",
        false => "",
    };
    let light = if takes_light(descriptor) { "3u, " } else { "" };
    let name = visibility_name(descriptor.map);
    format!(
        "
@fragment
fn given_host(
    @builtin(position) pixel: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
) -> @location(0) vec4f {{
    if normal.z < 0.0 {{
        return vec4f(0.0);
    }}
    return vec4f({name}_flat({light}position, normal{pixel}));
}}
"
    )
}

pub fn visibility_name(map: MapKind) -> &'static str {
    match map {
        MapKind::Flat(_) => "shadows_flat_visibility",
        _ => "shadows_visibility",
    }
}
