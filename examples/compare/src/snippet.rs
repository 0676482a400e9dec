//! Rust that makes exactly a technique's descriptors.

use std::fmt::Debug;

use shadows::{
    CubeShadowMapDescriptor, Kernel, MapKind, MapSettings, PcfDescriptor,
    PlanarSoftShadowDescriptor, ShadowMapDescriptor, ShadowVolumeDescriptor,
};

use crate::survey::Survey;
use crate::technique::Config;

/// Statements that bind `map` and `sampler`, or `volumes`. Fields that are as the default has them
/// are left to it. Labels, and what volumes need to know of the host's depth buffer, are the host's.
/// What did not move is kept, as by default: not to keep it is for timing alone.
pub fn of(config: &Config) -> String {
    match config.kept() {
        Config::Cube { map, sampler } => cube(&map) + &pcf(&sampler),
        Config::Flat { map, sampler } => flat(&map) + &pcf(&sampler),
        Config::Atlas { sampler, .. } => pcf(&sampler),
        Config::Volume(volume) => volumes(&volume),
        Config::Survey(survey) => match survey {
            Survey::Planar => "let planar = PlanarShadowDescriptor::default();\n".to_owned(),
            Survey::PlanarSoft { size, samples } => {
                let default = PlanarSoftShadowDescriptor::default();
                Literal::new("planar", "PlanarSoftShadowDescriptor")
                    .field("size", "", &[size; 2], &default.size)
                    .field("samples", "", &samples, &default.samples)
                    .finish()
            }
            Survey::Projected(projected) => projected.snippet(),
            Survey::Baked(baked) => baked.snippet(),
            Survey::Blob(blobs) => blobs.snippet(),
        },
        Config::Peer { peer, size } => format!(
            "// Another engine's, no part of this library: {}, {size} texels.\n",
            peer.name
        ),
    }
}

/// The fields of a literal that differ from the default.
struct Literal {
    name: &'static str,
    text: &'static str,
    fields: String,
}

impl Literal {
    fn new(name: &'static str, text: &'static str) -> Self {
        let fields = String::new();
        Self { name, text, fields }
    }

    /// A field whose values are written as `path` and their own `Debug`.
    fn field<T: Debug>(self, name: &str, path: &str, value: &T, default: &T) -> Self {
        let (value, default) = (format!("{value:?}"), format!("{default:?}"));
        self.written(name, &format!("{path}{value}"), value == default)
    }

    fn written(mut self, name: &str, value: &str, is_default: bool) -> Self {
        if !is_default {
            self.fields += &format!("    {name}: {value},\n");
        }
        self
    }

    /// What maps of all kinds have in common, in a literal of its own.
    fn settings(self, settings: &MapSettings) -> Self {
        let default = MapSettings::default();
        let MapSettings {
            format,
            bias: set_back,
            sides,
            reach,
        } = settings;
        let Self { text, fields, .. } = Self::new("settings", "MapSettings")
            .field("format", FORMAT, format, &default.format)
            .field("bias", "", set_back, &default.bias)
            .field("sides", "CasterSides::", sides, &default.sides)
            .field("reach", "Radius::", reach, &default.reach);
        let fields = fields.replace("    ", "        ");
        let literal = format!("{text} {{\n{fields}        ..Default::default()\n    }}");
        self.written("settings", &literal, *settings == default)
    }

    fn finish(self) -> String {
        let Self { name, text, fields } = self;
        match fields.is_empty() {
            true => format!("let {name} = {text}::default();\n"),
            false => format!("let {name} = {text} {{\n{fields}    ..Default::default()\n}};\n"),
        }
    }
}

// Each takes its descriptor apart without `..`, so that no new field is forgotten.

