//! Cascades as the camera turns and walks.

use super::*;

/// How many frames change as a camera turns in place in 64 steps, looking up and down too.
fn changes_in_a_turn(fit: CascadeFit, eye: Vec3, view: fn(Vec3, Vec3) -> View) -> usize {
    changes_in_a_turn_of(&fitted(fit), eye, view)
}

fn changes_in_a_turn_of(cascades: &Cascades, eye: Vec3, view: fn(Vec3, Vec3) -> View) -> usize {
    let light = sun();
    let mut last = Vec::new();
    let mut before: Option<Vec<FlatFrame>> = None;
    let mut changes = 0;
    for step in 0..64 {
        let angle = std::f32::consts::TAU * step as f32 / 64.0;
        let along = Vec3::new(angle.cos(), 0.4 * (3.0 * angle).sin(), angle.sin());
        let view = view(eye, along);
        let now = fit_cascades(&CascadesOf {
            last: &last,
            ..of(&view, &light, cascades)
        })
        .unwrap();
        last = placed(&now);
        let now = frames(&now);
        if let Some(before) = before {
            changes += now.iter().zip(&before).filter(|(a, b)| a != b).count();
        }
        before = Some(now);
    }
    changes
}

fn places() -> impl Iterator<Item = Vec3> {
    (0..40).map(|i| {
        let at = i as f32;
        Vec3::new((at * 1.7).sin(), (at * 0.9).cos(), (at * 2.3).sin()) * (1.0 + 12.0 * at)
    })
}

#[test]
fn a_camera_that_turns_in_place_changes_no_frame() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let wide = |eye, along| perspective(170.0, eye, along);
    for eye in places() {
        assert_eq!(
            changes_in_a_turn(CascadeFit::Stable, eye, normal),
            0,
            "{eye}"
        );
        assert_eq!(changes_in_a_turn(CascadeFit::Stable, eye, wide), 0, "{eye}");
        assert_eq!(
            changes_in_a_turn(CascadeFit::Stable, eye, off_centre),
            0,
            "{eye}"
        );
    }
    // Just between two texels of the first cascade, too, as far as can be told.
    let (light, cascades) = (sun(), fitted(CascadeFit::Stable));
    let view = normal(Vec3::ONE, Vec3::X);
    let first = frames(&fit_cascades(&of(&view, &light, &cascades)).unwrap())[0];
    let texel = 2.0 / first.scale / SIZE as f32;
    for texels in 0..40 {
        let eye = (first.right + first.up) * (texels as f32 + 0.5) * texel;
        let cascades = Cascades {
            margin: 0.0,
            ..cascades
        };
        assert_eq!(changes_in_a_turn_of(&cascades, eye, normal), 0, "{eye}");
    }
    // The broken twin: a fit that goes by what is seen.
    assert!(changes_in_a_turn(CascadeFit::Tight, Vec3::ONE, normal) > 200);
}

/// Where a camera is on its way.
fn place(step: u32) -> Vec3 {
    let step = step as f32;
    Vec3::new(0.05 * step, 2.0 + (0.1 * step).sin(), 8.0 - 0.03 * step)
}

/// What a camera does to the cascades of a light on its way: for each step and cascade, the frame and
/// the one before.
fn walk(
    cascades: &Cascades,
    view: fn(Vec3, Vec3) -> View,
    light_turns: f32,
) -> Vec<(FlatFrame, FlatFrame)> {
    let mut last = Vec::new();
    let mut before: Vec<FlatFrame> = Vec::new();
    let mut steps = Vec::new();
    for step in 0..300 {
        let step = step as f32;
        let light = DirectionalLight {
            toward_light: sun().toward_light + Vec3::X * light_turns * step,
        };
        let eye = Vec3::new(0.05 * step, 2.0 + (0.1 * step).sin(), 8.0 - 0.03 * step);
        let view = view(
            eye,
            Vec3::new((0.02 * step).sin(), -0.1, (0.02 * step).cos()),
        );
        let now = fit_cascades(&CascadesOf {
            last: &last,
            ..of(&view, &light, cascades)
        })
        .unwrap();
        last = placed(&now);
        let now = frames(&now);
        steps.extend(now.iter().copied().zip(before));
        before = now;
    }
    steps
}

