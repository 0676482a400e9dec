//! The GPU memory of the renderer: grown when a frame needs more, kept between frames.

use crate::uploads::Uploads;
use crate::volume::gpu::grown::{Grower, Grown, spread};
use crate::volume::multiview::Multiview;
use crate::volume::plan::cache::VolumeCache;
use crate::volume::plan::limits::PlanLimits;
use crate::volume::plan::merged::{BLOCK_BYTES, DRAW_BYTES, Member, MergedDraws};
use crate::volume::plan::meshes::{self, ITEM_BYTES, LISTS, MeshPool};
use crate::volume::plan::params::{
    Arguments, BatchParams, CasterParams, InstanceParams, LightParams, ViewParams,
};
use crate::volume::plan::ranges;
use crate::volume::plan::seats::SEATS_OF_CASTER;
use crate::volume::plan::windows::Windows;
use crate::volume::plan::work::{Merge, Share, Work};
use crate::volume::silhouette::{Way, Ways};

/// All buffers.
#[derive(Debug)]
pub(crate) struct Buffers {
    label: String,
    batches: Grown,
    instances: Grown,
    arguments: Grown,
    shares: Grown,
    merges: Grown,
    casters: Grown,
    views: Grown,
    lights: Grown,
    chunks: Vec<[Grown; 3]>,
    /// Positions, triangles, edges and uses of edges of meshes.
    pools: Vec<[Grown; LISTS]>,
    /// Casters, blocks and arguments of draws.
    merged: Vec<[Grown; 3]>,
    /// Grows by one whenever a buffer was made anew: bind groups of before are then stale.
    generation: u64,
}

/// What a frame has to have in its buffers.
pub(crate) struct Needs<'a> {
    pub windows: &'a Windows,
    /// The cameras of all views, a window after the other.
    pub views: &'a [ViewParams],
    pub lights: &'a [LightParams],
    pub work: &'a Work,
    pub cache: &'a VolumeCache,
    pub meshes: &'a MeshPool,
    pub merged: &'a MergedDraws,
}

/// The buffers that compute shaders read and write, besides a chunk's.
pub(crate) struct Bound<'a> {
    pub batches: &'a wgpu::Buffer,
    pub instances: &'a wgpu::Buffer,
    pub arguments: &'a wgpu::Buffer,
    pub shares: &'a wgpu::Buffer,
    pub merges: &'a wgpu::Buffer,
}

impl Buffers {
    /// `ways`: in which silhouettes may be found.
    pub fn new(label: &str, ways: &Ways) -> Self {
        use wgpu::BufferUsages as U;
        // The vertex way needs no storage buffers, and other ways no caster by itself.
        let casters = match ways.contain(Way::Vertex) {
            true => U::UNIFORM,
            false => U::STORAGE,
        };
        let name = |what: &str| format!("{label} {what}");
        Self {
            label: label.to_owned(),
            batches: Grown::new(name("batches"), U::UNIFORM | U::COPY_DST),
            instances: Grown::new(name("instances"), U::STORAGE | U::COPY_DST),
            arguments: Grown::keeping(name("arguments"), U::STORAGE | U::INDIRECT),
            shares: Grown::new(name("shares"), U::STORAGE | U::COPY_DST),
            merges: Grown::new(name("merges"), U::STORAGE | U::COPY_DST),
            casters: Grown::keeping(name("casters"), casters),
            views: Grown::keeping(name("views"), U::UNIFORM),
            lights: Grown::keeping(name("lights"), U::UNIFORM),
            chunks: Vec::new(),
            pools: Vec::new(),
            merged: Vec::new(),
            generation: 0,
        }
    }

