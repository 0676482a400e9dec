//! The error of both halves against the reference, a few rows at a time.

use anyhow::{Result, ensure};
use host::exact::reference_scene;
use host::pipelines::DEPTH;
use host::scene::{Cone, Light, LightKind};
use shadows::View;
use shadows::glam::{Mat4, Vec3, Vec4};
use shadows::reference::{Interior, ReferenceScene, Verdict};

use crate::choice::Place;
use crate::places;
use crate::world;

/// What the reference must know of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Job {
    pub clip_from_world: Mat4,
    pub light: Light,
    /// Of the left and the right half: where resolution is no excuse.
    pub interiors: [Interior; 2],
}

/// Numbers of a job, to be sent to a worker.
pub const NUMBERS: usize = 16 + 4 + 1 + 4 + 2 * INTERIOR;
const INTERIOR: usize = 3 + 16;

impl Job {
    /// As numbers.
    pub fn to_numbers(&self) -> [f32; NUMBERS] {
        let mut numbers = [0.0; NUMBERS];
        let light = &self.light;
        let (direction, angle) = light
            .cone
            .map_or((Vec3::ZERO, 0.0), |cone| (cone.direction, cone.half_angle));
        numbers[..16].copy_from_slice(&self.clip_from_world.to_cols_array());
        numbers[16..20].copy_from_slice(&light.place.to_array());
        numbers[20] = light.range;
        numbers[21..24].copy_from_slice(&direction.to_array());
        numbers[24] = angle;
        let interiors = numbers[25..].chunks_exact_mut(INTERIOR);
        for (numbers, interior) in interiors.zip(&self.interiors) {
            write_interior(numbers, interior);
        }
        numbers
    }

    /// From such numbers.
    pub fn from_numbers(numbers: &[f32; NUMBERS]) -> Self {
        let matrix = |at: usize| {
            let numbers: [f32; 16] = numbers[at..at + 16].try_into().unwrap_or_default();
            Mat4::from_cols_array(&numbers)
        };
        let vector = |at: usize| Vec3::from_slice(&numbers[at..]);
        let interior = |at: usize| {
            let kernel_radius = numbers[at + 2];
            match numbers[at] as u32 {
                0 => Interior::Screen,
                1 => Interior::Map {
                    face_size: numbers[at + 1] as u32,
                    kernel_radius,
                },
                _ => Interior::FlatMap {
                    clip_from_world: matrix(at + 3),
                    size: numbers[at + 1] as u32,
                    kernel_radius,
                },
            }
        };
        let mut light = Light::new(Vec4::from_slice(&numbers[16..]), numbers[20]);
        light.cone = (numbers[24] > 0.0).then(|| Cone {
            direction: vector(21),
            half_angle: numbers[24],
        });
        Self {
            clip_from_world: matrix(0),
            light,
            interiors: [25, 25 + INTERIOR].map(interior),
        }
    }
}

fn write_interior(numbers: &mut [f32], interior: &Interior) {
    match *interior {
        Interior::Map {
            face_size,
            kernel_radius,
        } => numbers[..3].copy_from_slice(&[1.0, face_size as f32, kernel_radius]),
        Interior::FlatMap {
            clip_from_world,
            size,
            kernel_radius,
        } => {
            numbers[..3].copy_from_slice(&[2.0, size as f32, kernel_radius]);
            numbers[3..].copy_from_slice(&clip_from_world.to_cols_array());
        }
        _ => {}
    }
}

/// Pixels of one half, counted so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// Where the light could be seen.
    pub counted: u32,
    /// Lit where there is shadow.
    pub false_lit: u32,
    /// In shadow where there is light.
    pub false_shadow: u32,
    /// Those of both that resolution does not excuse.
    pub interior: u32,
}

impl Count {
    fn add(&mut self, verdict: Verdict) {
        let (lit, interior) = match verdict {
            Verdict::NotCounted => return,
            Verdict::Right => (None, false),
            Verdict::FalseLit => (Some(true), false),
            Verdict::FalseShadow => (Some(false), false),
            Verdict::FalseLitInterior => (Some(true), true),
            Verdict::FalseShadowInterior => (Some(false), true),
        };
        self.counted += 1;
        self.false_lit += u32::from(lit == Some(true));
        self.false_shadow += u32::from(lit == Some(false));
        self.interior += u32::from(interior);
    }
}

/// A scene's triangles, ready for rays.
pub struct Judge {
    scene: ReferenceScene,
}

impl Judge {
    /// Builds the scene once more, as exact geometry.
    ///
    /// # Errors
    /// If the scene is broken.
    pub fn new(place: Place, kind: LightKind) -> Result<Self> {
        let (scene, _) = places::load(place, kind);
        Ok(Self {
            scene: reference_scene(&scene)?,
        })
    }

    /// Compares rows `first..end` of a picture of `size` pixels with the reference: counts for each half are
    /// added to, and gives a colour for each pixel of these rows, of the left half first.
    ///
    /// # Errors
    /// If the job makes no sense, or there is not a byte of visibility for each pixel.
    pub fn rows(
        &self,
        job: &Job,
        size: [u32; 2],
        [first, end]: [u32; 2],
        visibility: [&[u8]; 2],
        counts: &mut [Count; 2],
    ) -> Result<[Vec<[u8; 4]>; 2]> {
        let [width, height] = size;
        for bytes in visibility {
            ensure!(
                bytes.len() == width as usize * height as usize,
                "{} bytes of visibility for {width} x {height} pixels",
                bytes.len()
            );
        }
        // What is interior is known of rows that have one above and one below.
        let band = first.saturating_sub(1)..(end + 1).min(height);
        let scene = self.scene.clone().with_rows(band.clone());
        let view = View::new(job.clip_from_world, DEPTH)?;
        let light = &job.light;
        let image = match world::spot(light) {
            Some(spot) => scene.render_spot(&view, width, height, &spot)?,
            None => {
                let range = (light.kind() == LightKind::Point).then_some(light.range);
                let light = host::scene::homogeneous(light.place);
                scene.render(&view, width, height, light, range)?
            }
        };
        let pixels = |rows: [u32; 2]| {
            let [from, to] = rows.map(|row| row as usize * width as usize);
            from..to
        };
        let inner = pixels([first - band.start, end - band.start]);
        let mut colors = [const { Vec::new() }; 2];
        for side in 0..2 {
            let seen = &visibility[side][pixels([band.start, band.end])];
            let verdicts = image.compare(seen, job.interiors[side])?.verdicts;
            let (seen, verdicts) = (&seen[inner.clone()], &verdicts[inner.clone()]);
            verdicts
                .iter()
                .for_each(|&verdict| counts[side].add(verdict));
            colors[side] = seen.iter().zip(verdicts).map(color).collect();
        }
        Ok(colors)
    }
}

/// Wrong pixels in colour over the visibility in grey.
fn color((&visibility, verdict): (&u8, &Verdict)) -> [u8; 4] {
    let grey = |value| [value, value, value, 255];
    match verdict {
        Verdict::FalseLit | Verdict::FalseLitInterior => [255, 72, 48, 255],
        Verdict::FalseShadow | Verdict::FalseShadowInterior => [64, 148, 255, 255],
        Verdict::Right => grey(36 + visibility / 4),
        Verdict::NotCounted => grey(18),
    }
}