/// How far a fixed point of the world is from whole texels away from where it was on the map, at most;
/// and how often the map moved, and its scale changed.
fn grid_motion(steps: &[(FlatFrame, FlatFrame)]) -> (f64, usize, usize) {
    let texels = |frame: &FlatFrame| {
        let from = DVec3::new(3.3, 0.7, -2.1) - frame.origin.as_dvec3();
        let scale = f64::from(frame.scale) * f64::from(SIZE) / 2.0;
        DVec3::new(
            frame.right.as_dvec3().dot(from) * scale,
            frame.up.as_dvec3().dot(from) * scale,
            0.0,
        )
    };
    let (mut off, mut moved, mut resized) = (0.0_f64, 0, 0);
    for (now, before) in steps {
        if now.scale != before.scale {
            resized += 1;
            continue;
        }
        moved += usize::from(now != before);
        let shift = texels(now) - texels(before);
        off = off.max((shift - shift.round()).abs().max_element());
    }
    (off, moved, resized)
}

#[test]
fn a_camera_that_walks_moves_stable_cascades_by_whole_texels() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let cascades = Cascades {
        margin: 0.0,
        ..fitted(CascadeFit::Stable)
    };
    for view in [normal as fn(Vec3, Vec3) -> View, off_centre, orthographic] {
        let (off, moved, resized) = grid_motion(&walk(&cascades, view, 0.0));
        // What is left is the rounding of places to f32: here 1e-6 of 0.01.
        assert!(off < 1e-3, "{off} texels");
        assert!(moved > 300, "the maps follow: {moved}");
        assert_eq!(resized, 0);
    }
    // The broken twins: a light that turns takes the grid with it, and a tight fit changes in size.
    let (off, ..) = grid_motion(&walk(&cascades, normal, 1e-4));
    assert!(off > 0.01, "{off} texels");
    let (_, _, resized) = grid_motion(&walk(&fitted(CascadeFit::Tight), normal, 0.0));
    assert!(resized > 0);
}

#[test]
fn a_cascade_stays_until_the_camera_has_walked_its_margin() {
    let normal = |eye, along| perspective(50.0, eye, along);
    let path: f32 = (1..300)
        .map(|step| place(step).distance(place(step - 1)))
        .sum();
    let moves = |margin| {
        let cascades = Cascades {
            margin,
            ..fitted(CascadeFit::Stable)
        };
        let steps = walk(&cascades, normal, 0.0);
        [0, 1, 2, 3].map(|cascade| {
            let steps: Vec<_> = steps.iter().skip(cascade).step_by(4).copied().collect();
            (2.0 / steps[0].0.scale, grid_motion(&steps).1)
        })
    };
    let margin = 1.0 / 32.0;
    let total = |moves: [(f32, usize); 4]| moves.iter().map(|(_, moves)| moves).sum::<usize>();
    for (width, moved) in moves(margin) {
        let most = path / (margin * width);
        assert!(moved as f32 <= most, "{width} wide: {moved}, not {most}");
    }
    // The broken twin: without a margin they follow.
    let (stay, follow) = (total(moves(margin)), total(moves(0.0)));
    assert!(10 * stay < follow, "{stay} {follow}");
}

#[test]
fn depths_seen_that_change_a_little_change_no_size() {
    let (light, view) = (sun(), perspective(50.0, Vec3::ONE, Vec3::X));
    // How often sizes change while the farthest that is seen goes to and fro by a share of itself.
    let resized = |share: f32, fit| {
        let cascades = fitted(fit);
        let mut last = Vec::new();
        let mut scales: Vec<f32> = Vec::new();
        let mut resized = 0;
        for frame in 0..40 {
            let farthest = 40.0 * (1.0 + share * (0.7 * frame as f32).sin());
            let depth_bounds = Some(DepthBounds {
                nearest: 1.0,
                farthest,
            });
            let now = fit_cascades(&CascadesOf {
                depth_bounds,
                last: &last,
                ..of(&view, &light, &cascades)
            })
            .unwrap();
            last = placed(&now);
            let now: Vec<f32> = frames(&now).iter().map(|frame| frame.scale).collect();
            // The first ones find the greatest.
            let changed = now.iter().zip(&scales).filter(|(a, b)| a != b).count();
            resized += if frame > 9 { changed } else { 0 };
            scales = now;
        }
        resized
    };
    for fit in FITS {
        assert_eq!(resized(0.08, fit), 0, "{fit:?}");
        assert!(resized(0.4, fit) > 10, "{fit:?}");
    }
}
