//! Tint, the WGSL compiler of Chromium. It refuses more than naga: derivatives where control flow may differ
//! from pixel to pixel.

use std::path::Path;
use std::process::Command;

use crate::Module;
use crate::installed::{find, folder};

/// What Tint says against each of the modules, `name:line: message`; `None` (said on stderr) where it is
/// not installed.
fn refused(package: &Path, name: &str, modules: &[Module]) -> String {
    let folder = folder(name);
    for module in modules {
        // Names of files stay whole: two shaders of one page differ behind its extension.
        let file = folder.join(format!("{}.wgsl", module.name));
        std::fs::write(file, &module.wgsl).unwrap();
    }
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/translations/tint.mjs");
    let output = Command::new("node")
        .arg(script)
        .arg(package)
        .arg(&folder)
        .output();
    let output = output.unwrap_or_else(|error| panic!("node: {error}"));
    let [out, error] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(output.status.success(), "{error}");
    let count = format!("{} modules\n", modules.len());
    out.strip_suffix(&count)
        .unwrap_or_else(|| panic!("{out}"))
        .to_owned()
}

/// The package, or `None` (said on stderr) where it is not installed.
fn package() -> Option<std::path::PathBuf> {
    let found = find("tint/node_modules/webgpu");
    if found.is_none() {
        eprintln!("skipped: no Tint; scripts/drivers.sh install tint");
    }
    found
}

#[test]
fn tint_takes_every_module() {
    let Some(package) = package() else { return };
    assert_eq!(refused(&package, "tint", &crate::all()), "");
}

#[test]
fn tint_refuses_derivatives_in_a_branch() {
    let Some(package) = package() else { return };
    let all = crate::all();
    let asks = |module: &&Module| module.wgsl.contains("shadows_visibility(position)");
    let module = all.iter().find(asks).unwrap();
    let (call, branch) = (
        "return vec4f(shadows_visibility(position));",
        "if position.x > 0.0 { return vec4f(shadows_visibility(position)); } return vec4f();",
    );
    assert!(module.wgsl.contains(call));
    let twin = Module::new("branch", module.wgsl.replace(call, branch));
    naga::front::wgsl::parse_str(&twin.wgsl).unwrap();
    let refused = refused(&package, "tint-branch", &[twin]);
    assert!(
        refused.contains("'dpdx' must only be called from uniform control flow"),
        "{refused}"
    );
}
