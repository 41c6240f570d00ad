// From sums to means, pixel by pixel. Constants before this text: SUMS, BYTES.

struct Resolve {
    width: u32,
    height: u32,
    // The radius of the scene.
    radius: f32,
    unused: u32,
}

struct Answer {
    // About the scene's centre; the weight, 0 where nothing was hit.
    position: vec4f,
    // Of any length.
    normal: vec4f,
}

@group(0) @binding(0) var<uniform> resolve: Resolve;
@group(0) @binding(1) var positions: texture_2d<f32>;
@group(0) @binding(2) var normals: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> answers: array<Answer>;

@compute @workgroup_size(64)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let i = id.y * groups.x * 64u + id.x;
    if i >= resolve.width * resolve.height {
        return;
    }
    let pixel = vec2u(i % resolve.width, i / resolve.width);
    var position = textureLoad(positions, pixel, 0);
    var normal = textureLoad(normals, pixel, 0);
    if position.w > 0.0 {
        position = vec4f(position.xyz / position.w, position.w);
        if BYTES {
            position = vec4f(2.0 * position.xyz - 1.0, position.w);
            normal = vec4f(2.0 * normal.xyz / max(normal.w, 1e-6) - 1.0, normal.w);
        }
        if SUMS {
            position = vec4f(position.xyz * resolve.radius, position.w);
        }
    }
    answers[i] = Answer(position, normal);
}
