//! The WGSL of a kernel on a kind of map: the files that it takes, and the function that hosts call.

use super::Kernel;
use super::map_kind::MapWgsl;

const SQUARE: &str = include_str!("../../shaders/pcf_square.wgsl");
const RANDOM_DISK: &str = include_str!("../../shaders/pcf_random_disk.wgsl");
const VOGEL: &str = include_str!("../../shaders/pcf_vogel.wgsl");
const CONTACT: &str = include_str!("../../shaders/pcf_contact.wgsl");
pub(super) const TEXEL: &str = include_str!("../../shaders/pcf_texel.wgsl");
const DISK: &str = include_str!("../../shaders/pcf_disk.wgsl");
const NOISE: &str = include_str!("../../shaders/pcf_noise.wgsl");
const DERIVATIVES: &str = include_str!("../../shaders/pcf_derivatives.wgsl");
const HARDWARE: &str = include_str!("../../shaders/pcf_hardware.wgsl");
const TEXTBOOK: &str = include_str!("../../shaders/cube_textbook.wgsl");

/// Name of the textbook's function.
const TEXTBOOK_FUNCTION: &str = "shadows_cube_textbook";

/// What a kernel's functions take besides map, light, position and normal: for disks the
/// parameters, the offsets and the pixel.
struct Extra {
    parameters: &'static str,
    arguments: &'static str,
    pixel_parameter: &'static str,
    pixel: &'static str,
}

impl Extra {
    fn of(takes_pixel: bool) -> Self {
        match takes_pixel {
            false => Self {
                parameters: "",
                arguments: "",
                pixel_parameter: "",
                pixel: "",
            },
            true => Self {
                parameters: "\n    kernel: ShadowsCubeKernel,\n    offsets: texture_3d<f32>,",
                arguments: ", kernel, offsets",
                pixel_parameter: ", pixel: vec2f",
                pixel: ", pixel",
            },
        }
    }
}

/// The functions of a kernel, and no other's.
pub(super) fn functions(kernel: Kernel, own: &MapWgsl) -> String {
    if kernel == Kernel::HardwareBilinear {
        let text = [
            own.light,
            own.kind,
            own.edge,
            own.compare,
            own.hardware,
            HARDWARE,
        ];
        return own.adapt(&text.join("\n"));
    }
    let (weights, last) = match kernel {
        Kernel::Hard => (None, own.hard.to_vec()),
        Kernel::RandomDisk(_) => (None, vec![DISK, RANDOM_DISK]),
        Kernel::Vogel(_) => (None, vec![DISK, NOISE, VOGEL]),
        Kernel::ContactHardening(_) => (None, vec![DISK, NOISE, CONTACT]),
        _ => (kernel.weights(), vec![SQUARE]),
    };
    let map: &[&str] = match (kernel.uses_pixel(), &weights) {
        (true, _) => &[own.tap],
        (false, None) => &[],
        (false, Some(_)) => &[own.texel, TEXEL, own.gather, own.four],
    };
    let weights = weights.map(|weights| weights.wgsl());
    let entry = entry(kernel);
    let shared = [
        own.light,
        own.kind,
        own.receiver,
        own.depth,
        own.edge,
        own.fetch,
    ];
    let text = shared
        .into_iter()
        .chain([DERIVATIVES, own.slope])
        .chain(map.iter().copied())
        .chain(weights.as_deref())
        .chain(last)
        .chain([&entry[..]])
        .collect::<Vec<_>>()
        .join("\n");
    own.adapt(&text)
}

/// The textbook's receiver.
pub(super) fn textbook(own: &MapWgsl) -> String {
    own.adapt(&[own.light, own.receiver, own.depth, own.fetch, TEXTBOOK].join("\n"))
}

/// The function that hosts call: what every kernel does before its first tap.
fn entry(kernel: Kernel) -> String {
    let function = kernel.function();
    let Extra {
        parameters,
        arguments,
        pixel_parameter,
        pixel,
    } = Extra::of(kernel.uses_pixel());
    format!(
        "
fn {function}(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,{parameters}
    position: vec3f,
    normal: vec3f{pixel_parameter}
) -> f32 {{
    let derived = shadows_cube_given(light, position, normal);
    return {function}_derived(
        map, map_sampler, light{arguments}, position, derived{pixel}
    );
}}

fn {function}_derived(
    map: texture_cube<f32>,
    map_sampler: sampler,
    light: ShadowsCubeLight,{parameters}
    position: vec3f,
    derived: ShadowsCubeDerived{pixel_parameter}
) -> f32 {{
    let receiver = shadows_cube_receiver(light, position, derived);
    if !receiver.asks {{
        return select(0.0, 1.0, receiver.lit);
    }}
    return shadows_cube_filter(map, map_sampler, receiver, light.size{arguments}{pixel});
}}
"
    )
}

