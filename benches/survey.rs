//! What the cheap techniques cost, in one run.
//!
//! - `blob_decals_10000_vs_1000`: so many blobs over a floor at 1280x720, a sun of slope 0.05 and a
//!   reach of 1 m, in one draw: encode and wait for the device. All cover the same part of the picture, so the
//!   fewer are larger.
//! - `planar_draws_10000_vs_1000`: so many boxes in rows onto a floor under a sun, into a stencil of 1280x720;
//!   `planar_soft_10000_vs_1000`: the same from 4 places of the sun into 512x512 texels, and
//!   `projected_10000_vs_1000` into a tile of 1024x1024 and its mips, each with its `prepare`, without a cache.
//! - `..._prepare_kept_vs_moving`: `prepare` alone for 10,000 casters, nothing moving over everything moving.
//!
//! Times are wall time of medians; `--quick` takes fewer rounds.

#[allow(dead_code)] // what other tests need
#[path = "../tests/common/shapes.rs"]
mod shapes;
#[path = "shared/mod.rs"]
mod shared;

#[path = "survey/blob.rs"]
mod blob;
#[path = "survey/planar.rs"]
mod planar;
#[path = "survey/projected.rs"]
mod projected;
#[path = "survey/sides.rs"]
mod sides;

use std::time::Duration;

use host::gpu::Gpu;

fn main() {
    let quick = shared::quick();
    let gpu = match Gpu::new(None) {
        Ok(gpu) => gpu,
        Err(error) => return eprintln!("skipped: {error:#}"),
    };
    println!("adapter {}, clock wall", host::gpu::describe(&gpu.info));
    let [draws, prepares] = if quick { [5, 9] } else { [25, 51] };
    blob::decals(&gpu, draws);
    blob::prepares(&gpu, prepares);
    planar::draws(&gpu, draws);
    planar::soft_draws(&gpu, draws);
    planar::prepares(&gpu, prepares);
    projected::draws(&gpu, draws);
    projected::prepares(&gpu, prepares);
}

fn ratio(name: &str, ours: &[Duration], theirs: &[Duration]) {
    let median = |samples: &[Duration]| 1e3 * shared::median(shared::seconds(samples));
    println!("{name}: {:.3} ms / {:.3} ms", median(ours), median(theirs));
    let ratio = shared::paired(&shared::seconds(ours), &shared::seconds(theirs));
    println!("ratio {name} {ratio:.4}");
}
