//! The package's tests compile from the package alone: they use no other package of this repository, and what
//! measures against the reference says so in `Cargo.toml`. (In the tree the feature is on for all tests; in a
//! package it is not.)

use std::path::{Path, PathBuf};

use super::{read, rust_files};

/// Folders of `tests/` that hold a binary, by name.
fn binaries() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let paths = std::fs::read_dir(root).unwrap();
    let mut folders: Vec<(String, PathBuf)> = paths
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.join("main.rs").is_file())
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), path))
        .collect();
    folders.sort();
    folders
}

fn is_packaged(manifest: &str, name: &str) -> bool {
    !manifest.contains(&format!("\"tests/{name}\""))
}

/// Whether the manifest has an entry for this test that asks for the feature.
fn asks_for_reference(manifest: &str, name: &str) -> bool {
    let mut entries = manifest
        .split("\n[")
        .filter_map(|section| section.strip_prefix("[test]]\n"))
        .filter(|entry| entry.contains(&format!("name = \"{name}\"")));
    entries.any(|entry| entry.contains("required-features = [\"reference\"]"))
}

/// What is wrong with the package's tests.
fn faults(manifest: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let packaged = binaries().into_iter();
    for (name, folder) in packaged.filter(|(name, _)| is_packaged(manifest, name)) {
        let texts: Vec<String> = rust_files(&folder)
            .iter()
            .map(|path| std::fs::read_to_string(path).unwrap())
            .collect();
        let uses = |sign: &str| texts.iter().any(|text| text.contains(sign));
        if uses("use host::") || uses("use compare::") {
            faults.push(format!("{name}: exclude it, as it uses another package"));
        }
        if uses("shadows::reference") && !asks_for_reference(manifest, &name) {
            faults.push(format!("{name}: it needs [[test]] and required-features"));
        }
    }
    faults
}

#[test]
fn the_tests_of_the_package_need_nothing_else() {
    let manifest = read("Cargo.toml");
    let none: [String; 0] = [];
    assert_eq!(faults(&manifest), none);
    let with_maps = manifest.replace("\"tests/maps\", ", "");
    assert_eq!(faults(&with_maps).len(), 1, "{:?}", faults(&with_maps));
    let silent = manifest.replace("required-features = [\"reference\"]", "");
    assert_eq!(faults(&silent).len(), 1, "{:?}", faults(&silent));
}

/// Every binary is linked with wgpu anew, which is most of the time that building the tests takes.
#[test]
fn a_test_is_a_module_of_a_binary() {
    for folder in ["tests", "examples/compare/tests", "examples/host/tests"] {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        for entry in std::fs::read_dir(root).unwrap() {
            let path = entry.unwrap().path();
            assert!(
                path.is_dir(),
                "{}: make it a module of the binary of its subject",
                path.display()
            );
        }
    }
    assert!(binaries().len() <= 11, "{:?}", binaries());
}
