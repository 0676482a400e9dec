//! A tilted ground with boxes, each unwrapped for a light map, and points of it that a camera sees.

use glam::camera::rh::{proj::directx as proj, view as camera};
use glam::{Affine3A, DAffine3, DVec3, Quat, Vec3};
use shadows::reference::bake::{
    BakeDescriptor, BakedLight, LightMap, LightMapLayout, LightMapReceiver, TexelRectangle,
};
use shadows::reference::{ReferenceImage, ReferenceObject, ReferenceScene};
use shadows::{DepthConvention, PointLight, View, glam};

/// Columns and rows of the camera's picture.
pub const PICTURE: [u32; 2] = [160, 120];

/// A mesh whose faces are charts of their own.
#[derive(Clone, Debug, Default)]
pub struct Unwrapped {
    pub positions: Vec<[f32; 3]>,
    pub indices: Vec<u32>,
    pub uvs: Vec<[f32; 2]>,
}

impl Unwrapped {
    /// Faces of three or four corners in the cells of a grid, each `gap` of the map's `texels` away from its cell's edge.
    pub fn new(faces: &[Vec<Vec3>], texels: u32, gap: f32) -> Self {
        let side = (faces.len() as f32).sqrt().ceil();
        let inset = gap / texels as f32;
        let mut mesh = Self::default();
        for (place, face) in faces.iter().enumerate() {
            let [x, y] = [place % side as usize, place / side as usize].map(|at| at as f32 / side);
            let length = 1.0 / side - 2.0 * inset;
            let first = mesh.positions.len() as u32;
            for (corner, [u, v]) in
                face.iter()
                    .zip([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
            {
                mesh.positions.push(corner.to_array());
                let uv = [x + inset + length * u, y + inset + length * v];
                mesh.uvs.push(uv.map(|part: f32| part.clamp(0.0, 1.0)));
            }
            for k in 2..face.len() as u32 {
                mesh.indices.extend([first, first + k - 1, first + k]);
            }
        }
        mesh
    }

    pub fn object(&self, casts: bool) -> ReferenceObject<'_> {
        ReferenceObject {
            positions: &self.positions,
            indices: &self.indices,
            transform: DAffine3::IDENTITY,
            casts,
        }
    }

    pub fn receiver(&self, rectangle: TexelRectangle) -> LightMapReceiver<'_> {
        LightMapReceiver {
            positions: &self.positions,
            indices: &self.indices,
            uvs: &self.uvs,
            transform: DAffine3::IDENTITY,
            rectangle,
            two_sided: false,
        }
    }

    /// Where in the receiver's texture coordinates a point of a triangle is.
    pub fn uv(&self, triangle: usize, point: DVec3) -> [f64; 2] {
        let corner = [0, 1, 2].map(|k| self.indices[3 * triangle + k] as usize);
        let [a, b, c] = corner.map(|at| DVec3::from_array(self.positions[at].map(f64::from)));
        let normal = (b - a).cross(c - a);
        let part = |from: DVec3, to: DVec3| {
            (to - from).cross(point - from).dot(normal) / normal.length_squared()
        };
        let weights = [part(b, c), part(c, a), part(a, b)];
        [0, 1].map(|axis| {
            let parts = corner.iter().zip(weights);
            parts
                .map(|(&at, weight)| f64::from(self.uvs[at][axis]) * weight)
                .sum()
        })
    }
}

/// The six faces of a box with these half sides, counter-clockwise seen from outside.
pub fn cuboid(half: Vec3, transform: Affine3A) -> Vec<Vec<Vec3>> {
    let shape = crate::common::shapes::cuboid(half);
    let corner = |index: u32| transform.transform_point3(shape.positions[index as usize].into());
    let faces = shape.indices.chunks_exact(6);
    // Two triangles a face: a, b, c and a, c, d.
    faces
        .map(|face| [face[0], face[1], face[2], face[5]].map(corner).to_vec())
        .collect()
}

/// A square of the ground, seen counter-clockwise from above.
pub fn square(half: f32, transform: Affine3A) -> Vec<Vec<Vec3>> {
    let shape = crate::common::shapes::square(half);
    let corners = shape.positions.iter();
    vec![
        corners
            .map(|&corner| transform.transform_point3(corner.into()))
            .collect(),
    ]
}

