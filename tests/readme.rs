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
