//! The colours of the debug views.

use crate::volume::CasterState;

/// The colours of [`VolumeDebug`](crate::VolumeDebug): red, green, blue and opacity, not premultiplied, in
/// the target's colour space (linear for an sRGB target).
///
/// The default is the legend below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebugColors {
    /// Sides of volumes counted by z-pass. Default green, opacity 0.2.
    pub sides_z_pass: [f32; 4],
    /// Sides of volumes counted by z-fail. Default orange, opacity 0.2.
    pub sides_z_fail: [f32; 4],
    /// Light caps. Default yellow, opacity 0.2.
    pub light_caps: [f32; 4],
    /// Dark caps, fans included. Default violet, opacity 0.2.
    pub dark_caps: [f32; 4],
    /// Silhouette edges. Default white, opaque.
    pub edges: [f32; 4],
    /// Casters in [`CasterState::ZPass`]. Default green, opacity 0.7.
    pub casters_z_pass: [f32; 4],
    /// Casters in [`CasterState::ZFail`]. Default orange, opacity 0.7.
    pub casters_z_fail: [f32; 4],
    /// Casters in [`CasterState::OutOfRange`]. Default blue, opacity 0.7.
    pub casters_out_of_range: [f32; 4],
    /// Casters in [`CasterState::OutOfView`]. Default grey, opacity 0.7.
    pub casters_out_of_view: [f32; 4],
    /// Stencil counts 1 to 7, then 8 to 247; always opaque, whatever the fourth number. Default blue, green,
    /// yellow, orange, red, magenta, violet; white.
    pub counts: [[f32; 4]; 8],
    /// Stencil counts 248 to 255, opaque: -8 to -1 modulo 256. In a closed volume they indicate that
    /// something is counted that should not be. Default black.
    pub negative: [f32; 4],
}

impl Default for DebugColors {
    fn default() -> Self {
        let [green, orange] = [[0.0, 0.8, 0.2], [1.0, 0.4, 0.0]];
        let [yellow, violet, blue] = [[1.0, 1.0, 0.2], [0.6, 0.2, 1.0], [0.0, 0.4, 1.0]];
        let with = |[r, g, b]: [f32; 3], opacity| [r, g, b, opacity];
        Self {
            sides_z_pass: with(green, 0.2),
            sides_z_fail: with(orange, 0.2),
            light_caps: with(yellow, 0.2),
            dark_caps: with(violet, 0.2),
            edges: [1.0; 4],
            casters_z_pass: with(green, 0.7),
            casters_z_fail: with(orange, 0.7),
            casters_out_of_range: with(blue, 0.7),
            casters_out_of_view: with([0.6; 3], 0.7),
            counts: [
                with(blue, 1.0),
                with(green, 1.0),
                with(yellow, 1.0),
                with(orange, 1.0),
                [0.8, 0.0, 0.0, 1.0],
                [1.0, 0.0, 0.6, 1.0],
                with(violet, 1.0),
                [1.0; 4],
            ],
            negative: [0.0, 0.0, 0.0, 1.0],
        }
    }
}

impl DebugColors {
    /// The colour of a stencil count; `None` for 0, which is not drawn.
    pub fn of_count(&self, count: u8) -> Option<[f32; 4]> {
        match count {
            0 => None,
            1..=7 => Some(self.counts[usize::from(count) - 1]),
            8..=247 => Some(self.counts[7]),
            248..=255 => Some(self.negative),
        }
    }

    /// The colour of a caster; `None` for one without triangles.
    pub fn of_state(&self, state: CasterState) -> Option<[f32; 4]> {
        Some(self.list()[Swatch::of_state(state)? as usize])
    }

    /// All colours, in the order of [`Swatch`], the counts after them.
    pub(crate) fn list(&self) -> Vec<[f32; 4]> {
        let mut list = vec![
            self.sides_z_pass,
            self.sides_z_fail,
            self.light_caps,
            self.dark_caps,
            self.edges,
            self.casters_z_pass,
            self.casters_z_fail,
            self.casters_out_of_range,
            self.casters_out_of_view,
            self.negative,
        ];
        list.extend(self.counts);
        list
    }
}

/// Places in [`DebugColors::list`].
#[derive(Clone, Copy, Debug)]
pub(crate) enum Swatch {
    SidesZPass,
    SidesZFail,
    LightCaps,
    DarkCaps,
    Edges,
    CastersZPass,
    CastersZFail,
    CastersOutOfRange,
    CastersOutOfView,
    Negative,
    Counts,
}

impl Swatch {
    pub fn of_state(state: CasterState) -> Option<Self> {
        match state {
            CasterState::ZPass => Some(Self::CastersZPass),
            CasterState::ZFail => Some(Self::CastersZFail),
            CasterState::OutOfRange => Some(Self::CastersOutOfRange),
            CasterState::OutOfView => Some(Self::CastersOutOfView),
            CasterState::Empty | CasterState::Masked | CasterState::EdgeOn => None,
        }
    }
}
