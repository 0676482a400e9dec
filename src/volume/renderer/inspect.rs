//! Queries about the last frame of a renderer.

use super::{Drawn, ShadowVolumeRenderer};
use crate::DepthConvention;
use crate::error::VolumeRenderError;
use crate::volume::decide::method::Options;
use crate::volume::gpu::draw_pipelines::Feed;
use crate::volume::plan::count_bound;
use crate::volume::plan::merged::MergedDraw;
use crate::volume::{CasterState, VolumeStatistics};

impl ShadowVolumeRenderer {
    /// Statistics of the last [`prepare`](Self::prepare), for all lights and views together.
    pub fn statistics(&self) -> VolumeStatistics {
        self.statistics
    }

    /// The decision for each caster under one light in one view in the last prepared frame, in the frame's
    /// order. Empty if the frame had no such light or view.
    pub fn caster_states(&self, light: usize, view: usize) -> Vec<CasterState> {
        let Some(pair) = self.volumes.pair(light, view) else {
            return Vec::new();
        };
        let numbers = self.volumes.casters.numbers().iter();
        numbers.filter_map(|&number| pair.state(number)).collect()
    }

    /// What is drawn under a light in a view.
    pub(crate) fn drawn(&self, light: usize, view: usize) -> Result<Drawn<'_>, VolumeRenderError> {
        let [lights, views] = self.volumes.counts();
        let no_such = VolumeRenderError::NoSuch {
            light,
            view,
            lights,
            views,
        };
        Ok(Drawn {
            pair: self.volumes.pair(light, view).ok_or(no_such)?,
            volumes: &self.volumes,
            cache: &self.cache,
            buffers: &self.buffers,
            view: self.views.get(view * self.limits.cameras).ok_or(no_such)?,
            light: self.lights.get(light).ok_or(no_such)?,
        })
    }

    /// The same for what shows one view a pass.
    pub(crate) fn drawn_alone(
        &self,
        light: usize,
        view: usize,
    ) -> Result<Drawn<'_>, VolumeRenderError> {
        match self.pipelines.multiview.0 {
            None => self.drawn(light, view),
            Some(_) => Err(VolumeRenderError::Multiview(
                self.pipelines.multiview.views(),
            )),
        }
    }

    pub(crate) fn depth(&self) -> DepthConvention {
        self.depth
    }

    pub(crate) fn options(&self) -> Options {
        self.options
    }

    /// Sets the bind group that a draw reads, under the light and in the view of this place, if it is
    /// there.
    pub(crate) fn bind_draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        draw: &MergedDraw,
        [light, view]: [usize; 2],
    ) -> bool {
        let (Some(group), Some(caster)) = (self.groups.of_draws(&draw.key), draw.first()) else {
            return false;
        };
        let offsets = [
            view as u32 * self.limits.view_window,
            light as u32 * self.limits.light_window,
            caster * self.limits.caster_window,
        ];
        let uniforms = Feed::of(draw.key.way).uniform_count();
        pass.set_bind_group(0, group, &offsets[..uniforms]);
        true
    }

    /// An upper bound on the number of a light's volumes that contain any point visible in a view, among
    /// those that the last [`prepare`](Self::prepare) draws; 0 if the frame had no such light or view.
    ///
    /// The bound is 1 for a convex caster and grows with the number of silhouette edges that a plane through
    /// the light intersects. Casters add up where their bounding spheres overlap as seen from the light. A
    /// mesh over positions in the host's own buffer counts with all its triangles.
    ///
    /// The first call takes one to two times as long as extracting the volumes on the CPU
    /// ([`Silhouettes::Cpu`](crate::Silhouettes::Cpu)). Each caster's bound is kept with its volume, so if
    /// nothing has moved, only the casters are sorted. On the scenes of the example `compare` the bound is 3
    /// for `spheres`, 17 for `teapot` and 62 for `courtyard`.
    pub fn count_bound(&mut self, light: usize, view: usize) -> u64 {
        let pair = self.volumes.pair(light, view);
        let (Some(pair), Some(light)) = (pair, self.lights.get(light)) else {
            return 0;
        };
        let windows = pair.windows();
        let windows = windows.filter_map(|number| self.volumes.windows.get(number));
        let windows: Vec<_> = windows.collect();
        count_bound::bound(&windows, light, &mut self.cache, &mut self.on_cpu)
    }

    /// Whether the counter could wrap for a light in a view of the last prepared frame, so that a point in
    /// shadow would be lit: [`count_bound`](Self::count_bound) is at least 256, or with
    /// [`Counter::Exact`](crate::Counter::Exact) 2^24.
    ///
    /// `false` is certain. `true` may be a false alarm, because the bound is not the count.
    pub fn may_wrap(&mut self, light: usize, view: usize) -> bool {
        self.count_bound(light, view) >= self.counter.end()
    }
}
