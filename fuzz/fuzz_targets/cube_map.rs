//! Frames of a cube map: any lights, casters, views and budgets.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use shadows::{
    Allocation, Bias, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding,
    StaticLayers,
};
use shadows_fuzz::Length;
use shadows_fuzz::gpu::{device, submit, tidy};
use shadows_fuzz::map::{self, Reach};
use shadows_fuzz::scene::{Camera, Cast, Light, Projection, Story};

#[derive(Arbitrary, Debug)]
struct Settings {
    size: u8,
    bias: [Length; 2],
    lights: u8,
    cube_array: bool,
    linear: bool,
    cull_casters: bool,
    cache: bool,
    sides: u8,
    budget: Option<u8>,
    at_once: bool,
    reach: Reach,
    format: u8,
    static_layers: Still,
    /// Whether the first lights stay and every frame is encoded: what is drawn again and again shows
    /// only then what is kept under it.
    steady: bool,
}

/// Where casters that stand still are kept.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Still {
    Auto,
    Never,
    /// Layers under small meshes, too, which these are.
    Almost(u8),
    AtLeast(u64),
}

#[derive(Arbitrary, Debug)]
struct Frame {
    /// `None`: those of the frame before.
    lights: Option<[Option<Light>; 3]>,
    casters: Cast,
    camera: Option<(Camera, Projection)>,
    pinned: Option<u8>,
    encoded: bool,
}

impl Settings {
    fn map(&self) -> Option<CubeShadowMap> {
        let descriptor = CubeShadowMapDescriptor {
            size: u32::from(self.size),
            bias: Bias {
                normal_offset: self.bias[0].0,
                constant: self.bias[1].0,
                ..Bias::default()
            },
            lights: 4 - u32::from(self.lights % 5),
            cube_array: self.cube_array,
            encoding: match self.linear {
                true => DepthEncoding::LinearDistance,
                false => DepthEncoding::MajorAxis,
            },
            cull_casters: self.cull_casters,
            cache: self.cache,
            sides: map::sides(self.sides),
            max_faces_per_frame: self.budget.map(u32::from),
            allocation: match self.at_once {
                true => Allocation::AtOnce,
                false => Allocation::WithFirstCaster,
            },
            reach: self.reach.radius(),
            format: map::format(self.format),
            static_layers: match self.static_layers {
                Still::Auto => StaticLayers::Auto,
                Still::Never => StaticLayers::Never,
                Still::Almost(triangles) => StaticLayers::AtLeast(u64::from(triangles % 16)),
                Still::AtLeast(triangles) => StaticLayers::AtLeast(triangles),
            },
            label: None,
        };
        let made = CubeShadowMap::new(&device().0, &descriptor);
        if made.is_ok() {
            assert!(self.reach.is_in_range() && map::takes(descriptor.format));
        }
        made.ok()
    }
}

fuzz_target!(|input: (Settings, Story<Frame>)| {
    let (settings, story) = input;
    let (device, queue) = device();
    let Some(mut map) = settings.map() else {
        return;
    };
    let scenes = story.upload();
    let mut lights = Vec::new();
    for frame in &story.frames {
        if let Some(new) = &frame.lights
            && (lights.is_empty() || !settings.steady)
        {
            lights = new.iter().flatten().map(Light::point).collect();
        }
        let pinned: Vec<usize> = frame.pinned.iter().map(|&light| light.into()).collect();
        let camera = frame.camera.as_ref();
        let view = camera.and_then(|(camera, projection)| camera.view(*projection));
        let casters = &frame.casters.of(&scenes)[..];
        let before = map.statistics();
        let result = map.prepare(
            device,
            queue,
            &CubeFrame {
                lights: &lights,
                casters,
                view: view.as_ref(),
                pinned: &pinned,
            },
        );
        match result {
            Ok(()) => check(&map, lights.len(), casters.len()),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                assert_eq!(map.statistics(), before, "{error}: as it was");
            }
        }
        if frame.encoded || settings.steady {
            submit(|encoder| map.encode(encoder));
        }
    }
    tidy();
});

/// Each face is one of five things, and each caster in or out of each light's range.
fn check(map: &CubeShadowMap, lights: usize, casters: usize) {
    let s = map.statistics();
    let faces = s.faces_rendered + s.faces_kept + s.faces_empty + s.faces_hidden;
    assert_eq!((faces + s.faces_postponed) as usize, 6 * lights, "{s:?}");
    let counted = (s.casters_in_range + s.casters_out_of_range) as usize;
    assert_eq!(counted, lights * casters, "{s:?}");
    for light in 0..lights {
        for face in CubeFace::ALL {
            let matrix = map.clip_from_world(light, face).expect("such a light");
            assert!(matrix.is_finite(), "{matrix}");
        }
    }
}
