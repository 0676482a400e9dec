//! Lighting shaders: a Lambert shader whose light is shadowed in one way or another.

use shadows::{DepthEncoding, FlatLights, Gather, Kernel, MapKind};

use crate::pcf::{WAYS, Way, made, takes_light, textbooks};
use crate::pipeline::Case;
use host::peers::PEERS;

const HOST: &str = "
struct Frame {
    clip_from_world: mat4x4f,
    light: vec3f,
    intensity: f32,
    albedo: vec3f,
    ambient: f32,
}
@group(0) @binding(0) var<uniform> frame: Frame;

struct Vertex {
    @builtin(position) clip: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex(@location(0) world: vec3f, @location(1) normal: vec3f) -> Vertex {
    return Vertex(frame.clip_from_world * vec4f(world, 1.0), world, normal);
}

@fragment
fn fragment(vertex: Vertex) -> @location(0) vec4f {
    let normal = normalize(vertex.normal);
    let lit = VISIBILITY;
    let to_light = frame.light - vertex.world;
    let squared = dot(to_light, to_light);
    let cosine = max(dot(normal, to_light) * inverseSqrt(squared), 0.0);
    let shade = frame.ambient + lit * cosine * frame.intensity / squared;
    return vec4f(frame.albedo * shade, 1.0);
}
";

fn receiver(name: String, functions: &str, visibility: &str, trips: Vec<u32>) -> Case {
    Case {
        name,
        wgsl: [functions, &HOST.replace("VISIBILITY", visibility)].concat(),
        entries: vec!["vertex", "fragment"],
        instanced_from: u32::MAX,
        fragment_only: true,
        trips,
    }
}

/// What receivers are compared with: no shadow at all.
pub fn lambert() -> Case {
    receiver("lambert".to_owned(), "", "1.0", Vec::new())
}

/// What is counted: no device of today wants the others.
const COUNTED: [&str; 11] = [
    "cube",
    "cube-linear",
    "cube-array",
    "cube-fetches",
    "flat",
    "flat-fetches",
    "flat-border",
    "flat-spot",
    "flat-directional",
    "atlas-point",
    "atlas-spot",
];

fn name(kernel: Kernel) -> &'static str {
    kernel.function().trim_start_matches("shadows_cube_")
}

/// The loops of a kernel's code: a square's is for the edges of a face or of the map alone.
fn trips(way: &Way, kernel: Kernel) -> Vec<u32> {
    let linear = way.map == MapKind::Cube(DepthEncoding::LinearDistance);
    let fetches = way.gather == Gather::Never;
    match kernel {
        // What stands in for a texel beyond the horizon of the plane.
        Kernel::Hard if way.map != MapKind::Flat(FlatLights::Directional) => vec![0],
        Kernel::Hard | Kernel::HardwareBilinear => Vec::new(),
        // Nearly everywhere the first taps agree.
        Kernel::RandomDisk(disk) => disk_trips(way, disk.around * disk.rings / 2),
        Kernel::Vogel(disk) => disk_trips(way, disk.taps / 2),
        Kernel::ContactHardening(contact) => [contact.search_taps, contact.taps / 2]
            .map(|trips| disk_trips(way, trips))
            .concat(),
        // What is too long for the compiler to unroll, a row of gathers at a time.
        Kernel::Weighted7 if linear || fetches => vec![4, 0],
        _ => vec![0],
    }
}

/// The loop over the taps of a disk; on a cube then the one for disks that go over an edge of a face.
fn disk_trips(way: &Way, trips: u32) -> Vec<u32> {
    match way.map {
        MapKind::Cube(_) => vec![trips, 0],
        MapKind::Atlas(kinds) if kinds.point => vec![trips, 0],
        _ => vec![trips],
    }
}

/// Every kernel on every kind of map, with the plane's normal from derivatives and from the host, and
/// other engines' receivers.
pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for way in WAYS.iter().filter(|way| COUNTED.contains(&way.name)) {
        let (device, queue) = way.device();
        for kernel in Kernel::ALL
            .into_iter()
            .filter(|kernel| kernel.reads(way.map))
        {
            let sampler = made(&device, &queue, &way.descriptor(kernel));
            let index = match takes_light(&way.descriptor(kernel)) {
                true => "0u, ",
                false => "",
            };
            let flat = if matches!(way.map, MapKind::Flat(_)) {
                "_flat"
            } else {
                ""
            };
            let pixel = if sampler.takes_pixel() {
                ", vertex.clip.xy"
            } else {
                ""
            };
            let text = sampler.wgsl_module(1);
            // The first loop of derivatives reads the map where they say nothing.
            let derived = || match kernel {
                Kernel::HardwareBilinear => Vec::new(),
                _ => [vec![0], trips(way, kernel)].concat(),
            };
            for (suffix, given, normal, trips) in [
                ("", "", "", derived()),
                ("/normal", "_flat", ", normal", trips(way, kernel)),
            ] {
                let call =
                    format!("shadows{flat}_visibility{given}({index}vertex.world{normal}{pixel})");
                let name = format!("{}/{}{suffix}", way.name, name(kernel));
                cases.push(receiver(name, &text, &call, trips));
            }
        }
    }
    cases.push(textbook());
    for peer in &PEERS {
        let call = "peer_visibility(vertex.world, normal, vertex.clip.xy)";
        cases.push(receiver(
            format!("peer/{}", peer.name),
            &peer.wgsl(),
            call,
            Vec::new(),
        ));
    }
    cases
}

/// This crate's own rendition of the textbook, which its reports measure everything against.
fn textbook() -> Case {
    let (_, sampler) = textbooks().remove(0);
    let text = sampler.wgsl_module(1);
    let call = "shadows_visibility(vertex.world)";
    receiver("cube-linear/textbook".to_owned(), &text, call, Vec::new())
}