fn cube(map: &CubeShadowMapDescriptor<'_>) -> String {
    let default = CubeShadowMapDescriptor::default();
    let CubeShadowMapDescriptor {
        label: _,
        size,
        encoding,
        settings,
        cull_casters,
        cache,
        static_layers,
    } = map;
    Literal::new("map", "CubeShadowMapDescriptor")
        .field("size", "", size, &default.size)
        .field("encoding", "DepthEncoding::", encoding, &default.encoding)
        .settings(settings)
        .field("cull_casters", "", cull_casters, &default.cull_casters)
        .field("cache", "", cache, &default.cache)
        .field(
            "static_layers",
            "StaticLayers::",
            static_layers,
            &default.static_layers,
        )
        .finish()
}

fn flat(map: &ShadowMapDescriptor<'_>) -> String {
    let default = ShadowMapDescriptor::default();
    let ShadowMapDescriptor {
        label: _,
        size,
        settings,
        unclipped_depth,
        cache,
    } = map;
    Literal::new("map", "ShadowMapDescriptor")
        .field("size", "", size, &default.size)
        .settings(settings)
        .field(
            "unclipped_depth",
            "",
            unclipped_depth,
            &default.unclipped_depth,
        )
        .field("cache", "", cache, &default.cache)
        .finish()
}

fn pcf(sampler: &PcfDescriptor<'_>) -> String {
    let default = PcfDescriptor::default();
    let PcfDescriptor {
        label: _,
        kernel: filter,
        map,
        textbook,
        gather,
    } = sampler;
    Literal::new("sampler", "PcfDescriptor")
        .written("kernel", &kernel(*filter), *filter == default.kernel)
        .written("map", &kind(*map), *map == default.map)
        .field("textbook", "", textbook, &default.textbook)
        .field("gather", "Gather::", gather, &default.gather)
        .finish()
}

fn volumes(volume: &ShadowVolumeDescriptor<'_>) -> String {
    let default = ShadowVolumeDescriptor::default();
    let ShadowVolumeDescriptor {
        label: _,
        depth_stencil_format: _,
        sample_count,
        multiview_mask: _,
        depth: _,
        color_formats: _,
        cap_bias_ulps,
        method,
        caps,
        extrusion,
        start_from,
        culling,
        keep_between_frames,
        silhouettes,
        counter,
    } = volume;
    Literal::new("volumes", "ShadowVolumeDescriptor")
        .field("sample_count", "", sample_count, &default.sample_count)
        .field("cap_bias_ulps", "", cap_bias_ulps, &default.cap_bias_ulps)
        .field("method", "Method::", method, &default.method)
        .field("caps", "Caps::", caps, &default.caps)
        .field("extrusion", "Extrusion::", extrusion, &default.extrusion)
        .field("start_from", "StartFrom::", start_from, &default.start_from)
        .field("culling", "", culling, &default.culling)
        .field(
            "keep_between_frames",
            "",
            keep_between_frames,
            &default.keep_between_frames,
        )
        .field(
            "silhouettes",
            "Silhouettes::",
            silhouettes,
            &default.silhouettes,
        )
        .field("counter", "Counter::", counter, &default.counter)
        .finish()
}

const FORMAT: &str = "wgpu::TextureFormat::";

/// A kind of map as Rust has it. Atlases are not swept.
fn kind(kind: MapKind) -> String {
    let names = [
        (MapKind::FLAT, "MapKind::FLAT"),
        (MapKind::ATLAS, "MapKind::ATLAS"),
    ];
    match names.iter().find(|(named, _)| *named == kind) {
        Some((_, name)) => (*name).to_owned(),
        None => format!("MapKind::{kind:?}")
            .replace("Cube(", "Cube(DepthEncoding::")
            .replace("Flat(", "Flat(FlatLights::"),
    }
}

/// A kernel's `Debug` with the paths that Rust needs.
fn kernel(kernel: Kernel) -> String {
    let text = format!("Kernel::{kernel:?}");
    ["Texels(", "World("]
        .into_iter()
        .fold(text, |text, radius| {
            text.replace(radius, &format!("Radius::{radius}"))
        })
}
