//! What naga makes of a module for each of wgpu's back ends, with wgpu-hal's options where they matter, and
//! what compilers of those languages say of it, where they are installed.

use std::path::{Path, PathBuf};
use std::process::Command;

use naga::back::{glsl, hlsl, msl, spv};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{ResourceBinding, ShaderStage};

use crate::installed::{command, folder};
use crate::{Module, all};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Language {
    Hlsl,
    Msl,
    SpirV,
    /// OpenGL ES 3.2.
    Glsl,
}

const LANGUAGES: [Language; 4] = [
    Language::Hlsl,
    Language::Msl,
    Language::SpirV,
    Language::Glsl,
];

/// One entry point in one of the languages.
struct Translation {
    name: String,
    stage: ShaderStage,
    entry: String,
    bytes: Vec<u8>,
}

/// A module of which naga says that it is valid, its constants filled in for one entry point.
struct Ready<'a> {
    module: &'a naga::Module,
    info: &'a ModuleInfo,
    stage: ShaderStage,
    entry: String,
}

fn bytes(language: Language, ready: &Ready<'_>) -> Result<(Vec<u8>, String), String> {
    let own = ready.entry.clone();
    match language {
        Language::Hlsl => to_hlsl(ready),
        Language::Msl => to_msl(ready),
        Language::SpirV => to_spirv(ready).map(|bytes| (bytes, own)),
        // naga calls every entry point so.
        Language::Glsl => to_glsl(ready).map(|text| (text.into_bytes(), "main".to_owned())),
    }
}

/// The text, and what the entry point is called there.
fn to_hlsl(ready: &Ready<'_>) -> Result<(Vec<u8>, String), String> {
    let options = hlsl::Options {
        // The least that its present compiler has.
        shader_model: hlsl::ShaderModel::V6_0,
        special_constants_binding: Some(hlsl::BindTarget::default()),
        ..Default::default()
    };
    let pipeline = hlsl::PipelineOptions {
        entry_point: Some((ready.stage, ready.entry.clone())),
    };
    let mut text = String::new();
    let written = hlsl::Writer::new(&mut text, &options, &pipeline)
        .write(ready.module, ready.info, None)
        .map_err(|error| error.to_string())?;
    let entry = written.entry_point_names.into_iter().next();
    let entry = entry.ok_or("no entry point")?.map_err(|e| e.to_string())?;
    Ok((text.into_bytes(), entry))
}

/// The same, of the least version of Metal's language that has `@invariant`.
fn to_msl(ready: &Ready<'_>) -> Result<(Vec<u8>, String), String> {
    let options = msl::Options {
        lang_version: (2, 1),
        bounds_check_policies: BOUNDS,
        ..Default::default()
    };
    let pipeline = msl::PipelineOptions {
        entry_point: Some((ready.stage, ready.entry.clone())),
        ..Default::default()
    };
    let (text, written) = msl::write_string(ready.module, ready.info, &options, &pipeline)
        .map_err(|error| error.to_string())?;
    let entry = written.entry_point_names.into_iter().next();
    let entry = entry.ok_or("no entry point")?.map_err(|e| e.to_string())?;
    Ok((text.into_bytes(), entry))
}

const BOUNDS: BoundsCheckPolicies = BoundsCheckPolicies {
    index: BoundsCheckPolicy::Restrict,
    buffer: BoundsCheckPolicy::Restrict,
    image_load: BoundsCheckPolicy::Restrict,
    binding_array: BoundsCheckPolicy::Unchecked,
};

fn bindings(module: &naga::Module) -> impl Iterator<Item = ResourceBinding> {
    let globals = module.global_variables.iter();
    globals.filter_map(|(_, global)| global.binding)
}

