//! Pipelines shared by any number of renderers.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::DepthConvention;
use crate::error::ShadowVolumeError;
use crate::volume::ShadowVolumeDescriptor;
use crate::volume::gpu::counter::Counter;
use crate::volume::gpu::draw_pipelines::{DrawPipelines, Feed};
use crate::volume::gpu::reset;
use crate::volume::multiview::Multiview;
use crate::volume::silhouette::{Extraction, Way, Ways};

/// The compiled shaders of shadow volumes, created once and shared by any number of
/// [`ShadowVolumeRenderer`](crate::ShadowVolumeRenderer)s (clones are the same set). A renderer compiles nothing if an
/// earlier one had the same descriptor.
///
/// What a pipeline depends on is the descriptor's pass (formats, samples, multiview mask, depth convention,
/// counter), `cap_bias_ulps`, whether volumes may start from away-facing triangles, and where
/// silhouettes are found; not its label, method, caps, extrusion or culling.
///
/// ```
/// # use shadows::{wgpu, *};
/// # fn main() -> Result<(), error::ShadowVolumeError> {
/// # let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
/// #     required_features: wgpu::Features::DEPTH32FLOAT_STENCIL8, ..Default::default()
/// # });
/// let pipelines = VolumePipelines::new(&device, None);
/// let descriptor = ShadowVolumeDescriptor::default();
/// pipelines.warm_up(&descriptor)?; // while a level is loaded, say; on any thread
/// let first = ShadowVolumeRenderer::with_pipelines(&pipelines, &descriptor)?;
/// let second = ShadowVolumeRenderer::with_pipelines(&pipelines, &descriptor)?;
/// # let _ = (first, second);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct VolumePipelines {
    device: wgpu::Device,
    cache: Option<wgpu::PipelineCache>,
    compiled: Arc<Mutex<Compiled>>,
}

/// What there is so far.
#[derive(Debug, Default)]
struct Compiled {
    extraction: Option<Extraction>,
    draws: Vec<(Kind, DrawPipelines)>,
    resets: Vec<(Kind, wgpu::RenderPipeline)>,
}

/// What pipelines of all faces have in common.
#[derive(Clone, Debug, PartialEq)]
struct Kind {
    depth_stencil_format: wgpu::TextureFormat,
    sample_count: u32,
    multiview: Multiview,
    depth: DepthConvention,
    color_formats: Vec<Option<wgpu::TextureFormat>>,
    cap_bias_ulps: u32,
    counter: Counter,
    feed: Feed,
}

/// The pipelines of one renderer.
#[derive(Debug)]
pub(crate) struct OwnPipelines {
    pub extraction: Option<Extraction>,
    /// They read the lists of an extraction.
    pub pulled: Option<DrawPipelines>,
    /// They are fed all triangles and edges.
    pub fed: Option<DrawPipelines>,
    /// Sets counts back to 0.
    pub reset: wgpu::RenderPipeline,
    /// What all of them draw into.
    pub multiview: Multiview,
}

impl VolumePipelines {
    /// An empty set. Pipelines are compiled when renderers are created, or by [`warm_up`](Self::warm_up).
    ///
    /// `cache`: the host's pipeline cache, which may hold pipelines of an earlier run (needs
    /// [`PIPELINE_CACHE`](wgpu::Features::PIPELINE_CACHE)).
    pub fn new(device: &wgpu::Device, cache: Option<&wgpu::PipelineCache>) -> Self {
        Self {
            device: device.clone(),
            cache: cache.cloned(),
            compiled: Arc::default(),
        }
    }

    /// Compiles whatever a renderer with this descriptor needs and no other has needed before.
    ///
    /// # Errors
    /// Those of [`ShadowVolumeRenderer::new`](crate::ShadowVolumeRenderer::new).
    pub fn warm_up(
        &self,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> Result<(), ShadowVolumeError> {
        descriptor.validate(&self.device)?;
        let ways = Ways::new(descriptor.silhouettes, &self.device)?;
        self.take(descriptor, &ways);
        Ok(())
    }

    /// Number of pipelines compiled so far.
    pub fn count(&self) -> usize {
        let compiled = self.lock();
        let extraction = compiled.extraction.as_ref().map_or(0, |_| 3);
        let draws = compiled.draws.iter().map(|(_, draws)| draws.len());
        extraction + draws.sum::<usize>() + compiled.resets.len()
    }

    /// The device that they are compiled for.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// What a renderer of this descriptor needs, which is sound.
    pub(crate) fn take(
        &self,
        descriptor: &ShadowVolumeDescriptor<'_>,
        ways: &Ways,
    ) -> OwnPipelines {
        let mut compiled = self.lock();
        let pulls = ways.contain(Way::Compute) || ways.contain(Way::Cpu);
        OwnPipelines {
            extraction: ways.contain(Way::Compute).then(|| {
                let make = || Extraction::new(&self.device, self.cache.as_ref());
                compiled.extraction.get_or_insert_with(make).clone()
            }),
            pulled: pulls.then(|| self.draws(&mut compiled, descriptor, Feed::Pulled)),
            fed: (ways.contain(Way::Vertex))
                .then(|| self.draws(&mut compiled, descriptor, Feed::Records)),
            reset: self.reset(&mut compiled, descriptor),
            multiview: descriptor.multiview(),
        }
    }

    fn reset(
        &self,
        compiled: &mut Compiled,
        descriptor: &ShadowVolumeDescriptor<'_>,
    ) -> wgpu::RenderPipeline {
        let kind = Kind {
            cap_bias_ulps: 0,
            ..Kind::of(descriptor, Feed::Pulled)
        };
        if let Some((_, known)) = compiled.resets.iter().find(|(known, _)| *known == kind) {
            return known.clone();
        }
        let new = reset::pipeline(&self.device, self.cache.as_ref(), descriptor);
        compiled.resets.push((kind, new.clone()));
        new
    }

    fn draws(
        &self,
        compiled: &mut Compiled,
        descriptor: &ShadowVolumeDescriptor<'_>,
        feed: Feed,
    ) -> DrawPipelines {
        let kind = Kind::of(descriptor, feed);
        let known = compiled.draws.iter().position(|(known, _)| *known == kind);
        let place = known.unwrap_or_else(|| {
            let none = DrawPipelines::new(&self.device, feed, descriptor.multiview());
            compiled.draws.push((kind, none));
            compiled.draws.len() - 1
        });
        let draws = &mut compiled.draws[place].1;
        draws.complete(&self.device, self.cache.as_ref(), descriptor);
        draws.clone()
    }

    /// Whoever panicked while it held the lock left a set that is whole.
    fn lock(&self) -> MutexGuard<'_, Compiled> {
        self.compiled.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kind {
    fn of(descriptor: &ShadowVolumeDescriptor<'_>, feed: Feed) -> Self {
        Self {
            depth_stencil_format: descriptor.depth_stencil_format,
            sample_count: descriptor.sample_count,
            multiview: descriptor.multiview(),
            depth: descriptor.depth,
            color_formats: descriptor.color_formats.to_vec(),
            cap_bias_ulps: descriptor.cap_bias_ulps,
            counter: descriptor.counter,
            feed,
        }
    }
}
