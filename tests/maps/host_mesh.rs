//! Casters in the host's own vertex and index buffers, for maps alone.

use crate::common::noop;
use crate::common::shapes::{Random, Shape, cuboid, sphere};
use crate::cubes::{draw, faces, fresh};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::CasterMeshError as Error;
use shadows::mesh::{Bounds, MeshKind};
use shadows::{
    Caster, CasterMesh, CasterSides, CubeShadowMapDescriptor, DirectionalLight, FlatLight,
    HostMesh, MapSettings, PointLight, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight,
    glam, wgpu,
};
use wgpu::util::DeviceExt as _;

const LIGHT: PointLight = PointLight {
    position: Vec3::new(0.1, -0.2, 0.3),
    range: 40.0,
    near: None,
};

const BOUNDS: Bounds = Bounds {
    min: Vec3::splat(-2.0),
    max: Vec3::splat(2.0),
};

/// A host's buffers, with other things before, between and after what a caster has of them.
struct Buffers {
    vertices: wgpu::Buffer,
    stride: u64,
    offset: u64,
    indices: wgpu::Buffer,
    index_format: wgpu::IndexFormat,
    index_offset: u64,
    index_count: u32,
}

/// How they are laid out: bytes of a vertex and before the first, bytes of an index, indices before the
/// first.
#[derive(Clone, Copy, Debug)]
struct Layout {
    stride: usize,
    offset: usize,
    index_size: usize,
    index_skip: usize,
}

const LAYOUTS: [Layout; 4] = [
    Layout {
        stride: 12,
        offset: 0,
        index_size: 4,
        index_skip: 0,
    },
    Layout {
        stride: 32,
        offset: 20,
        index_size: 2,
        index_skip: 3,
    },
    Layout {
        stride: 16,
        offset: 4,
        index_size: 4,
        index_skip: 5,
    },
    Layout {
        stride: 2048,
        offset: 8,
        index_size: 2,
        index_skip: 1,
    },
];

impl Buffers {
    fn new(device: &wgpu::Device, shape: &Shape, layout: Layout) -> Self {
        let Layout {
            stride,
            offset,
            index_size,
            index_skip,
        } = layout;
        let count = shape.positions.len();
        // What is not a position is no number at all.
        let mut vertices = vec![0xff_u8; offset + (count + 1) * stride];
        for (i, position) in shape.positions.iter().enumerate() {
            let at = offset + i * stride;
            vertices[at..at + 12].copy_from_slice(bytemuck::cast_slice(position));
        }
        // What is not the mesh's are triangles all over it.
        let others = (0..index_skip as u32).map(|i| i % count as u32);
        let own = shape.indices.iter().copied();
        let mut indices: Vec<u8> = others
            .chain(own)
            .flat_map(|index| index.to_le_bytes()[..index_size].to_vec())
            .collect();
        indices.resize(indices.len().next_multiple_of(4), 0);
        let init = |contents, usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents,
                usage,
            })
        };
        Self {
            // No usage but that of any vertex or index buffer.
            vertices: init(
                &vertices,
                wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            ),
            stride: stride as u64,
            offset: offset as u64,
            indices: init(&indices, wgpu::BufferUsages::INDEX),
            index_format: match index_size {
                2 => wgpu::IndexFormat::Uint16,
                _ => wgpu::IndexFormat::Uint32,
            },
            index_offset: (index_skip * index_size) as u64,
            index_count: shape.indices.len() as u32,
        }
    }

    fn host_mesh(&self) -> HostMesh<'_> {
        HostMesh {
            vertices: &self.vertices,
            stride: self.stride,
            offset: self.offset,
            indices: &self.indices,
            index_format: self.index_format,
            index_offset: self.index_offset,
            index_count: self.index_count,
            bounds: BOUNDS,
        }
    }
}

