//! A field of a statistic or a variant of an enum may be added in a minor release: hosts cannot list them all,
//! unless the type's documentation says that the list is whole.

use std::path::Path;

use super::{read, rust_files};

/// The name of a public enum, or of a public struct of statistics, that a line declares.
fn declared(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let name = |rest: &'_ str| {
        rest.split(|c: char| !c.is_alphanumeric())
            .next()
            .map(str::len)
    };
    if let Some(rest) = line.strip_prefix("pub enum ") {
        return Some(&rest[..name(rest)?]);
    }
    let rest = line.strip_prefix("pub struct ")?;
    let name = &rest[..name(rest)?];
    name.ends_with("Statistics").then_some(name)
}

/// Those whose attributes and documentation, right above them, do not say whether they may grow.
fn silent(text: &str) -> (usize, Vec<String>) {
    let lines: Vec<&str> = text.lines().collect();
    let mut count = 0;
    let mut silent = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some(name) = declared(line) else { continue };
        count += 1;
        let head = lines[..at].iter().rev();
        let mut head = head.take_while(|line| !line.trim().is_empty() && line.trim() != "}");
        if !head.any(|line| line.contains("#[non_exhaustive]") || line.contains("Exhaustive")) {
            silent.push(name.to_owned());
        }
    }
    (count, silent)
}

#[test]
fn every_enum_and_every_statistic_says_whether_it_may_grow() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut count = 0;
    for file in rust_files(&source) {
        let (declared, silent) = silent(&std::fs::read_to_string(&file).unwrap());
        assert!(silent.is_empty(), "{}: {silent:?}", file.display());
        count += declared;
    }
    assert!(count >= 50, "{count} types");
}

#[test]
fn one_that_does_not_say_it_is_found() {
    let statistics = read("src/map/statistics.rs");
    assert!(silent(&statistics).1.is_empty());
    let twin = statistics.replace("#[non_exhaustive]", "#[must_use]");
    assert!(!silent(&twin).1.is_empty());
    let above = "#[non_exhaustive]\npub enum First {\n}\n\n/// Ways.\npub enum Second {\n}\n";
    assert_eq!(silent(above), (2, vec!["Second".to_owned()]));
}
