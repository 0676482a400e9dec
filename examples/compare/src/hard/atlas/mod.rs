//! What an atlas and cascades alone can get wrong: many lights in one texture, over several frames and views.

mod frames;
mod play;
mod resolution;

pub use frames::{Frame, Frames, Lamp, Seen};
pub use play::{Shown, play};