    /// Makes room for a frame. Bind groups of before are stale if the
    /// [`generation`](Self::generation) changes.
    pub fn reserve(
        &mut self,
        device: &wgpu::Device,
        uploads: &mut Uploads,
        needs: &Needs<'_>,
        limits: &PlanLimits,
    ) {
        let (most, storage) = (limits.buffer_bytes, limits.storage_bytes);
        let mut grower = Grower {
            device,
            uploads,
            made: false,
        };
        let mut grow = |grown: &mut Grown, count: usize, each: u64, most: u64| {
            grower.grow(grown, count as u64 * each, most);
        };
        let windows = limits.caster_window.into();
        let of_casters = limits.caster_bytes;
        grow(&mut self.casters, needs.windows.len(), windows, of_casters);
        let [views, lights] = [needs.views.len() / limits.cameras, needs.lights.len()];
        grow(&mut self.views, views, limits.view_window.into(), most);
        grow(&mut self.lights, lights, limits.light_window.into(), most);
        let work = needs.work;
        if !work.is_empty() {
            let batch = limits.batch_window.into();
            grow(&mut self.batches, work.dispatches().count(), batch, most);
            let instance = size_of::<InstanceParams>() as u64;
            grow(&mut self.instances, work.instances.len(), instance, storage);
            let share = size_of::<Share>() as u64;
            grow(&mut self.shares, work.shares.len(), share, storage);
            let merge = size_of::<Merge>() as u64;
            grow(&mut self.merges, work.merges.len(), merge, storage);
            let arguments = size_of::<Arguments>() as u64;
            grow(
                &mut self.arguments,
                needs.cache.arguments(),
                arguments,
                storage,
            );
        }
        for (place, words) in needs.cache.regions().ends().enumerate() {
            if place == self.chunks.len() {
                self.chunks.push(chunk(&self.label, place));
            }
            for (grown, words) in self.chunks[place].iter_mut().zip(words) {
                grower.grow(grown, words * 4, storage);
            }
        }
        for (place, items) in needs.meshes.ends().enumerate() {
            if place == self.pools.len() {
                self.pools.push(pool(&self.label, place));
            }
            for (list, grown) in self.pools[place].iter_mut().enumerate() {
                grower.grow(grown, items[list] * ITEM_BYTES[list], storage);
            }
        }
        for (place, items) in needs.merged.ends().enumerate() {
            if place == self.merged.len() {
                self.merged.push(merged(&self.label, place));
            }
            let each = [size_of::<Member>() as u64, BLOCK_BYTES, DRAW_BYTES];
            let lists = self.merged[place].iter_mut().zip(items).zip(each);
            for ((grown, items), each) in lists.filter(|((_, items), _)| *items > 0) {
                grower.grow(grown, items * each, storage);
            }
        }
        self.generation += u64::from(grower.made);
    }

    /// Has the windows written that changed, and what extraction needs. There is room for it.
    pub fn write(
        &mut self,
        uploads: &mut Uploads,
        needs: &Needs<'_>,
        changed: &[u32],
        limits: &PlanLimits,
    ) {
        if let Some(casters) = self.casters.buffer.as_ref() {
            let params = |number: u32| needs.windows.get(number).map(|window| window.params);
            for run in changed.chunk_by(|a, b| a + 1 == *b) {
                let params: Vec<CasterParams> = run.iter().filter_map(|n| params(*n)).collect();
                let offset = u64::from(run[0]) * u64::from(limits.caster_window);
                uploads.write(casters, offset, &spread(&params, limits.caster_window));
            }
        }
        let (views, lights) = ((needs.views, limits.cameras), (needs.lights, 1));
        self.views.write_changed(uploads, views, limits.view_window);
        self.lights
            .write_changed(uploads, lights, limits.light_window);
        self.write_work(uploads, needs.work, limits);
    }

    /// Has views and lights written again, whatever was written before.
    pub fn renew(&mut self) {
        self.views.renew();
        self.lights.renew();
    }

    fn write_work(&self, uploads: &mut Uploads, work: &Work, limits: &PlanLimits) {
        let Some(bound) = self.bound().filter(|_| !work.is_empty()) else {
            return;
        };
        let params = work.dispatches().map(|dispatch| BatchParams {
            first_item: dispatch.first_item,
            zero: 0,
            padding: [0; 2],
        });
        let params: Vec<BatchParams> = params.collect();
        uploads.write(bound.batches, 0, &spread(&params, limits.batch_window));
        uploads.write(bound.instances, 0, bytemuck::cast_slice(&work.instances));
        uploads.write(bound.shares, 0, bytemuck::cast_slice(&work.shares));
        uploads.write(bound.merges, 0, bytemuck::cast_slice(&work.merges));
        let mut rest = &work.arguments[..];
        while let Some(&(first, _)) = rest.first() {
            let follows = |(at, (number, _)): (u32, &(u32, Arguments))| *number == first + at;
            let run = (0..).zip(rest).take_while(|&pair| follows(pair)).count();
            let (now, later) = rest.split_at(run);
            let arguments: Vec<Arguments> = now.iter().map(|(_, own)| *own).collect();
            let offset = u64::from(first) * size_of::<Arguments>() as u64;
            uploads.write(bound.arguments, offset, bytemuck::cast_slice(&arguments));
            rest = later;
        }
    }