fn placed(mesh: &CasterMesh) -> Vec<Caster> {
    let mut random = Random::new(8);
    let place = |_| {
        let spin = (random.vec3() + 0.01).normalize();
        let at = Affine3A::from_translation(random.vec3().normalize() * 6.0);
        Caster::new(
            mesh.clone(),
            at * Affine3A::from_axis_angle(spin, 3.0 * random.next()),
        )
    };
    (0..24).map(place).collect()
}

fn cube_descriptor() -> CubeShadowMapDescriptor<'static> {
    CubeShadowMapDescriptor {
        size: 64,
        settings: MapSettings {
            sides: CasterSides::Both,
            ..Default::default()
        },
        ..Default::default()
    }
}

/// A flat map's texels.
fn flat(gpu: &Gpu, light: FlatLight, casters: &[Caster]) -> Vec<u8> {
    let descriptor = ShadowMapDescriptor {
        size: 128,
        settings: MapSettings {
            sides: CasterSides::Both,
            ..Default::default()
        },
        ..Default::default()
    };
    let mut map = ShadowMap::new(&gpu.device, &descriptor).unwrap();
    gpu.checked(|| {
        let frame = ShadowFrame::new(light, casters);
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        gpu.run(|encoder| map.encode(encoder));
    });
    gpu.read_texture(map.texture(), 0, wgpu::TextureAspect::All)
}

/// All texels of a point light, a spot and a directional light.
fn texels(gpu: &Gpu, casters: &[Caster]) -> Vec<Vec<u8>> {
    let mut all = faces(gpu, &fresh(gpu, &cube_descriptor(), LIGHT, casters));
    let spot = SpotLight::new(LIGHT.position, Vec3::X, 0.7, 40.0);
    all.push(flat(gpu, spot.into(), casters));
    let sun = DirectionalLight::new(Vec3::new(1.0, 2.0, 3.0));
    all.push(flat(gpu, sun.into(), casters));
    all
}

#[test]
fn maps_show_the_same_bits_whoever_has_the_buffers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let shape = sphere(7, 9);
    // Bounds decide where a directional light's map lies, so they are to be the same.
    let mut wide = shape.clone();
    wide.positions
        .extend([BOUNDS.min, BOUNDS.max].map(|corner| corner.to_array()));
    let truth = texels(&gpu, &placed(&wide.mesh(&gpu.device)));
    assert_eq!(truth.len(), 8);
    for layout in LAYOUTS {
        let buffers = Buffers::new(&gpu.device, &shape, layout);
        let of = |mesh: &HostMesh<'_>| {
            let mesh = CasterMesh::from_host(&gpu.device, mesh).unwrap();
            texels(&gpu, &placed(&mesh))
        };
        assert!(of(&buffers.host_mesh()) == truth, "{layout:?}");
        // The broken twins: a triangle less, and positions that begin a vertex later.
        let fewer = HostMesh {
            index_count: buffers.index_count - 3,
            ..buffers.host_mesh()
        };
        assert!(of(&fewer) != truth, "{layout:?}");
        let later = HostMesh {
            offset: buffers.offset + buffers.stride,
            ..buffers.host_mesh()
        };
        assert!(of(&later) != truth, "{layout:?}");
    }
}

#[test]
fn what_the_host_deforms_is_drawn_again_when_it_says_so() {
    let Some(gpu) = Gpu::for_test() else { return };
    let shape = cuboid(Vec3::splat(0.5));
    let buffers = Buffers::new(&gpu.device, &shape, LAYOUTS[0]);
    let mesh = CasterMesh::from_host(&gpu.device, &buffers.host_mesh()).unwrap();
    let casters = placed(&mesh);
    let mut map = fresh(&gpu, &cube_descriptor(), LIGHT, &casters);
    let before = faces(&gpu, &map);
    let moved: Vec<[f32; 3]> = shape.positions.iter().map(|p| p.map(|x| 2.0 * x)).collect();
    gpu.queue
        .write_buffer(&buffers.vertices, 0, bytemuck::cast_slice(&moved));
    draw(&gpu, &mut map, LIGHT, &casters);
    assert_eq!(map.statistics().faces_rendered, 0, "the map cannot know");
    mesh.bump_revision();
    draw(&gpu, &mut map, LIGHT, &casters);
    assert!(map.statistics().faces_rendered > 0);
    assert!(faces(&gpu, &map) != before);
}

