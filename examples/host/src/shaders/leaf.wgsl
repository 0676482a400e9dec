// Whether a place in a leaf card is on one leaf: its foot and direction, its length and half width.
fn host_on_leaf(place: vec2f, leaf: vec4f, size: vec2f) -> bool {
    let from_foot = place - leaf.xy;
    let t = dot(from_foot, leaf.zw) / size.x;
    let aside = abs(from_foot.y * leaf.z - from_foot.x * leaf.w);
    return aside <= 4.0 * size.y * t * (1.0 - t);
}
