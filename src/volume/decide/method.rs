//! How a caster's volume is counted and closed, and whether it is drawn at all.
//!
//! **z-pass** (Heidmann, "Real Shadows, Real Time", 1991) counts the faces in front of the visible
//! point P: +1 front, -1 back. **z-fail** counts those behind it: +1 back, -1 front. Along a ray
//! from a point N of the near rectangle through P to infinity the winding number of a closed volume
//! changes by +1 at a front face and by -1 at a back face, and is 0 at infinity. So z-fail counts
//! winding(P), and z-pass winding(P) - winding(N). Hence
//! - z-pass is right exactly where winding(N) = 0, so where no part of the caster lies between the
//!   near rectangle and the light: in the pyramid between the two, a prism for a directional light.
//! - Both may share one buffer, caster by caster: each adds the same winding(P), modulo 256.
//! - z-pass needs no cap that cannot lie between N and P: no light cap, for P is the first surface
//!   that the host draws and the light cap is such a surface, and no dark cap at infinity.
//!
//! Where far faces are kept by `unclipped_depth`, near ones are, too, unless the vertex shaders cut them
//! (see `near_plane.rs`): rays then start at the eye (from infinity behind it in an orthographic view),
//! and the pyramid is that much larger.
//!
//! **The dark cap** closes the sides, so its boundary must be theirs, projected to infinity. The
//! light cap projected there is one such chain; a fan from one point over the silhouette is another.
//! Their difference is a chain on the sphere of directions without boundary: a whole number of times
//! the whole sphere. With the light outside the caster's box all directions from it to the box, and
//! so both chains, lie in one open hemisphere, and that number is 0. With the light inside it may
//! not be, and the full cap is drawn.
//!
//! In a plane, where finite volumes end, any two caps with one boundary are the same chain, and the
//! fan serves.
//!
//! **Views that are drawn together** (see `multiview.rs`) share every draw. z-pass, an end before infinity and
//! leaving a caster out are then what is proven for each of them, and z-fail, which is right in all, is the rest.

use glam::{DVec4, Vec4Swizzles as _};

use crate::HomogeneousLight;
use crate::volume::StartFrom;
use crate::volume::decide::far_end::{Ends, FarEnd};
use crate::volume::decide::hull::Hull;
use crate::volume::decide::near_plane::NearPlane;
use crate::volume::decide::reach::Reach;
use crate::volume::decide::scissor::{self, Rect};
use crate::volume::decide::sight::{Sight, origins};
use crate::volume::decide::world_box::WorldBox;
use crate::volume::descriptor::ShadowVolumeDescriptor;
use crate::volume::frame::Situation;

/// Which faces of a volume are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// z-pass for each caster for which it is proven correct in this frame, z-fail for the others.
    #[default]
    Auto,
    /// z-pass for all casters, for comparison. **Incorrect whenever a caster lies between the near rectangle
    /// and the light**: part or all of the screen is then inverted.
    #[doc(hidden)]
    ZPass,
    /// z-fail for all casters: always right, for those too that the host does not draw
    /// ([`ShadowVolumeFrame::casters`](crate::ShadowVolumeFrame::casters)), and more to fill.
    ZFail,
}

/// How z-fail closes a volume at its far end.
#[doc(hidden)] // for measuring alone, as the field that it is of
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Caps {
    /// Nothing for a directional light, whose sides meet in one point at infinity; a fan over the silhouette
    /// for a point light outside the caster's bounds; the full cap for one inside.
    #[default]
    AsNeeded,
    /// The light cap repeated at infinity, triangle by triangle.
    Full,
}

/// How far volumes reach.
#[doc(hidden)] // for measuring alone, as the field that it is of
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Extrusion {
    /// To infinity.
    Infinite,
    /// Past the light's range, its cone or the frame's `receivers`, for less to fill: every shadow is complete
    /// within them and on the receivers, and beyond them, where the light must have no effect
    /// or nothing is, there may be none. Casters around the light, and lights without a range where
    /// the receivers are not known, have infinite volumes all the same.
    #[default]
    ToRange,
}

/// Which of the renderer's savings are on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    pub method: Method,
    pub caps: Caps,
    pub extrusion: Extrusion,
    pub culling: bool,
    pub start_from: StartFrom,
    pub near: NearPlane,
}

impl Options {
    pub fn of(device: &wgpu::Device, descriptor: &ShadowVolumeDescriptor<'_>) -> Self {
        Self {
            method: descriptor.method,
            caps: descriptor.caps,
            extrusion: descriptor.extrusion,
            culling: descriptor.culling,
            start_from: descriptor.start_from,
            near: NearPlane::of(device.features(), descriptor.depth),
        }
    }

    /// What of the target is drawn to, and the target's size; `None` for all of it.
    pub fn scissor(&self, of: &Situation) -> Option<(Rect, [u32; 2])> {
        let target = of.target_size.filter(|_| self.culling)?;
        let (centre, radius) = Reach::new(of).ball()?;
        let views = of.views.iter();
        let rects = views.filter_map(|view| scissor::of_sphere(view, centre, radius, target));
        Some((rects.reduce(scissor::around).unwrap_or_default(), target))
    }
}

/// Which side of the visible point counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Count {
    Pass,
    Fail,
}

/// The far end of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DarkCap {
    None,
    Fan,
    Full,
}

/// Why a caster is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Skip {
    Empty,
    Masked,
    EdgeOn,
    OutOfRange,
    OutOfView,
}

