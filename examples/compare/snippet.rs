//! Rust that makes exactly a technique's descriptors.

use std::fmt::Debug;

use shadows::{
    Bias, CubeShadowMapDescriptor, Kernel, PcfDescriptor, ShadowMapDescriptor,
    ShadowVolumeDescriptor,
};

use crate::technique::Config;

/// Statements that bind `map` and `sampler`, or `volumes`. Fields that are as the default has them
/// are left to it. Labels, and what volumes need to know of the host's depth buffer, are the host's.
pub fn of(config: &Config) -> String {
    match config {
        Config::Cube { map, sampler } => cube(map) + &pcf(sampler),
        Config::Flat { map, sampler } => flat(map) + &pcf(sampler),
        Config::Volume(volume) => volumes(volume),
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

    fn finish(self) -> String {
        let Self { name, text, fields } = self;
        match fields.is_empty() {
            true => format!("let {name} = {text}::default();\n"),
            false => format!("let {name} = {text} {{\n{fields}    ..Default::default()\n}};\n"),
        }
    }
}

fn cube(map: &CubeShadowMapDescriptor<'_>) -> String {
    let default = CubeShadowMapDescriptor::default();
    let CubeShadowMapDescriptor {
        lights,
        cull_casters,
        cache,
        ..
    } = map;
    Literal::new("map", "CubeShadowMapDescriptor")
        .field("size", "", &map.size, &default.size)
        .written("bias", &bias(map.bias), map.bias == default.bias)
        .field("lights", "", lights, &default.lights)
        .field("cube_array", "", &map.cube_array, &default.cube_array)
        .field(
            "allocation",
            "Allocation::",
            &map.allocation,
            &default.allocation,
        )
        .field(
            "encoding",
            "DepthEncoding::",
            &map.encoding,
            &default.encoding,
        )
        .field(
            "format",
            "wgpu::TextureFormat::",
            &map.format,
            &default.format,
        )
        .field("cull_casters", "", cull_casters, &default.cull_casters)
        .field("cache", "", cache, &default.cache)
        .field("sides", "CasterSides::", &map.sides, &default.sides)
        .field(
            "max_faces_per_frame",
            "",
            &map.max_faces_per_frame,
            &default.max_faces_per_frame,
        )
        .field("passes", "FacePasses::", &map.passes, &default.passes)
        .finish()
}

fn flat(map: &ShadowMapDescriptor<'_>) -> String {
    let default = ShadowMapDescriptor::default();
    let ShadowMapDescriptor {
        unclipped_depth,
        cache,
        ..
    } = map;
    Literal::new("map", "ShadowMapDescriptor")
        .field("size", "", &map.size, &default.size)
        .written("bias", &bias(map.bias), map.bias == default.bias)
        .field("sides", "CasterSides::", &map.sides, &default.sides)
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
    let is_default = sampler.kernel == default.kernel;
    Literal::new("sampler", "PcfDescriptor")
        .written("kernel", &kernel(sampler.kernel), is_default)
        .field("map", "MapKind::", &sampler.map, &default.map)
        .field(
            "encoding",
            "DepthEncoding::",
            &sampler.encoding,
            &default.encoding,
        )
        .field(
            "many_lights",
            "",
            &sampler.many_lights,
            &default.many_lights,
        )
        .field("textbook", "", &sampler.textbook, &default.textbook)
        .finish()
}

fn volumes(volume: &ShadowVolumeDescriptor<'_>) -> String {
    let default = ShadowVolumeDescriptor::default();
    let ShadowVolumeDescriptor {
        cap_bias_ulps,
        culling,
        ..
    } = volume;
    let keep = &volume.keep_between_frames;
    Literal::new("volumes", "ShadowVolumeDescriptor")
        .field(
            "sample_count",
            "",
            &volume.sample_count,
            &default.sample_count,
        )
        .field("cap_bias_ulps", "", cap_bias_ulps, &default.cap_bias_ulps)
        .field("method", "Method::", &volume.method, &default.method)
        .field("caps", "Caps::", &volume.caps, &default.caps)
        .field(
            "extrusion",
            "Extrusion::",
            &volume.extrusion,
            &default.extrusion,
        )
        .field(
            "start_from",
            "StartFrom::",
            &volume.start_from,
            &default.start_from,
        )
        .field("culling", "", culling, &default.culling)
        .field(
            "keep_between_frames",
            "",
            keep,
            &default.keep_between_frames,
        )
        .field(
            "silhouettes",
            "Silhouettes::",
            &volume.silhouettes,
            &default.silhouettes,
        )
        .field("counter", "Counter::", &volume.counter, &default.counter)
        .finish()
}

fn bias(bias: Bias) -> String {
    format!("{bias:?}")
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
