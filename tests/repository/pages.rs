//! Pages show code that compiles, and what they link to is there.

use std::path::{Path, PathBuf};

use super::{blocks, read};

/// Lines without their indentation, which an excerpt does not share.
fn flush_left(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    lines.join("\n")
}

fn is_excerpt(block: &str) -> bool {
    let examples = ["examples/first_shadow.rs", "examples/egui/src/shadow.rs"];
    let block = flush_left(block);
    examples
        .iter()
        .any(|example| flush_left(&read(example)).contains(&block))
}

#[test]
fn the_steps_of_adding_the_crate_are_excerpts_of_examples() {
    let blocks = blocks(&read("docs/adding.md"), "rust");
    assert!(blocks.len() >= 8, "{} blocks", blocks.len());
    for block in blocks {
        assert!(is_excerpt(&block), "in no example:\n{block}");
        assert!(!is_excerpt(&block.replace('(', "((")) || !block.contains('('));
    }
}

/// Where a page's links and pictures lead, but for other sites and places within the page.
fn links(page: &str) -> Vec<&str> {
    let starts = page.split("](").skip(1);
    let targets = starts.map(|rest| rest.split(')').next().unwrap());
    targets
        .map(|target| target.split('#').next().unwrap())
        .filter(|target| !target.is_empty() && !target.contains("://") && !target.contains("data:"))
        .collect()
}

fn broken_links(path: &Path, page: &str) -> Vec<String> {
    let folder = path.parent().unwrap();
    let missing = |target: &&str| !folder.join(target).exists();
    let broken = links(page).into_iter().filter(missing);
    broken.map(str::to_owned).collect()
}

fn pages() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pages: Vec<PathBuf> = ["README.md", "CHANGELOG.md", "fuzz/README.md"]
        .iter()
        .map(|page| root.join(page))
        .collect();
    let docs = std::fs::read_dir(root.join("docs")).unwrap();
    let docs = docs.map(|entry| entry.unwrap().path());
    pages.extend(docs.filter(|path| path.extension().is_some_and(|e| e == "md")));
    pages
}

#[test]
fn what_pages_link_to_is_there() {
    for path in pages() {
        let page = std::fs::read_to_string(&path).unwrap();
        let broken = broken_links(&path, &page);
        assert!(broken.is_empty(), "{}: {broken:?}", path.display());
    }
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let broken = broken_links(&readme, "![a](docs/none.png) [b](docs/adding.md#none)");
    assert_eq!(broken, ["docs/none.png"]);
}