fn to_spirv(ready: &Ready<'_>) -> Result<Vec<u8>, String> {
    let mut options = spv::Options {
        lang_version: (1, 3),
        bounds_check_policies: BOUNDS,
        ..Default::default()
    };
    for binding in bindings(ready.module) {
        let target = spv::BindingInfo {
            descriptor_set: binding.group,
            binding: binding.binding,
            ..Default::default()
        };
        options.binding_map.insert(binding, target);
    }
    let pipeline = spv::PipelineOptions {
        shader_stage: ready.stage,
        entry_point: ready.entry.clone(),
    };
    spv::write_vec(ready.module, ready.info, &options, Some(&pipeline))
        .map(|words| words.iter().flat_map(|word| word.to_le_bytes()).collect())
        .map_err(|error| error.to_string())
}

fn to_glsl(ready: &Ready<'_>) -> Result<String, String> {
    let options = glsl::Options {
        version: glsl::Version::Embedded {
            version: 320,
            is_webgl: false,
        },
        // One number each, as wgpu-hal gives them: the groups of GL are one.
        binding_map: bindings(ready.module).zip(0..).collect(),
        ..Default::default()
    };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ready.stage,
        entry_point: ready.entry.clone(),
        multiview: None,
    };
    let mut text = String::new();
    let policies = BoundsCheckPolicies::default();
    glsl::Writer::new(
        &mut text,
        ready.module,
        ready.info,
        &options,
        &pipeline,
        policies,
    )
    .and_then(|mut writer| writer.write())
    .map_err(|error| error.to_string())?;
    Ok(text)
}

/// What is not valid in a language, and why that is no matter.
const EXCEPT: [(Language, &str); 5] = [
    // glslang does not know GL_EXT_clip_cull_distance, by which OpenGL ES has them.
    (Language::Glsl, "@builtin(clip_distances)"),
    // `Features::CLIP_DISTANCES`, which wgpu does not offer on D3D12.
    (Language::Hlsl, "@builtin(clip_distances)"),
    // What joins or counts samples is refused there (`tests/gl/samples.rs`).
    (Language::Glsl, "@builtin(sample_index)"),
    (Language::Glsl, "textureNumSamples"),
    // naga makes a number of what should be an array of one (gfx-rs/wgpu#7311). No driver is known to mind.
    (Language::SpirV, "-> @builtin(sample_mask)"),
];

fn is_valid_in(language: Language, module: &Module) -> bool {
    let mut signs = EXCEPT.iter().filter(|(other, _)| *other == language);
    !signs.any(|(_, sign)| module.wgsl.contains(sign))
}

/// Every entry point of a module in every language.
fn translations(module: &Module, languages: &[Language]) -> Result<Vec<Translation>, String> {
    let explain = |what: &str| format!("{}: {what}", module.name);
    let parsed = naga::front::wgsl::parse_str(&module.wgsl)
        .map_err(|error| explain(&error.emit_to_string(&module.wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&parsed)
        .map_err(|error| explain(&error.emit_to_string(&module.wgsl)))?;
    let mut all = Vec::new();
    for point in &parsed.entry_points {
        let entry = Some((point.stage, &point.name[..]));
        let constants = Default::default();
        let (filled, info) =
            naga::back::pipeline_constants::process_overrides(&parsed, &info, entry, &constants)
                .map_err(|error| explain(&error.to_string()))?;
        let ready = Ready {
            module: &filled,
            info: &info,
            stage: point.stage,
            entry: point.name.clone(),
        };
        for &language in languages {
            let (bytes, entry) = bytes(language, &ready)
                .map_err(|error| explain(&format!("{language:?} of {}: {error}", point.name)))?;
            all.push(Translation {
                name: format!("{}-{}", module.name, point.name),
                stage: point.stage,
                entry,
                bytes,
            });
        }
    }
    Ok(all)
}

/// What checks a language, if anything does that runs anywhere.
fn compiler(language: Language) -> Option<&'static str> {
    Some(match language {
        Language::Hlsl => "dxc",
        Language::Msl => return None,
        Language::SpirV => "spirv-val",
        Language::Glsl => "glslangValidator",
    })
}

/// What is said against translations of one language; `None` where no compiler of it is installed.
fn refused(language: Language, translations: &[Translation], folder: &Path) -> Option<String> {
    let compiler = command(compiler(language)?)?;
    let files: Vec<PathBuf> = translations
        .iter()
        .map(|translation| {
            let file = format!("{}.{}", translation.name, extension(translation.stage));
            let file = folder.join(file);
            std::fs::write(&file, &translation.bytes).unwrap();
            file
        })
        .collect();
    let run = |command: &mut Command| {
        let output = command.output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        match output.status.success() {
            true => String::new(),
            false => String::from_utf8_lossy(&said).into_owned(),
        }
    };
    let command = || Command::new(&compiler);
    let each = files.iter().zip(translations);
    Some(match language {
        // All in one go; it knows the stage from the file's name, and names those that are right, too.
        Language::Glsl => {
            let said = run(command().args(&files));
            let lines: Vec<&str> = said.split_inclusive('\n').collect();
            let pairs = lines.iter().zip(lines.iter().skip(1));
            let wrong = pairs.filter(|(_, second)| second.starts_with("ERROR"));
            wrong
                .map(|(first, second)| [*first, *second].concat())
                .collect()
        }
        Language::SpirV => each
            .map(|(file, _)| run(command().args(["--target-env", "vulkan1.1"]).arg(file)))
            .collect(),
        Language::Hlsl | Language::Msl => each
            .map(|(file, translation)| {
                let model = match translation.stage {
                    ShaderStage::Vertex => "vs_6_0",
                    ShaderStage::Fragment => "ps_6_0",
                    _ => "cs_6_0",
                };
                run(command()
                    .args(["-T", model, "-E", &translation.entry])
                    .arg(file))
            })
            .collect(),
    })
}

fn extension(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vert",
        ShaderStage::Fragment => "frag",
        _ => "comp",
    }
}

