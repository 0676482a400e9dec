//! Where the map of a directional light lies, given what it has to cover.

use glam::{DVec2, DVec3, Vec3};

use super::flat::FlatFrame;
use super::light_box::{LightAxes, LightBox};
use crate::Radius;

/// No tap takes a receiver's plane for nearer to a directional light than the receiver by more widths
/// of the map: `bound` in flat_receiver.wgsl.
const BOUND_WIDTHS: f64 = 16.0;

/// The same camera, rounded to `f32` in two ways, sees sizes that differ by no larger share.
const SAME: f64 = 1e-6;

/// Widths to choose from in an octave: of maps of what changes in size with every frame, and of others.
pub(super) const COARSE: f64 = 4.0;
pub(super) const FINE: f64 = 64.0;

/// What is the same for all maps of a kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapShape {
    /// Texels along a side.
    pub size: u32,
    /// How far kernels reach beyond what is covered.
    pub reach: Radius,
    /// Whether casters before the near plane are pulled onto it.
    pub unclipped_depth: bool,
}

/// Where a map was placed, for the next frame to keep what it can of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    axes: [Vec3; 3],
    size: u32,
    width: f64,
    /// Of its middle, right and up: whole texels.
    middle: DVec2,
    /// The near plane, if no caster began behind it.
    near: f64,
}

/// What a map has to cover.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover {
    /// Right and up. Forward it holds what casts.
    pub across: LightBox,
    /// The longer side of the largest that `across` gets before the map may get wider.
    pub extent: f64,
    /// Along forward, of those that the map is for.
    pub nearest_receiver: f64,
    /// Texels by which what is covered may move before the map does.
    pub slack: f64,
    /// Widths to choose from in an octave: [`COARSE`] or [`FINE`].
    pub widths: f64,
}

/// What maps of one light are placed by.
pub(super) struct Placement<'a> {
    pub axes: &'a LightAxes,
    pub shape: MapShape,
    pub casters: &'a LightBox,
}

