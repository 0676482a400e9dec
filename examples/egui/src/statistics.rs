//! What a frame came to, for the panel.

use shadows::{CubeStatistics, ShadowMapStatistics, VolumeStatistics, VolumeSurvey};

/// Names and values.
pub type Rows = Vec<(&'static str, String)>;

pub fn of_cube(s: &CubeStatistics) -> Rows {
    let faces = s.faces_rendered + s.faces_kept;
    let drawn = format!("{} of {faces} with casters", s.faces_rendered);
    let prepare = format!("{:.0} µs", s.prepare.as_secs_f64() * 1e6);
    vec![
        ("faces drawn", drawn),
        ("faces hidden", s.faces_hidden.to_string()),
        ("casters in range", s.casters_in_range.to_string()),
        ("draws", s.draws.to_string()),
        ("triangles", s.triangles.to_string()),
        ("memory", mebibytes(s.bytes)),
        ("prepare", prepare),
    ]
}

pub fn of_flat(s: &ShadowMapStatistics) -> Rows {
    vec![
        ("drawn again", if s.rendered { "yes" } else { "no" }.into()),
        ("casters", s.casters_drawn.to_string()),
        ("draws", s.draws.to_string()),
        ("triangles", s.triangles.to_string()),
        ("memory", mebibytes(s.bytes)),
    ]
}

pub fn of_volumes(s: &VolumeStatistics) -> Rows {
    let casters = s.casters_drawn + s.casters_skipped;
    let methods = format!("{}, {}", s.casters_z_pass, s.casters_z_fail);
    vec![
        ("casters drawn", format!("{} of {casters}", s.casters_drawn)),
        ("z-pass, z-fail", methods),
        ("searched again", s.casters_extracted.to_string()),
        ("out of range", s.skipped_out_of_range.to_string()),
        ("masked", s.skipped_masked.to_string()),
        ("seen from the edge", s.skipped_edge_on.to_string()),
        ("out of view", s.skipped_out_of_view.to_string()),
        ("draws", s.draws.to_string()),
        ("triangles", s.triangles.to_string()),
        ("memory", mebibytes(s.gpu_bytes)),
    ]
}

/// Of a picture of `size` pixels.
pub fn of_survey(survey: &VolumeSurvey, size: [u32; 2]) -> Rows {
    let [width, height] = size.map(f64::from);
    let fill = format!("{:.2} pictures", survey.fill() / (width * height));
    vec![
        ("silhouette edges", survey.silhouette_edges.to_string()),
        ("side quads", survey.side_quads.to_string()),
        ("side triangles", survey.side_triangles.to_string()),
        ("light caps", survey.light_cap_triangles.to_string()),
        ("dark caps", survey.dark_cap_triangles.to_string()),
        ("fill", fill),
    ]
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}
