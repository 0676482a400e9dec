//! Frames of a flat map: any spot or directional light, casters, view and receivers.
#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use shadows::{Bias, FlatLight, ShadowFrame, ShadowMap, ShadowMapDescriptor};
use shadows_fuzz::Length;
use shadows_fuzz::gpu::{device, submit, tidy};
use shadows_fuzz::map::{self, Reach};
use shadows_fuzz::scene::{Camera, Corners, Light, Projection, Story, pick};

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
    light: Light,
    spot: bool,
    casters: u8,
    /// Whether the first of them was deformed in the host's buffer.
    deformed: bool,
    view: Option<(Camera, Projection, Length)>,
    receivers: Option<Corners>,
    encoded: bool,
}

impl Settings {
    fn map(&self) -> Option<ShadowMap> {
        let [normal_offset, constant, slope_scale] = self.bias.map(|number| number.0);
        let descriptor = ShadowMapDescriptor {
            size: u32::from(self.size),
            bias: Bias {
                normal_offset,
                constant,
                slope_scale,
            },
            sides: map::sides(self.sides),
            unclipped_depth: self.unclipped_depth,
            cache: self.cache,
            reach: self.reach.radius(),
            format: map::format(self.format),
            label: None,
        };
        let made = ShadowMap::new(&device().0, &descriptor);
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
    for frame in &story.frames {
        let view = frame
            .view
            .as_ref()
            .and_then(|(camera, projection, distance)| {
                let view = camera.view(*projection)?;
                Some((view, distance.0))
            });
        let casters = pick(&scenes, frame.casters);
        if let (true, [first, ..]) = (frame.deformed, casters) {
            first.mesh.bump_revision();
        }
        let before = map.statistics();
        let result = map.prepare(
            device,
            queue,
            &ShadowFrame {
                light: match frame.spot {
                    true => FlatLight::Spot(frame.light.spot()),
                    false => FlatLight::Directional(frame.light.directional()),
                },
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
