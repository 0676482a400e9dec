//! Casters, lights and views of any numbers.

use arbitrary::{Arbitrary, Result, Unstructured};
use shadows::glam::{Affine3A, Mat3A, Mat4, Vec3, Vec3A, camera::rh};
use shadows::mesh::Bounds;
use shadows::{
    Caster, CasterMesh, DepthConvention, DirectionalLight, HomogeneousLight, HostPositions,
    PointLight, SpotLight, View, wgpu,
};
use wgpu::util::DeviceExt as _;

use crate::gpu::device;
use crate::mesh::Mesh;
use crate::{Length, Number, list, vector};

/// A transform: the identity, a placement, or any twelve numbers.
#[derive(Arbitrary, Clone, Debug)]
pub enum Transform {
    Identity,
    Placed([Number; 3]),
    Scaled([Number; 3], [Number; 3]),
    Any([[Number; 3]; 4]),
}

impl Transform {
    pub fn affine(&self) -> Affine3A {
        match *self {
            Self::Identity => Affine3A::IDENTITY,
            Self::Placed(at) => Affine3A::from_translation(vector(at)),
            Self::Scaled(scale, at) => Affine3A {
                matrix3: Mat3A::from_diagonal(vector(scale)),
                translation: vector(at).into(),
            },
            Self::Any([x, y, z, at]) => Affine3A {
                matrix3: Mat3A::from_cols(vector(x).into(), vector(y).into(), vector(z).into()),
                translation: vector(at).into(),
            },
        }
    }
}

/// Bounds: mostly a box, else any two corners.
#[derive(Clone, Copy, Debug)]
pub struct Corners(pub Bounds);

impl<'a> Arbitrary<'a> for Corners {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let [min, max] = <[[Number; 3]; 2]>::arbitrary(u)?.map(vector);
        Ok(Self(match u.ratio(1, 16)? {
            true => Bounds { min, max },
            false => Bounds {
                min: min.min(max),
                max: min.max(max),
            },
        }))
    }
}

impl Corners {
    /// Whether they are a box, as receivers must be.
    pub fn are_box(&self) -> bool {
        let Bounds { min, max } = self.0;
        min.is_finite() && max.is_finite() && min.cmple(max).all()
    }
}

/// Where a mesh's positions are.
#[derive(Clone, Copy, Debug)]
pub enum Positions {
    Uploaded,
    /// In the host's buffer; the host says what encloses them, if not what does.
    Host(Option<Corners>),
}

impl<'a> Arbitrary<'a> for Positions {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(match u.ratio(1, 8)? {
            true => Self::Host(u.arbitrary()?),
            false => Self::Uploaded,
        })
    }
}

/// Meshes, and which of them stands where.
#[derive(Clone, Debug)]
pub struct Casters {
    meshes: Vec<(Mesh, Positions)>,
    placed: Vec<(u8, Transform)>,
}

impl<'a> Arbitrary<'a> for Casters {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(Self {
            meshes: list(u, 0, 3)?,
            placed: list(u, 0, 8)?,
        })
    }
}

/// A few scenes, and the frames that show them.
#[derive(Clone, Debug)]
pub struct Story<Frame> {
    pub scenes: Vec<Casters>,
    pub frames: Vec<Frame>,
}

impl<'a, Frame: Arbitrary<'a>> Arbitrary<'a> for Story<Frame> {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(Self {
            scenes: list(u, 0, 3)?,
            frames: list(u, 1, 6)?,
        })
    }
}

impl<Frame> Story<Frame> {
    /// The casters of each scene.
    pub fn upload(&self) -> Vec<Vec<Caster>> {
        self.scenes.iter().map(Casters::upload).collect()
    }
}

/// What casts in a frame: a scene, of which a part may have moved since the frame before.
#[derive(Arbitrary, Clone, Debug)]
pub struct Cast {
    scene: u8,
    /// One of its casters, and by how much it is moved.
    moved: Option<(u8, [Number; 3])>,
    /// Whether the first of its meshes was deformed in the host's buffer.
    deformed: bool,
}

impl Cast {
    /// The scene counted round and round; no casters where there is no scene.
    pub fn of(&self, scenes: &[Vec<Caster>]) -> Vec<Caster> {
        let mut casters = match scenes.len() {
            0 => Vec::new(),
            count => scenes[usize::from(self.scene) % count].clone(),
        };
        let count = casters.len().max(1);
        if let Some((place, by)) = self.moved
            && let Some(caster) = casters.get_mut(usize::from(place) % count)
        {
            caster.world_from_object.translation += Vec3A::from(vector(by));
        }
        if let (true, Some(first)) = (self.deformed, casters.first()) {
            first.mesh.bump_revision();
        }
        casters
    }
}

