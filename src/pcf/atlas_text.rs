//! The WGSL of a kernel on an atlas: the same functions as on cube and flat maps, and one that finds out
//! which of them a light needs, and which of its cascades.

use super::Kernel;
use super::map_kind::{LightKinds, MapWgsl};
use super::text::{Extra, own_functions, reach, shared_functions};

/// How a receiver's plane is given.
#[derive(Clone, Copy, PartialEq)]
enum Plane {
    /// By a normal of the host's.
    Given,
    /// By the derivatives of the position.
    Derived,
}

impl Plane {
    const ALL: [Self; 2] = [Self::Given, Self::Derived];

    /// What follows the names of its functions.
    fn suffix(self) -> &'static str {
        match self {
            Self::Given => "given",
            Self::Derived => "derived",
        }
    }

    fn parameters(self) -> &'static str {
        match self {
            Self::Given => "normal: vec3f",
            Self::Derived => "x: vec3f, y: vec3f",
        }
    }

    fn arguments(self) -> &'static str {
        match self {
            Self::Given => "normal",
            Self::Derived => "x, y",
        }
    }
}

/// The functions of a kernel for some kinds of light.
pub(super) fn functions(
    kernel: Kernel,
    point: &MapWgsl,
    flat: &MapWgsl,
    kinds: LightKinds,
) -> String {
    let mut text = vec![shared_functions(kernel, point)];
    if kinds.point {
        text.push(own_functions(kernel, point));
    }
    if kinds.is_flat() {
        text.push(own_functions(kernel, flat));
    }
    text.concat()
}

/// Functions that read the bindings, for a light by its number.
pub(super) fn visibility(kernel: Kernel, kinds: LightKinds) -> String {
    let Extra {
        pixel_parameter,
        pixel,
        ..
    } = Extra::of(kernel.uses_pixel());
    let mut text = String::new();
    for plane in Plane::ALL {
        if kinds.point {
            text += &one_map(kernel, plane, "cube");
        }
        if kinds.is_flat() {
            text += &one_map(kernel, plane, "flat");
        }
        if kinds.directional {
            text += &cascades(kernel, plane);
        }
        text += &choice(kernel, plane, kinds);
    }
    text + &format!(
        "
fn shadows_visibility_flat(light: u32, position: vec3f, normal: vec3f{pixel_parameter}) -> f32 {{
    return shadows_of_light_given(light, position, normal{pixel});
}}

fn shadows_visibility(light: u32, position: vec3f{pixel_parameter}) -> f32 {{
    return shadows_of_light_derived(light, position, dpdx(position), dpdy(position){pixel});
}}
"
    )
}

/// What the kernel says of one record.
fn one_map(kernel: Kernel, plane: Plane, map: &str) -> String {
    let Extra {
        pixel_parameter,
        pixel,
        ..
    } = Extra::of(kernel.uses_pixel());
    let function = kernel
        .function()
        .replace("shadows_cube_", &format!("shadows_{map}_"));
    let disk = match kernel.uses_pixel() {
        true => ", shadows_kernel, shadows_offsets",
        false => "",
    };
    let (suffix, parameters) = (plane.suffix(), plane.parameters());
    let maps = "shadows_map, shadows_map_sampler, record";
    let body = match plane {
        Plane::Given => {
            format!("    return {function}({maps}{disk}, position, normal{pixel});\n")
        }
        Plane::Derived if kernel == Kernel::HardwareBilinear => {
            format!("    return shadows_{map}_hardware_derived({maps}, position, x, y);\n")
        }
        Plane::Derived => {
            let reach = reach(kernel).replace("shadows_cube_", &format!("shadows_{map}_"));
            format!(
                "    let derived = shadows_{map}_derived({maps}, position, x, y, {reach});
    return {function}_derived({maps}{disk}, position, derived{pixel});
"
            )
        }
    };
    format!(
        "
fn shadows_on_{map}_{suffix}(
    record: ShadowsLight,
    position: vec3f,
    {parameters}{pixel_parameter}
) -> f32 {{
{body}}}
"
    )
}

