//! The draws of a volume's faces.

use crate::volume::decide::facing::Counted;
use crate::volume::decide::method::{Count, DarkCap, Form};
use crate::volume::gpu::draw_pipelines::{Part, Style};
use crate::volume::silhouette::Way;

/// The kinds of faces of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Faces {
    LightCap,
    DarkCap,
    Sides,
    /// The dark cap as a fan over the silhouette.
    Fan,
}

impl Faces {
    /// Whether they are drawn from a list of caps, or from one of sides.
    pub fn are_caps(self) -> bool {
        matches!(self, Self::LightCap | Self::DarkCap)
    }

    /// The vertex shader that places them.
    pub fn entry_point(self) -> &'static str {
        match self {
            Self::LightCap => "shadows_volume_light_cap",
            Self::DarkCap => "shadows_volume_dark_cap",
            Self::Sides => "shadows_volume_side",
            Self::Fan => "shadows_volume_fan",
        }
    }
}

/// The faces of one kind of one caster, as they are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Draw {
    pub style: Style,
    /// Number of the caster's window: see `windows.rs`.
    pub window: u32,
    /// Whether the caps are those that count -1.
    pub back: bool,
}

impl Style {
    /// Whether another draw has the same faces, this one being for those that it leaves out.
    pub fn is_repeat(&self) -> bool {
        let alone = (self.count, self.faces) == (Count::Pass, Faces::LightCap);
        self.part == Part::Back && !alone
    }
}

/// All that the draws of a volume follow from: where it is the same, so are they.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DrawnAs {
    pub window: u32,
    count: Count,
    dark_cap: DarkCap,
    light_cap_clipped: bool,
    counted: Counted,
    way: Way,
    /// Whether a cap that counts +1 is clockwise on screen if it faces the viewer.
    clockwise: bool,
}

impl DrawnAs {
    pub fn new(
        window: u32,
        form: &Form,
        (counted, way): (Counted, Way),
        (mirrored, left_handed): (bool, bool),
    ) -> Self {
        Self {
            window,
            count: form.count,
            dark_cap: form.dark_cap,
            light_cap_clipped: form.light_cap_clipped,
            counted,
            way,
            // It is counter-clockwise seen from the light, in the mesh's own space.
            clockwise: mirrored != left_handed,
        }
    }

    /// The lists of caps that are drawn: those that count +1 (`false`), those that count -1.
    fn cap_lists(self) -> &'static [bool] {
        match (self.way, self.counted) {
            // Where vertex shaders decide, they turn the caps that count -1 over.
            (Way::Vertex, _) | (_, Counted::LightFacing) => &[false],
            (_, Counted::All) => &[false, true],
            (_, Counted::AwayFacing) => &[true],
        }
    }

    /// Calls back with each draw.
    pub fn draws(self, mut each: impl FnMut(Draw)) {
        let Self {
            window,
            count,
            dark_cap,
            counted,
            clockwise,
            ..
        } = self;
        let mut push = |faces, clockwise, back, parts: &[Part]| {
            for &part in parts {
                each(Draw {
                    style: Style {
                        count,
                        faces,
                        clockwise,
                        part,
                        clipped: self.light_cap_clipped && faces == Faces::LightCap,
                    },
                    window,
                    back,
                });
            }
        };
        let parts = match counted {
            Counted::AwayFacing => &[Part::Front, Part::Back][..],
            Counted::LightFacing | Counted::All => &[Part::Whole],
        };
        push(Faces::Sides, clockwise, false, parts);
        if dark_cap == DarkCap::Fan {
            push(Faces::Fan, clockwise, false, &[Part::Whole]);
        }
        for &back in self.cap_lists() {
            match (count, counted) {
                (Count::Fail, _) => push(Faces::LightCap, clockwise != back, back, parts),
                // Where the mesh's far side is what is seen, its cap lies before it.
                (Count::Pass, Counted::AwayFacing) => {
                    push(Faces::LightCap, clockwise != back, back, &[Part::Back]);
                }
                (Count::Pass, _) => {}
            }
            if dark_cap == DarkCap::Full {
                push(Faces::DarkCap, clockwise == back, back, &[Part::Whole]);
            }
        }
    }
}