/// What is drawn of a caster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Form {
    pub count: Count,
    pub dark_cap: DarkCap,
    /// Whether the light cap is clipped, as the host's surfaces are.
    pub light_cap_clipped: bool,
    /// Vertices of a side: 6 for a quad, 3 where its far edge is one point at infinity.
    pub side_vertices: u32,
    pub far: FarEnd,
}

/// What the choices for one light and view depend on.
#[derive(Debug)]
pub(crate) struct Rules {
    options: Options,
    light: HomogeneousLight,
    /// Where rays start.
    origins: Vec<DVec4>,
    ends: Ends,
    /// The views that are drawn together.
    sights: Vec<Sight>,
    /// From the receivers to the light: what misses it shadows none of them.
    receiving: Option<Hull>,
    reach: Reach,
}

impl Rules {
    pub fn new(of: &Situation, options: Options) -> Self {
        let light = unit(of.light.0.as_dvec4());
        let views = of.views.iter();
        let origins: Vec<_> = views.flat_map(|view| origins(view, options.near)).collect();
        let reach = Reach::new(of);
        let ends = Ends::new(of, &reach, origins.clone());
        let sight = |view| Sight::new(view, options.near, light, reach.ball());
        let receiving = ends.receivers().map(|box_| Hull::new(&with(&box_, light)));
        Self {
            options,
            light: of.light,
            sights: of.views.iter().map(sight).collect(),
            receiving,
            origins,
            ends,
            reach,
        }
    }

    /// Why the caster need not be drawn, if it need not.
    pub fn skips(&self, world: &WorldBox) -> Option<Skip> {
        if !self.options.culling {
            return None;
        }
        if self.reach.misses(world) {
            return Some(Skip::OutOfRange);
        }
        let nowhere = self
            .receiving
            .as_ref()
            .is_some_and(|hull| hull.misses(world));
        let unseen = nowhere || self.ends.reaches_nothing;
        if unseen || self.sights.iter().all(|sight| sight.misses_shadow(world)) {
            return Some(Skip::OutOfView);
        }
        None
    }

    /// What is drawn of a caster that is not skipped.
    pub fn form(&self, world: &WorldBox) -> Form {
        let count = match self.options.method {
            Method::ZFail => Count::Fail,
            Method::ZPass => Count::Pass,
            Method::Auto if self.sights.iter().all(|sight| sight.starts_lit(world)) => Count::Pass,
            Method::Auto => Count::Fail,
        };
        let far = self.far_end(world, count);
        let full = self.options.caps == Caps::Full;
        let directional = self.light.is_directional();
        let dark_cap = match count {
            Count::Pass if self.starts_beyond(&far) => DarkCap::Fan,
            Count::Pass => DarkCap::None,
            Count::Fail if full || !world.excludes(self.light) => DarkCap::Full,
            Count::Fail if directional && far.is_infinite() => DarkCap::None,
            Count::Fail => DarkCap::Fan,
        };
        Form {
            count,
            dark_cap,
            light_cap_clipped: count == Count::Fail && self.is_cut_by_near_alone(world),
            side_vertices: if directional && !full && far.is_infinite() {
                3
            } else {
                6
            },
            far,
        }
    }

    /// Whether the near plane may cut the caster, and the far plane, which the view has, certainly does not.
    ///
    /// Its light cap is then clipped in z-fail, which loses nothing by that. Cut where the host's surfaces
    /// are, by the same arithmetic, it has their corners. From any other the rasteriser finds other depths:
    /// a corner is moved by up to half of 1/256 of a pixel, and steep depth by more than any bias.
    ///
    /// Of views drawn together: whether that goes for one, and the far plane of none may cut it.
    fn is_cut_by_near_alone(&self, world: &WorldBox) -> bool {
        let mut is_cut = false;
        for sight in &self.sights {
            match sight.holds(world) {
                Some([in_near, true]) => is_cut |= !in_near,
                _ => return false,
            }
        }
        is_cut
    }

    /// The nearest end that leaves every shadow whole.
    fn far_end(&self, world: &WorldBox, count: Count) -> FarEnd {
        let infinite = self.ends.infinite(world);
        if self.options.extrusion == Extrusion::Infinite {
            return infinite;
        }
        let end = self.ends.at_range(world).unwrap_or(infinite);
        let end = self.ends.behind_receivers(world, end);
        // Dark caps that z-fail counts are pushed away from the viewer: none may be before a receiver.
        match count {
            Count::Fail if self.starts_beyond(&end) => infinite,
            _ => end,
        }
    }

    /// Whether a ray may start beyond the plane that ends the volume, and so pass its dark cap on
    /// the way to a point within the range.
    fn starts_beyond(&self, far: &FarEnd) -> bool {
        // Ends behind receivers are only chosen where none does.
        if far.is_infinite() || self.light.is_directional() {
            return false;
        }
        let plane = far.plane.xyz();
        let light = self.light.0.xyz().as_dvec3();
        // Well before the plane, so that rounding cannot matter.
        let before = |p: &DVec4| plane.dot(p.xyz() - light * p.w) < 0.999 * p.w;
        !self.origins.iter().all(before)
    }
}

fn with(points: &[DVec4], last: DVec4) -> Vec<DVec4> {
    points.iter().copied().chain([last]).collect()
}

/// A direction of length 1; points as they are.
fn unit(light: DVec4) -> DVec4 {
    if light.w == 0.0 {
        light.xyz().normalize().extend(0.0)
    } else {
        light
    }
}
