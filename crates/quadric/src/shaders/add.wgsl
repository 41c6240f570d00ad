// The rendering pass: weighted sums over the first sheet.

struct Painted {
    @location(0) position: vec4f,
    @location(1) normal: vec4f,
    @builtin(frag_depth) depth: f32,
}

// The weight of a hit by its distance from the ball's centre in radii.
fn weight(d: f32) -> f32 {
    if d < 0.5 {
        return exp(-4.0 * d * d);
    }
    return 1.471517765 * (1.0 - d) * (1.0 - d);
}

@fragment
fn paint(fragment: Varying) -> Painted {
    let found = find(fragment);
    let w = weight(found.distance);
    // Another pass may round the same depth otherwise.
    let depth = found.depth - 2.5e-7;
    // Halves do not hold every length.
    let place = found.position / frame.radius;
    if BYTES {
        // From 0 to 1, and room for eight of them.
        let position = 0.5 + 0.5 * place;
        let normal = 0.5 + 0.5 * found.normal;
        return Painted(vec4f(position, 1.0) * (0.125 * w), vec4f(normal, 1.0) * (0.125 * w), depth);
    }
    return Painted(vec4f(place, 1.0) * w, vec4f(found.normal, 1.0) * w, depth);
}
