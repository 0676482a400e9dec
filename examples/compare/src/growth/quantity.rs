//! What grows, from where to where, and the scenes that grow with it.

use std::f32::consts::TAU;

use shadows::PointLight;
use shadows::glam::{Affine3A, Vec3, Vec4};

use host::scene::{Light, Object, Scene, square};
use host::shapes::{self, Shape};

/// Half the side of the ground, in metres.
const GROUND: f32 = 12.0;
const RANGE: f32 = 40.0;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Triangles,
    Casters,
    Meshes,
    Lights,
    Views,
    Pixels,
    Texels,
}

/// Everything that is rendered at one point of a series.
pub struct Situation {
    /// The ground alone: the casters cast, and are not seen, so that the host's own drawing does
    /// not grow with them.
    pub scene: Scene,
    pub caster: Shape,
    pub transforms: Vec<Affine3A>,
    /// Whether each caster has a mesh of its own.
    pub distinct: bool,
    pub lights: Vec<PointLight>,
    /// Of one camera that turns around the middle.
    pub views: u32,
    pub size: [u32; 2],
    /// Of a cube face, in texels.
    pub side: u32,
}

impl Quantity {
    pub const ALL: [Self; 7] = [
        Self::Triangles,
        Self::Casters,
        Self::Meshes,
        Self::Lights,
        Self::Views,
        Self::Pixels,
        Self::Texels,
    ];

    /// In file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Casters => "casters",
            Self::Meshes => "meshes",
            Self::Lights => "lights",
            Self::Views => "views",
            Self::Pixels => "resolution",
            Self::Texels => "map-size",
        }
    }

    /// Along the axis.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Triangles => "triangles, in four casters",
            Self::Casters => "casters, of twelve triangles each",
            Self::Meshes => "casters, each of a mesh of its own",
            Self::Lights => "lights",
            Self::Views => "views, each a whole picture",
            Self::Pixels => "pixels of the picture (360p to 2160p)",
            Self::Texels => "texels of a cube face (256 to 4096 a side)",
        }
    }

    /// What is in the scene, and what is to be expected.
    pub fn about(self) -> &'static str {
        match self {
            Self::Triangles => {
                "Four spheres around one light, increasingly fine. A map draws each triangle, so at \
                 most linear; what is kept is not redrawn. Volumes examine each edge, and draw the outline (which \
                 grows with the square root) and, where a cap is needed, triangles."
            }
            Self::Casters => {
                "Boxes on a grid under one light, in increasing number and decreasing size: at most \
                 linear, on both CPU and GPU. Maps compare static casters but do not redraw them; volumes are drawn \
                 every frame, but extracted only once."
            }
            Self::Meshes => {
                "The same boxes, each with its own mesh, so that nothing is drawn or extracted \
                 together: still at most linear."
            }
            Self::Lights => {
                "A hundred boxes, with lights on a circle above, all of which reach everything. One \
                 atlas holds the maps of all lights (256 texels a side), one renderer the volumes. Reading the maps \
                 is up to the host and not included here."
            }
            Self::Views => {
                "A hundred boxes and one light, seen from an increasing number of sides in one \
                 frame. Volumes are extracted once for all views; what is drawn of them is chosen for each view. A \
                 cube map does not depend on views."
            }
            Self::Pixels => {
                "A hundred boxes, one light. Maps are read once per pixel: linear, for the lit pass \
                 minus the lit pass without shadows. Volumes, with only their stencil pass, are at most linear in the \
                 pixels that they fill; where their draws outweigh that fill, they hardly grow."
            }
            Self::Texels => {
                "A hundred boxes, one light, six faces. Clearing and filling is linear in texels \
                 once it outweighs the draws; a map that is kept is only read. Includes the lit pass, minus the lit \
                 pass without shadows. Volumes have no texels."
            }
        }
    }

    /// Whether shadow maps, or else volumes, know of it.
    pub fn concerns(self, maps: bool) -> bool {
        match self {
            Self::Views => !maps,
            Self::Texels => maps,
            _ => true,
        }
    }

    /// Whether the lit pass is measured as well.
    pub fn reads(self) -> bool {
        matches!(self, Self::Pixels | Self::Texels)
    }

    /// The sizes by which a series goes: rings of spheres, rows of pixels, sides of faces, or what
    /// grows itself.
    fn sizes(self) -> &'static [u32] {
        match self {
            Self::Triangles => &[8, 16, 32, 64, 125, 250, 500],
            Self::Casters => &[1, 10, 100, 1_000, 10_000, 100_000],
            Self::Meshes => &[1, 10, 100, 1_000, 4_000, 10_000],
            Self::Lights => &[1, 2, 4, 8, 16, 32, 64],
            Self::Views => &[1, 2, 4, 8, 16],
            Self::Pixels => &[360, 540, 720, 1080, 1440, 2160],
            Self::Texels => &[256, 512, 1024, 2048, 4096],
        }
    }

    /// The series, no farther than to `times` its start. At least two points.
    pub fn series(self, times: f64) -> Vec<u32> {
        let sizes = self.sizes();
        let limit = times * self.amount(sizes[0]) * (1.0 + 1e-9);
        let within = |&&size: &&u32| self.amount(size) <= limit;
        let count = sizes.iter().take_while(within).count().max(2);
        sizes[..count].to_vec()
    }

    /// How much there is at a size: where along the axis it is.
    pub fn amount(self, size: u32) -> f64 {
        let size = f64::from(size);
        match self {
            // Four spheres of four triangles for each ring and each ring.
            Self::Triangles => 16.0 * size * size,
            Self::Casters | Self::Meshes | Self::Lights | Self::Views => size,
            Self::Pixels => size * size * 16.0 / 9.0,
            Self::Texels => size * size,
        }
    }

    /// What is rendered at a size.
    pub fn situation(self, size: u32) -> Situation {
        let common = Situation {
            scene: ground(),
            caster: shapes::cube(),
            transforms: grid(100),
            distinct: false,
            lights: vec![PointLight::new(Vec3::new(0.5, 6.0, 0.3), RANGE)],
            views: 1,
            size: [640, 360],
            side: 1024,
        };
        match self {
            Self::Triangles => Situation {
                caster: shapes::sphere(size),
                transforms: around(),
                ..common
            },
            Self::Casters => Situation {
                transforms: grid(size),
                ..common
            },
            Self::Meshes => Situation {
                transforms: grid(size),
                distinct: true,
                ..common
            },
            Self::Lights => Situation {
                lights: circle(size),
                side: 256,
                ..common
            },
            Self::Views => Situation {
                views: size,
                ..common
            },
            Self::Pixels => Situation {
                size: [size * 16 / 9, size],
                ..common
            },
            Self::Texels => Situation {
                side: size,
                ..common
            },
        }
    }
}