#[test]
fn what_is_known_of_such_a_mesh() {
    let (device, _) = noop();
    let shape = cuboid(Vec3::splat(0.5));
    let buffers = Buffers::new(&device, &shape, LAYOUTS[1]);
    let mesh = CasterMesh::from_host(&device, &buffers.host_mesh()).unwrap();
    assert_eq!(mesh.triangle_count(), 12);
    assert_eq!(mesh.vertex_count(), 9, "as many as there is room for");
    assert_eq!(mesh.kind(), MeshKind::General);
    assert_eq!(mesh.bounds(), BOUNDS);
    let empty = HostMesh {
        index_count: 0,
        ..buffers.host_mesh()
    };
    let empty = CasterMesh::from_host(&device, &empty).unwrap();
    assert_eq!(empty.triangle_count(), 0);
}

#[test]
fn buffers_that_do_not_fit_are_refused() {
    let (device, _) = noop();
    let shape = cuboid(Vec3::splat(0.5));
    let buffers = Buffers::new(&device, &shape, LAYOUTS[1]);
    let good = buffers.host_mesh();
    let refused = |mesh: HostMesh<'_>| CasterMesh::from_host(&device, &mesh).unwrap_err();
    for (stride, offset) in [(30, 20), (8, 20), (32, 2)] {
        let mesh = HostMesh {
            stride,
            offset,
            ..good.clone()
        };
        assert_eq!(refused(mesh), Error::Layout { stride, offset });
    }
    let limit = u64::from(device.limits().max_vertex_buffer_array_stride);
    let stride = limit + 4;
    let wide = HostMesh {
        stride,
        ..good.clone()
    };
    assert_eq!(refused(wide), Error::Stride { stride, limit });
    for (index_offset, index_count) in [(3, 36), (6, 35)] {
        let mesh = HostMesh {
            index_offset,
            index_count,
            ..good.clone()
        };
        let expected = Error::IndexLayout {
            offset: index_offset,
            count: index_count,
            index_size: 2,
        };
        assert_eq!(refused(mesh), expected);
    }
    let size = buffers.indices.size();
    let long = HostMesh {
        index_count: 39,
        ..good.clone()
    };
    let expected = Error::IndexBufferTooSmall {
        size,
        needed: 6 + 78,
        count: 39,
    };
    assert_eq!(refused(long), expected);
    let offset = buffers.vertices.size();
    let empty = HostMesh {
        offset,
        ..good.clone()
    };
    let expected = Error::BufferTooSmall {
        size: offset,
        needed: offset + 12,
        vertices: 1,
    };
    assert_eq!(refused(empty), expected);
    let no_vertices = HostMesh {
        vertices: &buffers.indices,
        offset: 0,
        ..good.clone()
    };
    let missing = wgpu::BufferUsages::VERTEX;
    assert_eq!(refused(no_vertices), Error::BufferUsage { missing });
    let no_indices = HostMesh {
        indices: &buffers.vertices,
        ..good.clone()
    };
    assert_eq!(refused(no_indices), Error::IndexBufferUsage);
    let inside_out = HostMesh {
        bounds: Bounds {
            min: Vec3::ONE,
            max: Vec3::ZERO,
        },
        ..good.clone()
    };
    assert!(matches!(refused(inside_out), Error::Bounds { .. }));
    let no_number = HostMesh {
        bounds: Bounds {
            min: Vec3::splat(f32::NAN),
            max: Vec3::ZERO,
        },
        ..good.clone()
    };
    assert!(matches!(refused(no_number), Error::NotFinite { .. }));
    CasterMesh::from_host(&device, &good).unwrap();
}
