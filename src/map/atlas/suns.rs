//! The directional lights of an atlas: where their tiles lie, frame by frame.

use super::descriptor::{AtlasFrame, AtlasView};
use super::{AtlasLight, Cascades};
use crate::error::ShadowAtlasError;
use crate::map::projection::{
    Cascade, CascadesOf, Fit, LightBox, LightProjection, MapShape, Placed, fit_cascades,
    fit_directional,
};
use crate::scene::{Casters, Record};
use crate::{DirectionalLight, Radius};

/// Changes of casters beyond which the box around all is found anew.
const MANY: usize = 1000;

/// One directional light for one view, or for none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sun<'a> {
    /// Its light's place in the frame.
    pub index: usize,
    pub light: DirectionalLight,
    pub cascades: &'a Cascades,
    pub view: Option<&'a AtlasView<'a>>,
    /// Texels along its tiles.
    pub size: u32,
}

/// What one directional light was fitted to, and came to.
#[derive(Clone, Debug, Default)]
struct Fitted {
    placed: Vec<Option<Placed>>,
    /// Texels before a cascade's border over which it blends into the next.
    blends: Vec<f32>,
}

/// All that is known of directional lights from the last frame, by their order in it.
#[derive(Debug)]
pub(crate) struct Suns {
    reach: Radius,
    unclipped_depth: bool,
    fitted: Vec<Fitted>,
    /// The box around all casters, as a light sees them.
    caster_boxes: Vec<(DirectionalLight, Option<LightBox>)>,
}

impl Suns {
    pub fn new(reach: Radius, unclipped_depth: bool) -> Self {
        Self {
            reach,
            unclipped_depth,
            fitted: Vec::new(),
            caster_boxes: Vec::new(),
        }
    }

    /// Learns what changed among the casters.
    pub fn casters_changed(&mut self, casters: &Casters) {
        if casters.changes().len() > MANY {
            self.caster_boxes.clear();
        }
        self.caster_boxes.retain_mut(|(light, around)| {
            casters.changes().all(|change| {
                let [old, new] = [change.old, change.new].map(|of| LightBox::of_casters(light, of));
                let stays = match (&old, &around) {
                    (Some(old), Some(around)) => around.is_held_by_others_than(old),
                    (old, _) => old.is_none(),
                };
                *around = match (*around, new) {
                    (Some(around), Some(new)) => Some(around.joined(&new)),
                    (around, new) => around.or(new),
                };
                stays
            })
        });
    }

    /// Forgets the lights that the frame does not have any more.
    pub fn keep(&mut self, count: usize) {
        self.fitted.truncate(count);
    }

    /// How many tiles a light has for a view.
    pub fn tiles(light: &AtlasLight, view: Option<&AtlasView<'_>>) -> usize {
        view.map_or(1, |_| light.cascades().count as usize)
    }

    /// Texels before the border of a sun's cascade over which it blends into the next.
    pub fn blend(&self, sun: usize, cascade: usize) -> f32 {
        let fitted = self.fitted.get(sun);
        let blend = fitted.and_then(|fitted| fitted.blends.get(cascade));
        blend.copied().unwrap_or(0.0)
    }

    /// Where the tiles of the frame's sun number `at` lie.
    pub fn fit(
        &mut self,
        at: usize,
        sun: &Sun<'_>,
        frame: &AtlasFrame<'_>,
        records: &[Record],
    ) -> Result<LightProjection, ShadowAtlasError> {
        if self.fitted.len() <= at {
            self.fitted.resize_with(at + 1, Fitted::default);
        }
        let casters = self.caster_box(&sun.light, records);
        let shape = MapShape {
            size: sun.size,
            reach: self.reach,
            unclipped_depth: self.unclipped_depth,
        };
        let fitted = &mut self.fitted[at];
        let Some(view) = sun.view else {
            return fit_whole(sun, frame, shape, casters, fitted);
        };
        let of = CascadesOf {
            light: &sun.light,
            view: view.view,
            cascades: sun.cascades,
            depth_bounds: view.depth_bounds,
            receivers: frame.receivers,
            shape,
            casters,
            last: &fitted.placed,
        };
        let index = sun.index;
        let of_cascades = |source| ShadowAtlasError::Cascades { index, source };
        let cascades = fit_cascades(&of).map_err(of_cascades)?;
        let count = sun.cascades.count as usize;
        let map = |cascade: usize| cascades.get(cascade).and_then(|cascade| cascade.map);
        let maps: Vec<_> = (0..count).map(map).collect();
        fitted.placed = maps.iter().map(|map| Some((*map)?.1)).collect();
        fitted.blends = cascades
            .iter()
            .map(|of| blend_texels(of, sun.size))
            .collect();
        let frames = maps.into_iter().map(|map| Some(map?.0));
        Ok(LightProjection::Cascades(frames.collect()))
    }

    fn caster_box(&mut self, light: &DirectionalLight, records: &[Record]) -> Option<LightBox> {
        let known = self.caster_boxes.iter().find(|(of, _)| of == light);
        if let Some((_, known)) = known {
            return *known;
        }
        let found = LightBox::of_casters(light, records);
        self.caster_boxes.push((*light, found));
        found
    }
}

/// One tile for all that casts and receives.
fn fit_whole(
    sun: &Sun<'_>,
    frame: &AtlasFrame<'_>,
    shape: MapShape,
    casters: Option<LightBox>,
    fitted: &mut Fitted,
) -> Result<LightProjection, ShadowAtlasError> {
    let index = sun.index;
    let (reach, _) = shape.reach.reach();
    if 4.0 * (reach + 1.0) > shape.size as f32 {
        let source = crate::error::CascadeError::ReachOfSize {
            reach,
            margin: 0.0,
            size: shape.size,
        };
        return Err(ShadowAtlasError::Cascades { index, source });
    }
    let (placed, last) = fit_directional(&Fit {
        light: &sun.light,
        view: None,
        receivers: frame.receivers,
        shape,
        casters,
        last: fitted.placed.first().copied().flatten(),
    })
    .unzip();
    if placed.is_some_and(|frame| !frame.fits_f32()) {
        return Err(ShadowAtlasError::BeyondF32 { index });
    }
    fitted.placed = vec![last];
    fitted.blends = vec![0.0];
    Ok(LightProjection::Cascades(Box::new([placed])))
}

/// The texels of a tile that the part of a slice takes which blends into the next.
fn blend_texels(cascade: &Cascade, size: u32) -> f32 {
    let Some((frame, _)) = cascade.map else {
        return 0.0;
    };
    let texel = 2.0 / (f64::from(frame.scale) * f64::from(size));
    ((cascade.slice.to - cascade.slice.blend_from) / texel) as f32
}
