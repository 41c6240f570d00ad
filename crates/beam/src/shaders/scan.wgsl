// From the sums of workgroups to where each begins, and how many cells and workgroups the next level has.
// One workgroup; each invocation takes a run of sums.

struct Level {
    size: u32,
    exponent: u32,
    number: u32,
    tolerance: f32,
    extent: vec2u,
    row: u32,
    width: u32,
}

@group(0) @binding(0) var<uniform> level: Level;
@group(0) @binding(1) var<storage, read_write> counts: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> sums: array<u32>;

var<workgroup> partial: array<u32, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) lane: u32) {
    let groups = (counts[level.number].w + 63u) / 64u;
    let run = (groups + 255u) / 256u;
    let first = min(lane * run, groups);
    let end = min(first + run, groups);
    var total = 0u;
    for (var i = first; i < end; i += 1u) {
        total += sums[i];
    }
    partial[lane] = total;
    workgroupBarrier();
    for (var step = 1u; step < 256u; step *= 2u) {
        var before = 0u;
        if lane >= step {
            before = partial[lane - step];
        }
        workgroupBarrier();
        partial[lane] += before;
        workgroupBarrier();
    }
    var begin = partial[lane] - total;
    for (var i = first; i < end; i += 1u) {
        let own = sums[i];
        sums[i] = begin;
        begin += own;
    }
    if lane == 255u {
        let cells = partial[255];
        let next = (cells + 63u) / 64u;
        let columns = min(next, 65535u);
        let rows = (next + max(columns, 1u) - 1u) / max(columns, 1u);
        counts[level.number + 1u] = vec4u(columns, rows, 1u, cells);
    }
}
