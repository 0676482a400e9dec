//! The section of docs/speed-vs-error.md.

use std::fmt::Write as _;

use anyhow::Result;
use serde_json::json;

use super::{Costs, Found, Lit};
use crate::measure::percent;
use host::scene::LightKind;

const HEAD: &str = "## Instructions against error

What a lighting shader pays for a shadow, counted on RDNA2 ([shader-cost.md](shader-cost.md)), against
what it gets wrong. No clock is in it: the counts are the same on any machine, and the errors but for what
drivers round otherwise.

![Instructions and error](cost-vs-error.svg)

`cube/` and `flat/` are this library's kernels, their plane's normal given by the host. `peer/` is **our
rendition** of other engines at their defaults, written anew from their sources and measured like
everything else: our scenes, map sizes and casters, their receiver, bias, projection, near plane, depth
format and the sides that they draw. No engine itself was run. `cube-linear/textbook` is what tutorials
show: distances, one tap, a constant bias of 0.15 m.

![The same shadows, exact and by several receivers](peers.png)

The same corner of `courtyard` with faces of 1024 texels. Above: exact, then this library's 2x2, 2x2 by the
hardware and 3x3; below: the textbook, then our rendition of Bevy's `Hardware2x2` and `Gaussian` and of three.js. Red is false
light, blue false shadow.

| | source | taken | left out |
|---|---|---|---|
| `bevy` | Bevy 0.20.1: `bevy_pbr` (`shadows.wesl`, `shadow_sampling.wesl`, `light.rs`), `bevy_light` | infinite reverse-Z from 0.1 m in 32-bit floats, sides that face the light, depth bias 0.08 m and normal bias 0.6 texels (point), 0.02 m and 1.8 texels (spot, directional), times the root of 2; `Hardware2x2`, and `Gaussian`, its default | cascades: a directional light has one map around the scene; the temporal filter; contact and soft shadows |
| `three` | three.js r187: `shadowmap_pars_fragment.glsl.js`, `WebGLShadowMap.js`, `LightShadow.js` | `PCFShadowMap` at its defaults: no bias, no normal bias, radius 1, far sides, from 0.5 m to the light's end in 24 bits | its flat maps |
| `wgpu-example` | wgpu 30: `wgpu/examples/features/src/shadow` | depth bias 2 steps and 2 slopes when the map is drawn, sides that face the light, standard depth from 1 m to the light's end in 32-bit floats | its light's own place and angle |

An open mesh (the teapot) casts as is better for each: by both sides in `bevy` and `wgpu-example`, as with a
double-sided material, by its far sides in `three`, as with the single-sided one that is the default.
Normals are smoothed as the mesh has them.

- **VALU**, **texture**: instructions, over the same shader without shadow.
- **wrong**: pixels in per cent of those that face the light.
- **lit**, **dark**: interior errors in pixels, which no resolution excuses: light where a shadow is
  (peter-panning, leaks), and shadow where light is (acne).
- **front**: nothing else in the table has as few instructions of both kinds and is as exact in the first
  scene. In the picture these are large, and a line joins what nothing of its group beats in VALU and error.
";

pub fn markdown(costs: &Costs) -> Result<String, std::fmt::Error> {
    let mut out = HEAD.to_owned();
    let [width, height] = costs.size;
    writeln!(
        out,
        "\n*{}; pictures of {width}x{height} pixels, maps of {} texels a side (three.js and the example of \
         wgpu have 512 by default, Bevy 1024 for point lights and 2048 for others).*",
        costs.driver, costs.side
    )?;
    for reason in &costs.left_out {
        writeln!(out, "\nLeft out: {reason}")?;
    }
    for lit in &costs.lit {
        table(&mut out, costs, lit)?;
    }
    Ok(out)
}

fn table(out: &mut String, costs: &Costs, lit: &Lit) -> std::fmt::Result {
    writeln!(out, "\n### {}\n", heading(lit.light))?;
    write!(out, "| | VALU | texture | front |")?;
    for scene in &costs.scenes {
        write!(out, " {scene}: wrong | lit | dark |")?;
    }
    write!(out, "\n|---|--:|--:|:-:|")?;
    for _ in &costs.scenes {
        write!(out, "--:|--:|--:|")?;
    }
    writeln!(out)?;
    let mut rows: Vec<&Found> = lit.found.iter().collect();
    rows.sort_by_key(|found| (found.count.valu, found.count.texture));
    for found in rows {
        let front = match found.is_beaten_by(&lit.found) {
            true => "",
            false => "\u{25cf}",
        };
        let count = found.count;
        write!(
            out,
            "| `{}` | {} | {} | {front} |",
            found.name, count.valu, count.texture
        )?;
        for (scene, error) in found.errors.iter().enumerate() {
            let (wrong, lit) = (found.wrong(scene), error.false_lit_interior);
            write!(
                out,
                " {wrong:.3} % | {lit} | {} |",
                error.false_shadow_interior
            )?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// A kind of light, as a heading.
pub fn heading(light: LightKind) -> &'static str {
    match light {
        LightKind::Point => "Point light, cube maps",
        LightKind::Spot => "Spot, flat maps",
        LightKind::Directional => "Directional light, one flat map",
    }
}

/// The same for programs.
pub fn json(costs: &Costs) -> serde_json::Result<String> {
    let mut rows = Vec::new();
    for lit in &costs.lit {
        for found in &lit.found {
            for (scene, error) in costs.scenes.iter().zip(&found.errors) {
                rows.push(json!({
                    "name": found.name,
                    "light": lit.light.name(),
                    "scene": scene,
                    "valu": found.count.valu,
                    "texture": found.count.texture,
                    "false_lit_percent": percent(error.false_lit, error),
                    "false_shadow_percent": percent(error.false_shadow, error),
                    "false_lit_interior": error.false_lit_interior,
                    "false_shadow_interior": error.false_shadow_interior,
                }));
            }
        }
    }
    Ok(serde_json::to_string_pretty(&rows)? + "\n")
}
