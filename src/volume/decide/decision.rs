//! What is decided for one caster under one light in one view.

use crate::Caster;
use crate::mesh::{CasterMesh, MeshKind};
use crate::volume::decide::facing::{self, Counted, ObjectLight};
use crate::volume::decide::method::{Caps, Form, Options, Rules, Skip};
use crate::volume::decide::near_light_cap;
use crate::volume::decide::world_box::WorldBox;
use crate::volume::frame::Situation;
use crate::volume::plan::ranges::Words;
use crate::volume::silhouette::Way;
use crate::volume::statistics::CasterState;

/// A caster, and what of it depends on neither light nor view.
#[derive(Clone, Debug)]
pub(crate) struct KnownCaster {
    pub caster: Caster,
    pub world: WorldBox,
    pub mirrored: bool,
    pub way: Way,
}

impl KnownCaster {
    pub fn new(caster: &Caster, way: Way) -> Self {
        Self {
            world: WorldBox::of(caster),
            mirrored: caster.transform().matrix3.determinant() < 0.0,
            caster: caster.clone(),
            way,
        }
    }

    pub fn mesh(&self) -> &CasterMesh {
        &self.caster.mesh
    }
}

/// A volume that is drawn, or is kept until its caster comes into view again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Volume {
    pub light: ObjectLight,
    pub counted: Counted,
}

/// What becomes of a caster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decision {
    pub state: CasterState,
    /// What is drawn of it, if anything is.
    pub form: Option<Form>,
    pub volume: Option<Volume>,
}

/// The choices for one light and view.
#[derive(Debug)]
pub(crate) struct Choices {
    rules: Rules,
    of: Situation,
    options: Options,
    /// Whether volumes out of view are kept.
    keep: bool,
    /// Whether a triangle whose normal points to the viewer is clockwise on screen.
    pub left_handed: bool,
}

impl Choices {
    pub fn new(of: &Situation, options: Options, keep: bool) -> Self {
        Self {
            rules: Rules::new(of, options),
            of: of.clone(),
            options,
            keep,
            // Views of one pass are all so, or none is.
            left_handed: of.views.first().is_some_and(facing::is_left_handed),
        }
    }

    /// Decides, with the light in the mesh's own space, if the mesh has a side that it sees.
    pub fn decide(&self, known: &KnownCaster, light: Option<&ObjectLight>) -> Decision {
        let empty = (known.mesh().triangle_count() == 0).then_some(Skip::Empty);
        let masked = (!self.admits(&known.caster)).then_some(Skip::Masked);
        let skip = empty.or(masked);
        let skip = skip.or_else(|| self.rules.skips(&known.world));
        let skip = skip.or(light.is_none().then_some(Skip::EdgeOn));
        let held = match skip {
            None => true,
            Some(Skip::OutOfView) => self.keep,
            Some(Skip::Empty | Skip::Masked | Skip::EdgeOn | Skip::OutOfRange) => false,
        };
        let form = skip.is_none().then(|| self.form(known));
        let state = match (&form, skip) {
            (Some(form), _) => form.count.into(),
            (None, skip) => skip.unwrap_or(Skip::EdgeOn).into(),
        };
        let volume = light.filter(|_| held).map(|light| Volume {
            light: *light,
            counted: Counted::of(
                known.mesh(),
                &known.world,
                &self.of,
                self.options.start_from,
            ),
        });
        Decision {
            state,
            form,
            volume,
        }
    }

    fn admits(&self, caster: &Caster) -> bool {
        self.of.filter.admits(caster.layers, caster.owner)
    }

    fn form(&self, known: &KnownCaster) -> Form {
        let mut form = self.rules.form(&known.world);
        if self.options.caps == Caps::AsNeeded {
            let map = known.caster.transform();
            let own = (known.mesh().bounds(), &map);
            near_light_cap::settle(&mut form, own, self.of.light, &known.world);
        }
        form
    }
}

/// Words for facings, caps and sides, the worst case: they cannot overflow.
///
/// Facings and caps: one for each triangle. Sides: an edge is extruded once for each of its uses at
/// most. (Where light-facing triangles alone count, half of that would do; but whether they do depends
/// on the camera, and no place may. A volume that the CPU finds takes what it comes to.)
pub(crate) fn words(mesh: &CasterMesh, way: Way) -> Words {
    let triangles = u64::from(mesh.triangle_count());
    let sides = match mesh.kind() {
        MeshKind::Closed => 2 * u64::from(mesh.edge_count()),
        MeshKind::General => u64::from(mesh.edge_use_count()),
    };
    match way {
        Way::Compute => [triangles, 3 * triangles, sides],
        // Facings stay on the CPU.
        Way::Cpu => [0, 3 * triangles, sides],
        Way::Vertex => [0; 3],
    }
}
