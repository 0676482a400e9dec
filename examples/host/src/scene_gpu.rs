//! A scene on the GPU: what the host draws and what casts shadows.

use anyhow::{Context as _, Result, ensure};
use shadows::glam::{Mat3, Mat4, Vec3};
use shadows::mesh::{Adjacency, MeshKind};
use shadows::wgpu::{self, util::DeviceExt as _};
use shadows::{Caster, CasterMesh, HostDraw};

use super::gpu::Gpu;
use super::masked_casters::MaskedCasters;
use super::scene::{Bounds, Light, Mesh, Object, Scene};

/// A mesh as the host draws it.
pub struct MeshGpu {
    pub positions: wgpu::Buffer,
    pub normals: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub index_count: u32,
    /// Each vertex's place in the leaf mask, if it has one.
    pub mask: Option<wgpu::Buffer>,
    pub kind: MeshKind,
    caster: CasterMesh,
}

/// Buffers of a scene's meshes, the objects' uniforms and the casters.
pub struct SceneGpu {
    pub meshes: Vec<MeshGpu>,
    pub objects: Vec<Drawn>,
    /// One [`ObjectUniform`] every [`Self::object_stride`] bytes.
    pub object_uniforms: wgpu::Buffer,
    pub object_stride: u32,
    /// What the library draws: all that casts but what has a mask.
    pub casters: Vec<Caster>,
    /// The objects that cast, for a host that draws them itself.
    pub casting: Vec<Casting>,
    /// What draws those that have a mask into the library's maps.
    pub masked: Option<MaskedCasters>,
}

/// An object as it is drawn.
pub struct Drawn {
    /// Place of its mesh.
    pub mesh: usize,
    /// Of a ball around it, world space.
    centre: Vec3,
    radius: f32,
}

/// An object that casts.
pub struct Casting {
    /// Its place among the objects.
    pub place: usize,
    /// Whether its transform turns windings around.
    pub mirrored: bool,
}

/// `HostObject` in host.wgsl.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ObjectUniform {
    world_from_object: [[f32; 4]; 4],
    normal_from_object: [[f32; 4]; 3],
    albedo: [f32; 4],
    glow: [f32; 4],
}

impl SceneGpu {
    /// Uploads a scene.
    ///
    /// # Errors
    /// One line naming the mesh or object that does not fit the device.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self> {
        let meshes: Vec<MeshGpu> = scene
            .meshes
            .iter()
            .map(|mesh| MeshGpu::new(gpu, mesh).with_context(|| format!("mesh {:?}", mesh.name)))
            .collect::<Result<_>>()?;
        let casters = scene
            .objects
            .iter()
            .filter(|object| object.casts && meshes[object.mesh].mask.is_none())
            .map(|object| Caster::new(meshes[object.mesh].caster.clone(), object.transform))
            .collect();
        let casting = (0..).zip(&scene.objects).filter(|(_, object)| object.casts);
        let casting = casting.map(|(place, object)| Casting {
            place,
            mirrored: object.transform.matrix3.determinant() < 0.0,
        });
        let casting = casting.collect();
        let (object_uniforms, object_stride) = upload_objects(gpu, &scene.objects)?;
        let masked = MaskedCasters::new(gpu, scene, &object_uniforms)?;
        Ok(Self {
            meshes,
            objects: scene
                .objects
                .iter()
                .map(|object| Drawn::new(scene, object))
                .collect(),
            object_uniforms,
            object_stride,
            casters,
            casting,
            masked,
        })
    }
}

impl SceneGpu {
    /// Whether any mesh has a mask.
    pub fn has_masks(&self) -> bool {
        self.meshes.iter().any(|mesh| mesh.mask.is_some())
    }

    /// Draws those casters that have a mask into a tile's pass, as far as they are asked for; among the frame's
    /// casters they begin at the place `first`.
    pub fn draw_masked(&self, first: usize, pass: &mut wgpu::RenderPass<'_>, asked: &HostDraw<'_>) {
        if let Some(masked) = &self.masked {
            masked.draw(self, first, pass, asked);
        }
    }
}

impl Drawn {
    fn new(scene: &Scene, object: &Object) -> Self {
        let bounds = Bounds::of(scene.world_points(object));
        Self {
            mesh: object.mesh,
            centre: bounds.centre().as_vec3(),
            // A little more, for what rounding takes.
            radius: 0.5001 * bounds.size().length() as f32,
        }
    }

    /// Whether a light may reach it.
    pub fn is_reached(&self, light: &Light) -> bool {
        let reach = light.range + self.radius;
        light.place.w == 0.0 || self.centre.distance(light.place.truncate()) <= reach
    }
}

impl MeshGpu {
    fn new(gpu: &Gpu, mesh: &Mesh) -> Result<Self> {
        let adjacency = Adjacency::new(&mesh.positions, &mesh.indices)?;
        let buffer = |label, contents: &[u8], usage| {
            let limit = gpu.device.limits().max_buffer_size;
            ensure!(
                contents.len() as u64 <= limit,
                "its {label} take {} bytes, the device allows {limit}",
                contents.len()
            );
            Ok(gpu
                .device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: Some(label),
                    contents,
                    usage,
                }))
        };
        let vertex = wgpu::BufferUsages::VERTEX;
        Ok(Self {
            positions: buffer("positions", bytemuck::cast_slice(&mesh.positions), vertex)?,
            normals: buffer("normals", bytemuck::cast_slice(&mesh.normals), vertex)?,
            indices: buffer(
                "indices",
                bytemuck::cast_slice(&mesh.indices),
                wgpu::BufferUsages::INDEX,
            )?,
            index_count: mesh.indices.len() as u32,
            mask: match mesh.mask.as_slice() {
                [] => None,
                mask => Some(buffer("mask", bytemuck::cast_slice(mask), vertex)?),
            },
            kind: adjacency.kind(),
            caster: CasterMesh::new(&gpu.device, &mesh.positions, &adjacency)?,
        })
    }
}

fn upload_objects(gpu: &Gpu, objects: &[Object]) -> Result<(wgpu::Buffer, u32)> {
    let limits = gpu.device.limits();
    let stride = size_of::<ObjectUniform>()
        .next_multiple_of(limits.min_uniform_buffer_offset_alignment as usize);
    let bytes = stride * objects.len().max(1);
    let addressable = limits.max_buffer_size.min(u64::from(u32::MAX));
    ensure!(
        bytes as u64 <= addressable,
        "{} objects are too many for one uniform buffer of at most {addressable} bytes",
        objects.len()
    );
    let mut contents = vec![0; bytes];
    for (slot, object) in contents.chunks_exact_mut(stride).zip(objects) {
        slot[..size_of::<ObjectUniform>()].copy_from_slice(bytemuck::bytes_of(&uniform(object)));
    }
    let buffer = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("objects"),
            contents: &contents,
            usage: wgpu::BufferUsages::UNIFORM,
        });
    Ok((buffer, stride as u32))
}

fn uniform(object: &Object) -> ObjectUniform {
    let linear = Mat3::from(object.transform.matrix3);
    // The cofactors: the inverse transpose up to a factor, and finite for a flattened object too.
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let normal = [y.cross(z), z.cross(x), x.cross(y)];
    let [r, g, b] = object.albedo;
    let glow = Vec3::from(object.glow);
    ObjectUniform {
        world_from_object: Mat4::from(object.transform).to_cols_array_2d(),
        normal_from_object: normal.map(|column| column.extend(0.0).to_array()),
        albedo: [r, g, b, 1.0],
        // And whether it casts.
        glow: glow.extend(f32::from(u8::from(object.casts))).to_array(),
    }
}
