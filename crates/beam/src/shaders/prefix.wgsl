// INVOCATIONS: those of a workgroup, a power of two.

var<workgroup> partial: array<u32, INVOCATIONS>;

// The sum of the values of a workgroup's invocations up to this one. All of them must call it.
fn up_to(lane: u32, own: u32) -> u32 {
    partial[lane] = own;
    workgroupBarrier();
    for (var step = 1u; step < INVOCATIONS; step *= 2u) {
        var before = 0u;
        if lane >= step {
            before = partial[lane - step];
        }
        workgroupBarrier();
        partial[lane] += before;
        workgroupBarrier();
    }
    return partial[lane];
}

