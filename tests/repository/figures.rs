//! Pages have a place for each figure that `scripts/report.sh` puts into them.

use super::read;

/// Whether a page has a place for a figure, with something in it.
fn has_figure(page: &str, name: &str) -> bool {
    let (open, shut) = (format!("<!-- {name} -->"), format!("<!-- /{name} -->"));
    let inside = page
        .split_once(&open)
        .and_then(|(_, rest)| rest.split_once(&shut));
    inside.is_some_and(|(figure, _)| !figure.trim().is_empty() && page.matches(&open).count() == 1)
}

#[test]
fn every_figure_that_is_measured_has_its_place() {
    let script = read("scripts/report.sh");
    let words: Vec<&str> = script.split_whitespace().collect();
    let puts = words
        .windows(3)
        .filter(|w| w[0] == "put" && w[2].starts_with('$'));
    let mut count = 0;
    for put in puts {
        let page = match put[2].trim_start_matches('$') {
            "readme" => read("README.md"),
            page => read(page),
        };
        assert!(has_figure(&page, put[1]), "{} has no {}", put[2], put[1]);
        assert!(!has_figure(&page.replace(put[1], "other"), put[1]));
        count += 1;
    }
    assert!(count >= 8, "{count} figures");
}
