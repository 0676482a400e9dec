//! Several views drawn by one pass, each into a layer of its own.
//!
//! The pipelines differ from those of one view in their vertex shaders alone, which pick the camera of
//! the layer that they draw into. What is decided for a caster holds for all views of a pass, and so is what
//! is right in each of them: see `Rules`.

use std::num::NonZeroU32;

use crate::error::{MultiviewError, ShadowVolumeError};
use crate::volume::VolumeView;
use crate::volume::decide::facing::is_left_handed;
use crate::volume::descriptor::check_feature;
use crate::volume::plan::limits::check_one;
use crate::volume::plan::params::ViewParams;

/// The layers that a pass draws into: one view, or one for each bit of a mask.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Multiview(pub Option<NonZeroU32>);

/// As many as a mask has bits.
const MOST_LAYERS: usize = u32::BITS as usize;

/// What a shader of one view says of its camera.
const CAMERA: &str = "@group(0) @binding(0) var<uniform> camera: Camera;";
/// The same, of one for each layer.
const CAMERAS: &str = "@group(0) @binding(0) var<uniform> cameras: array<Camera, 32>;
// That of the layer.
var<private> camera: Camera;";

/// How the parameters of each vertex shader begin, and where its body does.
const PARAMETERS: &str = "    @builtin(vertex_index) vertex: u32,\n";
const BODY: &str = "\n) -> Drawn {\n";

impl Multiview {
    /// How many views a pass draws.
    pub fn views(self) -> usize {
        self.0.map_or(1, |mask| mask.get().count_ones() as usize)
    }

    /// How many layers there are at least, up to the last that is drawn into.
    pub fn layers(self) -> u32 {
        self.0.map_or(1, |mask| u32::BITS - mask.leading_zeros())
    }

    /// Of the views of textures that a pass draws into.
    pub fn dimension(self) -> wgpu::TextureViewDimension {
        match self.0 {
            None => wgpu::TextureViewDimension::D2,
            Some(_) => wgpu::TextureViewDimension::D2Array,
        }
    }

    /// The layers that are drawn into.
    fn drawn(self) -> impl Iterator<Item = usize> {
        let mask = self.0.map_or(1, NonZeroU32::get);
        (0..MOST_LAYERS).filter(move |layer| mask >> layer & 1 == 1)
    }

    /// Cameras that shaders find in the window of a pass.
    pub fn cameras(self) -> usize {
        self.0.map_or(1, |_| MOST_LAYERS)
    }

    /// The cameras of all passes, each with its window, from the views in their order.
    pub fn windows(self, views: &[ViewParams]) -> Vec<ViewParams> {
        let mut cameras = Vec::with_capacity(views.len() / self.views() * self.cameras());
        for together in views.chunks(self.views()) {
            let first = cameras.len();
            cameras.resize(first + self.cameras(), bytemuck::Zeroable::zeroed());
            for (layer, view) in self.drawn().zip(together) {
                cameras[first + layer] = *view;
            }
        }
        cameras
    }

    /// The vertex shaders of these passes, from those of one view.
    pub fn source(self, of_one: String) -> String {
        match self.0 {
            None => of_one,
            Some(_) => of_one
                .replace(CAMERA, CAMERAS)
                .replace(
                    PARAMETERS,
                    &format!("{PARAMETERS}    @builtin(view_index) layer: u32,\n"),
                )
                .replace(BODY, &format!("{BODY}    camera = cameras[layer];\n")),
        }
    }

    /// What it takes to draw so.
    pub fn features(self) -> wgpu::Features {
        use wgpu::Features as F;
        match self.0.map(NonZeroU32::get) {
            None => F::empty(),
            // wgpu's Metal back end has no others.
            Some(mask) if mask.trailing_ones() == mask.count_ones() => F::MULTIVIEW,
            Some(_) => F::MULTIVIEW | F::SELECTIVE_MULTIVIEW,
        }
    }

    /// Whether a device draws so.
    pub fn validate(self, device: &wgpu::Device) -> Result<(), ShadowVolumeError> {
        let Some(mask) = self.0 else { return Ok(()) };
        check_feature(device, self.features(), || {
            format!("multiview_mask {mask:#b}")
        })?;
        check_one(
            "max_multiview_view_count",
            self.layers().into(),
            device.limits().max_multiview_view_count.into(),
        )
    }

