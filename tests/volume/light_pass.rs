//! The guard: light is added to a pixel once, however often its surface is drawn.

use crate::passes::LightPass;
use crate::pictures::{lamp, mixed};
use crate::stage::Stage;
use host::gpu::Gpu;

fn drawn(gpu: &Gpu, times: u32, guarded: bool) -> Vec<u8> {
    let stage = Stage {
        light_pass: LightPass::Scene { times, guarded },
        ..mixed(lamp())
    };
    stage.draw(gpu)
}

#[test]
fn light_is_never_added_twice() {
    let Some(gpu) = Gpu::for_test() else { return };
    let once = drawn(&gpu, 1, true);
    let twice = drawn(&gpu, 2, true);
    assert!(once == twice);
    assert!(once.iter().all(|&value| value == 0 || value == 100));

    let lit: Vec<u8> = once.iter().map(|&v| if v > 0 { 255 } else { 0 }).collect();
    let found = mixed(lamp()).truth().errors(&lit);
    assert!(found.interior > 10_000 && found.wrong == 0, "{found:?}");
}

#[test]
fn without_the_guard_light_is_added_twice() {
    let Some(gpu) = Gpu::for_test() else { return };
    let twice = drawn(&gpu, 2, false);
    assert!(twice.iter().filter(|&&value| value == 200).count() > 10_000);
}