impl Placement<'_> {
    /// The frame of a map, no larger than it has to be.
    ///
    /// Widths go in steps, and the last one stays while it is no more than a step too wide; the grid of texels is fixed in the world (Valient, "Stable Rendering of Cascaded Shadow
    /// Maps", ShaderX6, 2008). So shadows do not shimmer when the camera moves or turns.
    pub fn place(&self, cover: &Cover, last: Option<Placed>) -> (FlatFrame, Placed) {
        let size = f64::from(self.shape.size);
        let rounding = cover.across.rounding().max(self.casters.rounding());
        let width = self.width(cover, rounding, last);
        let texel = width / size;
        let [right, up, forward] = self.axes.exact;
        let last = last.filter(|last| {
            last.axes == self.axes.rounded && last.size == self.shape.size && last.width == width
        });
        let wanted = (cover.across.min + cover.across.max).truncate() * 0.5;
        let off = |last: &Placed| (wanted - last.middle).abs().max_element();
        let middle = match last {
            Some(last) if off(&last) <= (0.5 + cover.slack) * texel => last.middle,
            _ => (wanted / texel).round() * texel,
        };
        let near = self.near(cover, width, last);
        let margin = (2.0 * texel).max(rounding);
        let begin = self.casters.min.z.max(near) - margin;
        let origin: DVec3 = right * middle.x + up * middle.y + forward * begin;
        let frame = FlatFrame {
            origin: origin.as_vec3(),
            right: self.axes.rounded[0],
            up: self.axes.rounded[1],
            forward: self.axes.rounded[2],
            scale: (2.0 / width) as f32,
            near: 0.0,
            range: (self.casters.max.z + margin - begin) as f32,
            perspective: false,
        };
        let placed = Placed {
            axes: self.axes.rounded,
            size: self.shape.size,
            width,
            middle,
            near,
        };
        (frame, placed)
    }

    fn width(&self, cover: &Cover, rounding: f64, last: Option<Placed>) -> f64 {
        let size = f64::from(self.shape.size);
        // Texels on either side: one for the snap and the tap's own texel, and what kernels reach. No
        // more than half of the map: `CascadeError::ReachOfSize`, `ShadowMapError::ReachOfSize`.
        let (reach, _) = self.shape.reach.reach();
        let share = 2.0 * (f64::from(reach) + 1.0 + cover.slack) / size;
        // The frame's origin is rounded, too.
        let need = cover.extent.max(self.least_extent(cover)) + 2.0 * rounding;
        let need = need / (1.0 - share);
        let step = ((need * (1.0 + SAME)).log2() * cover.widths).ceil();
        let wide = |step: f64| (step / cover.widths).exp2();
        match last {
            Some(last) if last.width >= need && last.width <= wide(step + 1.04) => last.width,
            _ => wide(step),
        }
    }

    /// The least that a map can be wide: what `f32` tells apart where it lies, and so much at the
    /// origin that one over a texel is finite.
    fn least_extent(&self, cover: &Cover) -> f64 {
        let least = f64::from(f32::MIN_POSITIVE) * f64::from(self.shape.size);
        cover.across.rounding().max(least)
    }

    /// Casters so far before every receiver that no tap takes a receiver's plane for as near are pulled
    /// onto the near plane where the device can: there they are before every plane still. It goes in
    /// steps of the width, and stays while it is at most three too near.
    fn near(&self, cover: &Cover, width: f64, last: Option<Placed>) -> f64 {
        let limit = match self.shape.unclipped_depth {
            true => (cover.nearest_receiver - BOUND_WIDTHS * width).min(self.casters.max.z),
            false => f64::NEG_INFINITY,
        };
        match last {
            Some(last) if last.near <= limit && last.near >= limit - 3.0 * width => last.near,
            _ => ((limit / width).floor() - 1.0) * width,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DirectionalLight;

    const CASTERS: LightBox = LightBox {
        min: DVec3::splat(-5000.0),
        max: DVec3::splat(5000.0),
    };

    fn placed(axes: &LightAxes, cover: &Cover, last: Option<Placed>) -> (FlatFrame, Placed) {
        let shape = MapShape {
            size: 1000,
            reach: Radius::Texels(11.0),
            unclipped_depth: true,
        };
        let casters = &CASTERS;
        let placement = Placement {
            axes,
            shape,
            casters,
        };
        placement.place(cover, last)
    }

    fn sun(x: f32) -> LightAxes {
        let toward_light = Vec3::new(x, 1.0, 0.2);
        LightAxes::of(&DirectionalLight { toward_light })
    }

    fn cover(middle: DVec3, extent: f64) -> Cover {
        let half = DVec3::splat(0.5 * extent);
        let (min, max) = (middle - half, middle + half);
        Cover {
            across: LightBox { min, max },
            extent,
            nearest_receiver: min.z,
            slack: 0.25,
            widths: COARSE,
        }
    }

    #[test]
    fn what_is_the_same_but_for_rounding_keeps_its_place() {
        let axes = sun(0.3);
        // What needs a width of 16, just a step: texels of 0.016.
        let (room, rounding) = (16.0 * (1.0 - 2.0 * 12.25 / 1000.0), CASTERS.rounding());
        let mut moved = 0;
        for (i, fuller) in (0..100).flat_map(|i| [(i, 1e-12), (i, SAME + 1e-12)]) {
            let (i, extent) = (f64::from(i), room / (1.0 + fuller) - 2.0 * rounding);
            // Just between texels, and the near plane just at a step.
            let across = DVec3::new(i + 0.5, 3.0 * i - 0.5, 0.0) * 0.016;
            let middle = across + DVec3::Z * (16.0 * i + 0.5 * extent);
            for by in [1.0 - 1e-7, 1.0 + 1e-7] {
                let first = placed(&axes, &cover(middle, extent), None);
                let again = placed(&axes, &cover(middle * by, extent * by), Some(first.1));
                assert_eq!(first, again, "{i} {by}");
                let anew = placed(&axes, &cover(middle * by, extent * by), None);
                moved += usize::from(anew != first);
            }
        }
        // The broken twin: without what the last frame had.
        assert!(moved > 50, "{moved}");
    }

    #[test]
    fn what_has_changed_is_placed_anew() {
        let axes = sun(0.3);
        let at = |x: f64, z: f64, extent| cover(DVec3::new(x, 0.0, z), extent);
        let (first, last) = placed(&axes, &at(0.0, 0.0, 14.0), None);
        let texel = 2.0 / f64::from(first.scale) / 1000.0;
        let again = |cover: &Cover| placed(&axes, cover, Some(last)).0;
        assert_eq!(again(&at(0.7 * texel, 0.0, 14.0)), first);
        assert_ne!(again(&at(0.8 * texel, 0.0, 14.0)), first);
        // A step of a quarter octave wider than it must be, it stays; not two.
        assert_eq!(again(&at(0.0, 0.0, 12.0)).scale, first.scale);
        assert_ne!(again(&at(0.0, 0.0, 9.0)).scale, first.scale);
        assert_ne!(again(&at(0.0, 0.0, 17.0)).scale, first.scale);
        // The near plane follows receivers, three widths late.
        let width = 2.0 / f64::from(first.scale);
        assert_eq!(again(&at(0.0, 0.9 * width, 14.0)), first);
        let behind = again(&at(0.0, 3.1 * width, 14.0));
        let shift = f64::from(behind.origin.distance(first.origin)) / width;
        assert!((1.9..3.2).contains(&shift), "{shift}");
        assert_ne!(again(&at(0.0, -2.1 * width, 14.0)), first);
        // Another light's place is worth nothing.
        let turned = placed(&sun(0.4), &at(0.7 * texel, 0.0, 14.0), Some(last));
        assert_eq!(turned, placed(&sun(0.4), &at(0.7 * texel, 0.0, 14.0), None));
    }
}
