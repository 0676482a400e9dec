
// Lambert's law under three lights, each times its visibility. What `shadows` brings stands before this.

// Its colour, and what is shown: 0 the scene, above that the visibility of a light alone.
@group(3) @binding(0) var<uniform> lit: vec4f;

const COLORS = array(vec3f(1.1, 0.85, 0.6), vec3f(0.5, 0.7, 1.2), vec3f(0.75, 0.72, 0.65));

// What Bevy's vertex shader hands on.
@fragment
fn fragment(@location(0) place: vec4f, @location(1) normal_in: vec3f) -> @location(0) vec4f {
    let world = place.xyz;
    let plane = cross(dpdx(world), dpdy(world));
    let normal = normalize(normal_in);
    var sum = lit.rgb * 0.06;
    var alone = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let visible = shadows_visibility_flat(i, world, plane);
        alone = select(alone, visible, u32(lit.w) == i + 1u);
        let light = shadows_light[i];
        // The sun shines along its direction, the others from where they are.
        var toward = light.position - world;
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
        sum += lit.rgb * COLORS[i] * (visible * facing * brightness);
    }
    return vec4f(select(sum, vec3f(alone), lit.w > 0.0), 1.0);
}