#[test]
fn every_module_translates_to_what_each_back_end_takes() {
    let modules = all();
    for language in LANGUAGES {
        let own = modules
            .iter()
            .filter(|module| is_valid_in(language, module));
        let made: Vec<Translation> = own
            .flat_map(|module| translations(module, &[language]).unwrap())
            .collect();
        assert!(made.len() > modules.len(), "{language:?}: {}", made.len());
        let said = refused(language, &made, &folder(&format!("{language:?}")));
        if said.is_none() {
            eprintln!("{language:?}: translated, and not checked: no compiler of it is here");
        }
        assert_eq!(said.unwrap_or_default(), "", "{language:?}");
    }
}

#[test]
fn what_a_back_end_cannot_say_or_its_compiler_refuses_is_found() {
    let modules = all();
    // What naga writes for GLSL is wrong there, and the reason why it is refused on GL.
    let samples = |module: &&Module| module.wgsl.contains("@builtin(sample_index)");
    let samples = modules.iter().find(samples).unwrap();
    let made = translations(samples, &[Language::Glsl]).unwrap();
    if let Some(said) = refused(Language::Glsl, &made, &folder("glsl-refused")) {
        assert!(said.contains("cannot convert"), "{said}");
    }
    // A host that shares one struct between its stages.
    let host = modules.iter().find(|module| module.name == "host").unwrap();
    let shared = host.wgsl.replace("in: HostFragment", "in: HostVaryings");
    assert_ne!(shared, host.wgsl);
    let made = translations(&Module::new("shared", shared), &[Language::Glsl]).unwrap();
    if let Some(said) = refused(Language::Glsl, &made, &folder("glsl-shared")) {
        assert!(
            said.contains("'invariant' : can only apply to an output"),
            "{said}"
        );
    }
    let mask = |module: &&Module| module.wgsl.contains("-> @builtin(sample_mask)");
    let mask = modules.iter().find(mask).unwrap();
    let made = translations(mask, &[Language::SpirV]).unwrap();
    if let Some(said) = refused(Language::SpirV, &made, &folder("spirv-refused")) {
        assert!(said.contains("VUID-SampleMask-SampleMask-04359"), "{said}");
    }
    // GLSL ES has no doubles.
    let wgsl = "@fragment fn main() -> @location(0) vec4f { return vec4f(f32(shade(1.0))); }
        fn shade(x: f32) -> f64 { return f64(x) * 2.0lf; }";
    let doubles = Module::new("doubles", wgsl);
    assert!(translations(&doubles, &[Language::Glsl]).is_err());
}
