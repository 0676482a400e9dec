//! Light maps against exact visibility, at points that know nothing of texels.

mod combined;
mod error;
mod images;
mod input;
mod light;
mod overlap;
mod robust;
mod yard;
