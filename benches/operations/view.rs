//! What a host is asked once, and the camera.

use std::hint::black_box;

use shadows::glam::DVec3;
use shadows::mesh::Bounds;
use shadows::{Support, View, wgpu};

use crate::clock::Bench;
use crate::shared::torus::torus;
use crate::stage::Stage;

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    if let Some(adapter) = adapters.first() {
        bench.plain("host/Support::of_adapter", || Support::of_adapter(adapter));
    }
    let (matrix, depth) = (stage.view.clip_from_world(), stage.view.depth());
    bench.plain("host/View::new", || View::new(black_box(matrix), depth));
    let (exact, origin) = (matrix.as_dmat4(), DVec3::new(1e6, 0.0, 1e6));
    bench.plain("host/View::placed", || {
        View::placed(black_box(exact), origin, depth)
    });
    let (positions, _) = torus(500, 100);
    bench.plain("host/Bounds::of_points, 50,000", || {
        Bounds::of_points(positions.iter().map(|&position| position.into()))
    });
}
