//! What pages and comments name is there: files of this repository, and targets of commands.

use std::path::{Path, PathBuf};

use super::read;

/// Where files are named from, and where paths in backticks may lead.
const FOLDERS: [&str; 8] = [
    "benches/",
    "docs/",
    "examples/",
    "fuzz/",
    "scripts/",
    "shaders/",
    "src/",
    "tests/",
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every page, script and source file, by its path from the root.
fn texts() -> Vec<String> {
    let mut found = vec![
        "README.md".to_owned(),
        "CHANGELOG.md".to_owned(),
        ".ci/run".to_owned(),
    ];
    let mut waiting: Vec<PathBuf> = FOLDERS.map(|folder| root().join(folder)).to_vec();
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            let is_text = [".md", ".rs", ".sh"].iter().any(|end| name.ends_with(end));
            if path.is_dir() && name != "target" && name != "corpus" {
                waiting.push(path);
            } else if is_text && name != "named.rs" {
                let path = path.strip_prefix(root()).unwrap();
                found.push(path.to_str().unwrap().to_owned());
            }
        }
    }
    found
}

/// Paths in backticks that are not there.
fn missing_files(text: &str) -> Vec<String> {
    let is_path = |word: &&str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
        let is_placeholder = word.ends_with("/NAME");
        FOLDERS.iter().any(|folder| word.starts_with(folder))
            && word.chars().all(plain)
            && !is_placeholder
    };
    let words = text.split('`').skip(1).step_by(2);
    words
        .filter(is_path)
        .filter(|path| !root().join(path).exists())
        .map(str::to_owned)
        .collect()
}

/// Where a target of this kind and name may be.
fn homes(kind: &str, name: &str) -> Vec<String> {
    match kind {
        "--example" => vec![
            format!("examples/{name}.rs"),
            format!("examples/{name}/src/main.rs"),
            format!("examples/compare/examples/{name}.rs"),
            format!("examples/compare/examples/{name}/main.rs"),
        ],
        "--bench" => vec![
            format!("benches/{name}.rs"),
            format!("benches/{name}/main.rs"),
        ],
        "--test" => vec![
            format!("tests/{name}/main.rs"),
            format!("examples/compare/tests/{name}/main.rs"),
            format!("examples/host/tests/{name}/main.rs"),
        ],
        "--manifest-path" => vec![name.to_owned()],
        _ => Vec::new(),
    }
}

/// Targets of commands that are not there.
fn missing_targets(text: &str) -> Vec<String> {
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || "`\"'();,".contains(c))
        .collect();
    let pairs = words
        .windows(2)
        .map(|pair| (pair[0], pair[1].trim_end_matches('.')));
    pairs
        .filter(|(kind, name)| {
            let homes = homes(kind, name);
            let plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
            let is_name = !name.is_empty() && name.chars().all(plain) && !name.starts_with('-');
            is_name && !homes.is_empty() && !homes.iter().any(|home| root().join(home).exists())
        })
        .map(|(kind, name)| format!("{kind} {name}"))
        .collect()
}

#[test]
fn files_that_are_named_are_there() {
    let mut missing = Vec::new();
    for file in texts() {
        missing.extend(
            missing_files(&read(&file))
                .iter()
                .map(|path| format!("{file}: {path}")),
        );
    }
    assert!(missing.is_empty(), "{missing:#?}");
    let text = "`docs/adding.md` and `docs/none.md`, `src/*.rs`";
    assert_eq!(missing_files(text), ["docs/none.md"]);
}

#[test]
fn commands_name_targets_that_are_there() {
    let mut missing = Vec::new();
    for file in texts() {
        missing.extend(
            missing_targets(&read(&file))
                .iter()
                .map(|target| format!("{file}: {target}")),
        );
    }
    assert!(missing.is_empty(), "{missing:#?}");
    let text = "`cargo run --example compare -- --out a`, `cargo bench --bench none`; cargo test --test maps.";
    assert_eq!(missing_targets(text), ["--bench none"]);
}
