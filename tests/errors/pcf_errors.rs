//! What a sampler refuses: parameters out of range, before any GPU work, with the field named.

use crate::common::noop;
use shadows::error::PcfError;
use shadows::{
    ContactHardening, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, Kernel, MapKind,
    MapSettings, PcfDescriptor, PcfSampler, Radius, RandomDisk, ShadowMap, ShadowMapDescriptor,
    VogelDisk,
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
    let made = |map, textbook| {
        let descriptor = PcfDescriptor {
            map,
            textbook,
            ..Default::default()
        };
        PcfSampler::new(&device, &queue, &descriptor).map(drop)
    };
    for map in [MapKind::CUBE, MapKind::FLAT, MapKind::ATLAS] {
        assert_eq!(made(map, true), Err(PcfError::Textbook(map)));
        assert_eq!(made(map, false), Ok(()));
    }
    let linear = MapKind::Cube(DepthEncoding::LinearDistance);
    assert_eq!(made(linear, true), Ok(()));
}

#[test]
fn comparisons_in_hardware_of_another_encoding_are_refused() {
    let (device, queue) = noop();
    let made = |kernel: Kernel, map| {
        let descriptor = PcfDescriptor {
            kernel,
            map,
            ..Default::default()
        };
        PcfSampler::new(&device, &queue, &descriptor).map(drop)
    };
    let linear = MapKind::Cube(DepthEncoding::LinearDistance);
    for kernel in Kernel::ALL {
        assert_eq!(made(kernel, MapKind::CUBE), Ok(()));
        let expected = match kernel {
            Kernel::HardwareBilinear => Err(PcfError::HardwareEncoding(linear)),
            _ => Ok(()),
        };
        assert_eq!(made(kernel, linear), expected);
        assert_eq!(kernel.reads(linear), expected.is_ok());
    }
}

#[test]
fn a_kernel_that_textbook_receivers_do_not_have_is_refused() {
    let (device, queue) = noop();
    let made =
        |descriptor: &PcfDescriptor<'_>| PcfSampler::new(&device, &queue, descriptor).map(drop);
    // They are one tap.
    for (kernel, taken) in Kernel::ALL
        .into_iter()
        .zip([true, true].into_iter().chain([false; 8]))
    {
        let textbook = PcfDescriptor {
            kernel,
            map: MapKind::Cube(DepthEncoding::LinearDistance),
            textbook: true,
            ..Default::default()
        };
        let expected = if taken {
            Ok(())
        } else {
            Err(PcfError::TextbookKernel(kernel))
        };
        assert_eq!(made(&textbook), expected);
    }
}

#[test]
fn a_kernel_that_a_map_was_not_made_for_is_refused() {
    let (device, queue) = noop();
    let cube = |reach| {
        let descriptor = CubeShadowMapDescriptor {
            size: 16,
            settings: MapSettings {
                reach,
                ..Default::default()
            },
            ..Default::default()
        };
        CubeShadowMap::new(&device, &descriptor).unwrap()
    };
    let flat = |reach| {
        let descriptor = ShadowMapDescriptor {
            size: 16,
            settings: MapSettings {
                reach,
                ..Default::default()
            },
            ..Default::default()
        };
        ShadowMap::new(&device, &descriptor).unwrap()
    };
    let bound = |kernel, reach: Option<Radius>| {
        let of = |map| {
            let descriptor = PcfDescriptor {
                kernel,
                map,
                ..Default::default()
            };
            PcfSampler::new(&device, &queue, &descriptor).unwrap()
        };
        let usual = CubeShadowMapDescriptor::default().settings.reach;
        assert_eq!(usual, ShadowMapDescriptor::default().settings.reach);
        let (cube, flat) = (cube(reach.unwrap_or(usual)), flat(reach.unwrap_or(usual)));
        let results = [
            of(MapKind::CUBE).bind_group(&device, &cube).map(drop),
            of(MapKind::FLAT).bind_group(&device, &flat).map(drop),
        ];
        assert!(results.iter().all(|result| *result == results[0]));
        results[0]
    };
    for kernel in Kernel::ALL {
        assert_eq!(
            bound(kernel, None),
            Ok(()),
            "{kernel:?} as it is by default"
        );
    }
    let vogel = |radius| {
        Kernel::Vogel(VogelDisk {
            radius,
            ..Default::default()
        })
    };
    let contact = |max_radius| {
        Kernel::ContactHardening(ContactHardening {
            max_radius,
            ..Default::default()
        })
    };
    let (texels, world) = (Radius::Texels, Radius::World);
    for kernel in [vogel, contact] {
        for (radius, reach, fits) in [
            (texels(12.0), texels(8.0), false),
            (texels(12.0), texels(12.0), true),
            (world(0.3), world(0.2), false),
            (world(0.3), world(0.3), true),
            (world(0.3), texels(64.0), false),
            (texels(12.0), world(0.3), true),
            (texels(13.0), world(0.3), false),
        ] {
            let expected = match fits {
                true => Ok(()),
                false => Err(PcfError::Reach {
                    kernel: radius,
                    map: reach,
                }),
            };
            assert_eq!(bound(kernel(radius), Some(reach)), expected);
        }
    }
    let error = bound(vogel(texels(12.0)), Some(texels(8.0))).unwrap_err();
    let told = error.to_string();
    for part in ["Texels(12.0)", "Texels(8.0)", "reach: Radius::Texels(12.0)"] {
        assert!(told.contains(part), "{told}");
    }
}
