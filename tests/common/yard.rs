//! Boxes above a ground, seen straight down by one face of a cube map or by a spot with the same
//! frustum.
#![allow(dead_code)] // each test uses its own part

use shadows::glam::{Affine3A, DVec2, DVec3, Vec3};
use shadows::{
    AnyMap, Caster, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, FlatLight, Kernel,
    MapSettings, PointLight, Radius, ShadowFrame, ShadowMap, ShadowMapDescriptor, SpotLight,
};

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, cuboid};
use crate::receivers::visibility;
use host::gpu::Gpu;

pub const SIZE: u32 = 512;
pub const LIGHT: Vec3 = Vec3::new(0.0, 3.0, 0.0);

/// Boxes between a light and the ground y = 0, seen straight down by one face of a cube map or by
/// a spot with the same frustum.
pub struct Yard {
    pub gpu: Gpu,
    casters: Vec<Caster>,
    truth: Triangles,
    pub points: Vec<Vec3>,
}

impl Yard {
    /// Ten boxes in the air, seen at random points.
    pub fn new() -> Option<Self> {
        let mut random = Random::new(21);
        let boxes: Vec<(Vec3, Affine3A)> = (0..10)
            .map(|_| {
                let place = random.vec3() * Vec3::new(1.2, 0.5, 1.2) + Vec3::Y * 0.8;
                let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
                let transform = Affine3A::from_translation(place) * turn;
                (Vec3::new(0.25, 0.15, 0.2), transform)
            })
            .collect();
        let points = (0..4000)
            .map(|_| Vec3::new(random.next() * 2.0, 0.0, random.next() * 2.0))
            .collect();
        Self::of(&boxes, points)
    }

    /// Boxes by half their sides and their places, seen at points of the ground. `None` where there
    /// is no driver.
    pub fn of(boxes: &[(Vec3, Affine3A)], points: Vec<Vec3>) -> Option<Self> {
        let gpu = Gpu::for_test()?;
        let mut truth = Triangles::default();
        let casters = boxes
            .iter()
            .map(|&(half, transform)| {
                let shape = cuboid(half);
                truth.add(&shape.positions, &shape.indices, transform);
                shape.caster(&gpu.device, transform)
            })
            .collect();
        Some(Self {
            gpu,
            casters,
            truth,
            points,
        })
    }

    /// For the kernels of a host, none of which is wider.
    pub fn cube(&self) -> CubeShadowMap {
        self.cube_of(Radius::Texels(24.0))
    }

    pub fn cube_of(&self, reach: Radius) -> CubeShadowMap {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            settings: MapSettings {
                reach,
                ..Default::default()
            },
            ..Default::default()
        };
        let mut map = CubeShadowMap::new(device, &descriptor).unwrap();
        let frame = CubeFrame::new(PointLight::new(LIGHT, 30.0), &self.casters);
        map.prepare(device, queue, &frame).unwrap();
        self.gpu.run(|encoder| map.encode(encoder));
        map
    }

    /// The spot with the cube face's frustum; its axes are the face's up to signs.
    pub fn flat(&self) -> ShadowMap {
        self.flat_of(Radius::Texels(24.0))
    }

    pub fn flat_of(&self, reach: Radius) -> ShadowMap {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let descriptor = ShadowMapDescriptor {
            size: SIZE,
            settings: MapSettings {
                reach,
                ..Default::default()
            },
            ..Default::default()
        };
        let mut map = ShadowMap::new(device, &descriptor).unwrap();
        let right_angle = std::f32::consts::FRAC_PI_4;
        let light = FlatLight::Spot(SpotLight::new(LIGHT, Vec3::NEG_Y, right_angle, 30.0));
        map.prepare(device, queue, &ShadowFrame::new(light, &self.casters))
            .unwrap();
        self.gpu.run(|encoder| map.encode(encoder));
        map
    }

    pub fn seen<'a>(&self, map: impl Into<AnyMap<'a>>, kernel: Kernel) -> Vec<f64> {
        let points: Vec<_> = self.points.iter().map(|point| (*point, Vec3::Y)).collect();
        let seen = visibility(&self.gpu, map, kernel, &points);
        seen.into_iter().map(f64::from).collect()
    }

    /// How far along the way from the light to a point of the ground the first caster is; `None`
    /// if there is none.
    pub fn blocker(&self, point: DVec2) -> Option<f64> {
        let light = LIGHT.as_dvec3();
        let hit = self
            .truth
            .nearest(light, DVec3::new(point.x, 0.0, point.y) - light);
        hit.filter(|&t| t < 1.0)
    }

    /// Whether a point sees another.
    pub fn sees(&self, from: DVec3, to: DVec3) -> f64 {
        let hit = self.truth.nearest(from, to - from);
        f64::from(u8::from(hit.is_none_or(|t| t >= 1.0)))
    }

    pub fn lit(&self, point: DVec2) -> f64 {
        self.sees(LIGHT.as_dvec3(), DVec3::new(point.x, 0.0, point.y))
    }

    /// The kernel's answer at every point.
    pub fn exact(&self, kernel: impl Fn(&Self, usize, DVec2) -> f64) -> Vec<f64> {
        let points = self.points.iter().enumerate();
        points
            .map(|(i, point)| kernel(self, i, point.as_dvec3().truncate_y()))
            .collect()
    }
}

pub trait Ground {
    fn truncate_y(self) -> DVec2;
}

impl Ground for DVec3 {
    fn truncate_y(self) -> DVec2 {
        DVec2::new(self.x, self.z)
    }
}

/// Root mean square and largest difference.
pub fn error(seen: &[f64], exact: &[f64]) -> (f64, f64) {
    let differences = seen
        .iter()
        .zip(exact)
        .map(|(seen, exact)| (seen - exact).abs());
    let largest = differences.clone().fold(0.0, f64::max);
    let squares: f64 = differences.map(|difference| difference * difference).sum();
    ((squares / seen.len() as f64).sqrt(), largest)
}