/// What follows the derivatives of the position: the call of the kernel that `light` is given to.
fn derived(kernel: Option<Kernel>, light: &str, index: &str) -> String {
    let Some(kernel) = kernel else {
        return format!("    return shadows_visibility_flat({index}position, cross(x, y));\n");
    };
    if kernel == Kernel::HardwareBilinear {
        return format!(
            "    return shadows_cube_hardware_derived(
        shadows_map, shadows_map_sampler, {light}, position, x, y
    );
"
        );
    }
    let (disk, pixel) = match kernel.uses_pixel() {
        false => ("", ""),
        true => (", shadows_kernel, shadows_offsets", ", pixel"),
    };
    // As far as a tap's texel may be from the receiver, in texels and in the world: across the light's rays,
    // and in the receiver's plane, in which disks lie.
    let reach = match kernel {
        Kernel::Hard => "vec4f(0.71, 0.0, 0.0, 0.0)",
        // Stretched along the rays' footprint.
        Kernel::ContactHardening(_) => {
            "vec4f(shadows_kernel.radius_texels + 0.71, shadows_kernel.radius_world, 0.0, 0.0)"
        }
        _ if kernel.uses_pixel() => {
            "vec4f(0.71, 0.0, shadows_kernel.radius_texels, shadows_kernel.radius_world)"
        }
        _ => "vec4f(1.42 * f32(shadows_cube_pairs), 0.0, 0.0, 0.0)",
    };
    let function = kernel.function();
    format!(
        "    let derived = shadows_cube_derived(
        shadows_map, shadows_map_sampler, {light}, position, x, y, {reach}
    );
    return {function}_derived(
        shadows_map, shadows_map_sampler, {light}{disk}, position, derived{pixel}
    );
"
    )
}

/// The bindings of one group, and functions that read them.
pub(super) fn bindings(kernel: Option<Kernel>, own: &MapWgsl, group: u32) -> String {
    let function = kernel.map_or(TEXTBOOK_FUNCTION, Kernel::function);
    let (lights, index, light, element) = match own.many_lights() {
        false => ("uniform> shadows_light: ShadowsCubeLight", "", "", ""),
        true => (
            "storage, read> shadows_light: array<ShadowsCubeLight>",
            "light: u32, ",
            "light, ",
            "[light]",
        ),
    };
    let takes_pixel = kernel.is_some_and(Kernel::uses_pixel);
    let extra = Extra::of(takes_pixel);
    let (parameter, pixel) = (extra.pixel_parameter, extra.pixel);
    let (disk_bindings, disk) = match takes_pixel {
        false => (String::new(), ""),
        true => (
            format!(
                "@group({group}) @binding(3) var<uniform> shadows_kernel: ShadowsCubeKernel;
@group({group}) @binding(4) var shadows_offsets: texture_3d<f32>;
"
            ),
            ", shadows_kernel, shadows_offsets",
        ),
    };
    let (map, sampler) = match kernel {
        Some(Kernel::HardwareBilinear) => ("texture_depth_cube", "sampler_comparison"),
        _ => ("texture_cube<f32>", "sampler"),
    };
    let derived = derived(kernel, &format!("shadows_light{element}"), light);
    own.adapt_module(&format!(
        "
@group({group}) @binding(0) var shadows_map: {map};
@group({group}) @binding(1) var shadows_map_sampler: {sampler};
@group({group}) @binding(2) var<{lights};
{disk_bindings}
fn shadows_visibility_flat({index}position: vec3f, normal: vec3f{parameter}) -> f32 {{
    return {function}(
        shadows_map, shadows_map_sampler, shadows_light{element}{disk}, position, normal{pixel}
    );
}}

fn shadows_visibility({index}position: vec3f{parameter}) -> f32 {{
    let x = dpdx(position);
    let y = dpdy(position);
{derived}}}
"
    ))
}
