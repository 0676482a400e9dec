//! The WGSL of a kernel on a kind of map: the files that it takes, and the function that hosts call.

use super::Kernel;
use super::map_kind::{Lights, MapWgsl};
use crate::map::UNIFORM_LIGHTS;

const LIGHT: &str = include_str!("../../shaders/light_record.wgsl");
const PARAMETERS: &str = include_str!("../../shaders/pcf_parameters.wgsl");
const SQUARE: &str = include_str!("../../shaders/pcf_square.wgsl");
const RANDOM_DISK: &str = include_str!("../../shaders/pcf_random_disk.wgsl");
const VOGEL: &str = include_str!("../../shaders/pcf_vogel.wgsl");
const CONTACT: &str = include_str!("../../shaders/pcf_contact.wgsl");
pub(super) const TEXEL: &str = include_str!("../../shaders/pcf_texel.wgsl");
const SEARCH: &str = include_str!("../../shaders/pcf_search.wgsl");
const DISK: &str = include_str!("../../shaders/pcf_disk.wgsl");
const NOISE: &str = include_str!("../../shaders/pcf_noise.wgsl");
const DERIVATIVES: &str = include_str!("../../shaders/pcf_derivatives.wgsl");
const HARDWARE: &str = include_str!("../../shaders/pcf_hardware.wgsl");
const TEXTBOOK: &str = include_str!("../../shaders/cube_textbook.wgsl");

/// Name of the textbook's function.
const TEXTBOOK_FUNCTION: &str = "shadows_cube_textbook";

/// What a kernel's functions take besides map, light, position and normal: for disks the
/// parameters, the offsets and the pixel.
pub(super) struct Extra {
    pub parameters: &'static str,
    pub arguments: &'static str,
    pub pixel_parameter: &'static str,
    pub pixel: &'static str,
}

impl Extra {
    pub fn of(takes_pixel: bool) -> Self {
        match takes_pixel {
            false => Self {
                parameters: "",
                arguments: "",
                pixel_parameter: "",
                pixel: "",
            },
            true => Self {
                parameters: "\n    kernel: ShadowsKernel,\n    offsets: texture_3d<f32>,",
                arguments: ", kernel, offsets",
                pixel_parameter: ", pixel: vec2f",
                pixel: ", pixel",
            },
        }
    }
}

/// The functions of a kernel, and no other's.
pub(super) fn functions(kernel: Kernel, own: &MapWgsl) -> String {
    own.adapt(&shared_functions(kernel, own)) + &own_functions(kernel, own)
}

/// What is the same for all kinds of light.
pub(super) fn shared_functions(kernel: Kernel, own: &MapWgsl) -> String {
    let parameters = match kernel.uses_pixel() {
        true => PARAMETERS,
        false => "",
    };
    [LIGHT, own.tile, parameters].join("\n")
}

/// The functions of a kernel for the lights of a kind of map.
pub(super) fn own_functions(kernel: Kernel, own: &MapWgsl) -> String {
    if kernel == Kernel::HardwareBilinear {
        return own.adapt(&[own.kind, own.edge, own.hardware, HARDWARE].join("\n"));
    }
    let (weights, last) = match kernel {
        Kernel::Hard => (None, own.hard.to_vec()),
        Kernel::RandomDisk(_) => (None, vec![DISK, own.disk, RANDOM_DISK]),
        Kernel::Vogel(_) => (None, vec![DISK, own.disk, NOISE, VOGEL]),
        Kernel::ContactHardening(_) => (
            None,
            vec![DISK, own.disk, SEARCH, own.search, NOISE, CONTACT],
        ),
        _ => (kernel.weights(), vec![SQUARE]),
    };
    let map: &[&str] = match (kernel.uses_pixel(), &weights) {
        (true, _) => &[own.tap],
        (false, None) => &[],
        (false, Some(_)) => &[own.texel, TEXEL, own.gather, own.four],
    };
    let weights = weights.map(|weights| weights.wgsl());
    let entry = entry(kernel);
    let text = [own.kind, own.receiver, own.depth, own.edge, own.fetch]
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
    let text = [
        LIGHT,
        own.tile,
        own.kind,
        own.receiver,
        own.depth,
        own.fetch,
        TEXTBOOK,
    ];
    own.adapt(&text.join("\n"))
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
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,{parameters}
    position: vec3f,
    normal: vec3f{pixel_parameter}
) -> f32 {{
    let derived = shadows_cube_given(light, position, normal);
    return {function}_derived(
        map, map_sampler, light{arguments}, position, derived{pixel}
    );
}}

