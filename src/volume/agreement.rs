//! The three ways to find silhouettes give the same volume, edge for edge.

#[allow(dead_code)]
#[path = "../../tests/common/unit/gpu.rs"]
mod gpu;
#[allow(dead_code)]
#[path = "../../tests/common/unit/shapes.rs"]
mod shapes;

use glam::camera::rh::{proj::directx as proj, view};
use glam::{Affine3A, Quat, Vec3};
use wgpu::util::DeviceExt as _;

use super::*;
use crate::mesh::{Adjacency, EdgeRecord, MeshKind, edge_records};
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::gpu::draw_pipelines::Feed;
use crate::volume::plan::cache::Slot;
use crate::volume::plan::params::{Arguments, CasterParams};
use crate::volume::silhouette::Way;
use crate::{Caster, DepthConvention, HomogeneousLight, Silhouettes, StartFrom, View};
use gpu::Gpu;
use shapes::Shape;

/// One instance's volume, in an order of its own.
#[derive(Debug, PartialEq)]
struct Volume {
    front: Vec<[u32; 3]>,
    back: Vec<[u32; 3]>,
    sides: Vec<u32>,
}

fn prepare(renderer: &mut ShadowVolumeRenderer, gpu: &Gpu, light: Vec3, casters: &[Caster]) {
    let frame = ShadowVolumeFrame {
        lights: &[HomogeneousLight::point(light).into()],
        views: &[camera().into()],
        casters,
        ..Default::default()
    };
    renderer.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
}

fn camera() -> View {
    let camera = view::look_at_mat4(Vec3::new(1.0, 5.0, 9.0), Vec3::ZERO, Vec3::Y);
    let projection = proj::perspective_infinite_reverse(0.9, 1.0, 0.1);
    View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap()
}

fn casters(gpu: &Gpu) -> Vec<Caster> {
    let place = Affine3A::from_rotation_translation(
        Quat::from_rotation_x(0.3) * Quat::from_rotation_y(0.8),
        Vec3::new(0.3, 1.0, -0.2),
    );
    let caster = |shape: Shape| {
        let adjacency = Adjacency::new(&shape.positions, &shape.indices).unwrap();
        let mesh = crate::CasterMesh::new(&gpu.device, &shape.positions, &adjacency).unwrap();
        Caster::new(mesh, place)
    };
    vec![
        caster(shapes::sphere(24)),
        caster(shapes::sphere(9).turned(|triangle| triangle % 3 == 0)),
        caster(shapes::fins(3)),
        caster(shapes::fins(4).with(&shapes::cube())),
    ]
}

fn renderer(gpu: &Gpu, silhouettes: Silhouettes, start_from: StartFrom) -> ShadowVolumeRenderer {
    let descriptor = ShadowVolumeDescriptor {
        silhouettes,
        start_from,
        ..Default::default()
    };
    ShadowVolumeRenderer::new(&gpu.device, &descriptor).unwrap()
}

/// Each caster's volume, and what its draws read, in the casters' order.
fn slots(renderer: &ShadowVolumeRenderer) -> impl Iterator<Item = (&Slot, &CasterParams)> {
    let mut windows: Vec<u32> = renderer.volumes.pair(0, 0).unwrap().windows().collect();
    windows.sort_unstable();
    windows.into_iter().map(|number| {
        let window = renderer.volumes.windows.get(number).unwrap();
        (renderer.cache.get(window.slot).unwrap(), &window.params)
    })
}

/// What lies in the buffers after an extraction.
fn extracted(
    gpu: &Gpu,
    (way, start_from): (Silhouettes, StartFrom),
    light: Vec3,
    casters: &[Caster],
) -> Vec<Volume> {
    let mut renderer = renderer(gpu, way, start_from);
    prepare(&mut renderer, gpu, light, casters);
    gpu.run(|encoder| renderer.encode(encoder));
    let words = |buffer| bytemuck::pod_collect_to_vec::<u8, u32>(&gpu.read_buffer(buffer));
    let bound = renderer.buffers.bound();
    let arguments = bound.map(|bound| {
        bytemuck::pod_collect_to_vec::<u8, Arguments>(&gpu.read_buffer(bound.arguments))
    });
    let volume = |(slot, _): (&Slot, &CasterParams)| {
        let [_, caps, sides] = renderer.buffers.chunk(slot.place.chunk).unwrap();
        let (caps, sides) = (words(caps), words(sides));
        let cap_base = slot.place.cap;
        let (front, back, count) = match slot.way {
            Way::Cpu => {
                let middle = cap_base + slot.counts.front;
                let end = middle + slot.counts.back;
                (cap_base..middle, middle..end, slot.counts.sides)
            }
            _ => {
                let own = &arguments.as_ref().unwrap()[slot.instance.arguments as usize];
                let [front, back] = [own.front, own.back].map(|a| a[2]..a[2] + a[0]);
                (front, back, own.sides)
            }
        };
        let list = |range: std::ops::Range<u32>| {
            let (corners, _) = caps[range.start as usize..range.end as usize].as_chunks::<3>();
            let mut corners = corners.to_vec();
            corners.sort_unstable();
            corners
        };
        let first = slot.place.side as usize;
        let mut sides = sides[first..first + count as usize].to_vec();
        sides.sort_unstable();
        Volume {
            front: list(front),
            back: list(back),
            sides,
        }
    };
    slots(&renderer).map(volume).collect()
}

