//! Frames of a flat map: any spot or directional light, casters, view and receivers.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use shadows::glam::Vec3;
use shadows::{
    Bias, DirectionalLight, FlatLight, MapSettings, ShadowFrame, ShadowMap, ShadowMapDescriptor,
};
use shadows_fuzz::Length;
use shadows_fuzz::gpu::{device, submit, tidy};
use shadows_fuzz::map::{self, Reach};
use shadows_fuzz::scene::{Camera, Cast, Corners, Light, Projection, Story};

#[derive(Arbitrary, Debug)]
struct Settings {
    size: u8,
    bias: [Length; 3],
    sides: u8,
    unclipped_depth: bool,
    cache: bool,
    reach: Reach,
    format: u8,
}

#[derive(Arbitrary, Debug)]
struct Frame {
    /// `None`: that of the frame before.
    light: Option<(Light, bool)>,
    casters: Cast,
    view: Option<(Camera, Projection, Length)>,
    receivers: Option<Corners>,
    encoded: bool,
}

impl Settings {
    fn map(&self) -> Option<ShadowMap> {
        let [normal_offset, constant, slope_scale] = self.bias.map(|number| number.0);
        let descriptor = ShadowMapDescriptor {
            size: u32::from(self.size),
            settings: MapSettings {
                bias: Bias {
                    normal_offset,
                    constant,
                    slope_scale,
                    ..Bias::default()
                },
                sides: map::sides(self.sides),
                reach: self.reach.radius(),
                format: map::format(self.format),
            },
            unclipped_depth: self.unclipped_depth,
            cache: self.cache,
            label: None,
        };
        let made = ShadowMap::new(&device().0, &descriptor);
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
    let mut light = FlatLight::Directional(DirectionalLight::new(Vec3::Y));
    for frame in &story.frames {
        if let Some((new, spot)) = frame.light {
            light = match spot {
                true => FlatLight::Spot(new.spot()),
                false => FlatLight::Directional(new.directional()),
            };
        }
        let view = frame
            .view
            .as_ref()
            .and_then(|(camera, projection, distance)| {
                let view = camera.view(*projection)?;
                Some((view, distance.0))
            });
        let casters = &frame.casters.of(&scenes)[..];
        let before = map.statistics();
        let result = map.prepare(
            device,
            queue,
            &ShadowFrame {
                light,
                casters,
                view: view.as_ref().map(|(view, distance)| (view, *distance)),
                receivers: frame.receivers.map(|corners| corners.0),
            },
        );
        let s = map.statistics();
        match result {
            Ok(()) => {
                assert!(frame.receivers.is_none_or(|corners| corners.are_box()));
                let counted = (s.casters_drawn + s.casters_outside) as usize;
                assert_eq!(counted, casters.len(), "{s:?}");
                if let Some(matrix) = map.clip_from_world() {
                    assert!(matrix.is_finite(), "{matrix}");
                }
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                assert_eq!(s, before, "{error}: as it was");
            }
        }
        if frame.encoded {
            submit(|encoder| map.encode(encoder));
        }
    }
    tidy();
});
