//! The comparison's GPU clock against the wall.

use std::time::Instant;

use host::gpu::Gpu;
use host::renderer::Renderer;
use host::scene_gpu::SceneGpu;
use host::timer::{Clock, Timer};
use shadows::wgpu;

#[test]
fn timestamps_count_milliseconds() {
    let Some(gpu) = Gpu::for_test() else {
        return;
    };
    let inside = wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    if !gpu.device.features().contains(inside) {
        eprintln!("skipped: no timestamps inside encoders");
        return;
    }
    let timer = Timer::with_timestamps(&gpu, true);
    assert_eq!(timer.clock(), Clock::Gpu);
    let scene = host::scene::spheres();
    let scene_gpu = SceneGpu::new(&gpu, &scene).unwrap();
    let renderer = Renderer::new(&gpu, [1280, 720], &scene, &scene_gpu).unwrap();
    let frames = |count| {
        let start = Instant::now();
        let clocked = gpu.checked(|| {
            timer.time(&gpu, |encoder| {
                for _ in 0..count {
                    renderer.draw_ambient(encoder, &scene_gpu);
                }
            })
        });
        (clocked, start.elapsed().as_secs_f64() * 1e3)
    };
    // The least of several, so that no other load on the machine makes one frame long.
    let one = (0..4).map(|_| frames(1).0).fold(f64::INFINITY, f64::min);
    let (many, wall) = frames(20);
    eprintln!("{one} ms for one frame, {many} ms for twenty, {wall} ms by the wall");
    assert!(many <= wall, "{many} ms in {wall} ms");
    assert!(
        many > 2.0 * one,
        "{many} ms for 20 frames, {one} ms for one"
    );
}
