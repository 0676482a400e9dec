//! The debug views of volumes.

use anyhow::Result;
use shadows::{VolumeDebug, VolumeDebugDescriptor, wgpu};

use crate::clock::Bench;
use crate::stage::Stage;
use crate::volume::Volumes;
use host::renderer::{DEPTH, SHADED};

/// One of the views.
type View = fn(&VolumeDebug, &mut wgpu::RenderPass<'_>, &Volumes<'_>);

pub fn all(bench: &mut Bench<'_>, stage: &Stage<'_>) -> Result<()> {
    let device = &stage.gpu.device;
    let descriptor = VolumeDebugDescriptor {
        color_format: SHADED,
        depth_stencil_format: stage.host.depth_stencil_format(),
        depth: DEPTH,
        ..Default::default()
    };
    let new = |(): &mut ()| VolumeDebug::new(device, &descriptor);
    bench.cpu("debug/VolumeDebug::new", &mut (), |()| {}, new);
    let mut state = (
        VolumeDebug::new(device, &descriptor)?,
        Volumes::new(stage, Default::default())?,
    );
    stage.gpu.run(|encoder| state.1.count(encoder));
    let prepare = |(debug, volumes): &mut (VolumeDebug, Volumes<'_>)| {
        volumes
            .frame()
            .with(|frame| debug.prepare(device, frame, &volumes.renderer, 0, 0))
    };
    bench.cpu("debug/prepare", &mut state, |_| {}, prepare);
    let views: [(&str, View); 4] = [
        ("draw_surfaces", |debug, pass, volumes| {
            debug
                .draw_surfaces(pass, &volumes.renderer, 0, 0)
                .expect("it is prepared");
        }),
        ("draw_edges", |debug, pass, volumes| {
            debug
                .draw_edges(pass, &volumes.renderer, 0, 0)
                .expect("it is prepared");
        }),
        ("draw_counts", |debug, pass, _| {
            debug.draw_counts(pass).expect("it has a stencil");
        }),
        ("draw_casters", |debug, pass, _| debug.draw_casters(pass)),
    ];
    for (name, view) in views {
        let draw = |(debug, volumes): &mut (VolumeDebug, Volumes<'_>), encoder: &mut _| {
            view(debug, &mut stage.host.begin_overlay_pass(encoder), volumes);
        };
        bench.gpu(&format!("debug/{name}"), &mut state, |_| {}, draw);
    }
    Ok(())
}