const COUNT: &str = "
@group(0) @binding(3) var<storage, read> records: array<array<u32, 19>>;
@group(0) @binding(4) var<storage, read_write> counts: array<i32>;
fn corner(record: u32, n: u32) -> vec3f {
    return vec3f(
        bitcast<f32>(records[record][3u * n]),
        bitcast<f32>(records[record][3u * n + 1u]),
        bitcast<f32>(records[record][3u * n + 2u]),
    );
}
@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i < arrayLength(&counts) {
        counts[i] = side_count(Edge(
            corner(i, 0u), corner(i, 1u), corner(i, 2u), corner(i, 3u), corner(i, 4u),
            corner(i, 5u), records[i][18],
        ));
    }
}
";

/// The sides that the vertex shader's own functions find, those of one edge added up.
fn found_by_vertices(
    gpu: &Gpu,
    start_from: StartFrom,
    light: Vec3,
    casters: &[Caster],
) -> Vec<Vec<u32>> {
    let mut renderer = renderer(gpu, Silhouettes::Vertex, start_from);
    prepare(&mut renderer, gpu, light, casters);
    slots(&renderer)
        .map(|(slot, params)| {
            let data = slot.mesh.data().unwrap();
            let records = edge_records(data, slot.mesh.kind());
            let counts = counted(gpu, bytemuck::bytes_of(params), &records);
            let mut counts = counts.into_iter();
            let mut sides = Vec::new();
            for (edge, record) in (0u32..).zip(&data.edges) {
                let pairs = match slot.mesh.kind() {
                    MeshKind::Closed => 1,
                    MeshKind::General => record[3].div_ceil(2),
                };
                let sum: i32 = counts.by_ref().take(pairs as usize).sum();
                let side = edge << 1 | u32::from(sum < 0);
                sides.extend((0..sum.unsigned_abs()).map(|_| side));
            }
            assert_eq!(counts.next(), None);
            sides
        })
        .collect()
}

fn counted(gpu: &Gpu, params: &[u8], records: &[EdgeRecord]) -> Vec<i32> {
    let device = &gpu.device;
    let buffer = |contents, usage| {
        let label = None;
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label,
            contents,
            usage,
        })
    };
    let zeros = vec![0u8; 4 * records.len()];
    let storage = wgpu::BufferUsages::STORAGE;
    let buffers = [
        buffer(params, wgpu::BufferUsages::UNIFORM),
        buffer(bytemuck::cast_slice(records), storage),
        buffer(&zeros, storage | wgpu::BufferUsages::COPY_SRC),
    ];
    let source = Feed::Records.source(DepthConvention::InfiniteReverse, NearPlane::Clipped) + COUNT;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("count"),
        compilation_options: Default::default(),
        cache: None,
    });
    let entries: Vec<_> = (2..)
        .zip(&buffers)
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    gpu.run(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups((records.len() as u32).div_ceil(64), 1, 1);
    });
    bytemuck::pod_collect_to_vec(&gpu.read_buffer(&buffers[2]))
}

/// Far, near, in the plane of faces, inside.
const LIGHTS: [[f32; 3]; 4] = [
    [-2.0, 6.0, 2.5],
    [0.3, 2.3, 0.1],
    [0.3, 1.0, 40.0],
    [0.35, 1.05, -0.15],
];

/// Starts from the light and from the far side.
const STARTS: [StartFrom; 2] = [StartFrom::LightFacing, StartFrom::AwayFacing];

fn sides(volumes: &[Volume]) -> Vec<Vec<u32>> {
    volumes.iter().map(|volume| volume.sides.clone()).collect()
}

#[test]
fn the_three_ways_find_the_same_sides_and_caps() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    for light in LIGHTS.map(Vec3::from) {
        for start in STARTS {
            let cpu = extracted(&gpu, (Silhouettes::Cpu, start), light, &casters);
            assert_eq!(cpu.len(), casters.len());
            let inside = light.x == 0.35;
            let capped = |v: &Volume| !(v.front.is_empty() && v.back.is_empty());
            assert!(
                cpu.iter()
                    .all(|v| capped(v) && !v.sides.is_empty() || inside)
            );
            assert!(cpu == extracted(&gpu, (Silhouettes::Compute, start), light, &casters));
            assert!(sides(&cpu) == found_by_vertices(&gpu, start, light, &casters));
        }
    }
}

#[test]
fn a_closed_mesh_starts_from_one_side_or_the_other() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    let light = Vec3::from(LIGHTS[0]);
    let [facing, away] =
        STARTS.map(|start| extracted(&gpu, (Silhouettes::Cpu, start), light, &casters));
    // The first is closed: the same silhouette, and caps that are all of it together.
    assert_eq!(facing[0].sides, away[0].sides);
    assert!(facing[0].back.is_empty() && away[0].front.is_empty());
    let caps = facing[0].front.len() + away[0].back.len();
    assert_eq!(caps as u32, casters[0].mesh.triangle_count());
    // The others are not, and know no far side.
    assert_eq!(facing[1..], away[1..]);
}

#[test]
fn another_light_has_another_volume() {
    let Some(gpu) = Gpu::for_test() else { return };
    let casters = casters(&gpu);
    let [here, there] = [Vec3::from(LIGHTS[0]), Vec3::from(LIGHTS[1])];
    for start in STARTS {
        let cpu = extracted(&gpu, (Silhouettes::Cpu, start), here, &casters);
        assert!(cpu != extracted(&gpu, (Silhouettes::Compute, start), there, &casters));
        assert!(sides(&cpu) != found_by_vertices(&gpu, start, there, &casters));
    }
}