    /// Whether these views can be drawn together as the mask says.
    pub fn check(self, views: &[VolumeView]) -> Result<(), MultiviewError> {
        let together = self.views();
        if !views.len().is_multiple_of(together) {
            return Err(MultiviewError::Views {
                views: views.len(),
                together,
            });
        }
        for (pass, set) in views.chunks(together).enumerate() {
            let Some((first, others)) = set.split_first() else {
                continue;
            };
            for (view, other) in (pass * together + 1..).zip(others) {
                if other.target_size != first.target_size {
                    return Err(MultiviewError::TargetSize {
                        view,
                        found: other.target_size,
                        needed: first.target_size,
                    });
                }
                if is_left_handed(&other.view) != is_left_handed(&first.view) {
                    return Err(MultiviewError::Mirrored { view });
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;
    use crate::DepthConvention;
    use crate::volume::decide::near_plane::NearPlane;
    use crate::volume::gpu::draw_pipelines::Feed;

    fn of(mask: u32) -> Multiview {
        Multiview(NonZeroU32::new(mask))
    }

    fn camera(number: u32) -> ViewParams {
        ViewParams {
            depth_step: number as f32,
            ..bytemuck::Zeroable::zeroed()
        }
    }

    #[test]
    fn each_camera_is_where_its_layer_looks_for_it() {
        let views: Vec<_> = (1..=4).map(camera).collect();
        let numbers = |mask| {
            let windows = of(mask).windows(&views);
            let numbers = windows.iter().map(|camera| camera.depth_step as u32);
            numbers.collect::<Vec<_>>()
        };
        assert_eq!(numbers(0), [1, 2, 3, 4]);
        let mut of_two = [0; 64];
        (of_two[0], of_two[2], of_two[32], of_two[34]) = (1, 2, 3, 4);
        assert_eq!(numbers(0b101), of_two);
        assert_eq!(
            [of(0).layers(), of(1).layers(), of(0b101).layers()],
            [1, 1, 3]
        );
    }

    #[test]
    fn shaders_of_several_views_need_the_layer_and_nothing_else() {
        let near = NearPlane::Clipped;
        for feed in [Feed::Pulled, Feed::Records] {
            for depth in [DepthConvention::InfiniteReverse, DepthConvention::Standard] {
                let one = feed.source(depth, near);
                assert_eq!(of(0).source(one.clone()), one);
                let entry_points = one.matches("@vertex").count();
                let source = of(0b11).source(one);
                for new in ["@builtin(view_index)", "camera = cameras[layer];"] {
                    assert_eq!(source.matches(new).count(), entry_points, "{new}");
                }
                let module = naga::front::wgsl::parse_str(&source).unwrap();
                let is_valid = |capabilities| {
                    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
                    validator.validate(&module).is_ok()
                };
                assert!(is_valid(Capabilities::MULTIVIEW), "{source}");
                assert!(!is_valid(Capabilities::empty()), "{source}");
            }
        }
    }

    #[test]
    fn each_back_end_that_draws_so_has_them_in_its_language() {
        use naga::back::{hlsl, msl, spv};
        for feed in [Feed::Pulled, Feed::Records] {
            let source = feed.source(DepthConvention::InfiniteReverse, NearPlane::Clipped);
            let module = naga::front::wgsl::parse_str(&of(0b11).source(source)).unwrap();
            let mut validator = Validator::new(ValidationFlags::all(), Capabilities::MULTIVIEW);
            let info = validator.validate(&module).unwrap();
            let mut text = String::new();
            let options = hlsl::Options {
                shader_model: hlsl::ShaderModel::V6_1,
                special_constants_binding: Some(Default::default()),
                ..Default::default()
            };
            hlsl::Writer::new(&mut text, &options, &Default::default())
                .write(&module, &info, None)
                .unwrap();
            assert!(text.contains("SV_ViewID"), "{text}");
            let options = msl::Options {
                lang_version: (2, 2),
                ..Default::default()
            };
            let (text, _) =
                msl::write_string(&module, &info, &options, &Default::default()).unwrap();
            assert!(text.contains("amplification_id"), "{text}");
            spv::write_vec(&module, &info, &Default::default(), None).unwrap();
        }
    }
}
