//! What is measured: a technique in a scene where all moves, or where all stands still.

use std::f32::consts::TAU;
use std::time::Instant;

use anyhow::Result;
use shadows::glam::{Affine3A, Mat4, Vec3};
use shadows::mesh::Adjacency;
use shadows::{
    AtlasFrame, AtlasLight, Caster, CasterMesh, CubeShadowMapDescriptor, PcfDescriptor, PointLight,
    ShadowAtlas, ShadowAtlasDescriptor, ShadowVolumeDescriptor, ShadowVolumeFrame,
    ShadowVolumeRenderer, TileSize, View, VolumeLight, VolumeView, wgpu,
};

use super::quantity::Situation;
use crate::shadow::{Shadow, ShadowInputs};
use crate::stage::Stage;
use crate::technique::{Config, Technique};
use host::gpu::Gpu;
use host::timer::Timer;

/// What moves in a frame, in metres.
const STEP: Vec3 = Vec3::new(0.003, 0.001, 0.002);

/// A technique, and whether everything moves: all with their default settings, under which what
/// stands still is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    pub name: &'static str,
    pub is_map: bool,
    pub moves: bool,
}

const fn kind(name: &'static str, is_map: bool, moves: bool) -> Kind {
    Kind {
        name,
        is_map,
        moves,
    }
}

pub const KINDS: [Kind; 4] = [
    kind("cube map, all moving", true, true),
    kind("cube map, kept", true, false),
    kind("volumes, all moving", false, true),
    kind("volumes, kept", false, false),
];

/// A situation on the GPU.
pub struct Place {
    stage: Stage,
    lights: Vec<PointLight>,
    views: Vec<VolumeView>,
    side: u32,
    /// Where everything is in even frames, and in odd ones if it moves.
    inputs: [ShadowInputs; 2],
}

impl Place {
    /// # Errors
    /// If something does not fit the device.
    pub fn new(gpu: &Gpu, situation: Situation) -> Result<Self> {
        let shape = &situation.caster;
        let adjacency = Adjacency::new(&shape.positions, &shape.indices)?;
        let mesh = || CasterMesh::new(&gpu.device, &shape.positions, &adjacency);
        let count = match situation.distinct {
            true => situation.transforms.len(),
            false => 1,
        };
        let meshes: Vec<CasterMesh> = (0..count).map(|_| mesh()).collect::<Result<_, _>>()?;
        let stage = Stage::new(gpu, situation.scene, situation.size)?;
        let light = situation.lights[0].homogeneous();
        let inputs = [Vec3::ZERO, STEP].map(|step| {
            let moved = Affine3A::from_translation(step);
            let transforms = situation.transforms.iter().enumerate();
            ShadowInputs {
                casters: transforms
                    .map(|(place, transform)| {
                        Caster::new(meshes[place % count].clone(), moved * *transform)
                    })
                    .collect(),
                light,
                ..stage.inputs.clone()
            }
        });
        let first = &stage.inputs.view;
        let turned = |n: u32| {
            let turn = Mat4::from_rotation_y(TAU * n as f32 / situation.views as f32);
            Ok(View::new(first.clip_from_world() * turn, first.depth())?.into())
        };
        let views = (0..situation.views).map(turned).collect::<Result<_>>()?;
        Ok(Self {
            stage,
            views,
            lights: situation.lights,
            side: situation.side,
            inputs,
        })
    }
}

/// A technique at work in a place.
pub struct Subject {
    kind: Kind,
    means: Means,
    frame: usize,
    pub prepare: Vec<f64>,
    pub work: Vec<f64>,
    /// Seconds of measuring so far.
    pub spent: f64,
}

enum Means {
    /// A map of one light, with a lit pass.
    Map(Box<Shadow>),
    /// One for all lights.
    Atlas(Box<ShadowAtlas>),
    /// One for all lights and views.
    Volumes(Box<ShadowVolumeRenderer>),
}

impl Subject {
    /// Makes it, and renders what need not be rendered again where nothing moves.
    ///
    /// # Errors
    /// If the device cannot do it.
    pub fn new(gpu: &Gpu, place: &Place, kind: Kind) -> Result<Self> {
        let mut subject = Self {
            kind,
            means: Means::new(gpu, place, kind)?,
            frame: 0,
            prepare: Vec::new(),
            work: Vec::new(),
            spent: 0.0,
        };
        let untimed = Timer::with_timestamps(gpu, false);
        for _ in 0..2 {
            subject.measure(gpu, place, &untimed, true)?;
        }
        subject.prepare.clear();
        subject.work.clear();
        subject.spent = 0.0;
        Ok(subject)
    }