/// Ground, a box that rests on it, one in the air, and a pole.
pub struct Yard {
    pub meshes: Vec<Unwrapped>,
    pub scene: ReferenceScene,
    /// Texels along the side of each mesh's rectangle.
    pub texels: u32,
    scale: f32,
}

/// Where a camera sees the yard.
pub struct Point {
    pub pixel: [u32; 2],
    /// In texels of the map.
    pub at: [f64; 2],
}

impl Yard {
    pub fn new(texels: u32) -> Self {
        Self::scaled(texels, 1.0)
    }

    pub fn scaled(texels: u32, scale: f32) -> Self {
        let tilt = Affine3A::from_quat(Quat::from_rotation_z(0.17) * Quat::from_rotation_x(0.05));
        let on = |at: Vec3, turn: f32| {
            tilt * Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), at)
        };
        let faces = [
            square(4.0, tilt),
            cuboid(Vec3::new(0.6, 0.5, 0.4), on(Vec3::new(-1.2, 0.5, 0.3), 0.4)),
            cuboid(Vec3::new(0.5, 0.2, 0.7), on(Vec3::new(1.3, 1.4, -0.8), 1.1)),
            cuboid(
                Vec3::new(0.08, 0.9, 0.08),
                on(Vec3::new(0.4, 0.9, 1.5), 0.2),
            ),
        ];
        let faces = faces.map(|mesh| -> Vec<Vec<Vec3>> {
            let scaled = |face: &Vec<Vec3>| face.iter().map(|corner| scale * *corner).collect();
            mesh.iter().map(scaled).collect()
        });
        let meshes: Vec<Unwrapped> = faces
            .iter()
            .map(|mesh| Unwrapped::new(mesh, texels, 2.0))
            .collect();
        let objects: Vec<ReferenceObject<'_>> =
            meshes.iter().map(|mesh| mesh.object(true)).collect();
        let scene = ReferenceScene::new(&objects).unwrap();
        Self {
            meshes,
            scene,
            texels,
            scale,
        }
    }

    pub fn lamp(&self) -> PointLight {
        PointLight::new(self.scale * Vec3::new(1.0, 5.0, 0.5), self.scale * 40.0)
    }

    fn rectangle(&self, mesh: usize) -> TexelRectangle {
        TexelRectangle {
            x: mesh as u32 * self.texels,
            y: 0,
            width: self.texels,
            height: self.texels,
        }
    }

    pub fn layout(&self) -> LightMapLayout {
        let meshes = self.meshes.iter().enumerate();
        let receivers: Vec<_> = meshes
            .map(|(place, mesh)| mesh.receiver(self.rectangle(place)))
            .collect();
        LightMapLayout::new(
            [self.texels * receivers.len() as u32, self.texels],
            &receivers,
        )
        .unwrap()
    }

    pub fn bake(&self, light: &BakedLight, samples: u32) -> LightMap {
        let descriptor = BakeDescriptor {
            samples,
            ..Default::default()
        };
        self.scene.bake(&self.layout(), light, &descriptor).unwrap()
    }

    pub fn image(&self) -> ReferenceImage {
        let eye = self.scale * Vec3::new(2.5, 5.5, 5.0);
        let view = camera::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
        let aspect = PICTURE[0] as f32 / PICTURE[1] as f32;
        let projection = proj::perspective_infinite_reverse(0.8, aspect, 0.1 * self.scale);
        let view = View::new(projection * view, DepthConvention::InfiniteReverse).unwrap();
        let light = self.lamp();
        self.scene
            .render(
                &view,
                PICTURE[0],
                PICTURE[1],
                light.homogeneous(),
                Some(light.range),
            )
            .unwrap()
    }

    /// What the camera sees of what faces the light, and where that is in the map.
    pub fn points(&self, image: &ReferenceImage) -> Vec<Point> {
        let mut points = Vec::new();
        for (place, class) in image.classes().enumerate() {
            let pixel = [place as u32 % PICTURE[0], place as u32 / PICTURE[0]];
            let Some(hit) = image
                .hit(pixel[0], pixel[1])
                .filter(|_| class.faces_light())
            else {
                continue;
            };
            let mesh = hit.object as usize;
            let uv = self.meshes[mesh].uv(hit.triangle as usize, hit.position);
            let rectangle = self.rectangle(mesh);
            let texels = f64::from(self.texels);
            points.push(Point {
                pixel,
                at: [f64::from(rectangle.x) + texels * uv[0], texels * uv[1]],
            });
        }
        points
    }
}
