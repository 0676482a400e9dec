//! Meshes at many places that lie in a buffer of the host.

use crate::atlas::{assert_few, atlas, descriptor, draw, wrong_texels};
use crate::common::shapes::{Random, sphere};
use glam::{Affine3A, Mat4, Quat, Vec3};
use host::gpu::Gpu;
use shadows::error::CasterMeshError;
use shadows::mesh::Bounds;
use shadows::{
    AtlasFrame, AtlasLight, Caster, CasterMesh, DirectionalLight, HostInstances, InstanceLayout,
    PointLight, SpotLight, TileSize, glam, wgpu,
};
use wgpu::util::DeviceExt as _;

const PLACES: usize = 40;

fn transforms(seed: u64) -> Vec<Mat4> {
    let mut random = Random::new(seed);
    let place = |_| {
        let scale = Vec3::new(0.3, 0.2 + 0.1 * random.next(), 0.3) * random.next().signum();
        let turn = Quat::from_rotation_z(random.next());
        Mat4::from_scale_rotation_translation(scale, turn, 4.0 * random.vec3())
    };
    (0..PLACES).map(place).collect()
}

/// The bytes that lie in the host's buffer: something else, then the transforms.
fn bytes(transforms: &[Mat4], layout: InstanceLayout, stride: usize, offset: usize) -> Vec<u8> {
    let mut bytes = vec![0xff; offset];
    for transform in transforms {
        let floats = match layout {
            InstanceLayout::Rows3x4 => transform.transpose().to_cols_array()[..12].to_vec(),
            _ => transform.to_cols_array().to_vec(),
        };
        let start = bytes.len();
        bytes.extend_from_slice(bytemuck::cast_slice(&floats));
        bytes.resize(start + stride, 0xff);
    }
    bytes
}

fn buffer(gpu: &Gpu, contents: &[u8]) -> wgpu::Buffer {
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        })
}

fn at_places(mesh: &CasterMesh, transforms: &[Mat4], whole: Affine3A) -> Vec<Caster> {
    let caster =
        |transform: &Mat4| Caster::new(mesh.clone(), whole * Affine3A::from_mat4(*transform));
    transforms.iter().map(caster).collect()
}

#[test]
fn one_caster_at_many_places_is_as_many_casters() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = sphere(7, 9).mesh(&gpu.device);
    let whole = Affine3A::from_rotation_y(0.4);
    let spot = SpotLight::new(Vec3::new(0.0, 6.0, 1.0), Vec3::NEG_Y, 0.7, 12.0);
    let lights = [
        AtlasLight::new(PointLight::new(Vec3::new(0.2, 0.1, 0.3), 7.0)),
        AtlasLight::new(spot),
        AtlasLight::directional(DirectionalLight::new(Vec3::Y + 0.3), Default::default()),
    ]
    .map(|light| light.with_size(TileSize::Fixed(128)));
    for (layout, stride, offset) in [
        (InstanceLayout::Columns4x4, 64, 0),
        (InstanceLayout::Columns4x4, 80, 16),
        (InstanceLayout::Rows3x4, 48, 4),
    ] {
        let before = transforms(1);
        let buffer = buffer(&gpu, &bytes(&before, layout, stride, offset));
        let instances = HostInstances {
            buffer: &buffer,
            layout,
            stride: stride as u64,
            offset: offset as u64,
            count: PLACES as u32,
            bounds: Bounds {
                min: Vec3::splat(-4.5),
                max: Vec3::splat(4.5),
            },
        };
        let many = mesh.at_places(&instances).unwrap();
        let casters = [Caster::new(many.clone(), whole)];
        let mut atlas = atlas(&gpu, &descriptor(2));
        let frame = AtlasFrame {
            lights: &lights[..2],
            casters: &casters,
            ..Default::default()
        };
        draw(&gpu, &mut atlas, &frame);
        let statistics = atlas.statistics();
        assert_eq!(statistics.draws, 7, "one a tile");
        assert_eq!(statistics.triangles, 7 * u64::from(many.triangle_count()));
        let apart = at_places(&mesh, &before, whole);
        assert_few(wrong_texels(&gpu, &atlas, &lights[..2], &apart), "at first");

        // The host moves them, and says so.
        let after = transforms(2);
        gpu.queue
            .write_buffer(&buffer, 0, &bytes(&after, layout, stride, offset));
        draw(&gpu, &mut atlas, &frame);
        assert_eq!(atlas.statistics().tiles_rendered, 0, "nobody said so");
        let apart = at_places(&mesh, &after, whole);
        // The broken twin.
        assert!(wrong_texels(&gpu, &atlas, &lights[..2], &apart).0 > 1000);
        many.bump_revision();
        draw(&gpu, &mut atlas, &frame);
        assert_few(wrong_texels(&gpu, &atlas, &lights[..2], &apart), "moved");
    }
}

#[test]
fn places_that_do_not_fit_are_refused() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mesh = sphere(3, 4).mesh(&gpu.device);
    let bytes = bytes(&transforms(1), InstanceLayout::Columns4x4, 64, 0);
    let right = buffer(&gpu, &bytes);
    let instances = HostInstances {
        buffer: &right,
        layout: InstanceLayout::Columns4x4,
        stride: 64,
        offset: 0,
        count: PLACES as u32,
        bounds: Bounds {
            min: Vec3::NEG_ONE,
            max: Vec3::ONE,
        },
    };
    let many = mesh.at_places(&instances).unwrap();
    let refused = |instances: &HostInstances<'_>| mesh.at_places(instances).unwrap_err();
    assert_eq!(
        many.at_places(&instances).unwrap_err(),
        CasterMeshError::NotPlain
    );
    let (stride, least) = (60, 64);
    assert_eq!(
        refused(&HostInstances {
            stride,
            ..instances.clone()
        }),
        CasterMeshError::InstanceLayout {
            stride,
            offset: 0,
            least
        }
    );
    let count = PLACES as u32 + 1;
    let size = right.size();
    assert_eq!(
        refused(&HostInstances {
            count,
            ..instances.clone()
        }),
        CasterMeshError::InstanceBufferTooSmall {
            size,
            needed: size + 64,
            count
        }
    );
    let wrong = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    assert_eq!(
        refused(&HostInstances {
            buffer: &wrong,
            ..instances.clone()
        }),
        CasterMeshError::InstanceBufferUsage
    );
    let bounds = Bounds {
        min: Vec3::ONE,
        max: Vec3::NEG_ONE,
    };
    assert!(matches!(
        refused(&HostInstances {
            bounds,
            ..instances
        }),
        CasterMeshError::Bounds { .. }
    ));
}