    /// Measures a frame; with `reads` also what the lit pass takes more than without shadows, if it
    /// reads a map. (A stencil test is no more than the noise of that difference.)
    ///
    /// # Errors
    /// If the technique refuses its inputs.
    pub fn measure(&mut self, gpu: &Gpu, place: &Place, timer: &Timer, reads: bool) -> Result<()> {
        let whole = Instant::now();
        let (renderer, scene) = (&place.stage.renderer, &place.stage.scene_gpu);
        gpu.run(|encoder| renderer.draw_ambient(encoder, scene));
        self.frame += 1;
        let inputs = &place.inputs[self.frame % 2 * usize::from(self.kind.moves)];
        let start = Instant::now();
        self.means.prepare(gpu, place, inputs)?;
        self.prepare.push(start.elapsed().as_secs_f64() * 1e3);
        let mut work = timer.time(gpu, |encoder| self.means.generate(place, encoder));
        if let (true, Means::Map(shadow)) = (reads, &self.means) {
            let with = timer.time(gpu, |encoder| shadow.shade(renderer, scene, encoder));
            let without = timer.time(gpu, |encoder| {
                renderer.draw_lit(encoder, scene, renderer.unshadowed(), None);
            });
            work += with - without;
        }
        self.work.push(work);
        self.spent += whole.elapsed().as_secs_f64();
        Ok(())
    }
}

impl Means {
    fn new(gpu: &Gpu, place: &Place, kind: Kind) -> Result<Self> {
        if kind.is_map && place.lights.len() == 1 {
            let config = Config::Cube {
                map: CubeShadowMapDescriptor {
                    size: place.side,
                    ..Default::default()
                },
                sampler: PcfDescriptor::default(),
            };
            let name = kind.name.into();
            let shadow = Shadow::new(gpu, &place.stage.renderer, Technique { name, config })?;
            return Ok(Self::Map(Box::new(shadow)));
        }
        if kind.is_map {
            let atlas = ShadowAtlas::new(&gpu.device, &ShadowAtlasDescriptor::default())?;
            return Ok(Self::Atlas(Box::new(atlas)));
        }
        let descriptor = ShadowVolumeDescriptor {
            depth_stencil_format: place.stage.renderer.depth_stencil_format(),
            ..Default::default()
        };
        let volumes = ShadowVolumeRenderer::new(&gpu.device, &descriptor)?;
        Ok(Self::Volumes(Box::new(volumes)))
    }

    fn prepare(&mut self, gpu: &Gpu, place: &Place, inputs: &ShadowInputs) -> Result<()> {
        match self {
            Self::Map(shadow) => shadow.prepare(gpu, inputs)?,
            Self::Atlas(atlas) => {
                let size = TileSize::Fixed(place.side);
                let lights = place.lights.iter();
                let lights: Vec<_> = lights
                    .map(|&light| AtlasLight::new(light).with_size(size))
                    .collect();
                let frame = AtlasFrame {
                    lights: &lights,
                    casters: &inputs.casters,
                    ..Default::default()
                };
                atlas.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
            Self::Volumes(volumes) => {
                let lights = place.lights.iter().copied();
                let lights: Vec<VolumeLight> = lights.map(VolumeLight::from).collect();
                let frame = ShadowVolumeFrame {
                    lights: &lights,
                    views: &place.views,
                    receivers: Some(inputs.receivers),
                    casters: &inputs.casters,
                };
                volumes.prepare(&gpu.device, &gpu.queue, &frame)?;
            }
        }
        Ok(())
    }

    fn generate(&mut self, place: &Place, encoder: &mut wgpu::CommandEncoder) {
        let renderer = &place.stage.renderer;
        match self {
            Self::Map(shadow) => shadow.generate(renderer, &place.stage.scene_gpu, encoder),
            Self::Atlas(atlas) => atlas.encode(encoder),
            Self::Volumes(volumes) => {
                volumes.encode(encoder);
                // The ground is a square: other views see nearly the depth of the first.
                for light in 0..place.lights.len() {
                    for view in 0..place.views.len() {
                        volumes
                            .render(&mut renderer.begin_stencil_pass(encoder), light, view)
                            .expect("it is encoded");
                    }
                }
            }
        }
    }
}
