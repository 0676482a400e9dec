// Edge pass, one invocation an edge: how often the caps' boundary runs through the edge.

@group(0) @binding(4) var<storage, read> edges: array<vec4u>;
// A use is `triangle << 1 | reversed`; read only where the mesh is general.
@group(0) @binding(5) var<storage, read> edge_uses: array<u32>;
@group(0) @binding(6) var<storage, read> facing: array<i32>;
@group(0) @binding(7) var<storage, read_write> sides: array<u32>;

var<workgroup> side_count: atomic<u32>;
var<workgroup> side_first: u32;

// The coefficient of an edge in the boundary of the chain of caps: +1 for each cap that runs
// through it from its first vertex to its second, -1 for each that runs back.
fn boundary(edge: vec4u, instance: Instance) -> i32 {
    let general = instance.general != 0u;
    let facing_base = instance.facing_base;
    let first_use = instance.use_base + edge.z;
    let pair = facing_base + select(edge.zw, vec2u(0u), general);
    let uses = select(0u, edge.w, general);
    var sum = facing[pair.x] - facing[pair.y];
    for (var i = 0u; i < uses; i += 1u) {
        let edge_use = edge_uses[first_use + i];
        let count = facing[facing_base + (edge_use >> 1u)];
        sum += select(count, -count, (edge_use & 1u) == 1u);
    }
    return sum;
}

@compute @workgroup_size(256)
fn shadows_volume_edges(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let share = share_of(group, groups);
    let instance = instances[share.x];
    let edge = share.y + local;
    var sum = 0i;
    var slot = 0u;
    if edge < instance.edge_count {
        sum = boundary(edges[instance.edge_base + edge], instance);
    }
    let copies = u32(abs(sum));
    if copies > 0u {
        slot = atomicAdd(&side_count, copies);
    }
    workgroupBarrier();
    if local == 0u {
        let total = atomicLoad(&side_count);
        if total > 0u {
            let word = instance.arguments * ARGS_STRIDE;
            side_first = instance.side_base + atomicAdd(&args[word + ARGS_SIDES], total);
        }
    }
    workgroupBarrier();
    let entry = (edge << 1u) | select(0u, 1u, sum < 0);
    for (var i = 0u; i < copies; i += 1u) {
        sides[side_first + slot + i] = entry;
    }
}