impl Casters {
    /// Those whose meshes the library takes.
    pub fn upload(&self) -> Vec<Caster> {
        let meshes: Vec<CasterMesh> = self.meshes.iter().filter_map(upload).collect();
        if meshes.is_empty() {
            return Vec::new();
        }
        let place = |(mesh, transform): &(u8, Transform)| {
            let mesh = meshes[usize::from(*mesh) % meshes.len()].clone();
            Caster::new(mesh, transform.affine())
        };
        self.placed.iter().map(place).collect()
    }
}

fn upload((mesh, place): &(Mesh, Positions)) -> Option<CasterMesh> {
    let (device, _) = device();
    let adjacency = mesh.adjacency().ok()?;
    let positions = mesh.positions();
    let Positions::Host(bounds) = place else {
        // The adjacency's own checks are stricter than what a mesh on the GPU needs.
        return Some(CasterMesh::new(device, &positions, &adjacency).expect("a sound mesh"));
    };
    let bounds = match bounds {
        Some(corners) => corners.0,
        None => Bounds::of_points(positions.iter().map(|&position| position.into()))?,
    };
    let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: &positions
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_ne_bytes())
            .collect::<Vec<_>>(),
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE,
    });
    let host = HostPositions {
        buffer: &buffer,
        stride: 12,
        offset: 0,
        bounds,
    };
    let made = CasterMesh::from_host_positions(device, &host, &adjacency).ok()?;
    assert!(Corners(bounds).are_box(), "{bounds:?} was taken for a box");
    Some(made)
}

/// A view: a camera somewhere, or any sixteen numbers.
#[derive(Arbitrary, Clone, Debug)]
pub enum Camera {
    At {
        eye: [Number; 3],
        toward: [Number; 3],
        near: Length,
    },
    From {
        eye: [Number; 3],
        toward: [Number; 3],
        near: Length,
    },
    Any([[Number; 4]; 4]),
}

/// One of the depth conventions.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Projection {
    InfiniteReverse,
    FiniteReverse,
    Standard,
}

impl Projection {
    pub fn convention(self) -> DepthConvention {
        match self {
            Self::InfiniteReverse => DepthConvention::InfiniteReverse,
            Self::FiniteReverse => DepthConvention::FiniteReverse,
            Self::Standard => DepthConvention::Standard,
        }
    }

    fn matrix(self, near: f32) -> Mat4 {
        use rh::proj::directx as proj;
        match self {
            Self::InfiniteReverse => proj::perspective_infinite_reverse(0.8, 1.5, near),
            Self::FiniteReverse => proj::perspective(0.8, 1.5, 1e3, near),
            Self::Standard => proj::perspective(0.8, 1.5, near, 1e3),
        }
    }
}

impl Camera {
    pub fn matrix(&self, projection: Projection) -> Mat4 {
        match *self {
            Self::At { eye, toward, near } | Self::From { eye, toward, near } => {
                // Not along an axis, unless it is asked for.
                let forward = vector(toward) + Vec3::new(0.01, -0.02, -0.03);
                let look = rh::view::look_to_mat4(vector(eye), forward.normalize(), Vec3::Y);
                projection.matrix(near.0 / 16.0) * look
            }
            Self::Any(columns) => {
                Mat4::from_cols_array_2d(&columns.map(|column| column.map(|number| number.0)))
            }
        }
    }

    /// The view, if the library takes it; then all that is known of it is finite.
    pub fn view(&self, projection: Projection) -> Option<View> {
        let view = View::new(self.matrix(projection), projection.convention()).ok()?;
        assert!(view.eye().is_finite());
        assert!(view.near_corners().iter().all(|corner| corner.is_finite()));
        Some(view)
    }
}

/// A light of any kind.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub struct Light {
    pub at: [Number; 3],
    pub direction: [Number; 3],
    pub w: Weight,
    pub near: Option<Length>,
    pub range: Length,
    pub half_angle: Length,
}

/// The last of a light's homogeneous coordinates.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Weight {
    Point,
    Directional,
    PointAgain,
    Any(Number),
}

impl Light {
    fn near(&self) -> Option<f32> {
        self.near.map(|near| near.0 / 256.0)
    }

    pub fn point(&self) -> PointLight {
        PointLight {
            near: self.near(),
            ..PointLight::new(vector(self.at), self.range.0)
        }
    }

    pub fn spot(&self) -> SpotLight {
        SpotLight {
            position: vector(self.at),
            direction: vector(self.direction),
            half_angle: self.half_angle.0 / 24.0,
            range: self.range.0,
            near: self.near(),
        }
    }

    pub fn directional(&self) -> DirectionalLight {
        DirectionalLight::new(vector(self.direction))
    }

    pub fn homogeneous(&self) -> HomogeneousLight {
        let at = vector(self.at);
        match self.w {
            Weight::Point | Weight::PointAgain => HomogeneousLight::point(at),
            Weight::Directional => HomogeneousLight::directional(at),
            Weight::Any(number) => {
                let light = HomogeneousLight::try_from(at.extend(number.0));
                light.unwrap_or(HomogeneousLight::point(at))
            }
        }
    }
}
