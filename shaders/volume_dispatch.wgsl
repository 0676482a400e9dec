// What every compute pass of volumes knows of its dispatch.

const WORKGROUP: u32 = 256u;

struct Batch {
    // The first workgroup's item, in the list of what is to be done.
    first_item: u32,
    // See `settled` in volume_light_side.wgsl.
    zero: u32,
    padding: vec2u,
}

@group(0) @binding(0) var<uniform> batch: Batch;

// A workgroup's item. Long lists are folded into rows.
fn item_of(group: vec3u, groups: vec3u) -> u32 {
    return batch.first_item + group.y * groups.x + group.x;
}
