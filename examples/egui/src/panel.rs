//! The controls at the side, and what they say.

use eframe::egui::{self, Color32, ComboBox, Slider, Ui};
use shadows::glam::Vec3;
use shadows::{Kernel, Radius};

use crate::measure::Measured;
use crate::shadow::{Settings, Technique};
use crate::viewport::Show;

/// What the user can change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controls {
    pub settings: Settings,
    /// Where the light is, or from where it shines, in metres.
    pub light: Vec3,
    pub show: Show,
    /// Whether the light goes round the scene.
    pub turning: bool,
}

impl Controls {
    /// The sliders; light positions within `reach` of the middle.
    pub fn ui(&mut self, ui: &mut Ui, reach: f32) {
        ui.heading("Light");
        let settings = &mut self.settings;
        ui.horizontal(|ui| {
            ui.selectable_value(&mut settings.directional, false, "point");
            ui.selectable_value(&mut settings.directional, true, "directional");
            ui.checkbox(&mut self.turning, "turning");
        });
        ui.add(Slider::new(&mut self.light.x, -reach..=reach).text("x, m"));
        ui.add(Slider::new(&mut self.light.y, 0.1..=reach).text("y, m"));
        ui.add(Slider::new(&mut self.light.z, -reach..=reach).text("z, m"));

        ui.heading("Shadows");
        ui.horizontal(|ui| {
            let technique = &mut settings.technique;
            ui.selectable_value(technique, Technique::Map, "map");
            ui.selectable_value(technique, Technique::Atlas, "atlas");
            ui.selectable_value(technique, Technique::Volumes, "volumes");
            ui.selectable_value(technique, Technique::None, "none");
        });
        if matches!(settings.technique, Technique::Map | Technique::Atlas) {
            map_ui(ui, settings);
        }

        ui.heading("Show");
        ui.horizontal_wrapped(|ui| {
            ui.selectable_value(&mut self.show, Show::Picture, "picture");
            ui.selectable_value(&mut self.show, Show::Visibility, "visibility");
            ui.selectable_value(&mut self.show, Show::Error, "error");
            if settings.technique == Technique::Map && !settings.directional {
                ui.selectable_value(&mut self.show, Show::Cross, "cube cross");
            }
            if settings.technique == Technique::Atlas {
                ui.selectable_value(&mut self.show, Show::Tiles, "tiles");
            }
            if settings.technique == Technique::Volumes {
                ui.selectable_value(&mut self.show, Show::Surfaces, "surfaces");
                ui.selectable_value(&mut self.show, Show::Counts, "counts");
                ui.selectable_value(&mut self.show, Show::Casters, "casters");
            }
        });
    }
}

fn map_ui(ui: &mut Ui, settings: &mut Settings) {
    ComboBox::from_label("kernel")
        .selected_text(name(settings.kernel))
        .show_ui(ui, |ui| {
            for kernel in Kernel::ALL {
                let same = name(kernel) == name(settings.kernel);
                if ui.selectable_label(same, name(kernel)).clicked() && !same {
                    settings.kernel = kernel;
                }
            }
        });
    if let Some(radius) = radius_mut(&mut settings.kernel) {
        let slider = Slider::new(radius, 0.5..=Radius::MAX_TEXELS);
        ui.add(slider.logarithmic(true).text("radius, texels"));
    }
    let mut exponent = settings.size.ilog2();
    let size = |exponent: f64, _| format!("{}", 1_u32 << exponent as u32);
    ui.add(
        Slider::new(&mut exponent, 6..=12)
            .custom_formatter(size)
            .text("size, texels"),
    );
    settings.size = 1 << exponent;
    let bias = &mut settings.bias;
    ui.add(Slider::new(&mut bias.normal_offset, 0.0..=3.0).text("normal offset, texels"));
    ui.add(Slider::new(&mut bias.constant, 0.0..=3.0).text("constant, texels"));
}

/// As the sampler's WGSL calls it.
pub fn name(kernel: Kernel) -> &'static str {
    kernel.function().trim_start_matches("shadows_cube_")
}

/// The radius in texels of a kernel that has one to choose.
fn radius_mut(kernel: &mut Kernel) -> Option<&mut f32> {
    let radius = match kernel {
        Kernel::RandomDisk(disk) => &mut disk.radius,
        Kernel::Vogel(disk) => &mut disk.radius,
        Kernel::ContactHardening(contact) => &mut contact.max_radius,
        _ => return None,
    };
    match radius {
        Radius::Texels(texels) => Some(texels),
        _ => None,
    }
}

/// Names and values, side by side.
pub fn table(ui: &mut Ui, title: &str, rows: &[(&'static str, String)]) {
    ui.heading(title);
    egui::Grid::new(title)
        .num_columns(2)
        .striped(true)
        .show(ui, |ui| {
            for (name, value) in rows {
                ui.label(*name);
                ui.monospace(value);
                ui.end_row();
            }
        });
}

/// The error, or why it is not known.
pub fn error_ui(ui: &mut Ui, measured: Option<&anyhow::Result<Measured>>, problem: Option<&str>) {
    if let Some(problem) = problem {
        ui.colored_label(Color32::LIGHT_RED, problem);
    }
    let measured = match measured {
        Some(Ok(measured)) => measured,
        other => {
            ui.heading("Error");
            match other {
                Some(Err(error)) => ui.colored_label(Color32::LIGHT_RED, format!("{error:#}")),
                _ => ui.weak("measured as soon as nothing moves"),
            };
            return;
        }
    };
    let error = &measured.error;
    let wrong = error.false_lit + error.false_shadow;
    let share = 100.0 * wrong as f64 / error.lit_facing.max(1) as f64;
    let interior = error.false_lit_interior + error.false_shadow_interior;
    table(
        ui,
        "Error",
        &[
            ("pixels facing the light", error.lit_facing.to_string()),
            ("wrong", format!("{wrong} ({share:.4} %)")),
            ("false lit", error.false_lit.to_string()),
            ("false shadow", error.false_shadow.to_string()),
            ("in the interior", interior.to_string()),
            ("rays cast in", format!("{:.2} s", measured.seconds)),
        ],
    );
}
