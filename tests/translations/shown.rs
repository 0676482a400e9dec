//! The modules of examples, pages and the crate's documentation.

use std::path::{Path, PathBuf};

use shadows::{Kernel, wgsl};

use crate::Module;
use crate::pcf::{WAYS, made};
use host::peers::PEERS;
use host::scene::leaf_mask;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

pub fn all() -> Vec<Module> {
    let mut all = pages();
    all.extend(host());
    all.extend(peers());
    let blit = root().join("examples/egui/src/blit.wgsl");
    // The package is without it.
    if blit.exists() {
        all.push(Module::new("egui-blit", read(&blit)));
    }
    all
}

/// The example host's modules, as its pipelines put them together. The first sampler is as good as any: it
/// calls all alike.
fn host() -> Vec<Module> {
    let file = |name: &str| read(&host_shaders().join(name));
    let shared = [wgsl::POSITION.to_owned(), file("host.wgsl")].concat();
    let leaves = leaf_mask::wgsl();
    let way = &WAYS[0];
    let (device, queue) = way.device();
    let sampler = made(&device, &queue, &way.descriptor(Kernel::ALL[0]));
    let asks =
        "fn host_visibility(at: HostReceiver) -> f32 { return shadows_visibility(at.world); }";
    let sampled = [&sampler.wgsl_module(1)[..], asks, &file("sampled.wgsl")].concat();
    let masked = leaves.clone() + &file("masked.wgsl");
    let of_host = |name: &str, parts: &[&str]| Module::new(name, shared.clone() + &parts.concat());
    vec![
        of_host("host", &[]),
        of_host("host-sky", &[&file("sky.wgsl")]),
        of_host("host-masked", &[&masked]),
        of_host("host-unshadowed", &[&file("unshadowed.wgsl")]),
        of_host("host-sampled", &[&sampled]),
        of_host(
            "host-masked-lit",
            &[&sampled, &masked, &file("masked_lit.wgsl")],
        ),
        Module::new("host-masked-casters", leaves + &file("caster.wgsl")),
        Module::new("host-depth-bounds", file("depth_bounds.wgsl")),
    ]
}

fn host_shaders() -> PathBuf {
    root().join("examples/host/src/shaders")
}

#[test]
fn every_shader_of_the_host_is_in_a_module() {
    let modules = host();
    let files = std::fs::read_dir(host_shaders()).unwrap();
    let left_out = files.map(|file| file.unwrap().path()).filter(|path| {
        let text = read(path);
        !modules.iter().any(|module| module.wgsl.contains(&text))
    });
    assert_eq!(left_out.collect::<Vec<_>>(), Vec::<PathBuf>::new());
}

fn peers() -> Vec<Module> {
    let asks = "
@fragment
fn peer(@builtin(position) pixel: vec4f, @location(0) world: vec3f, @location(1) normal: vec3f)
    -> @location(0) vec4f {
    return vec4f(peer_visibility(world, normal, pixel.xy));
}
";
    let module = |peer: &host::peers::Peer| {
        Module::new(
            format!("peer-{}", peer.name.replace('/', "-")),
            peer.wgsl() + asks,
        )
    };
    PEERS.iter().map(module).collect()
}

/// Shaders in texts, behind the sampler's module that they ask.
fn pages() -> Vec<Module> {
    let mut all = Vec::new();
    for path in texts() {
        for (place, shader) in shaders(&read(&path)).into_iter().enumerate() {
            let file = path.strip_prefix(root()).unwrap().display().to_string();
            let name = format!("{}-{place}", file.replace('/', "-"));
            all.push(Module::new(name, asked(&shader) + &shader));
        }
    }
    assert!(
        all.len() >= 3,
        "README, the first example, the crate's documentation"
    );
    all
}

/// The modules of the samplers that a shader asks: of an atlas if it names its lights, else of the cube sampler
/// and of the flat one.
fn asked(shader: &str) -> String {
    let of = |(name, sign, group): &(&str, &str, u32)| {
        let way = WAYS.iter().find(|way| way.name == *name).unwrap();
        let (device, queue) = way.device();
        let sampler = made(&device, &queue, &way.descriptor(Kernel::ALL[0]));
        match shader.contains(sign) {
            true => sampler.wgsl_module(*group),
            false => String::new(),
        }
    };
    let samplers: &[_] = match shader.contains("shadows_visibility_flat(i,") {
        true => &[("atlas", "shadows_visibility", 1)],
        false => &[
            ("cube", "shadows_visibility", 1),
            ("flat", "shadows_flat_", 2),
        ],
    };
    samplers.iter().map(of).collect()
}

/// The pages, the crate's documentation, and the examples.
fn texts() -> Vec<PathBuf> {
    let mut all = ["README.md", "src/lib.rs"]
        .map(|file| root().join(file))
        .to_vec();
    let mut waiting = ["docs", "examples"]
        .map(|folder| root().join(folder))
        .to_vec();
    while let Some(folder) = waiting.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let kind = path
                .extension()
                .map(|kind| kind.to_str().unwrap().to_owned());
            match kind.as_deref() {
                _ if path.is_dir() => waiting.push(path),
                Some("md" | "rs") => all.push(path),
                _ => {}
            }
        }
    }
    all.sort();
    all
}

/// What is a shader of its own in a text: string literals and fenced blocks with an entry point.
pub fn shaders(text: &str) -> Vec<String> {
    let text: Vec<&str> = text.lines().map(bare).collect();
    let text = text.join("\n");
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(entry) = ["@vertex", "@fragment", "@compute"]
        .iter()
        .filter_map(|attribute| text[at..].find(attribute))
        .min()
    {
        let entry = at + entry;
        let before = &text[at..entry];
        let (fence, quote) = (before.rfind("```wgsl\n"), before.rfind('"'));
        let is_open = |fence: &usize| !before[fence + 8..].contains("```");
        let (from, end) = match (fence.filter(is_open), quote) {
            (Some(fence), _) => (at + fence + 8, "```"),
            (None, Some(quote)) => (at + quote + 1, "\""),
            // Prose.
            (None, None) => {
                at = entry + 1;
                continue;
            }
        };
        let to = entry + text[entry..].find(end).unwrap_or(text.len() - entry);
        let shader = &text[from..to];
        // Prose has no function; what has `{{` is a template, and filled in elsewhere.
        if shader.contains("fn ") && !shader.contains("{{") {
            found.push(shader.to_owned());
        }
        at = (to + end.len()).min(text.len());
    }
    found
}

/// A line without the marks of a doc comment.
fn bare(line: &str) -> &str {
    let line = line.trim_start();
    let without = line.strip_prefix("//!").or(line.strip_prefix("///"));
    without.unwrap_or(line)
}

#[test]
fn a_shader_in_a_text_is_found() {
    let text = "a \"b\" c
const S: &str = \"
@vertex fn one() {}
@fragment fn two() {}
\"; \"d\"
//! let s = \"@fragment
//!   fn three() {}\";
```wgsl
@compute fn four() {}
```
The attribute `@fragment`, and \"no more\".
";
    let found = shaders(text);
    let has = |name: &str| found.iter().filter(|shader| shader.contains(name)).count();
    assert_eq!(found.len(), 3, "{found:#?}");
    assert_eq!(["one", "two", "three", "four"].map(has), [1; 4]);
    assert!(!found.concat().contains("//!"));
}
