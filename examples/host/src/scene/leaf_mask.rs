//! What is cut out of a leaf card: one formula, for the reference in f64 and for shaders in WGSL.

/// A leaf: where its stalk is in the card, which way it points (degrees counter-clockwise from the
/// card's u axis), its length and its half width, in parts of the card.
struct Leaf {
    foot: [f32; 2],
    degrees: f32,
    length: f32,
    half_width: f32,
}

const fn leaf(foot: [f32; 2], degrees: f32, length: f32, half_width: f32) -> Leaf {
    Leaf {
        foot,
        degrees,
        length,
        half_width,
    }
}

/// A twig from the middle of the card's lower edge upwards; the first is the twig itself.
const TWIG: [Leaf; 12] = [
    leaf([0.5, -0.05], 90.0, 1.0, 0.018),
    leaf([0.5, 0.1], 28.0, 0.44, 0.085),
    leaf([0.5, 0.16], 155.0, 0.45, 0.085),
    leaf([0.5, 0.3], 40.0, 0.47, 0.09),
    leaf([0.5, 0.36], 143.0, 0.48, 0.09),
    leaf([0.5, 0.48], 33.0, 0.46, 0.09),
    leaf([0.5, 0.55], 150.0, 0.45, 0.09),
    leaf([0.5, 0.62], 52.0, 0.42, 0.08),
    leaf([0.5, 0.66], 127.0, 0.4, 0.08),
    leaf([0.5, 0.6], 90.0, 0.39, 0.075),
    leaf([0.5, 0.02], -12.0, 0.4, 0.07),
    leaf([0.5, 0.05], 190.0, 0.41, 0.07),
];

/// Whether there is leaf at a place in the card (0 to 1 along both sides).
///
/// A leaf is what lies between two parabolas over its midrib: `|s| <= 4 w t (1 - t)` at the part `t`
/// of its length, `w` being its half width.
pub fn is_leaf([u, v]: [f64; 2]) -> bool {
    TWIG.iter().any(|leaf| {
        let [along_u, along_v] = direction(leaf).map(f64::from);
        let (du, dv) = (u - f64::from(leaf.foot[0]), v - f64::from(leaf.foot[1]));
        let t = (du * along_u + dv * along_v) / f64::from(leaf.length);
        let aside = (dv * along_u - du * along_v).abs();
        aside <= 4.0 * f64::from(leaf.half_width) * t * (1.0 - t)
    })
}

/// The same as WGSL: `fn host_is_leaf(place: vec2f) -> bool`.
pub fn wgsl() -> String {
    let tests = TWIG.iter().map(|leaf| {
        let ([u, v], [x, y]) = (leaf.foot, direction(leaf));
        let (length, half_width) = (leaf.length, leaf.half_width);
        format!("host_on_leaf(place, vec4f({u:?}, {v:?}, {x:?}, {y:?}), vec2f({length:?}, {half_width:?}))")
    });
    let tests: Vec<String> = tests.collect();
    format!(
        "{}\nfn host_is_leaf(place: vec2f) -> bool {{\n    return {};\n}}\n",
        include_str!("../shaders/leaf.wgsl"),
        tests.join("\n        || ")
    )
}

/// Unit, rounded to the `f32` that shaders are told.
fn direction(leaf: &Leaf) -> [f32; 2] {
    let (sine, cosine) = leaf.degrees.to_radians().sin_cos();
    [cosine, sine]
}