fn ground() -> Scene {
    let light = Vec4::new(0.5, 6.0, 0.3, 1.0);
    let mut scene = Scene::empty("growth");
    *scene.light_mut() = Light::new(light, RANGE);
    scene.camera.eye = Vec3::new(0.0, 10.0, 18.0);
    scene.meshes = vec![square("ground", Vec3::ZERO, GROUND)];
    scene.objects = vec![Object {
        name: "ground".into(),
        mesh: 0,
        transform: Affine3A::IDENTITY,
        casts: false,
        albedo: [0.6; 3],
        glow: [0.0; 3],
    }];
    scene
}

/// Boxes above the ground, whatever their number over the same area.
fn grid(count: u32) -> Vec<Affine3A> {
    let side = f64::from(count).sqrt().ceil() as u32;
    let cell = 2.0 * 0.9 * GROUND / side as f32;
    let middle = |n: u32| (n as f32 + 0.5) * cell - 0.9 * GROUND;
    let half = 0.2 * cell.min(4.0);
    (0..count)
        .map(|n| {
            let place = Vec3::new(middle(n % side), 2.0 * half, middle(n / side));
            Affine3A::from_translation(place) * Affine3A::from_scale(Vec3::splat(half))
        })
        .collect()
}

/// Four balls around the light's foot.
fn around() -> Vec<Affine3A> {
    let places = [(-4.0, -3.0), (4.0, -3.0), (-4.0, 4.0), (4.0, 4.0)];
    places
        .map(|(x, z)| {
            Affine3A::from_translation(Vec3::new(x, 1.7, z))
                * Affine3A::from_scale(Vec3::splat(1.5))
        })
        .to_vec()
}

fn circle(count: u32) -> Vec<PointLight> {
    (0..count)
        .map(|n| {
            let (z, x) = (TAU * n as f32 / count as f32).sin_cos();
            PointLight::new(Vec3::new(4.0 * x, 6.0, 4.0 * z), RANGE)
        })
        .collect()
}
