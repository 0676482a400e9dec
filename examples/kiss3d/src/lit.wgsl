// Lambert's law under three lights, each times its visibility. What `shadows` brings stands before this.

struct Frame {
    clip_from_world: mat4x4f,
    // What is shown: 0 the scene, above that the visibility of a light alone.
    shown: u32,
}

struct Object {
    pose: mat4x4f,
    scale: vec4f,
    color: vec4f,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(1) @binding(0) var<uniform> object: Object;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) instance: vec3f,
    @location(3) deformation_x: vec3f,
    @location(4) deformation_y: vec3f,
    @location(5) deformation_z: vec3f,
}

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex(in: Vertex) -> Corner {
    let deformation = mat3x3f(in.deformation_x, in.deformation_y, in.deformation_z);
    let within = deformation * (object.scale.xyz * in.position);
    let world = in.instance + (object.pose * vec4f(within, 1.0)).xyz;
    let normal = (object.pose * vec4f(deformation * (in.normal / object.scale.xyz), 0.0)).xyz;
    return Corner(frame.clip_from_world * vec4f(world, 1.0), world, normal);
}

const COLORS = array(vec3f(1.1, 0.85, 0.6), vec3f(0.5, 0.7, 1.2), vec3f(0.75, 0.72, 0.65));

@fragment
fn fragment(in: Corner) -> @location(0) vec4f {
    let plane = cross(dpdx(in.world), dpdy(in.world));
    let normal = normalize(in.normal);
    var sum = object.color.rgb * 0.06;
    var alone = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let visible = shadows_visibility_flat(i, in.world, plane);
        alone = select(alone, visible, frame.shown == i + 1u);
        let light = shadows_light[i];
        // The sun shines along its direction, the others from where they are.
        var toward = light.position - in.world;
        var brightness = 30.0 / dot(toward, toward);
        if i == 2u {
            toward = -light.forward;
            brightness = 1.0;
        }
        // A spot shines into its cone only.
        if i == 1u {
            brightness *= smoothstep(0.80, 0.84, dot(normalize(-toward), normalize(light.forward)));
        }
        let facing = max(dot(normal, normalize(toward)), 0.0);
        sum += object.color.rgb * COLORS[i] * (visible * facing * brightness);
    }
    return vec4f(select(sum, vec3f(alone), frame.shown > 0u), 1.0);
}
