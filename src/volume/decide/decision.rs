//! The casters of one frame, and what is decided for each.

use std::collections::HashMap;

use crate::Caster;
use crate::error::{LightError, ShadowVolumeError};
use crate::mesh::{Bounds, CasterMesh, MeshKind};
use crate::volume::ShadowVolumeFrame;
use crate::volume::decide::facing::{Counted, ObjectLight};
use crate::volume::decide::method::{Caps, Form, Rules, Skip};
use crate::volume::decide::near_light_cap;
use crate::volume::decide::world_box::WorldBox;
use crate::volume::plan::cache::Key;
use crate::volume::plan::faces::{Means, PlanLimits};
use crate::volume::plan::ranges::{Overflow, Words};
use crate::volume::silhouette::Way;
use crate::volume::statistics::Tally;

/// A caster that has a place in the buffers.
pub(crate) struct Subject {
    pub light: ObjectLight,
    /// What is drawn of it; `None` if it only keeps its place until it comes into view again.
    pub form: Option<Form>,
    pub counted: Counted,
    pub mirrored: bool,
    pub way: Way,
    pub index: usize,
    pub key: Key,
}

impl Subject {
    /// The lists of caps that are drawn: those that count +1 (`false`), those that count -1.
    pub fn cap_lists(&self) -> &'static [bool] {
        match (self.way, self.counted) {
            // Where vertex shaders decide, they turn the caps that count -1 over.
            (Way::Vertex, _) | (_, Counted::LightFacing) => &[false],
            (_, Counted::All) => &[false, true],
            (_, Counted::AwayFacing) => &[true],
        }
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

/// Whether light, range, target and casters are sound.
pub(crate) fn validate(
    frame: &ShadowVolumeFrame<'_>,
    device: &wgpu::Device,
) -> Result<(), ShadowVolumeError> {
    frame.light.validate()?;
    if let Some(range) = frame.range
        && !(range.is_finite() && range > 0.0)
    {
        return Err(LightError::Range(range).into());
    }
    if let Some(size) = frame.target_size.filter(|size| size.contains(&0)) {
        return Err(ShadowVolumeError::TargetSize(size));
    }
    if let Some(Bounds { min, max }) = frame.receivers
        && !(min.is_finite() && max.is_finite() && min.cmple(max).all())
    {
        let [min, max] = [min, max].map(|corner| corner.to_array());
        return Err(ShadowVolumeError::Receivers { min, max });
    }
    validate_casters(frame.casters, device)
}

/// Whether casters are sound, and enough is known of them.
pub(crate) fn validate_casters(
    casters: &[Caster],
    device: &wgpu::Device,
) -> Result<(), ShadowVolumeError> {
    for (index, caster) in casters.iter().enumerate() {
        caster.validate(index, device)?;
        if !caster.mesh.has_adjacency() {
            return Err(ShadowVolumeError::NoAdjacency { index });
        }
    }
    Ok(())
}

/// The casters that are drawn, and those that keep their places, those of one mesh together, in the
/// order of first appearance.
///
/// A caster out of view keeps its place, so that turning the camera moves no other caster's; unless
/// that takes more memory than one chunk of buffers has.
pub(crate) fn subjects(
    frame: &ShadowVolumeFrame<'_>,
    means: &Means<'_>,
    limits: &PlanLimits,
    tally: &mut Tally,
) -> Result<Vec<Subject>, ShadowVolumeError> {
    let rules = Rules::new(frame, means.options);
    let mut groups: Vec<Vec<Subject>> = Vec::new();
    let mut group_of = HashMap::new();
    let mut total = [0_u64; 3];
    for (index, caster) in frame.casters.iter().enumerate() {
        let Some(subject) = subject(frame, means, &rules, (index, caster), tally)? else {
            continue;
        };
        for (total, words) in total.iter_mut().zip(words(&caster.mesh, subject.way)) {
            *total += words;
        }
        let group = *group_of.entry(caster.mesh.id()).or_insert_with(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[group].push(subject);
    }
    let mut subjects: Vec<Subject> = groups.into_iter().flatten().collect();
    let crowded = subjects.len() > limits.casters
        || total
            .into_iter()
            .any(|words| words > limits.storage_bytes / 4);
    if crowded {
        subjects.retain(|subject| subject.form.is_some());
    }
    for subject in &subjects {
        check(subject, &frame.casters[subject.index].mesh, means, limits)?;
    }
    Ok(subjects)
}

fn subject(
    frame: &ShadowVolumeFrame<'_>,
    means: &Means<'_>,
    rules: &Rules,
    (index, caster): (usize, &Caster),
    tally: &mut Tally,
) -> Result<Option<Subject>, ShadowVolumeError> {
    let map = caster.transform();
    let world = WorldBox::of(caster);
    let empty = (caster.mesh.triangle_count() == 0).then_some(Skip::Empty);
    let skip = empty.or_else(|| rules.skips(&world));
    let light = match skip {
        None | Some(Skip::OutOfView) => ObjectLight::new(frame.light, &map, caster.mesh.bounds()),
        Some(Skip::Empty | Skip::EdgeOn | Skip::OutOfRange) => None,
    };
    let skip = skip.or(light.is_none().then_some(Skip::EdgeOn));
    if let Some(skip) = skip {
        tally.note(skip.into());
    }
    let Some(light) = light.filter(|_| skip.is_none() || means.keep) else {
        return Ok(None);
    };
    let way = means
        .ways
        .of(&caster.mesh)
        .ok_or(ShadowVolumeError::HostPositions { index })?;
    let form = skip.is_none().then(|| {
        let mut form = rules.form(&world);
        if means.options.caps == Caps::AsNeeded {
            let own = (caster.mesh.bounds(), &map);
            near_light_cap::settle(&mut form, own, frame.light, &world);
        }
        form
    });
    let counted = Counted::of(caster, &world, frame, means.options.start_from);
    let key = Key::new(&caster.mesh, &light, counted, way);
    if let Some(form) = &form {
        let away = counted == Counted::AwayFacing;
        tally.statistics.casters_away_facing += u32::from(away);
        tally.note(form.count.into());
    }
    Ok(Some(Subject {
        light,
        form,
        counted,
        mirrored: map.matrix3.determinant() < 0.0,
        way,
        index,
        key,
    }))
}

/// Whether a subject's volume fits the device's buffers.
fn check(
    subject: &Subject,
    mesh: &CasterMesh,
    means: &Means<'_>,
    limits: &PlanLimits,
) -> Result<(), ShadowVolumeError> {
    let records = match subject.way {
        Way::Vertex => mesh.record_bytes(),
        Way::Compute | Way::Cpu => 0,
    };
    let checked = match records > limits.buffer_bytes {
        true => Err(Overflow {
            what: "edge records",
            size: records,
            limit: limits.buffer_bytes,
        }),
        false => means.regions.check(words(mesh, subject.way)),
    };
    checked.map_err(|overflow| ShadowVolumeError::TooLarge {
        index: subject.index,
        what: overflow.what,
        size: overflow.size,
        limit: overflow.limit,
    })
}
