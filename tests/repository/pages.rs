//! Pages show code that compiles, and what they link to is there.

use std::path::{Path, PathBuf};

use super::{blocks, read};

/// Lines without their indentation, which an excerpt does not share.
fn flush_left(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    lines.join("\n")
}

fn is_excerpt(block: &str) -> bool {
    let examples = [
        "examples/first_shadow.rs",
        "examples/egui/src/shadow.rs",
        "tests/volume/one_pass.rs",
    ];
    let block = flush_left(block);
    examples
        .iter()
        .any(|example| flush_left(&read(example)).contains(&block))
}

#[test]
fn the_steps_of_adding_the_crate_are_excerpts_of_examples() {
    // The others are tests of the documentation.
    let blocks = blocks(&read("docs/adding.md"), "rust,ignore");
    assert!(blocks.len() >= 8, "{} blocks", blocks.len());
    for block in blocks {
        assert!(is_excerpt(&block), "in no example:\n{block}");
        assert!(!is_excerpt(&block.replace('(', "((")) || !block.contains('('));
    }
}

/// README's code: the pieces between its comments `// ...` are excerpts.
#[test]
fn the_readme_shows_code_that_runs() {
    let blocks = blocks(&read("README.md"), "rust");
    assert_eq!(blocks.len(), 1);
    let lines: Vec<&str> = blocks[0].lines().collect();
    let pieces: Vec<String> = lines
        .split(|line| line.starts_with("// ..."))
        .map(|piece| piece.join("\n"))
        .collect();
    assert!(pieces.len() >= 4, "{} pieces", pieces.len());
    for piece in pieces {
        assert!(is_excerpt(&piece), "in no example:\n{piece}");
        assert!(!is_excerpt(&piece.replacen('(', "((", 1)));
    }
    assert!(
        lines.len() <= 40,
        "{} lines are not the shortest code",
        lines.len()
    );
}

/// Where a page's links and pictures lead, those of its definitions `[name]: target` included, but for other
/// sites.
fn links(page: &str) -> Vec<&str> {
    let starts = page.split("](").skip(1);
    let inline = starts.map(|rest| rest.split(')').next().unwrap());
    let defined = page.lines().filter(|line| line.starts_with('['));
    let targets = inline.chain(defined.filter_map(|line| line.split_once("]: ").map(|(_, to)| to)));
    targets
        .filter(|target| !target.is_empty() && !target.contains("://") && !target.contains("data:"))
        .collect()
}

/// The anchors of a page: its headings in lower case, words joined by hyphens, the rest left out.
fn anchors(page: &str) -> Vec<String> {
    let headings = page.lines().filter_map(|line| line.strip_prefix('#'));
    headings
        .map(|heading| {
            let words = heading.trim_start_matches('#').trim().to_lowercase();
            let kept = words
                .chars()
                .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

fn broken_links(path: &Path, page: &str) -> Vec<String> {
    let is_broken = |target: &&str| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let file = match file {
            "" => path.to_owned(),
            file => path.parent().unwrap().join(file),
        };
        if anchor.is_empty() || !file.exists() {
            return !file.exists();
        }
        let text = std::fs::read_to_string(file).unwrap();
        !anchors(&text).iter().any(|heading| heading == anchor)
    };
    let broken = links(page).into_iter().filter(is_broken);
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
    let page = "![a](docs/none.png) [b](docs/adding.md#2-register-each-mesh-once) [c](docs/adding.md#none) [d][d]\n[d]: no.md";
    let broken = broken_links(&readme, page);
    assert_eq!(broken, ["docs/none.png", "docs/adding.md#none", "no.md"]);
}

/// Which test compiles the Rust of a page; a page that is not here may have none.
const COMPILED: [(&str, &str); 3] = [
    ("README.md", "the_readme_shows_code_that_runs"),
    ("adding.md", "a test of the documentation"),
    (
        "speed-vs-error.md",
        "what `compare --sweep` advises, compiled by its own tests",
    ),
];

fn is_unchecked(name: &str, page: &str) -> bool {
    let is_compiled = COMPILED.iter().any(|(known, _)| *known == name);
    !blocks(page, "rust").is_empty() && !is_compiled
}

#[test]
fn all_rust_of_pages_is_compiled_somewhere() {
    for path in pages() {
        let page = std::fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(!is_unchecked(name, &page), "{name}: who compiles its Rust?");
    }
    assert!(is_unchecked("none.md", "a\n```rust\nfn a() {}\n```\n"));
}
