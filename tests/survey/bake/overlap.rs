//! Charts that overlap are found, those that touch are not, by another way of counting.

use glam::{DAffine3, DVec2};
use proptest::prelude::*;
use shadows::error::LightMapError;
use shadows::glam;
use shadows::reference::bake::{LightMapLayout, LightMapReceiver, TexelRectangle};

/// What a layout of these triangles says; their positions lie apart.
fn told(uvs: &[[f32; 2]]) -> Result<(), [usize; 2]> {
    let positions: Vec<[f32; 3]> = (0..uvs.len() as u32)
        .map(|at| [(at % 3) as f32 + at as f32, (at % 2) as f32, 0.0])
        .collect();
    let indices: Vec<u32> = (0..uvs.len() as u32).collect();
    let receiver = LightMapReceiver {
        positions: &positions,
        indices: &indices,
        uvs,
        transform: DAffine3::IDENTITY,
        rectangle: TexelRectangle {
            x: 0,
            y: 0,
            width: 16,
            height: 16,
        },
        two_sided: true,
    };
    match LightMapLayout::new([16, 16], &[receiver]) {
        Ok(_) => Ok(()),
        Err(LightMapError::UvOverlap {
            receiver: 0,
            triangles,
        }) => Err(triangles),
        Err(other) => panic!("{other}"),
    }
}

/// The area that two triangles have in common: the first clipped by the second's edges.
fn common_area(a: &[[f32; 2]], b: &[[f32; 2]]) -> f64 {
    let point = |uv: &[f32; 2]| DVec2::from_array(uv.map(f64::from));
    let mut rest: Vec<DVec2> = a.iter().map(point).collect();
    let b: Vec<DVec2> = b.iter().map(point).collect();
    let turn = (b[1] - b[0]).perp_dot(b[2] - b[0]).signum();
    for k in 0..3 {
        let (from, along) = (b[k], b[(k + 1) % 3] - b[k]);
        let inside = |p: DVec2| turn * along.perp_dot(p - from);
        let mut kept = Vec::new();
        for (i, &to) in rest.iter().enumerate() {
            let before = rest[(i + rest.len() - 1) % rest.len()];
            let (s, t) = (inside(before), inside(to));
            if s * t < 0.0 {
                kept.push(before.lerp(to, s / (s - t)));
            }
            if t >= 0.0 {
                kept.push(to);
            }
        }
        rest = kept;
    }
    let fan = (2..rest.len()).map(|k| (rest[k - 1] - rest[0]).perp_dot(rest[k] - rest[0]));
    0.5 * fan.sum::<f64>().abs()
}

/// The first pair with an area in common that is more than rounding, and whether any is in doubt.
fn counted(uvs: &[[f32; 2]]) -> (Option<[usize; 2]>, bool) {
    let triangles: Vec<&[[f32; 2]]> = uvs.chunks_exact(3).collect();
    let (mut first, mut doubt) = (None, false);
    for second in 0..triangles.len() {
        for other in 0..second {
            let area = common_area(triangles[other], triangles[second]);
            if area > 1e-5 {
                first = first.or(Some([other, second]));
            } else if area > 0.0 {
                doubt = true;
            }
        }
    }
    (first, doubt)
}

fn has_area(uvs: &[[f32; 2]]) -> bool {
    uvs.chunks_exact(3).all(|triangle| {
        let [a, b, c] = [0, 1, 2].map(|k| DVec2::from_array(triangle[k].map(f64::from)));
        (b - a).perp_dot(c - a).abs() > 1e-4
    })
}

/// A triangle somewhere, of some size.
fn triangle() -> impl Strategy<Value = [[f32; 2]; 3]> {
    let place = (0.0_f32..0.7, 0.0_f32..0.7, 0.02_f32..0.3);
    let corners = prop::array::uniform6(0.0_f32..1.0);
    (place, corners).prop_map(|((x, y, size), c)| {
        [[c[0], c[1]], [c[2], c[3]], [c[4], c[5]]].map(|[u, v]| [x + size * u, y + size * v])
    })
}

/// The squares of a grid, each two triangles whose diagonal lies either way, the grid's inner corners moved by less than
/// half a square: a mesh without overlap.
fn grid(side: usize) -> impl Strategy<Value = Vec<[f32; 2]>> {
    let corners = (side + 1) * (side + 1);
    (
        prop::collection::vec((-0.2_f32..0.2, -0.2_f32..0.2), corners),
        prop::collection::vec(any::<bool>(), side * side),
    )
        .prop_map(move |(moves, diagonals)| {
            let corner = |x: usize, y: usize| {
                let inner = |at: usize| f32::from(u8::from(at > 0 && at < side));
                let (u, v) = moves[y * (side + 1) + x];
                let place = |at: usize, by: f32| (at as f32 + inner(at) * by) / side as f32;
                [place(x, u), place(y, v)]
            };
            let mut uvs = Vec::new();
            for y in 0..side {
                for x in 0..side {
                    let [a, b] = [corner(x, y), corner(x, y + 1)];
                    let [c, d] = [corner(x + 1, y + 1), corner(x + 1, y)];
                    match diagonals[y * side + x] {
                        true => uvs.extend([a, b, c, a, c, d]),
                        false => uvs.extend([b, c, d, a, b, d]),
                    }
                }
            }
            uvs
        })
}

#[test]
fn the_first_of_several_is_named() {
    // The last lies on both others. The second is in the first rows of texture coordinates, the first is not.
    let corner = |x: f32, y: f32, size: f32| [[x, y], [x + size, y], [x, y + size]];
    let first = corner(0.1, 0.6, 0.3);
    let second = corner(0.1, 0.1, 0.3);
    let last = [[0.05, 0.05], [0.45, 0.05], [0.05, 0.95]];
    let on_both = [first, second, last].concat();
    assert_eq!(counted(&on_both), (Some([0, 2]), false));
    assert_eq!(told(&on_both), Err([0, 2]));
    assert_eq!(told(&[second, first, last].concat()), Err([0, 2]));
    assert_eq!(told(&[first, second].concat()), Ok(()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_triangles_overlap_as_their_areas_say(
        triangles in prop::collection::vec(triangle(), 1..9),
    ) {
        let uvs = triangles.concat();
        prop_assume!(has_area(&uvs));
        let (first, doubt) = counted(&uvs);
        prop_assume!(!doubt);
        prop_assert_eq!(told(&uvs).err(), first);
    }

    #[test]
    fn a_mesh_without_overlap_passes_and_a_corner_dragged_over_others_does_not(
        uvs in grid(5),
        dragged in 0_usize..150,
        to in (0.0_f32..1.0, 0.0_f32..1.0),
    ) {
        prop_assert_eq!(told(&uvs), Ok(()));
        let mut broken = uvs.clone();
        broken[dragged] = [to.0, to.1];
        prop_assume!(has_area(&broken));
        let (first, _) = counted(&broken);
        if first.is_some() {
            let found = told(&broken).err();
            prop_assert!(found.is_some_and(|pair| pair.contains(&(dragged / 3))), "{:?}", found);
        }
    }
}
