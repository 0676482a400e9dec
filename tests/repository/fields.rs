//! How much a host has to read before it makes a map, a sampler or volumes: the documented fields of their
//! descriptors. What is there for measuring alone is hidden, and what several have in common is written once.

use super::read;

/// The descriptors, and what they share.
const STRUCTS: [(&str, &str); 6] = [
    ("src/map/settings.rs", "MapSettings"),
    ("src/map/cube_descriptor.rs", "CubeShadowMapDescriptor"),
    ("src/map/flat_descriptor.rs", "ShadowMapDescriptor"),
    ("src/map/atlas/descriptor.rs", "ShadowAtlasDescriptor"),
    ("src/pcf/sampler.rs", "PcfDescriptor"),
    ("src/volume/descriptor.rs", "ShadowVolumeDescriptor"),
];

/// As many as there are. Raise it only for what a host has a reason to set.
const MOST: usize = 32;

/// The fields of a struct that are public and not hidden.
fn fields(text: &str, name: &str) -> Vec<String> {
    let start = text
        .find(&format!("pub struct {name} {{"))
        .or_else(|| text.find(&format!("pub struct {name}<'a> {{")))
        .unwrap_or_else(|| panic!("no struct {name}"));
    let body = &text[start..];
    let body = &body[..body.find("\n}").unwrap()];
    let mut hidden = false;
    let mut fields = Vec::new();
    for line in body.lines().skip(1).map(str::trim) {
        if line.starts_with("#[doc(hidden)]") {
            hidden = true;
        } else if let Some((field, _)) = line.strip_prefix("pub ").and_then(|l| l.split_once(':')) {
            if !hidden {
                fields.push(field.to_owned());
            }
            hidden = false;
        }
    }
    fields
}

#[test]
fn descriptors_have_no_more_fields_than_hosts_have_reasons() {
    let all: Vec<_> = STRUCTS
        .iter()
        .map(|&(file, name)| (name, fields(&read(file), name)))
        .collect();
    let count: usize = all.iter().map(|(_, fields)| fields.len()).sum();
    assert!(count <= MOST, "{count}: {all:#?}");
    // Nothing of what is shared is said again.
    let (_, shared) = &all[0];
    for (name, fields) in &all[1..] {
        let again: Vec<_> = fields.iter().filter(|f| shared.contains(f)).collect();
        assert!(again.is_empty(), "{name}: {again:?}");
    }
}

#[test]
fn one_more_is_counted_and_a_hidden_one_is_not() {
    let (file, name) = STRUCTS[1];
    let text = read(file);
    let usual = fields(&text, name).len();
    let twin = |field: &str| {
        let wider = text.replacen("    pub label:", &format!("{field}\n    pub label:"), 1);
        assert_ne!(wider, text);
        fields(&wider, name).len()
    };
    assert_eq!(twin("    pub knob: bool,"), usual + 1);
    assert_eq!(twin("    #[doc(hidden)]\n    pub knob: bool,"), usual);
    assert_eq!(twin("    knob: bool,"), usual);
}
