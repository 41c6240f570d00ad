// The cells of the next level, in spatial order: the quarters in the image of those that may see the surface.

@group(0) @binding(0) var<uniform> level: Level;
@group(0) @binding(1) var<storage, read> counts: array<vec4u>;
@group(0) @binding(2) var<storage, read> cells: array<Cell>;
@group(0) @binding(3) var<storage, read> quarters: array<vec2u>;
@group(0) @binding(4) var<storage, read> sums: array<u32>;
@group(0) @binding(5) var<storage, read_write> next: array<Cell>;

@compute @workgroup_size(INVOCATIONS)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let count = counts[level.number];
    let workgroup = group.y * count.x + group.x;
    let i = workgroup * 64u + lane;
    var own = vec2u(0u);
    if i < count.w {
        own = quarters[i];
    }
    let sum = up_to(lane, own.x);
    if own.x == 0u {
        return;
    }
    var place = sums[workgroup] + sum - own.x;
    let first = vec2u(cells[i].place & 0xffffu, cells[i].place >> 16u) * 2u;
    for (var k = 0u; k < 4u; k += 1u) {
        let quarter = first + vec2u(k & 1u, k >> 1u);
        if all(quarter < level.extent) {
            next[place] = Cell(quarter.x | quarter.y << 16u, bitcast<f32>(own.y));
            place += 1u;
        }
    }
}
