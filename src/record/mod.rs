//! What a frame records into the host's encoder.

mod submission;
mod uploads;

pub(crate) use submission::Submissions;
pub(crate) use uploads::{Copy, Stream, Uploads};
