// Facing pass, one invocation a triangle: on which side of the triangle the light lies, decided
// once and stored, and the list of caps that follows from it.

@group(0) @binding(3) var<storage, read> positions: array<f32>;
@group(0) @binding(4) var<storage, read> triangles: array<u32>;
@group(0) @binding(5) var<storage, read_write> facing: array<i32>;
@group(0) @binding(6) var<storage, read_write> caps: array<u32>;

var<workgroup> front_count: atomic<u32>;
var<workgroup> back_count: atomic<u32>;
var<workgroup> front_first: u32;
var<workgroup> back_first: u32;

fn position(vertex: u32) -> vec3f {
    let word = batch.position_offset + vertex * batch.position_stride;
    return vec3f(positions[word], positions[word + 1u], positions[word + 2u]);
}

@compute @workgroup_size(256)
fn shadows_volume_facing(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let instance = instances[batch.first_instance + group.y];
    let triangle = element(group, groups, local);
    var corners = vec3u(0u);
    var count = 0i;
    var slot = 0u;
    if triangle < batch.triangle_count {
        let word = 3u * triangle;
        corners = vec3u(triangles[word], triangles[word + 1u], triangles[word + 2u]);
        count = light_side(
            position(corners.x),
            position(corners.y),
            position(corners.z),
            instance.light,
            instance.light_rest,
            batch.zero,
        );
        count = counted(count, instance.both_sides);
        facing[instance.facing_base + triangle] = count;
    }
    if count > 0 {
        slot = atomicAdd(&front_count, 3u);
    } else if count < 0 {
        slot = atomicAdd(&back_count, 3u);
    }
    workgroupBarrier();
    if local == 0u {
        // One global atomic a workgroup. The list of -1 grows down from the end of the region: the
        // two cannot meet, for together they are no longer than the list of triangles.
        let word = instance.arguments * ARGS_STRIDE;
        let front = atomicLoad(&front_count);
        if front > 0u {
            front_first = instance.cap_base + atomicAdd(&args[word + ARGS_FRONT], front);
        }
        let back = atomicLoad(&back_count);
        if back > 0u {
            atomicAdd(&args[word + ARGS_BACK], back);
            back_first = atomicSub(&args[word + ARGS_BACK + 2u], back) - back;
        }
    }
    workgroupBarrier();
    if count != 0 {
        let first = select(back_first, front_first, count > 0) + slot;
        caps[first] = corners.x;
        caps[first + 1u] = corners.y;
        caps[first + 2u] = corners.z;
    }
}