/// The cascades of a directional light: the first that holds all that the kernel reads, and within the
/// band before its end the next one, too, as far as that holds it as well: one that is fitted tightly to what
/// is farther away need not hold what is near the eye.
fn cascades(kernel: Kernel, plane: Plane) -> String {
    let Extra {
        pixel_parameter,
        pixel,
        ..
    } = Extra::of(kernel.uses_pixel());
    let (suffix, parameters, arguments) = (plane.suffix(), plane.parameters(), plane.arguments());
    let room = match plane {
        Plane::Given => room(kernel),
        Plane::Derived => String::new(),
    };
    format!(
        "{room}
fn shadows_on_cascades_{suffix}(
    first: ShadowsLight,
    position: vec3f,
    {parameters}{pixel_parameter}
) -> f32 {{
    let further = (first.kind >> 8u) & 15u;
    var record = first;
    var room = shadows_cascade_room(record, position);
    var next = 0u;
    for (; next < further; next++) {{
        if room > 0.0 {{
            break;
        }}
        record = shadows_light[first.tiles.y + next];
        room = shadows_cascade_room(record, position);
    }}
    let lit = shadows_on_flat_{suffix}(record, position, {arguments}{pixel});
    let share = room * record.per_blend;
    if share >= 1.0 || next >= further {{
        return lit;
    }}
    let other = shadows_light[first.tiles.y + next];
    // Both bands are as wide in the world; each room is in texels of its own.
    let per_blend = record.per_blend * (record.texels / other.texels);
    let own = max(share, 1.0 - shadows_cascade_room(other, position) * per_blend);
    if own >= 1.0 {{
        return lit;
    }}
    return mix(shadows_on_flat_{suffix}(other, position, {arguments}{pixel}), lit, saturate(own));
}}
"
    )
}

/// How many texels are left between what the kernel reads and the border of a cascade. None before its near
/// plane: what casters there are nearer than that is pulled onto it.
fn room(kernel: Kernel) -> String {
    let reads = match kernel {
        Kernel::Hard | Kernel::HardwareBilinear => "1.5",
        _ if kernel.uses_pixel() => {
            "1.5 + shadows_kernel.radius_texels + shadows_kernel.radius_world / record.texel"
        }
        _ => "f32(shadows_flat_pairs) + 0.5",
    };
    format!(
        "
fn shadows_cascade_room(record: ShadowsLight, position: vec3f) -> f32 {{
    let local = position - record.position;
    let place = abs(vec2f(dot(record.right, local), dot(record.down, local)) * record.texels);
    let room = record.middle - ({reads}) - max(place.x, place.y);
    return select(room, -1.0, dot(record.forward, local) < 0.0);
}}
"
    )
}

/// Which function a light needs.
fn choice(kernel: Kernel, plane: Plane, kinds: LightKinds) -> String {
    let Extra {
        pixel_parameter,
        pixel,
        ..
    } = Extra::of(kernel.uses_pixel());
    let (suffix, parameters, arguments) = (plane.suffix(), plane.parameters(), plane.arguments());
    let case = |has: bool, kind: &str, on: &str| match has {
        true => format!(
            "        case {kind}: {{
            return shadows_on_{on}_{suffix}(record, position, {arguments}{pixel});
        }}
"
        ),
        false => String::new(),
    };
    let cases = [
        case(kinds.point, "1u", "cube"),
        case(kinds.spot, "2u", "flat"),
        case(kinds.directional, "3u", "cascades"),
    ]
    .concat();
    format!(
        "
fn shadows_of_light_{suffix}(
    light: u32,
    position: vec3f,
    {parameters}{pixel_parameter}
) -> f32 {{
    let record = shadows_light[light];
    switch shadows_kind(record) {{
{cases}        default: {{
            return 0.0;
        }}
    }}
}}
"
    )
}
