//! `docs/shader-cost.md`.

use std::fmt::Write as _;

use crate::device::Device;
use crate::row::Row;

const HEAD: &str = "# What the shaders cost on a GPU

```sh
cargo bench --bench shader_cost -- --page docs/shader-cost.md
```

Counted, not timed: Mesa's RADV compiles every shader for RDNA2 on its null device, in the same way as wgpu
does on Vulkan (with naga's bounds checks and bounded loops), and the instructions are those of its assembly.
The same Mesa gives the same counts on any machine, so a change by one instruction is detected; CI compares
them with those recorded for its version of Mesa. They do not cover the latency of textures, caches, or
divergence between pixels.

- **VALU**: vector instructions on the path that nearly all pixels take, with loops multiplied by their
  iterations. Code that only runs for pixels at an edge of the map or at a plane's horizon is left out.
- **texture**: texture instructions on the same path; a gather of four texels is one.
- **waves**: how many waves of 32 a SIMD holds at a time (at most 32), according to the vector registers. More
  waves hide more of the textures' latency.

";

const RECEIVERS: &str = "## Receivers

In addition to a Lambert shader with one light and no shadow. *Normal given*: the host passes its geometric
normal, which saves the derivatives. `peer` rows do what other engines' shaders do, in WGSL of our own. For
the errors of all of them, see [speed-vs-error.md](speed-vs-error.md#instructions-against-error).

| | VALU | normal given | texture | VGPRs | waves |
|---|--:|--:|--:|--:|--:|
";

const STAGES: &str = "
## Casters and volumes

Whole stages: a vertex, or for `facing` a triangle and for `edges` an edge. `peer/depth-only` is a plain
depth shader with a transform for each instance.

| | VALU | memory | VGPRs | waves |
|---|--:|--:|--:|--:|
";

const LOOPS: &str = "
## Disks, taken apart

| | set-up | search, a tap | a pair of taps | pairs |
|---|--:|--:|--:|--:|
";

const STEPS: &str = "
## What made receivers on cubes cheaper, step by step

VALU of `cube` with derivatives, on Mesa 22.3.6, in the order in which it was done. Errors against ray casting
stayed within a hundredth of what they were (`compare`, two scenes), without one in the interior.

| | Hard | Bilinear | FourTaps | Weighted3 | Weighted5 | Weighted7 | Vogel, 16 |
|---|--:|--:|--:|--:|--:|--:|--:|
| before | 276 | 261 | 392 | 410 | 642 | 1040 | 1347 |
| normals keep their length and sign, faces by selection, the plane as its depth at the receiver and a slope a texel, the step of the format added once, weights by rows, bounds tested once a kernel; Hard and disks snap directions on three axes; doubt of derivatives compared squared | 121 | 169 | 257 | 263 | 396 | 583 | 862 |
| a texel beyond the horizon is mirrored for Hard, too | 122 | 169 | 257 | 263 | 396 | 583 | 862 |
| what is the same for all receivers comes from the light's buffer | 113 | 162 | 250 | 256 | 389 | 576 | 855 |
| a face's signs as truth values; taps counted as integers, the layer of offsets carried along | 111 | 160 | 248 | 253 | 388 | 577 | 809 |
| places counted from the middle of the face; the loop for edges keeps fewer values (Bilinear: 24 to 32 waves) | 111 | 161 | 245 | 252 | 382 | 570 | 809 |
| the place between texels by `fract`; nothing divides by 0 at the light | 110 | 157 | 242 | 246 | 379 | 565 | 808 |
| a disk's axes written out, no test for a first batch that there is not | 110 | 157 | 242 | 246 | 379 | 564 | 765 |

Of what derivatives add (38 to 41), 18 are the differences and their cross product; the rest says how far
rounding may have turned it (docs/numerics.md, \"Ulps of positions\"): without, far from the origin all normals
are noise. 8 more, with a given normal too, are the bias in ulps. Tried without success: fewer registers for the
squares of four pairs and more (the compiler takes them to have more gathers in flight), depths worked out
after each gather, the corner carried through the loop for edges.
";

fn is_receiver(row: &Row) -> bool {
    row.name.starts_with("cube") || row.name.starts_with("flat") || is_peer_receiver(row)
}

fn is_peer_receiver(row: &Row) -> bool {
    row.name.starts_with("peer/cube") || row.name.starts_with("peer/flat")
}

pub fn page(rows: &[Row], device: &Device) -> String {
    let mut page = HEAD.to_owned();
    let _ = writeln!(page, "Here: {}, {}.\n", device.name, device.driver);
    page += RECEIVERS;
    let normal = |row: &Row| {
        let name = format!("{}/normal", row.name);
        rows.iter().find(|row| row.name == name).map(|row| row.valu)
    };
    let receivers = rows
        .iter()
        .filter(|row| is_receiver(row) && !row.name.ends_with("/normal"));
    for row in receivers.clone() {
        let given = normal(row).map_or_else(|| "-".to_owned(), |valu| valu.to_string());
        let _ = writeln!(
            page,
            "| `{}` | {} | {given} | {} | {} | {} |",
            row.name, row.valu, row.texture, row.vgprs, row.waves
        );
    }
    page += LOOPS;
    for row in receivers.filter(|row| row.loops.iter().any(|l| l.trips > 0)) {
        page += &disk(row);
    }
    page += STAGES;
    for row in rows.iter().filter(|row| !is_receiver(row)) {
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {} | {} |",
            row.name, row.valu, row.memory, row.vgprs, row.waves
        );
    }
    page + STEPS
}

/// Set-up and loops of a disk.
fn disk(row: &Row) -> String {
    let in_loops: i64 = row.loops.iter().map(|l| i64::from(l.trips) * l.valu).sum();
    let Some((taps, search)) = row.loops.split_last() else {
        return String::new();
    };
    let search = search
        .first()
        .map_or_else(|| "-".to_owned(), |search| search.valu.to_string());
    format!(
        "| `{}` | {} | {search} | {} | {} |\n",
        row.name,
        row.valu - in_loops,
        taps.valu,
        taps.trips
    )
}
