// Merge pass, one workgroup a draw: the blocks of its casters, one after the other, and the arguments of
// the draw. A block is an instance of the draw: so many sides, or triangles of a cap, of one caster. The
// counts were left by the passes before this one.

// Elements in a block.
const BLOCK: u32 = 8u;

// Of a seat without a caster, and of an item that is there to fill a row.
const NONE: u32 = 0xffffffffu;

// A draw to be made anew.
struct Merge {
    first_member: u32,
    // As many as a workgroup has invocations, at most.
    member_count: u32,
    first_block: u32,
    // Which arguments are its own.
    draw: u32,
    // Words of an element in its list.
    element_words: u32,
    // Vertices of a block.
    block_vertices: u32,
    padding: vec2u,
}

// A caster in a draw.
struct Member {
    caster: u32,
    // The word of `args` that says how many words its list has.
    count: u32,
    // The list's first word, or the word behind its last where lists grow down.
    start: u32,
    grows_down: u32,
}

@group(0) @binding(1) var<storage, read> merges: array<Merge>;
@group(0) @binding(2) var<storage, read> members: array<Member>;
@group(0) @binding(3) var<storage, read> args: array<u32>;
// Three words each: the caster, the first word of the elements, their number.
@group(0) @binding(4) var<storage, read_write> blocks: array<u32>;
@group(0) @binding(5) var<storage, read_write> draws: array<vec4u>;

// Of each caster the blocks of those up to it, its elements, their first word.
var<workgroup> block_ends: array<u32, WORKGROUP>;
var<workgroup> counts: array<u32, WORKGROUP>;
var<workgroup> firsts: array<u32, WORKGROUP>;

// The first caster whose blocks end behind this one.
fn caster_of(block: u32) -> u32 {
    var low = 0u;
    for (var step = WORKGROUP / 2u; step > 0u; step /= 2u) {
        low += select(0u, step, block_ends[low + step - 1u] <= block);
    }
    return low;
}

@compute @workgroup_size(256)
fn shadows_volume_merge(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let merge = merges[item_of(group, groups)];
    var member = Member(0u, NONE, 0u, 0u);
    if local < merge.member_count {
        member = members[merge.first_member + local];
    }
    var words = 0u;
    if member.count != NONE {
        words = args[member.count];
    }
    counts[local] = words / max(merge.element_words, 1u);
    firsts[local] = member.start - select(0u, words, member.grows_down == 1u);
    block_ends[local] = (counts[local] + BLOCK - 1u) / BLOCK;
    workgroupBarrier();
    // Sums of all up to this one, by doubling the distance (Hillis and Steele, "Data parallel
    // algorithms", 1986).
    for (var step = 1u; step < WORKGROUP; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = block_ends[local - step];
        }
        workgroupBarrier();
        block_ends[local] += before;
        workgroupBarrier();
    }
    let total = block_ends[WORKGROUP - 1u];
    for (var block = local; block < total; block += WORKGROUP) {
        let place = caster_of(block);
        var before = 0u;
        if place > 0u {
            before = block_ends[place - 1u];
        }
        let done = (block - before) * BLOCK;
        let word = 3u * (merge.first_block + block);
        blocks[word] = members[merge.first_member + place].caster;
        blocks[word + 1u] = firsts[place] + done * merge.element_words;
        blocks[word + 2u] = min(counts[place] - done, BLOCK);
    }
    if local == 0u && merge.draw != NONE {
        draws[merge.draw] = vec4u(merge.block_vertices, total, 0u, 0u);
    }
}
