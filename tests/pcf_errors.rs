//! What a sampler refuses: parameters out of range, before any GPU work, with the field named.

mod common;

use common::noop;
use shadows::error::PcfError;
use shadows::{
    ContactHardening, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel, MapKind,
    PcfDescriptor, PcfSampler, Radius, RandomDisk, VogelDisk,
};

fn make(kernel: Kernel) -> Result<PcfSampler, PcfError> {
    let (device, queue) = noop();
    let descriptor = PcfDescriptor {
        kernel,
        ..Default::default()
    };
    PcfSampler::new(&device, &queue, &descriptor)
}

fn refused(kernel: Kernel) -> PcfError {
    make(kernel).expect_err("it must be refused")
}

#[test]
fn tap_counts_out_of_range_are_refused() {
    for taps in [0, 3, 65, u32::MAX] {
        let disk = VogelDisk {
            taps,
            ..Default::default()
        };
        assert_eq!(
            refused(Kernel::Vogel(disk)),
            PcfError::Taps {
                what: "taps",
                taps,
                limit: 64
            }
        );
    }
    for taps in [4, 5, 64] {
        let disk = VogelDisk {
            taps,
            ..Default::default()
        };
        assert!(make(Kernel::Vogel(disk)).is_ok());
    }
    // The search uses the filter's taps, so it cannot have more.
    let contact = ContactHardening {
        search_taps: 33,
        ..Default::default()
    };
    assert_eq!(
        refused(Kernel::ContactHardening(contact)),
        PcfError::Taps {
            what: "search_taps",
            taps: 33,
            limit: 32
        }
    );
}

#[test]
fn strata_out_of_range_are_refused() {
    for (around, rings) in [(0, 4), (7, 1), (3, 3), (17, 16), (u32::MAX, u32::MAX)] {
        let disk = RandomDisk {
            around,
            rings,
            ..Default::default()
        };
        let error = refused(Kernel::RandomDisk(disk));
        let limit = 256;
        assert_eq!(
            error,
            PcfError::Samples {
                around,
                rings,
                limit
            }
        );
    }
    for (around, rings) in [(8, 1), (16, 16), (5, 2)] {
        let disk = RandomDisk {
            around,
            rings,
            ..Default::default()
        };
        assert!(make(Kernel::RandomDisk(disk)).is_ok());
    }
}

#[test]
fn texture_sizes_out_of_range_are_refused() {
    for size in [0, 257] {
        let disk = RandomDisk {
            size,
            ..Default::default()
        };
        assert_eq!(
            refused(Kernel::RandomDisk(disk)),
            PcfError::OffsetTexture { size, limit: 256 }
        );
    }
}

#[test]
fn radii_out_of_range_are_refused_by_every_disk() {
    for radius in [
        Radius::Texels(0.0),
        Radius::Texels(-1.0),
        Radius::Texels(64.1),
        Radius::Texels(f32::INFINITY),
        Radius::World(0.0),
        Radius::World(f32::INFINITY),
    ] {
        let kernels = [
            Kernel::Vogel(VogelDisk {
                radius,
                ..Default::default()
            }),
            Kernel::RandomDisk(RandomDisk {
                radius,
                ..Default::default()
            }),
            Kernel::ContactHardening(ContactHardening {
                max_radius: radius,
                ..Default::default()
            }),
        ];
        for kernel in kernels {
            assert_eq!(refused(kernel), PcfError::Radius { radius }, "{kernel:?}");
        }
    }
    let nan = VogelDisk {
        radius: Radius::World(f32::NAN),
        ..Default::default()
    };
    assert!(matches!(
        refused(Kernel::Vogel(nan)),
        PcfError::Radius { .. }
    ));
}

#[test]
fn a_light_without_a_size_is_refused() {
    for light_size in [0.0, -0.1, f32::INFINITY] {
        let contact = ContactHardening {
            light_size,
            ..Default::default()
        };
        assert_eq!(
            refused(Kernel::ContactHardening(contact)),
            PcfError::LightSize(light_size)
        );
    }
}

#[test]
fn textbook_receivers_of_another_encoding_are_refused() {
    let (device, queue) = noop();
    let made = |encoding, map, textbook| {
        let descriptor = PcfDescriptor {
            encoding,
            map,
            textbook,
            ..Default::default()
        };
        PcfSampler::new(&device, &queue, &descriptor).map(drop)
    };
    let (major, linear) = (DepthEncoding::MajorAxis, DepthEncoding::LinearDistance);
    let error = made(major, MapKind::Cube, true);
    assert_eq!(error, Err(PcfError::Textbook(major)));
    assert_eq!(made(linear, MapKind::Cube, true), Ok(()));
    assert_eq!(made(major, MapKind::Cube, false), Ok(()));
    // Flat maps have neither encodings nor textbook receivers.
    assert_eq!(made(major, MapKind::Flat, true), Ok(()));
}

#[test]
fn a_light_that_a_map_has_no_place_for_is_refused() {
    let (device, queue) = noop();
    let sampler = PcfSampler::new(&device, &queue, &PcfDescriptor::default()).unwrap();
    let descriptor = CubeShadowMapDescriptor {
        lights: 2,
        ..Default::default()
    };
    let map = CubeShadowMap::new(&device, &descriptor).unwrap();
    let of = |light| sampler.bind_group_of(&device, &map, light).map(drop);
    for light in [2, usize::MAX] {
        assert_eq!(of(light), Err(PcfError::Light { light, lights: 2 }));
    }
    assert_eq!(of(1), Ok(()));
}
