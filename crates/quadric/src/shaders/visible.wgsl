// The visibility pass: the depth of the first sheet's end.

@fragment
fn paint(fragment: Varying) -> @builtin(frag_depth) f32 {
    return find(fragment).depth;
}
