// From the sums of workgroups to where each begins, and how many cells and workgroups the next level has.
// One workgroup; each invocation takes a run of sums.

@group(0) @binding(0) var<uniform> level: Level;
@group(0) @binding(1) var<storage, read_write> counts: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> sums: array<u32>;

@compute @workgroup_size(INVOCATIONS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let groups = (counts[level.number].w + 63u) / 64u;
    let run = (groups + INVOCATIONS - 1u) / INVOCATIONS;
    let first = min(lane * run, groups);
    let end = min(first + run, groups);
    var total = 0u;
    for (var i = first; i < end; i += 1u) {
        total += sums[i];
    }
    let sum = up_to(lane, total);
    var begin = sum - total;
    for (var i = first; i < end; i += 1u) {
        let own = sums[i];
        sums[i] = begin;
        begin += own;
    }
    if lane == INVOCATIONS - 1u {
        let cells = sum;
        let next = (cells + 63u) / 64u;
        let columns = min(next, 65535u);
        let rows = (next + max(columns, 1u) - 1u) / max(columns, 1u);
        counts[level.number + 1u] = vec4u(columns, rows, 1u, cells);
    }
}
