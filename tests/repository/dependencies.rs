//! What a host is told to depend on is what its first shadow needs, back ends included.

use super::{blocks, read};

/// A dependency's name and, but for ours, which versions will do.
type Dependency = (String, Option<String>);

/// What the `cargo add` lines of a page's first block of shell name.
fn added(page: &str) -> Vec<Dependency> {
    let block = &blocks(page, "sh")[0];
    let lines = block
        .lines()
        .filter_map(|line| line.strip_prefix("cargo add "));
    let mut found = Vec::new();
    for line in lines {
        let line = line.split(" #").next().unwrap();
        let words: Vec<&str> = line.split_whitespace().collect();
        let path = words.iter().position(|word| *word == "--path");
        for (at, word) in words.iter().enumerate() {
            if path.is_some_and(|path| at == path || at == path + 1) {
                continue;
            }
            assert!(!word.starts_with('-'), "{word} in `cargo add {line}`");
            let (name, version) = word.split_once('@').unwrap_or((word, ""));
            found.push((
                name.to_owned(),
                (!version.is_empty()).then(|| version.to_owned()),
            ));
        }
    }
    found.sort();
    found
}

/// What a page's block of TOML names, as lines `name = "version"` or `name = { path = ".." }`.
fn declared(page: &str) -> Vec<Dependency> {
    let block = &blocks(page, "toml")[0];
    let lines = block.lines().filter(|line| !line.starts_with(['[', '#']));
    let mut found: Vec<Dependency> = lines
        .map(|line| {
            let (name, value) = line.split_once(" = ").unwrap();
            let version = value
                .strip_prefix('"')
                .map(|v| v.split('"').next().unwrap());
            (name.to_owned(), version.map(str::to_owned))
        })
        .collect();
    found.sort();
    found
}

/// The crates by whose names `first_shadow.rs` calls them, and wgpu, which it needs for its back ends.
fn needed() -> Vec<String> {
    let example = read("examples/first_shadow.rs");
    let candidates = ["bytemuck", "glam", "png", "pollster", "wgpu"];
    let used = candidates.iter().filter(|name| {
        let by_path = format!("{name}::");
        let own = format!("shadows::{name}");
        **name == "wgpu" || (example.contains(&by_path) && !example.contains(&own))
    });
    let mut names: Vec<String> = used.map(|name| (*name).to_owned()).collect();
    names.push("shadows".to_owned());
    names.sort();
    names
}

/// The requirement of `Cargo.toml` on a crate, among those for hosts or for tests.
fn required(name: &str) -> String {
    let manifest = read("Cargo.toml");
    let line = manifest
        .lines()
        .find(|line| line.starts_with(&format!("{name} = ")))
        .unwrap_or_else(|| panic!("{name} is not in Cargo.toml"));
    line.split('"').nth(1).unwrap().to_owned()
}

fn names(dependencies: &[Dependency]) -> Vec<String> {
    dependencies.iter().map(|(name, _)| name.clone()).collect()
}

#[test]
fn a_host_is_told_to_depend_on_what_its_first_shadow_needs() {
    let readme = added(&read("README.md"));
    let guide = declared(&read("docs/adding.md"));
    assert_eq!(names(&readme), needed());
    assert_eq!(names(&guide), needed());
    for (name, version) in &guide {
        let expected = (name != "shadows").then(|| required(name));
        assert_eq!(*version, expected, "{name} in docs/adding.md");
    }
    for (name, version) in readme {
        if let Some(version) = version {
            assert_eq!(version, required(&name), "{name} in the README");
        }
    }
}

#[test]
fn dependencies_are_read_as_they_stand() {
    let page = "\n```sh\ncargo new a\ncargo add shadows --path ../shadows # ours\ncargo add wgpu@30 png\n```\n";
    let expected = [("png", None), ("shadows", None), ("wgpu", Some("30"))]
        .map(|(name, version)| (name.to_owned(), version.map(str::to_owned)));
    assert_eq!(added(page), expected);
    let page =
        "\n```toml\n[dependencies]\n# a\nshadows = { path = \"..\" }\nwgpu = \"30\" # b\n```\n";
    assert_eq!(declared(page), expected[1..]);
}

/// The versions of a crate in a lock file.
fn locked(lock: &str, name: &str) -> Vec<String> {
    let entry = format!("name = \"{name}\"\nversion = \"");
    let versions = lock.split(entry.as_str()).skip(1);
    versions
        .map(|rest| rest.split('"').next().unwrap().to_owned())
        .collect()
}

/// Two of them would split the types that hosts pass in.
#[test]
fn there_is_one_wgpu_and_one_glam_in_every_lock_file() {
    for file in [
        "Cargo.lock",
        "examples/bevy/Cargo.lock",
        "examples/egui/Cargo.lock",
        "examples/kiss3d/Cargo.lock",
        "examples/web/Cargo.lock",
        "fuzz/Cargo.lock",
    ] {
        let lock = read(file);
        for (name, line) in [("wgpu", "30."), ("naga", "30."), ("glam", "0.33.")] {
            let versions = locked(&lock, name);
            let one = versions.len() == 1 && versions[0].starts_with(line);
            assert!(one, "{name} in {file}: {versions:?}");
        }
        let twice = format!("{lock}\nname = \"glam\"\nversion = \"0.34.2\"\n");
        assert_eq!(locked(&twice, "glam").len(), 2);
    }
}
