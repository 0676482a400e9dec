//! Frames of a cube map: any light, casters and views.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use shadows::{
    Bias, CubeFace, CubeFrame, CubeShadowMap, CubeShadowMapDescriptor, DepthEncoding, MapSettings,
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
    linear: bool,
    cull_casters: bool,
    cache: bool,
    sides: u8,
    reach: Reach,
    format: u8,
    static_layers: Still,
    /// Whether the first light stays and every frame is encoded: what is drawn again and again shows
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
    /// `None`: that of the frame before.
    light: Option<Light>,
    casters: Cast,
    camera: Option<(Camera, Projection)>,
    encoded: bool,
}

impl Settings {
    fn map(&self) -> Option<CubeShadowMap> {
        let descriptor = CubeShadowMapDescriptor {
            size: u32::from(self.size),
            settings: MapSettings {
                bias: Bias {
                    normal_offset: self.bias[0].0,
                    constant: self.bias[1].0,
                    ..Bias::default()
                },
                sides: map::sides(self.sides),
                reach: self.reach.radius(),
                format: map::format(self.format),
            },
            encoding: match self.linear {
                true => DepthEncoding::LinearDistance,
                false => DepthEncoding::MajorAxis,
            },
            cull_casters: self.cull_casters,
            cache: self.cache,
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
            assert!(self.reach.is_in_range() && map::takes(descriptor.settings.format));
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
    let mut light = None;
    for frame in &story.frames {
        if let Some(new) = &frame.light
            && (light.is_none() || !settings.steady)
        {
            light = Some(new.point());
        }
        let Some(light) = light else {
            continue;
        };
        let camera = frame.camera.as_ref();
        let view = camera.and_then(|(camera, projection)| camera.view(*projection));
        let casters = &frame.casters.of(&scenes)[..];
        let before = map.statistics();
        let result = map.prepare(
            device,
            queue,
            &CubeFrame {
                light,
                casters,
                view: view.as_ref(),
            },
        );
        match result {
            Ok(()) => check(&map, casters.len()),
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

/// Each face is one of four things, and each caster in or out of the light's range.
fn check(map: &CubeShadowMap, casters: usize) {
    let s = map.statistics();
    let faces = s.faces_rendered + s.faces_kept + s.faces_empty + s.faces_hidden;
    assert_eq!(faces, 6, "{s:?}");
    let counted = (s.casters_in_range + s.casters_out_of_range) as usize;
    assert_eq!(counted, casters, "{s:?}");
    for face in CubeFace::ALL {
        let matrix = map.clip_from_world(face).expect("it is prepared");
        assert!(matrix.is_finite(), "{matrix}");
    }
}
