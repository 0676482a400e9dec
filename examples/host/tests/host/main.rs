//! The example host: its scenes and its file loader.

mod scene_files;
mod scenes;
mod unwrap;
mod warped;
