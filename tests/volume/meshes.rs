//! Meshes that come and go: all of them lie in shared buffers, and none is taken for another.

use host::one_light::{OneLight, PrepareOne as _};
use shadows::glam::{Affine3A, Vec3};
use shadows::mesh::{Adjacency, Bounds};
use shadows::{
    Caster, CasterMesh, HostPositions, ShadowVolumeDescriptor, ShadowVolumeRenderer, Silhouettes,
    VolumeStatistics, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::errors::{LIGHT, bare};
use crate::kept::{Theatre, frame, is_shown};
use crate::pictures::{lamp, mixed};
use crate::shapes::{self, Shape};
use host::gpu::Gpu;

fn mesh(device: &wgpu::Device, shape: &Shape) -> CasterMesh {
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
    CasterMesh::new(device, &shape.positions, &adjacency).unwrap()
}

/// The same over a buffer of the host, 20 bytes a vertex.
fn host_mesh(device: &wgpu::Device, shape: &Shape) -> CasterMesh {
    let vertex = |&[x, y, z]: &[f32; 3]| [x, y, z, 9.0, 9.0];
    let vertices: Vec<[f32; 5]> = shape.positions.iter().map(vertex).collect();
    let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&vertices),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
    });
    let positions = HostPositions {
        buffer: &buffer,
        stride: 20,
        offset: 0,
        bounds: Bounds {
            min: Vec3::splat(-3.0),
            max: Vec3::splat(3.0),
        },
    };
    let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
    CasterMesh::from_host_positions(device, &positions, &adjacency).unwrap()
}

/// Shapes of many sizes, closed and general.
fn shape(number: usize) -> Shape {
    match number % 4 {
        0 => shapes::sphere(3 + number as u32 / 4),
        1 => shapes::fins(2 + number as u32 / 4),
        2 => shapes::cube(),
        _ => shapes::sphere(4 + number as u32 / 4).turned(|triangle| triangle % 3 == 0),
    }
}

/// A theatre where each of these is another mesh; for compute, every fifth over positions of the host.
fn theatre(gpu: Gpu, way: Silhouettes) -> Theatre {
    let mut theatre = Theatre::new(gpu);
    let device = theatre.gpu.device.clone();
    let make = |number| match number % 5 == 4 && way == Silhouettes::Compute {
        true => host_mesh(&device, &shape(number)),
        false => mesh(&device, &shape(number)),
    };
    theatre.meshes = (0..24).map(make).collect();
    theatre
}

/// What becomes of a frame.
#[derive(Clone, Copy, PartialEq)]
enum End {
    Drawn,
    Forgotten,
    Dropped,
}

/// Draws frames of these casters with one renderer; each has to be what a new one draws.
fn assert_as_fresh(
    theatre: &Theatre,
    way: Silhouettes,
    frames: &[(&[usize], End)],
) -> Vec<(Vec<u8>, VolumeStatistics)> {
    let view = mixed(lamp()).view();
    let mut renderer = theatre.renderer(way);
    let mut drawn = Vec::new();
    for (step, (numbers, end)) in frames.iter().enumerate() {
        let casters = theatre.casters(numbers.iter().copied());
        let frame = frame(&view, lamp(), &casters);
        if *end == End::Drawn {
            let (counts, statistics) = theatre.draw(&mut renderer, &frame);
            assert!(
                counts == theatre.fresh(way, &frame),
                "{way:?}, frame {step}"
            );
            assert!(is_shown(&counts), "{way:?}, frame {step}");
            drawn.push((counts, statistics));
        } else {
            theatre.prepare(&mut renderer, &frame);
            if *end == End::Dropped {
                let device = &theatre.gpu.device;
                renderer.encode(&mut device.create_command_encoder(&Default::default()));
            }
        }
    }
    drawn
}

/// Numbers of casters, each with a mesh of its own.
const FRAMES: [(&[usize], End); 12] = [
    (&[0, 1, 2, 3, 4], End::Drawn),
    // Others take the room of those that went.
    (&[3, 4, 8, 9, 10, 11], End::Drawn),
    (&[0, 1, 2, 3, 4, 5], End::Forgotten),
    (&[0, 1, 2, 6], End::Drawn),
    (
        &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
        End::Drawn,
    ),
    (&[20, 21], End::Dropped),
    (&[14, 15, 20, 21], End::Drawn),
    (&[16, 17, 18, 19], End::Forgotten),
    (&[22, 23], End::Drawn),
    (&[16, 17, 18, 19, 22], End::Drawn),
    (&[], End::Forgotten),
    (&[22, 19, 4, 9], End::Drawn),
];

const WAYS: [Silhouettes; 2] = [Silhouettes::Compute, Silhouettes::Cpu];

#[test]
fn meshes_that_come_and_go_are_not_taken_for_each_other() {
    for way in WAYS {
        let Some(gpu) = Gpu::for_test() else { return };
        let drawn = assert_as_fresh(&theatre(gpu, way), way, &FRAMES);
        // Whoever reads the mesh that lay there before sees another picture.
        for (first, (counts, _)) in drawn.iter().enumerate() {
            assert!(drawn[..first].iter().all(|(other, _)| other != counts));
        }
    }
}

