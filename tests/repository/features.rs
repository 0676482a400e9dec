//! What measures against the reference says so in `Cargo.toml`. In the tree the feature is on for all tests;
//! in a package it is not, and what does not say so does not compile there.

use std::path::{Path, PathBuf};

use super::read;

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut files = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// Whether a target's file, or a module in the folder of its name, uses the host of the examples as a whole
/// or the reference itself.
fn needs_reference(file: &Path) -> bool {
    let modules = rust_files(&file.with_extension(""));
    let mut texts = std::iter::once(file.to_owned())
        .chain(modules)
        .map(|path| std::fs::read_to_string(path).unwrap());
    texts.any(|text| {
        ["mod host;", "shadows::reference"]
            .iter()
            .any(|sign| text.contains(sign))
    })
}

/// Whether the manifest has an entry of this kind and name that asks for the feature.
fn asks_for_reference(manifest: &str, kind: &str, name: &str) -> bool {
    let entries = manifest.split("\n[").filter_map(|section| {
        section
            .strip_prefix(&format!("[{kind}]]\n"))
            .filter(|entry| entry.contains(&format!("name = \"{name}\"")))
    });
    let mut entries = entries.map(|entry| entry.contains("required-features = [\"reference\"]"));
    entries.any(|asks| asks)
}

/// Targets of one kind that need the feature and do not ask for it.
fn silent(manifest: &str, kind: &str, folder: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut silent = Vec::new();
    for entry in std::fs::read_dir(root).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let main = path.join("main.rs");
        let file = if main.is_file() { main } else { path };
        // `repository` is not in the package.
        let needs = file.is_file() && name != "repository" && needs_reference(&file);
        if needs && !asks_for_reference(manifest, kind, &name) {
            silent.push(name);
        }
    }
    silent.sort();
    silent
}

#[test]
fn targets_that_need_the_reference_ask_for_it() {
    let manifest = read("Cargo.toml");
    for (kind, folder) in [
        ("test", "tests"),
        ("example", "examples"),
        ("bench", "benches"),
    ] {
        let none: [String; 0] = [];
        assert_eq!(
            silent(&manifest, kind, folder),
            none,
            "each needs [[{kind}]], name and required-features = [\"reference\"] in Cargo.toml"
        );
    }
    let without = manifest.replace(
        "name = \"volume\"\nrequired-features = [\"reference\"]\n",
        "",
    );
    assert_eq!(silent(&without, "test", "tests"), ["volume"]);
}
