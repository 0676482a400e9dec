//! The GPU memory of the renderer: grown when a frame needs more, kept between frames.

use crate::uploads::Uploads;
use crate::volume::plan::cache::Kept;
use crate::volume::plan::faces::{Plan, PlanLimits};
use crate::volume::plan::params::{Arguments, BatchParams, CasterParams, InstanceParams};
use crate::volume::plan::ranges::NAMES;
use crate::volume::silhouette::{Way, Ways};

/// A buffer that grows.
#[derive(Debug)]
struct Grown {
    label: String,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
    /// Whether later frames read what this one writes.
    keeps: bool,
}

impl Grown {
    fn new(label: String, usage: wgpu::BufferUsages) -> Self {
        Self {
            label,
            usage,
            buffer: None,
            keeps: false,
        }
    }

    /// One that takes along what it holds when it grows.
    fn keeping(label: String, usage: wgpu::BufferUsages) -> Self {
        use wgpu::BufferUsages as U;
        Self {
            keeps: true,
            ..Self::new(label, usage | U::COPY_SRC | U::COPY_DST)
        }
    }

    fn size(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }
}

/// Makes buffers large enough.
struct Grower<'a> {
    device: &'a wgpu::Device,
    uploads: &'a mut Uploads,
    /// Whether one was made.
    made: bool,
}

impl Grower<'_> {
    /// Room for at least `size` bytes, `most` being the largest buffer that there can be.
    fn grow(&mut self, grown: &mut Grown, size: u64, most: u64) {
        if grown.buffer.is_some() && grown.size() >= size {
            return;
        }
        // A frame that needs a little more than the last should not allocate again.
        let room = size.max(256).next_power_of_two().min(most).max(size);
        let new = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(&grown.label),
            size: room,
            usage: grown.usage,
            mapped_at_creation: false,
        });
        if let Some(old) = grown.buffer.as_ref().filter(|_| grown.keeps) {
            self.uploads.replace(old, &new);
        }
        grown.buffer = Some(new);
        self.made = true;
    }
}

/// All buffers.
#[derive(Debug)]
pub(crate) struct Buffers {
    label: String,
    batches: Grown,
    instances: Grown,
    arguments: Grown,
    casters: Grown,
    chunks: Vec<[Grown; 3]>,
    /// Grows by one whenever a buffer was made anew: bind groups of before are then stale.
    generation: u64,
}

/// The buffers that compute shaders read and write, besides a chunk's.
pub(crate) struct Bound<'a> {
    pub batches: &'a wgpu::Buffer,
    pub instances: &'a wgpu::Buffer,
    pub arguments: &'a wgpu::Buffer,
}

impl Buffers {
    pub fn new(label: &str) -> Self {
        use wgpu::BufferUsages as U;
        let name = |what: &str| format!("{label} {what}");
        Self {
            label: label.to_owned(),
            batches: Grown::new(name("batches"), U::UNIFORM | U::COPY_DST),
            instances: Grown::new(name("instances"), U::STORAGE | U::COPY_DST),
            arguments: Grown::keeping(name("arguments"), U::STORAGE | U::INDIRECT),
            casters: Grown::new(name("casters"), U::UNIFORM | U::COPY_DST),
            chunks: Vec::new(),
            generation: 0,
        }
    }

    /// Makes room for a plan. Bind groups of before are stale if the
    /// [`generation`](Self::generation) changes.
    pub fn reserve(
        &mut self,
        device: &wgpu::Device,
        uploads: &mut Uploads,
        (plan, kept): (&Plan, &Kept),
        limits: &PlanLimits,
    ) {
        let device_limits = device.limits();
        let (most, storage) = (device_limits.max_buffer_size, limits.storage_bytes);
        let mut grower = Grower {
            device,
            uploads,
            made: false,
        };
        let mut grow = |grown: &mut Grown, count: usize, each: u64, most: u64| {
            grower.grow(grown, count as u64 * each, most);
        };
        let caster = window::<CasterParams>(&device_limits);
        grow(&mut self.casters, plan.casters.len(), caster, most);
        if !plan.batches.is_empty() {
            let batch = window::<BatchParams>(&device_limits);
            grow(&mut self.batches, plan.batches.len(), batch, most);
            let instance = size_of::<InstanceParams>() as u64;
            grow(&mut self.instances, plan.instances.len(), instance, storage);
            let arguments = size_of::<Arguments>() as u64;
            grow(&mut self.arguments, kept.len(), arguments, storage);
        }
        for (place, words) in kept.regions().ends().enumerate() {
            if place == self.chunks.len() {
                self.chunks.push(chunk(&self.label, place));
            }
            for (grown, words) in self.chunks[place].iter_mut().zip(words) {
                grower.grow(grown, words * 4, storage);
            }
        }
        self.generation += u64::from(grower.made);
    }

