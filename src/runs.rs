//! Which items of a buffer are written again: in few copies, each of which costs more than a few items do.

use std::ops::Range;

use crate::uploads::Uploads;

/// Items that are rather written again than left out between two that have changed.
const GAP: usize = 16;

/// Places of items that are to be written, in order.
#[derive(Debug, Default)]
pub(crate) struct Runs(Vec<Range<usize>>);

impl Runs {
    /// Adds places behind those added before.
    pub fn add(&mut self, more: Range<usize>) {
        match self
            .0
            .last_mut()
            .filter(|last| more.start <= last.end + GAP)
        {
            Some(last) => last.end = more.end,
            None => self.0.push(more),
        }
    }

    /// Has the items there written into a buffer in which the first item is at `offset`.
    pub fn write<T: bytemuck::NoUninit>(
        self,
        uploads: &mut Uploads,
        (buffer, offset): (&wgpu::Buffer, u64),
        items: &[T],
    ) {
        for run in self.0 {
            let at = offset + (run.start * size_of::<T>()) as u64;
            uploads.write(buffer, at, bytemuck::cast_slice(&items[run]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{GAP, Runs};

    #[test]
    fn what_is_near_is_written_together() {
        let mut runs = Runs::default();
        for place in [3, 4, 5 + GAP, 7 + 2 * GAP, 8 + 2 * GAP] {
            runs.add(place..place + 1);
        }
        runs.add(100..120);
        assert_eq!(runs.0, [3..6 + GAP, 7 + 2 * GAP..9 + 2 * GAP, 100..120]);
    }
}
