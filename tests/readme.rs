//! The README and the pages of docs/ show the code that runs.

#[test]
fn the_host_in_the_readme_is_the_example() {
    let readme = include_str!("../README.md");
    let example = include_str!("../examples/first_shadow.rs");
    let start = readme.find("```rust\n").unwrap() + "```rust\n".len();
    let end = start + readme[start..].find("\n```\n").unwrap() + 1;
    assert_eq!(&readme[start..end], example);
}

/// Lines without their indentation, which an excerpt does not share.
fn flush_left(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    lines.join("\n")
}

/// The blocks of Rust of a page.
fn blocks(page: &str) -> Vec<&str> {
    let starts = page.split("```rust\n").skip(1);
    starts
        .map(|rest| rest.split("\n```").next().unwrap())
        .collect()
}

fn is_excerpt(block: &str) -> bool {
    let examples = [
        include_str!("../examples/first_shadow.rs"),
        include_str!("../examples/egui/src/shadow.rs"),
    ];
    let block = flush_left(block);
    examples
        .iter()
        .any(|example| flush_left(example).contains(&block))
}

#[test]
fn the_steps_of_adding_the_crate_are_excerpts_of_examples() {
    let page = include_str!("../docs/adding.md");
    let blocks = blocks(page);
    assert!(blocks.len() >= 8, "{} blocks", blocks.len());
    for block in blocks {
        assert!(is_excerpt(block), "in no example:\n{block}");
        assert!(!is_excerpt(&block.replace('(', "((")) || !block.contains('('));
    }
}

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
    // What is packaged comes without scripts.
    let Ok(script) = std::fs::read_to_string("scripts/report.sh") else {
        return;
    };
    let words: Vec<&str> = script.split_whitespace().collect();
    let puts = words
        .windows(3)
        .filter(|w| w[0] == "put" && w[2].starts_with('$'));
    let mut count = 0;
    for put in puts {
        let page = match put[2].trim_start_matches('$') {
            "readme" => include_str!("../README.md"),
            "docs/benches.md" => include_str!("../docs/benches.md"),
            other => panic!("what page is {other}?"),
        };
        assert!(has_figure(page, put[1]), "{} has no {}", put[2], put[1]);
        assert!(!has_figure(&page.replace(put[1], "other"), put[1]));
        count += 1;
    }
    assert!(count >= 8, "{count} figures");
}