    /// Counts the times a buffer was made.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The buffers of compute shaders, once there was work for them.
    pub fn bound(&self) -> Option<Bound<'_>> {
        Some(Bound {
            batches: self.batches.buffer.as_ref()?,
            instances: self.instances.buffer.as_ref()?,
            arguments: self.arguments.buffer.as_ref()?,
            shares: self.shares.buffer.as_ref()?,
            merges: self.merges.buffer.as_ref()?,
        })
    }

    /// The parameters of views, lights and casters, once there are any.
    pub fn uniforms(&self) -> Option<[&wgpu::Buffer; 3]> {
        Some([
            self.views.buffer.as_ref()?,
            self.lights.buffer.as_ref()?,
            self.casters.buffer.as_ref()?,
        ])
    }

    /// Casters, blocks and arguments of a chunk of draws, as far as any draw has them.
    pub fn merged(&self, chunk: usize) -> Option<[Option<&wgpu::Buffer>; 3]> {
        let lists = self.merged.get(chunk)?;
        Some(lists.each_ref().map(|grown| grown.buffer.as_ref()))
    }

    /// Facings, caps and sides of a chunk.
    pub fn chunk(&self, chunk: usize) -> Option<[&wgpu::Buffer; 3]> {
        let [facings, caps, sides] = self.chunks.get(chunk)?;
        Some([
            facings.buffer.as_ref()?,
            caps.buffer.as_ref()?,
            sides.buffer.as_ref()?,
        ])
    }

    /// Positions, triangles, edges and uses of edges in a pool of meshes.
    pub fn pool(&self, pool: usize) -> Option<[&wgpu::Buffer; LISTS]> {
        let [positions, triangles, edges, uses] = self.pools.get(pool)?;
        Some([
            positions.buffer.as_ref()?,
            triangles.buffer.as_ref()?,
            edges.buffer.as_ref()?,
            uses.buffer.as_ref()?,
        ])
    }

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        [
            &self.batches,
            &self.instances,
            &self.arguments,
            &self.shares,
            &self.merges,
            &self.casters,
            &self.views,
            &self.lights,
        ]
        .into_iter()
        .chain(self.chunks.iter().flatten())
        .chain(self.pools.iter().flatten())
        .chain(self.merged.iter().flatten())
        .map(Grown::size)
        .sum()
    }
}

fn chunk(label: &str, place: usize) -> [Grown; 3] {
    use wgpu::BufferUsages as U;
    // Facings are read by the pass after the one that writes them. Only caps are read as indices.
    let name = |i: usize| format!("{label} {} {place}", ranges::NAMES[i]);
    [
        Grown::new(name(0), U::STORAGE),
        Grown::keeping(name(1), U::STORAGE | U::INDEX),
        Grown::keeping(name(2), U::STORAGE),
    ]
}

fn merged(label: &str, place: usize) -> [Grown; 3] {
    use wgpu::BufferUsages as U;
    let name = |what: &str| format!("{label} draws {what} {place}");
    [
        Grown::keeping(name("members"), U::STORAGE),
        Grown::keeping(name("blocks"), U::STORAGE | U::VERTEX),
        Grown::keeping(name("arguments"), U::STORAGE | U::INDIRECT),
    ]
}

fn pool(label: &str, place: usize) -> [Grown; LISTS] {
    let name = |what: &str| format!("{label} mesh {what} {place}");
    meshes::NAMES.map(|what| Grown::keeping(name(what), wgpu::BufferUsages::STORAGE))
}

/// Bytes from one uniform window to the next.
pub(crate) fn window<T>(limits: &wgpu::Limits) -> u32 {
    window_of::<T>(1, limits)
}

/// The same of windows that hold so many.
fn window_of<T>(each: usize, limits: &wgpu::Limits) -> u32 {
    ((each * size_of::<T>()) as u32).next_multiple_of(limits.min_uniform_buffer_offset_alignment)
}

impl PlanLimits {
    /// What the device's limits allow to those who look for silhouettes in these ways.
    pub fn of(limits: &wgpu::Limits, ways: &Ways, multiview: Multiview) -> Self {
        let storage_bytes = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
        // Dynamic offsets are 32 bits wide.
        let uniform_bytes = limits.max_buffer_size.min(u64::from(u32::MAX));
        let of_compute = [
            uniform_bytes / u64::from(window::<BatchParams>(limits)),
            storage_bytes / size_of::<InstanceParams>() as u64,
            storage_bytes / size_of::<Arguments>() as u64,
            // One of each pass at least.
            storage_bytes / (2 * size_of::<Share>() as u64),
            // If none of its faces shares a draw.
            storage_bytes / (SEATS_OF_CASTER * size_of::<Merge>() as u64),
        ];
        let of_compute = of_compute
            .into_iter()
            .filter(|_| ways.contain(Way::Compute));
        let (caster_window, caster_bytes) = match ways.contain(Way::Vertex) {
            true => (window::<CasterParams>(limits), limits.max_buffer_size),
            false => (size_of::<CasterParams>() as u32, storage_bytes),
        };
        // Dynamic offsets are 32 bits wide.
        let windows = caster_bytes.min(u64::from(u32::MAX)) / u64::from(caster_window);
        let casters = of_compute.fold(windows, u64::min);
        Self {
            buffer_bytes: limits.max_buffer_size,
            storage_bytes,
            caster_bytes,
            casters: usize::try_from(casters).unwrap_or(usize::MAX),
            workgroups: limits.max_compute_workgroups_per_dimension,
            caster_window,
            cameras: multiview.cameras(),
            view_window: window_of::<ViewParams>(multiview.cameras(), limits),
            light_window: window::<LightParams>(limits),
            batch_window: window::<BatchParams>(limits),
        }
    }
}
