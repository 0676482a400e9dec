//! From what was decided to what `encode` records: what has to be found, and what has to be written.

use super::ShadowVolumeRenderer;
use crate::volume::VolumeStatistics;
use crate::volume::decide::decision::words;
use crate::volume::gpu::bind_groups::Parts;
use crate::volume::gpu::buffers::Needs;
use crate::volume::gpu::staged::StagedVolumes;
use crate::volume::gpu::staged_draws::write_draws;
use crate::volume::gpu::staged_meshes::write_meshes;
use crate::volume::plan::work::Work;
use crate::volume::silhouette::Way;

impl ShadowVolumeRenderer {
    /// Lets go what of the last frame cannot be counted on. Whether it was not encoded, and whether
    /// an encoder was dropped.
    pub(super) fn forget(&mut self) -> [bool; 2] {
        let dropped = self.submissions.take_dropped();
        let not_encoded = self.prepared && !self.encoded;
        if dropped {
            self.meshes.forget_all();
        } else if not_encoded {
            self.meshes.forget_last();
        }
        if dropped || !self.keep {
            self.cache.forget_all();
            self.renew();
        } else if not_encoded && self.waits {
            self.cache.forget_last();
            self.renew();
        }
        self.uploads.clear();
        [not_encoded && self.statistics.draws > 0, dropped]
    }

    /// Has everything written again.
    pub(super) fn renew(&mut self) {
        self.renewed = true;
    }

    /// Finds a place for everything that is new, and on the CPU what is found there.
    pub(super) fn find(&mut self) -> StagedVolumes {
        let mut staged = StagedVolumes::default();
        self.meshes.begin();
        let mut by_compute = Vec::new();
        for number in self.cache.take_wanted(&self.limits) {
            let Some(slot) = self.cache.get(number) else {
                continue;
            };
            let mesh = slot.mesh.clone();
            let mesh_place = self.meshes.place(&mesh, slot.way);
            match (slot.way, mesh.data()) {
                (Way::Cpu, Some(data)) => {
                    let counts = self.on_cpu.extract(data, mesh.kind(), &slot.instance);
                    self.cache.place_found(number, counts, mesh_place);
                    if let Some(slot) = self.cache.get(number) {
                        staged.add(&mut self.uploads, &self.on_cpu, data, slot);
                    }
                }
                (way, _) => {
                    self.cache.place(number, words(&mesh, way), mesh_place);
                    by_compute.extend((way == Way::Compute).then_some(number));
                }
            }
        }
        self.work = Work::of(&by_compute, &self.cache, self.limits.workgroups);
        staged
    }

    /// Has written what changed, and brings the bind groups up to date.
    pub(super) fn upload(&mut self, device: &wgpu::Device, staged: StagedVolumes, touched: &[u32]) {
        self.waits = false;
        if self.volumes.pairs().all(|pair| pair.draws.is_empty()) {
            return;
        }
        if std::mem::take(&mut self.renewed) {
            self.volumes.windows.renew(&self.cache);
            self.buffers.renew();
        }
        let changed = self.volumes.windows.take_changed();
        let needs = Needs {
            windows: &self.volumes.windows,
            views: &self.views,
            lights: &self.lights,
            work: &self.work,
            cache: &self.cache,
            meshes: &self.meshes,
            merged: &self.volumes.merged,
        };
        let (uploads, limits) = (&mut self.uploads, &self.limits);
        self.buffers.reserve(device, uploads, &needs, limits);
        self.buffers.write(uploads, &needs, &changed, limits);
        write_meshes(device, uploads, (&self.meshes, &self.buffers), limits);
        staged.write(uploads, &self.buffers);
        write_draws(uploads, &self.volumes.merged, touched, &self.buffers);
        self.waits = uploads.is_waiting() || !self.work.is_empty();
        let parts = Parts {
            device: &self.device,
            label: &self.label,
            buffers: &self.buffers,
            pipelines: &self.pipelines,
        };
        let keys = self.volumes.pairs().flat_map(|pair| pair.draws.keys());
        self.groups.update(keys, &self.work, &self.cache, &parts);
    }

    pub(super) fn count(&self) -> VolumeStatistics {
        let found = self.cache.last_found().iter();
        let searched = found.filter_map(|&number| self.cache.get(number));
        let searched = searched.filter(|slot| slot.way != Way::Vertex);
        let mut statistics = VolumeStatistics {
            casters_extracted: searched.count() as u32,
            dispatches: self.work.dispatches().count() as u32,
            uploaded: self.uploads.bytes(),
            gpu_bytes: self.buffers.bytes(),
            ..Default::default()
        };
        for pair in self.volumes.pairs() {
            statistics.draws += pair.draws.len() as u32;
            pair.tally.sum_into(&mut statistics);
        }
        statistics
    }
}
