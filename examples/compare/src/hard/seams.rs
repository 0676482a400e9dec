//! Whether a cube map is worse at its seams and corners than in the middle of its faces.

use shadows::glam::DVec3;
use shadows::reference::{Class, ReferenceImage};

/// A direction's second largest component over its largest: from here on it is at a seam, and up to
/// there in the middle.
const SEAM: f64 = 0.85;
const MIDDLE: f64 = 0.5;
/// The scene's first object, whose walls receive.
const ROOM: u32 = 0;
/// How many times the error at face centres is allowed at seams: room for chance, since some
/// thousand pixels are compared and how the edges lie among the texels differs.
pub const FACTOR: f64 = 1.25;

/// Wrong pixels at shadow edges, and what texels explain of them, near seams and in the middle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates {
    pub seams: Rate,
    pub middle: Rate,
}

/// Of one of the two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rate {
    pub wrong: f64,
    /// The sum over the pixels at shadow edges of how wide a texel is there, in pixels: an edge is
    /// lost by a share of a texel.
    pub texels: f64,
}

impl Rates {
    /// Of one picture, with the light at the centre of a cube map along the world's axes.
    pub fn of(reference: &ReferenceImage, visibility: &[u8], [light, camera]: [DVec3; 2]) -> Self {
        let width = reference.width() as usize;
        let classes: Vec<Class> = reference.classes().collect();
        let mut rates = Self::default();
        for (pixel, &class) in classes.iter().enumerate() {
            let place = [pixel % width, pixel / width].map(|at| at as u32);
            let hit = reference.hit(place[0], place[1]);
            // What casts is not spread evenly over the directions, what is around it all is.
            let Some(hit) = hit.filter(|hit| hit.object == ROOM && class.faces_light()) else {
                continue;
            };
            let from_light = hit.position - light;
            let Some(rate) = rates.at(from_light) else {
                continue;
            };
            let shown = visibility[pixel] >= 128;
            rate.wrong += f64::from(u8::from(shown != (class == Class::Lit)));
            if is_edge(&classes, pixel, width) {
                let to_camera = camera - hit.position;
                rate.texels += texel(from_light, hit.normal) / footprint(to_camera, hit.normal);
            }
        }
        rates
    }

    fn at(&mut self, from_light: DVec3) -> Option<&mut Rate> {
        if is_at_seam(from_light) {
            return Some(&mut self.seams);
        }
        (toward_seam(from_light) <= MIDDLE).then_some(&mut self.middle)
    }

    pub fn add(&mut self, other: &Self) {
        for (rate, other) in [
            (&mut self.seams, other.seams),
            (&mut self.middle, other.middle),
        ] {
            rate.wrong += other.wrong;
            rate.texels += other.texels;
        }
    }

    /// How many times more is wrong at seams than texels explain in the middle.
    pub fn ratio(&self) -> f64 {
        let Self { seams, middle } = self;
        // One more in the middle: where nothing is wrong there, one wrong pixel is no infinity.
        (seams.wrong / seams.texels) / ((middle.wrong + 1.0) / middle.texels)
    }

    /// What is wrong, if that is more than chance allows or there was nothing to compare.
    pub fn failure(&self) -> Option<String> {
        let ratio = self.ratio();
        // Written so that nothing to compare, which is not a number, fails.
        let sound = ratio <= FACTOR;
        (!sound).then(|| {
            format!("edges at seams are {ratio:.2} times as wrong as at face centres ({self:?})")
        })
    }
}

/// A direction's second largest component over its largest.
fn toward_seam(from_light: DVec3) -> f64 {
    let mut sides = from_light.abs().to_array();
    sides.sort_by(f64::total_cmp);
    sides[1] / sides[2]
}

/// Whether a direction is near where two faces meet, or three.
pub fn is_at_seam(from_light: DVec3) -> bool {
    toward_seam(from_light) >= SEAM
}

/// Whether the reference says otherwise to the right or below.
fn is_edge(classes: &[Class], pixel: usize, width: usize) -> bool {
    let shadowed = |pixel: usize| classes.get(pixel).map(|class| *class == Class::Shadowed);
    let right = (pixel % width + 1 < width).then_some(pixel + 1);
    let others = right.into_iter().chain([pixel + width]);
    let own = shadowed(pixel);
    others.filter_map(shadowed).any(|other| Some(other) != own)
}

/// How wide a texel is on a surface, but for the map's size: of its area the root.
fn texel(from_light: DVec3, normal: DVec3) -> f64 {
    let distance = from_light.length();
    let cosine = from_light.abs().max_element() / distance;
    let incidence = normal.dot(from_light).abs() / distance;
    distance * cosine.powf(1.5) / incidence.sqrt()
}

/// How wide a pixel is on a surface, but for the picture's size: of its area about the root.
fn footprint(to_camera: DVec3, normal: DVec3) -> f64 {
    let distance = to_camera.length();
    let incidence = normal.dot(to_camera).abs() / distance;
    distance / incidence.sqrt()
}
