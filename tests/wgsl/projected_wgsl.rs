//! The WGSL of projected shadows: valid with either buffer, free of bindings as functions, and importable.

use crate::common::{to_glsl, to_webgl, validate};
use crate::projected::{made, modules};
use shadows::wgpu;

#[test]
fn modules_are_valid_for_any_group_with_either_buffer() {
    for group in [0, 3] {
        for (name, text) in modules(group) {
            let module = validate(&text).unwrap();
            let bindings = module.global_variables.iter();
            let bindings: Vec<_> = bindings.filter_map(|(_, v)| v.binding).collect();
            assert_eq!(bindings.len(), 3, "{name}");
            assert!(bindings.iter().all(|binding| binding.group == group));
            to_glsl(&text, "host_projected").unwrap();
        }
    }
    let [(_, storage), (_, uniform)] = modules(0);
    to_webgl(&uniform, "host_projected").unwrap();
    // The broken twin: no storage buffers there.
    assert!(to_webgl(&storage, "host_projected").is_err());
}

#[test]
fn functions_have_no_bindings_and_names_of_their_own() {
    let text = made(wgpu::Limits::defaults()).wgsl();
    let module = validate(&text).unwrap();
    assert!(module.global_variables.is_empty());
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap_or_default();
        assert!(name.starts_with("shadows_projected_"), "{name}");
    }
}
