//! Whether what was recorded came to be submitted.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Learns of encoders that were dropped instead of submitted: what was recorded into them never ran,
/// and what it would have drawn must not be taken for drawn.
#[derive(Debug, Default)]
pub(crate) struct Submissions {
    dropped: Arc<AtomicBool>,
}

impl Submissions {
    /// Watches an encoder that something was recorded into.
    pub fn watch(&self, encoder: &wgpu::CommandEncoder) {
        let recorded = Recorded(Some(Arc::clone(&self.dropped)));
        encoder.on_submitted_work_done(move || recorded.submitted());
    }

    /// Whether [`take_dropped`](Self::take_dropped) would say so.
    pub fn is_dropped(&self) -> bool {
        self.dropped.load(Ordering::Relaxed)
    }

    /// Whether an encoder was dropped since this was last asked.
    pub fn take_dropped(&mut self) -> bool {
        self.dropped.swap(false, Ordering::Relaxed)
    }
}

/// Goes with an encoder and its command buffer: called when their work is done, or dropped with them.
struct Recorded(Option<Arc<AtomicBool>>);

impl Recorded {
    fn submitted(mut self) {
        self.0 = None;
    }
}

impl Drop for Recorded {
    fn drop(&mut self) {
        if let Some(dropped) = &self.0 {
            dropped.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Submissions;

    #[test]
    fn an_encoder_that_is_dropped_is_told_from_one_that_is_submitted() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let encoder = || device.create_command_encoder(&Default::default());
        let mut submissions = Submissions::default();
        let recorded = encoder();
        submissions.watch(&recorded);
        assert!(!submissions.take_dropped(), "not yet");
        queue.submit([recorded.finish()]);
        assert!(!submissions.take_dropped());
        assert!(device.poll(wgpu::PollType::wait_indefinitely()).is_ok());
        assert!(!submissions.take_dropped());
        let recorded = encoder();
        submissions.watch(&recorded);
        drop(recorded);
        assert!(submissions.is_dropped() && submissions.take_dropped());
        assert!(!submissions.take_dropped(), "told once");
        let recorded = encoder();
        submissions.watch(&recorded);
        let commands = recorded.finish();
        assert!(!submissions.take_dropped());
        drop(commands);
        assert!(submissions.take_dropped(), "a command buffer, too");
    }
}
