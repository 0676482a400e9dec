//! How cost grows: the fit against power laws, and a small run of the measurement.

use compare::growth::fit::{added, upper};
use compare::growth::quantity::Quantity;
use host::gpu::Gpu;
use serde_json::Value;

/// A power law at these places, with a cost that does not grow.
fn law(places: &[f64], power: f64, constant: f64) -> Vec<(f64, f64)> {
    let law = |&x: &f64| (x, constant + 3.0 * x.powf(power));
    places.iter().map(law).collect()
}

const PLACES: [f64; 7] = [1e3, 4e3, 1.6e4, 6.4e4, 2.5e5, 1e6, 4e6];

#[test]
fn a_power_law_is_found_exactly() {
    for power in [-0.5, 0.0, 0.5, 1.0, 2.0] {
        let fit = upper(&law(&PLACES, power, 0.0)).unwrap();
        assert!((fit.slope - power).abs() < 1e-12, "{power}: {fit:?}");
        assert!(fit.error.unwrap() < 1e-9 && fit.points == 4, "{fit:?}");
    }
    let words = [0.1, 0.5, 1.0, 1.5].map(|p| upper(&law(&PLACES, p, 0.0)).unwrap().word());
    assert_eq!(words, ["flat", "below linear", "linear", "above linear"]);
}

#[test]
fn what_does_not_grow_counts_less_in_the_upper_half() {
    let points = law(&PLACES, 1.0, 3e5);
    let all = upper(&points).unwrap().slope;
    // The twin: the lower half, where the constant is nearly everything.
    let lower = upper(&points[..4]).unwrap().slope;
    assert!(all > 0.75 && lower < 0.4, "{all} {lower}");
}

#[test]
fn what_comes_on_top_of_the_first_point_tells_a_law_from_a_constant() {
    for power in [0.5, 1.0, 1.5] {
        // Half of the last point is constant.
        let points = law(&PLACES, power, 3.0 * 4e6_f64.powf(power));
        let on_top = added(&points).unwrap();
        // Not exactly: what is taken off holds the first point's own share of the law.
        assert!((on_top.slope - power).abs() < 0.04, "{power}: {on_top:?}");
        // The twin: with the constant.
        let all = upper(&points).unwrap().slope;
        assert!((all - power).abs() > 0.1, "{power}: {all}");
    }
    assert_eq!(added(&law(&PLACES, 0.0, 5.0)), None);
    assert_eq!(added(&law(&PLACES, 1.0, 1e9)), None);
    assert_eq!(added(&[]), None);
}

#[test]
fn the_error_says_how_far_from_a_line_the_points_are() {
    let mut points = law(&PLACES, 1.0, 0.0);
    points[5].1 *= 1.5;
    let fit = upper(&points).unwrap();
    assert!(
        fit.error > Some(0.02) && (fit.slope - 1.0).abs() < 3.0 * fit.error.unwrap(),
        "{fit:?}"
    );
    // Points without a logarithm, and too few of them.
    points.push((1e7, -1.0));
    assert_eq!(upper(&points), Some(fit));
    assert_eq!(upper(&points[..1]), None);
    assert_eq!(upper(&[(2.0, 1.0), (2.0, 3.0)]), None);
    assert_eq!(upper(&[(1.0, 1.0), (2.0, f64::NAN)]), None);
    let two = upper(&[(1.0, 1.0), (10.0, 100.0)]).unwrap();
    assert!((two.slope - 2.0).abs() < 1e-12 && two.error.is_none());
}

#[test]
fn series_reach_as_far_as_asked() {
    let ends = |quantity: Quantity, times: f64| {
        let series = quantity.series(times);
        [series[0], series[series.len() - 1]].map(|size| quantity.amount(size).round())
    };
    assert_eq!(ends(Quantity::Triangles, 1e6), [1024.0, 4e6]);
    assert_eq!(ends(Quantity::Triangles, 16.0), [1024.0, 16_384.0]);
    assert_eq!(ends(Quantity::Casters, 1e6), [1.0, 1e5]);
    assert_eq!(ends(Quantity::Meshes, 1e6), [1.0, 1e4]);
    assert_eq!(ends(Quantity::Lights, 1e6), [1.0, 64.0]);
    assert_eq!(ends(Quantity::Views, 1e6), [1.0, 16.0]);
    assert_eq!(
        ends(Quantity::Pixels, 1e6),
        [640.0 * 360.0, 3840.0 * 2160.0]
    );
    assert_eq!(ends(Quantity::Texels, 1e6), [65_536.0, 16_777_216.0]);
    for quantity in Quantity::ALL {
        assert_eq!(quantity.series(1.0).len(), 2, "{quantity:?}");
        // What a situation holds is what its series says.
        let size = quantity.series(1.0)[1];
        let situation = quantity.situation(size);
        let held = match quantity {
            // The triangles at the poles have no area.
            Quantity::Triangles => situation.caster.indices.len() / 3 * situation.transforms.len(),
            Quantity::Casters => situation.transforms.len(),
            Quantity::Meshes => {
                assert!(situation.distinct);
                situation.transforms.len()
            }
            Quantity::Lights => situation.lights.len(),
            Quantity::Views => situation.views as usize,
            Quantity::Pixels => (situation.size[0] * situation.size[1]) as usize,
            Quantity::Texels => (situation.side * situation.side) as usize,
        };
        assert_eq!(held as f64, quantity.amount(size), "{quantity:?}");
    }
}

#[test]
fn a_short_run_writes_a_page_and_a_plot_for_each_quantity() {
    let Some(gpu) = Gpu::for_test() else { return };
    let dir = std::env::temp_dir().join(format!("shadows-growth-{}", std::process::id()));
    compare::growth::run(&gpu, 1.0, 2, &dir).unwrap();
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap();
    let (page, json) = (read("growth.md"), read("growth.json"));
    let json: Value = serde_json::from_str(&json).unwrap();
    let series = json["series"].as_array().unwrap();
    assert_eq!(series.len(), Quantity::ALL.len());
    for (one, quantity) in series.iter().zip(Quantity::ALL) {
        let name = quantity.name();
        assert_eq!(one["quantity"], name);
        let curves = one["curves"].as_array().unwrap();
        let of_one_technique = ["map-size", "views"].contains(&name);
        assert_eq!(curves.len(), if of_one_technique { 2 } else { 4 });
        let svg = read(&format!("growth-{name}.svg"));
        assert!(page.contains(&format!("(growth-{name}.svg)")));
        for curve in curves {
            let kind = curve["name"].as_str().unwrap();
            assert!(page.contains(&format!("| {kind} |")) && svg.contains(kind));
            let prepare = curve["prepare_ms"].as_array().unwrap();
            assert_eq!(prepare.len(), 2);
            assert!(prepare.iter().all(|point| point[1].as_f64().unwrap() > 0.0));
            assert!(curve["prepare_fit"]["slope"].is_number(), "{curve}");
        }
    }
    std::fs::remove_dir_all(&dir).unwrap();
}