/// The same adapter with buffers of this many bytes at most.
fn with_small_buffers(gpu: &Gpu, bytes: u64) -> Option<Gpu> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let same = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        (info.name, info.backend) == (gpu.info.name.clone(), gpu.info.backend)
    };
    let adapter = adapters.into_iter().find(same)?;
    let descriptor = wgpu::DeviceDescriptor {
        required_features: gpu.support.features(),
        required_limits: wgpu::Limits {
            max_storage_buffer_binding_size: bytes,
            ..gpu.support.limits()
        },
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).ok()?;
    Some(Gpu {
        device,
        queue,
        info: gpu.info.clone(),
        support: gpu.support.clone(),
    })
}

#[test]
fn meshes_that_fit_no_one_buffer_lie_in_several() {
    let frames = [
        (&[0, 1, 2, 3, 6, 7, 8, 15][..], End::Drawn),
        (&[1, 2, 8, 10, 11, 12, 13], End::Drawn),
        (&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11], End::Drawn),
    ];
    for way in WAYS {
        let Some(gpu) = Gpu::for_test() else { return };
        let Some(small) = with_small_buffers(&gpu, 7_000) else {
            panic!("{}: no second device", gpu.info.name)
        };
        let [all, few] = [gpu, small].map(|gpu| assert_as_fresh(&theatre(gpu, way), way, &frames));
        for ((counts, _), (in_few, _)) in all.iter().zip(&few) {
            assert!(counts == in_few, "{way:?}");
        }
        let dispatches = |frames: &[(Vec<u8>, VolumeStatistics)]| -> u32 {
            frames.iter().map(|(_, found)| found.dispatches).sum()
        };
        if way == Silhouettes::Compute {
            assert!(dispatches(&few) > dispatches(&all), "{few:?}");
        }
    }
}

fn row(
    device: &wgpu::Device,
    count: usize,
    make: fn(&wgpu::Device, &Shape) -> CasterMesh,
) -> Vec<Caster> {
    let at = |i: usize| Vec3::new((i % 20) as f32 * 0.2 - 2.0, 0.5, (i / 20) as f32 * -0.2);
    let place = |i| Affine3A::from_translation(at(i)) * Affine3A::from_scale(Vec3::splat(0.05));
    let caster = |i| Caster::new(make(device, &shape(i % 24)), place(i));
    (0..count).map(caster).collect()
}

/// A renderer without a driver, and what a frame of it comes to.
struct Counting {
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: ShadowVolumeRenderer,
}

impl Counting {
    fn new() -> Self {
        let (device, queue) = bare();
        let descriptor = ShadowVolumeDescriptor {
            silhouettes: Silhouettes::Compute,
            ..Default::default()
        };
        Self {
            renderer: ShadowVolumeRenderer::new(&device, &descriptor).unwrap(),
            device,
            queue,
        }
    }

    fn frame(&mut self, casters: &[Caster]) -> VolumeStatistics {
        let view = mixed(lamp()).view();
        let frame = OneLight::new(&view, LIGHT, casters);
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        self.renderer
            .prepare_one(&self.device, &self.queue, &frame)
            .unwrap();
        let mut encoder = self.device.create_command_encoder(&Default::default());
        self.renderer.encode(&mut encoder);
        self.queue.submit([encoder.finish()]);
        let error = pollster::block_on(scope.pop());
        assert!(error.is_none(), "{error:?}");
        self.renderer.statistics()
    }
}

#[test]
fn any_number_of_meshes_takes_three_dispatches() {
    let mut counting = Counting::new();
    for count in [1, 10, 300] {
        let casters = row(&counting.device, count, mesh);
        let found = counting.frame(&casters);
        assert_eq!(
            (found.casters_extracted, found.dispatches),
            (count as u32, 3)
        );
    }
    // Each buffer of the host's is bound by itself where positions are read.
    let mut casters = row(&counting.device, 20, mesh);
    casters.extend(row(&counting.device, 5, host_mesh));
    assert_eq!(counting.frame(&casters).dispatches, 3 + 5);
}

#[test]
fn a_mesh_is_uploaded_once_and_its_room_used_again() {
    let mut counting = Counting::new();
    let [mut first, second] = [0; 2].map(|_| row(&counting.device, 24, mesh));
    let of_meshes = counting.frame(&first).uploaded;
    let move_all = |casters: &mut [Caster]| {
        for caster in casters {
            caster.world_from_object.translation.y += 0.25;
        }
    };
    move_all(&mut first);
    let moved = counting.frame(&first);
    assert_eq!(moved.casters_extracted, 24);
    // The meshes are 24 of up to 200 triangles.
    assert!(
        of_meshes > moved.uploaded + 24_000,
        "{moved:?}, {of_meshes}"
    );
    // A caster that is gone for a frame takes its mesh with it.
    counting.frame(&second);
    let here = counting.frame(&second[..12]).gpu_bytes;
    for _ in 0..20 {
        let others = row(&counting.device, 12, mesh);
        counting.frame(&others);
    }
    assert_eq!(counting.renderer.statistics().gpu_bytes, here);
    // Twenty such rows at once would not fit.
    let all = row(&counting.device, 240, mesh);
    assert!(counting.frame(&all).gpu_bytes > here);
}
