//! What each operation of the library costs, one by one.
//!
//! The name of each says by which clock it is timed:
//! - `cpu`: until the call returns; the device is not waited for. (`reference` uses all cores, the
//!   rest the calling thread.)
//! - `gpu`: GPU work between two timestamps, on a real GPU that has them.
//! - `wall`: GPU work from the first command recorded until the device reports all of it done,
//!   elsewhere: software drivers write timestamps when commands are queued, not when they are done.
//!
//! `cargo bench --bench operations -- volume` runs those with `volume` in their names, `--quick` takes
//! fewer runs. Times here depend on the machine and its load; what is compared is in the other
//! benches, whose `ratio` lines measure both sides in turn.

mod clock;
mod cube;
mod debug;
mod deformed;
mod flat;
mod lights;
mod mesh;
mod pcf;
mod reference;
mod screen;
#[path = "../shared/mod.rs"]
mod shared;
mod stage;
mod view;
mod volume;

use clock::Bench;
use host::gpu::Gpu;
use stage::Stage;

fn main() -> anyhow::Result<()> {
    let Ok(gpu) = Gpu::new(None) else {
        eprintln!("skipped: no adapter");
        return Ok(());
    };
    let mut bench = Bench::new(&gpu);
    println!("adapter {}", host::gpu::describe(&gpu.info));
    println!("GPU work is timed by the clock `{}`", bench.clock());
    let stage = Stage::new(&gpu)?;
    view::all(&mut bench, &stage);
    mesh::all(&mut bench, &gpu)?;
    cube::all(&mut bench, &stage)?;
    lights::all(&mut bench, &stage)?;
    flat::all(&mut bench, &stage)?;
    pcf::all(&mut bench, &stage)?;
    volume::all(&mut bench, &stage)?;
    deformed::all(&mut bench, &stage)?;
    screen::all(&mut bench, &stage)?;
    debug::all(&mut bench, &stage)?;
    reference::all(&mut bench, &stage)?;
    bench.finish();
    Ok(())
}
