//! Whether what was recorded into an encoder came to the queue.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Counts the encoders that were dropped with what was recorded into them. Of one that is neither
/// submitted nor dropped nothing is known, and it counts as submitted.
#[derive(Debug, Default)]
pub(crate) struct Submissions {
    dropped: Arc<AtomicU32>,
    /// How many of them were told already.
    told: u32,
}

/// Goes with an encoder: called when its work is done, and only dropped if it never was submitted.
struct Watch {
    dropped: Arc<AtomicU32>,
    done: bool,
}

impl Watch {
    fn finish(mut self) {
        self.done = true;
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if !self.done {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Submissions {
    /// Watches an encoder.
    pub fn watch(&self, encoder: &wgpu::CommandEncoder) {
        let watch = Watch {
            dropped: Arc::clone(&self.dropped),
            done: false,
        };
        encoder.on_submitted_work_done(move || watch.finish());
    }

    /// Whether an encoder was dropped that [`forgive`](Self::forgive) does not know of.
    pub fn is_one_lost(&self) -> bool {
        self.dropped.load(Ordering::Relaxed) != self.told
    }

    /// The same, once for each.
    pub fn forgive(&mut self) -> bool {
        let dropped = self.dropped.load(Ordering::Relaxed);
        std::mem::replace(&mut self.told, dropped) != dropped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dropped_encoder_is_told_from_one_that_was_submitted() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let mut submissions = Submissions::default();
        let encoder = || device.create_command_encoder(&Default::default());

        let submitted = encoder();
        submissions.watch(&submitted);
        let commands = submitted.finish();
        assert!(!submissions.is_one_lost());
        queue.submit([commands]);
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
        assert!(!submissions.is_one_lost());

        let dropped = encoder();
        submissions.watch(&dropped);
        drop(dropped);
        assert!(submissions.is_one_lost());
        assert!(submissions.forgive() && !submissions.forgive());

        let finished = encoder();
        submissions.watch(&finished);
        drop(finished.finish());
        assert!(submissions.forgive());
    }
}
