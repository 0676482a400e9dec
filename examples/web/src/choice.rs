//! What a visitor chooses, by the names that the controls and the page's address have for it.

use anyhow::{Context as _, Result, bail};
use host::scene::LightKind;
use shadows::{Bias, Kernel, MapSettings};

/// A way to find shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// A cube map for a point light, a flat one for other lights.
    Map,
    /// Tiles of an atlas.
    Atlas,
    /// Stencil shadow volumes.
    Volumes,
    /// A map with one tap and a constant bias: for a point light by this crate, for others as the example
    /// `shadow` of wgpu has it.
    Textbook,
    /// Stencil shadow volumes as they are usually written down.
    TextbookVolumes,
    /// As three.js has it, in our rendition; for point lights.
    Three,
    /// As Bevy has it, in our rendition: 2x2 texels.
    Bevy,
    /// The same with its wide filter.
    BevyGaussian,
    /// No shadows.
    None,
}

/// What is shown of a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The shaded picture.
    Picture,
    /// The light's visibility: white where it is lit.
    Visibility,
}

/// The scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Courtyard,
    City,
    Valley,
}

/// How maps are made and read, where the method leaves a choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maps {
    pub kernel: Kernel,
    /// Texels along a side.
    pub size: u32,
    /// In texels.
    pub bias: Bias,
}

impl Maps {
    /// What maps of all kinds are told.
    pub fn settings(&self) -> MapSettings {
        MapSettings {
            bias: self.bias,
            reach: self.kernel.radius(),
            ..Default::default()
        }
    }
}

/// All of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    pub place: Place,
    pub light: LightKind,
    pub left: Method,
    pub right: Method,
    pub maps: Maps,
    pub show: Show,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            place: Place::Courtyard,
            light: LightKind::Point,
            left: Method::Textbook,
            right: Method::Map,
            maps: Maps {
                kernel: Kernel::default(),
                size: 512,
                bias: Bias::default(),
            },
            show: Show::Picture,
        }
    }
}

const PLACES: &[(&str, Place)] = &[
    ("courtyard", Place::Courtyard),
    ("city", Place::City),
    ("valley", Place::Valley),
];

const LIGHTS: &[(&str, LightKind)] = &[
    ("point", LightKind::Point),
    ("spot", LightKind::Spot),
    ("sun", LightKind::Directional),
];

const METHODS: &[(&str, Method)] = &[
    ("map", Method::Map),
    ("atlas", Method::Atlas),
    ("volumes", Method::Volumes),
    ("textbook", Method::Textbook),
    ("textbook-volumes", Method::TextbookVolumes),
    ("three", Method::Three),
    ("bevy", Method::Bevy),
    ("bevy-gaussian", Method::BevyGaussian),
    ("none", Method::None),
];

const SHOWN: &[(&str, Show)] = &[("picture", Show::Picture), ("visibility", Show::Visibility)];

impl Choice {
    /// Changes one of the choices.
    ///
    /// # Errors
    /// One line that names what there is instead.
    pub fn set(&mut self, name: &str, value: &str) -> Result<()> {
        let number = || {
            let number = value.parse::<f32>();
            number.with_context(|| format!("{name}: {value:?} is no number"))
        };
        match name {
            "scene" => self.place = one_of(name, value, PLACES)?,
            "light" => self.light = one_of(name, value, LIGHTS)?,
            "left" => self.left = one_of(name, value, METHODS)?,
            "right" => self.right = one_of(name, value, METHODS)?,
            "show" => self.show = one_of(name, value, SHOWN)?,
            "kernel" => self.maps.kernel = one_of(name, value, &kernels())?,
            "size" => {
                let size = value.parse().ok();
                self.maps.size = size.with_context(|| format!("size: {value:?} is no size"))?;
            }
            "normal" => self.maps.bias.normal_offset = number()?,
            "constant" => self.maps.bias.constant = number()?,
            _ => bail!("there is no choice {name:?}"),
        }
        Ok(())
    }
}

/// The kernels by name.
fn kernels() -> Vec<(&'static str, Kernel)> {
    let name = |kernel: Kernel| kernel.function().trim_start_matches("shadows_cube_");
    Kernel::ALL.map(|kernel| (name(kernel), kernel)).to_vec()
}

fn one_of<T: Copy>(name: &str, value: &str, all: &[(&'static str, T)]) -> Result<T> {
    let found = all.iter().find(|(other, _)| *other == value);
    found.map(|(_, found)| *found).with_context(|| {
        let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
        format!(
            "{name}: there is no {value:?}; there are {}",
            names.join(", ")
        )
    })
}
