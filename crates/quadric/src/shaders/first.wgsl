// What is nearest stays.

struct Painted {
    @location(0) position: vec4f,
    @location(1) normal: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn paint(fragment: Varying) -> Painted {
    let found = find(fragment);
    return Painted(vec4f(found.position, 1.0), vec4f(found.normal, 1.0), found.depth);
}