    /// Has everything written but what was extracted. There is room for it.
    pub fn write(&self, device: &wgpu::Device, uploads: &mut Uploads, plan: &Plan) {
        if let Some(casters) = self.casters() {
            uploads.write(casters, 0, &spread(&plan.casters, device));
        }
        let Some(bound) = self.bound().filter(|_| !plan.batches.is_empty()) else {
            return;
        };
        let batches: Vec<BatchParams> = plan.batches.iter().map(|b| b.params).collect();
        uploads.write(bound.batches, 0, &spread(&batches, device));
        uploads.write(bound.instances, 0, bytemuck::cast_slice(&plan.instances));
        let mut rest = &plan.arguments[..];
        while let Some(&(first, _)) = rest.first() {
            let follows = |(at, (slot, _)): (u32, &(u32, Arguments))| *slot == first + at;
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
        })
    }

    /// The parameters of the casters, once there are any.
    pub fn casters(&self) -> Option<&wgpu::Buffer> {
        self.casters.buffer.as_ref()
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

    /// Bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        [
            &self.batches,
            &self.instances,
            &self.arguments,
            &self.casters,
        ]
        .into_iter()
        .chain(self.chunks.iter().flatten())
        .map(Grown::size)
        .sum()
    }
}

fn chunk(label: &str, place: usize) -> [Grown; 3] {
    use wgpu::BufferUsages as U;
    // Facings are read by the pass after the one that writes them. Only caps are read as indices.
    let name = |i: usize| format!("{label} {} {place}", NAMES[i]);
    [
        Grown::new(name(0), U::STORAGE),
        Grown::keeping(name(1), U::STORAGE | U::INDEX),
        Grown::keeping(name(2), U::STORAGE),
    ]
}

/// Bytes from one uniform window to the next.
pub(crate) fn window<T>(limits: &wgpu::Limits) -> u64 {
    (size_of::<T>() as u64).next_multiple_of(u64::from(limits.min_uniform_buffer_offset_alignment))
}

/// Items one window after another.
pub(crate) fn spread<T: bytemuck::NoUninit>(items: &[T], device: &wgpu::Device) -> Vec<u8> {
    let window = window::<T>(&device.limits()) as usize;
    let mut bytes = vec![0; window * items.len()];
    for (target, item) in bytes.chunks_exact_mut(window).zip(items) {
        target[..size_of::<T>()].copy_from_slice(bytemuck::bytes_of(item));
    }
    bytes
}

impl PlanLimits {
    /// What the device's limits allow to those who look for silhouettes in these ways.
    pub fn of(limits: &wgpu::Limits, ways: &Ways) -> Self {
        let storage_bytes = limits
            .max_storage_buffer_binding_size
            .min(limits.max_buffer_size);
        // Dynamic offsets are 32 bits wide.
        let uniform_bytes = limits.max_buffer_size.min(u64::from(u32::MAX));
        let of_compute = [
            uniform_bytes / window::<BatchParams>(limits),
            storage_bytes / size_of::<InstanceParams>() as u64,
            storage_bytes / size_of::<Arguments>() as u64,
        ];
        let of_compute = of_compute
            .into_iter()
            .filter(|_| ways.contain(Way::Compute));
        let casters = of_compute.fold(uniform_bytes / window::<CasterParams>(limits), u64::min);
        Self {
            buffer_bytes: limits.max_buffer_size,
            storage_bytes,
            casters: usize::try_from(casters).unwrap_or(usize::MAX),
            workgroups: limits.max_compute_workgroups_per_dimension,
            caster_window: window::<CasterParams>(limits) as u32,
            batch_window: window::<BatchParams>(limits) as u32,
        }
    }
}
