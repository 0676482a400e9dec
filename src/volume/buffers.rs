//! The GPU memory of the renderer: grown when a frame needs more, kept between frames.

use super::params::{Arguments, BatchParams, CasterParams, InstanceParams};
use super::plan::{Plan, PlanLimits};
use super::regions::NAMES;
use super::silhouette::{Way, Ways};

/// Tests read what was extracted.
const READ_BACK: wgpu::BufferUsages = match cfg!(test) {
    true => wgpu::BufferUsages::COPY_SRC,
    false => wgpu::BufferUsages::empty(),
};

/// A buffer that grows.
#[derive(Debug)]
struct Grown {
    label: String,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl Grown {
    fn new(label: String, usage: wgpu::BufferUsages) -> Self {
        Self {
            label,
            usage,
            buffer: None,
        }
    }

    /// The buffer, with room for at least `size` bytes; `made` is set if it had to be made anew.
    fn get(
        &mut self,
        device: &wgpu::Device,
        size: u64,
        most: u64,
        made: &mut bool,
    ) -> &wgpu::Buffer {
        // A frame that needs a little more than the last should not allocate again.
        let room = size.max(256).next_power_of_two().min(most).max(size);
        let kept = self.buffer.take().filter(|buffer| buffer.size() >= size);
        *made |= kept.is_none();
        self.buffer.insert(kept.unwrap_or_else(|| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(&self.label),
                size: room,
                usage: self.usage,
                mapped_at_creation: false,
            })
        }))
    }

    fn size(&self) -> u64 {
        self.buffer.as_ref().map_or(0, wgpu::Buffer::size)
    }
}

/// All buffers.
#[derive(Debug)]
pub(super) struct Buffers {
    label: String,
    batches: Grown,
    instances: Grown,
    template: Grown,
    arguments: Grown,
    casters: Grown,
    chunks: Vec<[Grown; 3]>,
    /// Grows by one whenever a buffer was made anew: bind groups of before are then stale.
    generation: u64,
}

/// The buffers that compute shaders read and write, besides a chunk's.
pub(super) struct Bound<'a> {
    pub batches: &'a wgpu::Buffer,
    pub instances: &'a wgpu::Buffer,
    pub template: &'a wgpu::Buffer,
    pub arguments: &'a wgpu::Buffer,
}

impl Buffers {
    pub fn new(label: &str) -> Self {
        use wgpu::BufferUsages as U;
        let grown = |what: &str, usage| Grown::new(format!("{label} {what}"), usage);
        Self {
            label: label.to_owned(),
            batches: grown("batches", U::UNIFORM | U::COPY_DST),
            instances: grown("instances", U::STORAGE | U::COPY_DST),
            template: grown("argument template", U::COPY_SRC | U::COPY_DST),
            arguments: grown(
                "arguments",
                U::STORAGE | U::INDIRECT | U::COPY_DST | READ_BACK,
            ),
            casters: grown("casters", U::UNIFORM | U::COPY_DST),
            chunks: Vec::new(),
            generation: 0,
        }
    }

    /// Makes room for a plan. What was extracted before is lost if the
    /// [`generation`](Self::generation) changes.
    pub fn reserve(&mut self, device: &wgpu::Device, plan: &Plan, limits: &PlanLimits) {
        let mut made = false;
        let most = device.limits().max_buffer_size;
        let storage = limits.storage_bytes;
        let mut get = |grown: &mut Grown, count: usize, each: u64, most: u64| {
            grown.get(device, count as u64 * each, most, &mut made);
        };
        // Those out of view, too: what comes into view must not move what is there.
        let count = plan.slots.len();
        let caster = window::<CasterParams>(&device.limits());
        get(&mut self.casters, count, caster, most);
        if plan.uses(Way::Compute) {
            // There are at most as many batches as casters. How many there are depends on what is
            // kept, and must not decide whether it can be.
            get(
                &mut self.batches,
                count,
                window::<BatchParams>(&device.limits()),
                most,
            );
            get(
                &mut self.instances,
                count,
                size_of::<InstanceParams>() as u64,
                storage,
            );
            let arguments = size_of::<Arguments>() as u64;
            get(&mut self.template, count, arguments, most);
            get(&mut self.arguments, count, arguments, storage);
        }
        // Nothing is listed where vertex shaders do all the work, and there may be no storage.
        let listed = plan.uses(Way::Compute) || plan.uses(Way::Cpu);
        while listed && self.chunks.len() < plan.chunks.len() {
            self.chunks.push(chunk(&self.label, self.chunks.len()));
        }
        for (chunk, words) in self.chunks.iter_mut().zip(&plan.chunks) {
            for (grown, words) in chunk.iter_mut().zip(words) {
                grown.get(device, words * 4, limits.storage_bytes, &mut made);
            }
        }
        self.generation += u64::from(made);
    }

    /// Uploads a plan for which there is room.
    pub fn upload(&self, device: &wgpu::Device, queue: &wgpu::Queue, plan: &Plan) {
        if let Some(casters) = self.casters() {
            queue.write_buffer(casters, 0, &spread(&plan.casters, device));
        }
        if let Some(bound) = self.bound()
            && plan.stale().next().is_some()
        {
            let batches: Vec<BatchParams> = plan.batches.iter().map(|b| b.params).collect();
            queue.write_buffer(bound.batches, 0, &spread(&batches, device));
            queue.write_buffer(bound.instances, 0, bytemuck::cast_slice(&plan.instances));
            queue.write_buffer(bound.template, 0, bytemuck::cast_slice(&plan.arguments));
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
            template: self.template.buffer.as_ref()?,
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
            &self.template,
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
    // Only caps are read as indices. The CPU may write caps and sides.
    let list = U::STORAGE | U::COPY_DST | READ_BACK;
    let usages = [U::STORAGE, list | U::INDEX, list];
    std::array::from_fn(|i| Grown::new(format!("{label} {} {place}", NAMES[i]), usages[i]))
}

/// Bytes from one uniform window to the next.
pub(super) fn window<T>(limits: &wgpu::Limits) -> u64 {
    (size_of::<T>() as u64).next_multiple_of(u64::from(limits.min_uniform_buffer_offset_alignment))
}

/// Items one window after another.
pub(super) fn spread<T: bytemuck::NoUninit>(items: &[T], device: &wgpu::Device) -> Vec<u8> {
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
        }
    }
}
