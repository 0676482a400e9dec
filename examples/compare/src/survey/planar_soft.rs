//! Soft shadows on the scene's ground, of a light as large as contact hardening takes it to be.

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use shadows::glam::{DMat4, DVec3, DVec4, Vec3};
use shadows::reference::Interior;
use shadows::{
    ContactHardening, LightShape, PlanarRectangle, PlanarSoftFrame, PlanarSoftShadow,
    PlanarSoftShadowDescriptor, wgpu,
};

use super::SurveyShadow;
use super::planar::{NO_GROUND, light};
use crate::shadow::{Cost, ShadowInputs};
use host::gpu::Gpu;
use host::renderer::{LitPipeline, Renderer, ShadowAccess};
use host::scene_gpu::SceneGpu;

/// Everything that was chosen, by name.
pub fn settings(size: u32, samples: u32) -> Value {
    json!({
        "technique": "planar-soft",
        "texels": size,
        "samples": samples,
        "light_radius": f64::from(radius()),
    })
}

struct PlanarSoft {
    shadow: PlanarSoftShadow,
    size: u32,
    interior: Interior,
}

/// Makes it, and the lit pass that reads it.
///
/// # Errors
/// If the device cannot do it.
pub fn make(
    gpu: &Gpu,
    renderer: &Renderer,
    (size, samples): (u32, u32),
) -> Result<(Box<dyn SurveyShadow>, LitPipeline)> {
    let descriptor = PlanarSoftShadowDescriptor {
        size: [size; 2],
        samples,
        cache: false,
        ..Default::default()
    };
    let shadow = PlanarSoftShadow::new(&gpu.device, &descriptor)?;
    let module = PlanarSoftShadow::wgsl_module(1)
        + "fn host_visibility(at: HostReceiver) -> f32 {
    return shadows_planar_visibility(at.world);
}
";
    let access = ShadowAccess {
        module: Some(&module),
        layout: Some(shadow.bind_group_layout()),
        ..Default::default()
    };
    let lit = renderer.lit_pipeline(gpu, &access);
    let interior = Interior::Screen;
    let made = PlanarSoft {
        shadow,
        size,
        interior,
    };
    Ok((Box::new(made), lit))
}

fn radius() -> f32 {
    ContactHardening::default().light_size
}

impl SurveyShadow for PlanarSoft {
    fn prepare(&mut self, gpu: &Gpu, inputs: &ShadowInputs) -> Result<()> {
        let [corner, width, _, height] = inputs.ground.context(NO_GROUND)?;
        let receiver = PlanarRectangle {
            corner,
            width: width - corner,
            height: height - corner,
        };
        self.interior = interior(inputs, &receiver, self.size);
        let frame = PlanarSoftFrame {
            light: light(inputs),
            shape: LightShape::Sphere { radius: radius() },
            receiver,
            casters: &inputs.casters,
        };
        Ok(self.shadow.prepare(&gpu.device, &gpu.queue, &frame)?)
    }

    fn generate(&mut self, _: &Renderer, _: &SceneGpu, encoder: &mut wgpu::CommandEncoder) {
        self.shadow.encode(encoder);
    }

    fn group(&self) -> Option<&wgpu::BindGroup> {
        Some(self.shadow.bind_group())
    }

    fn cost(&self) -> Cost {
        let taken = self.shadow.statistics();
        Cost {
            bytes: taken.bytes,
            draws: taken.draws.into(),
            triangles: taken.triangles,
        }
    }

    fn interior(&self) -> Interior {
        self.interior
    }
}

/// As far from edges as the widest penumbra and a texel: the texture seen as a map of the light's middle. Where things
/// are as high as the light there is no widest one, and the screen alone decides.
fn interior(inputs: &ShadowInputs, receiver: &PlanarRectangle, size: u32) -> Interior {
    let light = inputs.light.xyzw().as_dvec4();
    let ground = f64::from(receiver.corner.y);
    let plane = DVec4::new(0.0, 1.0, 0.0, -ground);
    let height = plane.dot(light);
    let top = f64::from(inputs.receivers.max.y) - ground;
    let room = height - light.w * top;
    if room <= 0.0 {
        return Interior::Screen;
    }
    // By how much the light's rim moves a shadow, and along the ground more where light comes in low.
    let far = |side: Vec3| side.as_dvec3().length();
    let reach = match light.w {
        0.0 => light.truncate().length() / height,
        _ => (height.powi(2) + far(receiver.width).powi(2)).sqrt() / height,
    };
    let penumbra = f64::from(radius()) * top * reach / room;
    let narrower = far(receiver.width).min(far(receiver.height));
    let texel = narrower / f64::from(size);
    // As wide as what receives: nothing is so far from an edge, and many rays would ask.
    if penumbra >= 0.5 * narrower {
        return Interior::Screen;
    }
    // Blinn's matrix, and the rectangle as clip space.
    let columns = plane.to_array().map(|entry| -light * entry / height);
    let projected = DMat4::IDENTITY + DMat4::from_cols_array_2d(&columns.map(|c| c.to_array()));
    let part = |along: Vec3| {
        let along: DVec3 = along.as_dvec3() / along.as_dvec3().length_squared();
        along.extend(-along.dot(receiver.corner.as_dvec3()))
    };
    let (across, down, one) = (part(receiver.width), part(receiver.height), DVec4::W);
    let rows = DMat4::from_cols(2.0 * across - one, one - 2.0 * down, 0.5 * one, one);
    Interior::FlatMap {
        clip_from_world: (rows.transpose() * projected).as_mat4(),
        size,
        kernel_radius: (penumbra / texel) as f32 + 1.0,
    }
}
