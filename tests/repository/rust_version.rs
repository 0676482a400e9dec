//! The Rust that the crate states is no older than that of what it depends on.

use std::collections::BTreeMap;
use std::process::Command;

use serde_json::Value;

use super::read;

/// What `reference` takes; `rust-version` in `Cargo.toml` is for everything else.
const WITH_REFERENCE: (u32, u32) = (1, 89);
const REFERENCE: [&str; 2] = ["parry3d_f64", "rayon"];

fn version(text: &str) -> (u32, u32) {
    let mut numbers = text.split('.').map(|number| number.parse().unwrap());
    (numbers.next().unwrap(), numbers.next().unwrap())
}

/// This platform, since what others need is not downloaded.
fn platform() -> String {
    let rustc = std::env::var("RUSTC").unwrap_or("rustc".to_owned());
    let output = Command::new(rustc).arg("-vV").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.unwrap().to_owned()
}

fn metadata() -> Value {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--locked",
            "--all-features",
        ])
        .args(["--filter-platform", &platform()])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Who needs a Rust newer than `most`, among all that the library depends on (but for what its own
/// dependencies named `without` bring).
fn newer(metadata: &Value, without: &[&str], most: (u32, u32)) -> Vec<String> {
    let by_id = |list: &Value| -> BTreeMap<String, Value> {
        let entries = list.as_array().unwrap().iter();
        entries
            .map(|entry| (entry["id"].as_str().unwrap().to_owned(), entry.clone()))
            .collect()
    };
    let nodes = by_id(&metadata["resolve"]["nodes"]);
    let packages = by_id(&metadata["packages"]);
    let root = metadata["resolve"]["root"].as_str().unwrap();
    let mut open = vec![root.to_owned()];
    let mut seen = Vec::new();
    while let Some(id) = open.pop() {
        if seen.contains(&id) {
            continue;
        }
        for dependency in nodes[&id]["deps"].as_array().unwrap() {
            let kinds = dependency["dep_kinds"].as_array().unwrap();
            let for_tests = kinds.iter().all(|kind| kind["kind"] == "dev");
            let left_out = id == root && without.contains(&dependency["name"].as_str().unwrap());
            if !for_tests && !left_out {
                open.push(dependency["pkg"].as_str().unwrap().to_owned());
            }
        }
        seen.push(id);
    }
    let needs = |id: &String| {
        let stated = packages[id]["rust_version"].as_str()?;
        let name = packages[id]["name"].as_str().unwrap();
        (version(stated) > most).then(|| format!("{name} {stated}"))
    };
    seen.iter().filter_map(needs).collect()
}

#[test]
fn no_dependency_needs_a_newer_rust_than_is_stated() {
    let metadata = metadata();
    let root = metadata["resolve"]["root"].as_str().unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    let own = packages.iter().find(|package| package["id"] == root);
    let stated = version(own.unwrap()["rust_version"].as_str().unwrap());
    let none: [String; 0] = [];
    assert_eq!(newer(&metadata, &REFERENCE, stated), none);
    assert_eq!(newer(&metadata, &[], WITH_REFERENCE), none);
    // `reference` takes more than the rest, or what follows says too much.
    assert_ne!(newer(&metadata, &[], stated), none);
    for page in ["README.md", "CHANGELOG.md", "src/lib.rs"] {
        let page = read(page);
        for (major, minor) in [stated, WITH_REFERENCE] {
            assert!(
                page.contains(&format!("{major}.{minor}")),
                "{major}.{minor}"
            );
        }
    }
}
