// Facing pass, one invocation a triangle: on which side of the triangle the light lies, decided
// once and stored, and the list of caps that follows from it.

@group(0) @binding(4) var<storage, read> positions: array<f32>;
@group(0) @binding(5) var<storage, read> triangles: array<u32>;
@group(0) @binding(6) var<storage, read_write> facing: array<i32>;
@group(0) @binding(7) var<storage, read_write> caps: array<u32>;

var<workgroup> front_count: atomic<u32>;
var<workgroup> back_count: atomic<u32>;
var<workgroup> front_first: u32;
var<workgroup> back_first: u32;

fn position(vertex: u32, stride: u32, offset: u32) -> vec3f {
    let word = offset + vertex * stride;
    return vec3f(positions[word], positions[word + 1u], positions[word + 2u]);
}

@compute @workgroup_size(256)
fn shadows_volume_facing(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let share = share_of(group, groups);
    let instance = instances[share.x];
    let triangle = share.y + local;
    var corners = vec3u(0u);
    var count = 0i;
    var slot = 0u;
    if triangle < instance.triangle_count {
        let word = instance.triangle_base + 3u * triangle;
        let stride = instance.position_stride;
        let offset = instance.position_offset;
        corners = vec3u(triangles[word], triangles[word + 1u], triangles[word + 2u]);
        count = light_side(
            position(corners.x, stride, offset),
            position(corners.y, stride, offset),
            position(corners.z, stride, offset),
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
