//! Edges and corners of a cube map: kernels err there no more than in the middle of a face.

use crate::common::rays::Triangles;
use crate::common::shapes::{Random, Shape, cuboid};
use crate::receivers::ask_changed;
use glam::{Affine3A, DVec3, Quat, Vec3};
use host::gpu::Gpu;
use shadows::{
    Caster, ContactHardening, CubeShadowMap, CubeShadowMapDescriptor, Kernel, PcfDescriptor,
    PointLight, glam,
};

const SIZE: u32 = 128;
/// World width of a texel straight ahead, at distance 1.
const TEXEL: f32 = 2.0 / SIZE as f32;
const POINTS: usize = 1500;

/// Small boxes around the z axis, and points behind them, all within some texels.
struct Cluster {
    shape: Shape,
    places: Vec<Affine3A>,
    directions: Vec<Vec3>,
    lit: Vec<f32>,
}

impl Cluster {
    fn new(octant: u64) -> Self {
        let mut random = Random::new(octant);
        let shape = cuboid(Vec3::new(4.0, 2.0, 3.0) * TEXEL);
        let places: Vec<_> = (0..8)
            .map(|_| {
                let off = Vec3::new(random.next(), random.next(), 0.0) * 12.0 * TEXEL;
                let turn = Affine3A::from_axis_angle(random.vec3().normalize(), 3.0);
                Affine3A::from_translation(Vec3::Z + off) * turn
            })
            .collect();
        let mut truth = Triangles::default();
        for &place in &places {
            truth.add(&shape.positions, &shape.indices, place);
        }
        let directions: Vec<_> = (0..POINTS)
            .map(|_| Vec3::new(random.next(), random.next(), 0.0) * TEXEL + Vec3::Z)
            .collect();
        let lit = directions
            .iter()
            .map(|d| truth.nearest(DVec3::ZERO, d.as_dvec3()).is_none())
            .map(|lit| f32::from(u8::from(lit)))
            .collect();
        Self {
            shape,
            places,
            directions,
            lit,
        }
    }
}

/// Where clusters are put: the three faces, three edges and the corner of an octant, as the number of
/// faces that meet there less one, and how the cluster is turned. What is opposite is left empty.
fn sites(octant: u64) -> Vec<(usize, Quat)> {
    let mut random = Random::new(octant);
    let signs = [1, 2, 4].map(|bit| if octant & bit == 0 { 1.0 } else { -1.0 });
    (1..8_u32)
        .map(|faces| {
            let there = Vec3::new(
                (faces & 1) as f32,
                (faces >> 1 & 1) as f32,
                (faces >> 2) as f32,
            );
            let direction = (there * Vec3::from_array(signs)).normalize();
            let roll = Quat::from_rotation_z(3.15 * random.next());
            let turn = Quat::from_rotation_arc(Vec3::Z, direction) * roll;
            (faces.count_ones() as usize - 1, turn)
        })
        .collect()
}

/// The same cluster at every site, drawn.
struct Sky {
    cluster: Cluster,
    sites: Vec<(usize, Quat)>,
    map: CubeShadowMap,
}

impl Sky {
    fn new(gpu: &Gpu, octant: u64) -> Self {
        let cluster = Cluster::new(octant);
        let sites = sites(octant);
        let mesh = cluster.shape.mesh(&gpu.device);
        let casters: Vec<_> = sites
            .iter()
            .flat_map(|(_, turn)| {
                let turn = Affine3A::from_quat(*turn);
                let places = cluster.places.iter();
                places.map(move |place| turn * *place)
            })
            .map(|place| Caster::new(mesh.clone(), place))
            .collect();
        let descriptor = CubeShadowMapDescriptor {
            size: SIZE,
            ..Default::default()
        };
        let light = PointLight::new(Vec3::ZERO, 30.0);
        let map = crate::cubes::fresh(gpu, &descriptor, light, &casters);
        Self {
            cluster,
            sites,
            map,
        }
    }

    /// Adds to the wrong points, and to the points, in the middles of faces, at edges and at corners.
    fn errors(
        &self,
        gpu: &Gpu,
        kernel: Kernel,
        change: fn(String) -> String,
        sums: &mut [[f64; 2]; 3],
    ) {
        let points: Vec<_> = self
            .sites
            .iter()
            .flat_map(|(_, turn)| self.cluster.directions.iter().map(move |d| *turn * *d))
            .map(|direction| (direction * 2.0, direction))
            .collect();
        let descriptor = PcfDescriptor {
            kernel,
            ..Default::default()
        };
        let seen = ask_changed(gpu, (&self.map).into(), &descriptor, 0, &points, change);
        for ((kind, _), seen) in self.sites.iter().zip(seen.chunks_exact(POINTS)) {
            for (seen, lit) in seen.iter().zip(&self.cluster.lit) {
                sums[*kind][0] += f64::from(u8::from((seen - lit).abs() > 0.5));
                sums[*kind][1] += 1.0;
            }
        }
    }
}

/// Of wrong points in the middle of a face, so many may be wrong at edges and corners: texels are
/// smaller there (0.71 and 0.58 of the angle), which leaves kernels less to be wrong about.
const SHARE: f64 = 0.75;

fn assert_no_seam(gpu: &Gpu) {
    let skies: Vec<_> = (0..8).map(|octant| Sky::new(gpu, octant)).collect();
    let wrong = |kernel, change| {
        let mut sums = [[0.0; 2]; 3];
        for sky in &skies {
            sky.errors(gpu, kernel, change, &mut sums);
        }
        sums.map(|[sum, count]| sum / count)
    };
    let seamless = |[middle, edges, corners]: [f64; 3]| edges.max(corners) <= SHARE * middle;
    let contact = Kernel::ContactHardening(ContactHardening {
        light_size: 0.01, // small, so that its penumbra is measured in texels, too
        ..Default::default()
    });
    for kernel in Kernel::ALL[..9].iter().copied().chain([contact]) {
        let right = wrong(kernel, |module| module);
        // The broken twin: what is beyond the face's edge is looked for on the opposite side.
        let broken = wrong(kernel, |module| {
            module
                .replace(
                    "over.y, on_face)",
                    "over.y, select(on_face, -on_face, over > vec2f(0.0)))",
                )
                .replace(
                    "select(texel, place, a >= vec3f(most))",
                    "select(texel, vec3f(place.x, -place.yz), a >= vec3f(most))",
                )
        });
        println!("{right:.4?}, broken {broken:.4?} {kernel:?}");
        assert!(right[0] > 0.03 && seamless(right), "{kernel:?}: {right:?}");
        match kernel {
            // One texel, of the receiver's own face.
            Kernel::Hard => assert_eq!(right, broken),
            // Its taps end where the face does.
            Kernel::HardwareBilinear => assert_eq!(right, broken),
            // Beyond the edge from half a texel before it only.
            Kernel::Bilinear => assert!(broken[2] > 1.2 * right[2], "{broken:?}"),
            _ => assert!(!seamless(broken), "{kernel:?}: {broken:?}"),
        }
    }
}

#[test]
fn kernels_err_no_more_at_edges_and_corners_than_in_the_middle_of_a_face() {
    let Some(gpu) = Gpu::for_test() else { return };
    assert_no_seam(&gpu);
}

#[test]
fn they_do_not_on_gl_either() {
    let Ok(gl) = Gpu::new(Some("(gl,")) else {
        eprintln!("skipped: no GL adapter");
        return;
    };
    assert_no_seam(&gl);
}
