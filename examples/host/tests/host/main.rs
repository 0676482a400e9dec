//! The example host: its scenes, its file loader and its clock.

mod scene_files;
mod scenes;
mod timer;