fn {function}_derived(
    map: texture_2d_array<f32>,
    map_sampler: sampler,
    light: ShadowsLight,{parameters}
    position: vec3f,
    derived: ShadowsCubeDerived{pixel_parameter}
) -> f32 {{
    let receiver = shadows_cube_receiver(light, position, derived);
    if !receiver.asks {{
        return select(0.0, 1.0, receiver.lit);
    }}
    return shadows_cube_filter(map, map_sampler, receiver{arguments}{pixel});
}}
"
    )
}

/// As far as a tap's texel may be from the receiver, in texels and in the world: across the light's rays,
/// and in the receiver's plane, in which disks lie.
pub(super) fn reach(kernel: Kernel) -> &'static str {
    match kernel {
        Kernel::Hard => "vec4f(0.71, 0.0, 0.0, 0.0)",
        // Stretched along the rays' footprint.
        Kernel::ContactHardening(_) => {
            "vec4f(shadows_kernel.radius_texels + 0.71, shadows_kernel.radius_world, 0.0, 0.0)"
        }
        _ if kernel.uses_pixel() => {
            "vec4f(0.71, 0.0, shadows_kernel.radius_texels, shadows_kernel.radius_world)"
        }
        _ => "vec4f(1.42 * f32(shadows_cube_pairs), 0.0, 0.0, 0.0)",
    }
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
    let reach = reach(kernel);
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

/// The bindings of one group.
pub(super) fn declarations(
    kernel: Option<Kernel>,
    lights: Lights,
    group: u32,
    first_binding: u32,
) -> String {
    let binding = |index: u32| format!("@group({group}) @binding({})", first_binding + index);
    let many = format!("uniform> shadows_light: array<ShadowsLight, {UNIFORM_LIGHTS}>");
    let lights = match lights {
        Lights::One => "uniform> shadows_light: ShadowsLight",
        Lights::Storage => "storage, read> shadows_light: array<ShadowsLight>",
        Lights::Uniform => &many,
    };
    let disk = match kernel.is_some_and(Kernel::uses_pixel) {
        false => String::new(),
        true => format!(
            "{} var<uniform> shadows_kernel: ShadowsKernel;
{} var shadows_offsets: texture_3d<f32>;
",
            binding(3),
            binding(4)
        ),
    };
    let (map, sampler) = match kernel {
        Some(Kernel::HardwareBilinear) => ("texture_depth_2d_array", "sampler_comparison"),
        _ => ("texture_2d_array<f32>", "sampler"),
    };
    format!(
        "
{} var shadows_map: {map};
{} var shadows_map_sampler: {sampler};
{} var<{lights};
{disk}",
        binding(0),
        binding(1),
        binding(2)
    )
}

/// The bindings of one group, and functions that read them.
pub(super) fn bindings(
    kernel: Option<Kernel>,
    own: &MapWgsl,
    group: u32,
    first_binding: u32,
) -> String {
    let function = kernel.map_or(TEXTBOOK_FUNCTION, Kernel::function);
    let takes_pixel = kernel.is_some_and(Kernel::uses_pixel);
    let extra = Extra::of(takes_pixel);
    let (parameter, pixel) = (extra.pixel_parameter, extra.pixel);
    let disk = match takes_pixel {
        false => "",
        true => ", shadows_kernel, shadows_offsets",
    };
    let declarations = declarations(kernel, Lights::One, group, first_binding);
    let derived = derived(kernel, "shadows_light", "");
    own.adapt_module(&format!(
        "{declarations}
fn shadows_visibility_flat(position: vec3f, normal: vec3f{parameter}) -> f32 {{
    return {function}(
        shadows_map, shadows_map_sampler, shadows_light{disk}, position, normal{pixel}
    );
}}

fn shadows_visibility(position: vec3f{parameter}) -> f32 {{
    let x = dpdx(position);
    let y = dpdy(position);
{derived}}}
"
    ))
}
