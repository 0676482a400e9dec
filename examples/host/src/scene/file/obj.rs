//! Wavefront OBJ: groups as meshes, polygons as triangles. Materials and texture coordinates are ignored;
//! what makes no faces is left out and told.
//!
//! Read here, as neither tobj 4 nor obj 0.10, which were tried, takes files as they are. tobj makes a face of a
//! polyline and a fan across its own edge of a concave polygon, ends at `usemtl` without a name, overflows
//! at a normal too far back, and does not say on which line it stopped. obj hands on polygons whole, and
//! indices of vertices that are not there.

use std::collections::{BTreeMap, HashMap};

use anyhow::{Context, Result, bail, ensure};
use shadows::glam::{Affine3A, DVec3, Vec3};

use super::{Model, checked};

mod polygon;
mod statement;

use statement::{Statement, statements};

/// OBJ files seldom say where they are smooth; faces that meet at less than this are, in degrees.
const CREASE: f64 = 60.0;

pub(super) fn parse(bytes: Vec<u8>) -> Result<Model> {
    let text = statement::decoded(bytes);
    let mut reader = Reader::default();
    for statement in statements(&text) {
        reader
            .take(&statement)
            .with_context(|| statement.to_string())?;
    }
    reader.finish()
}

/// A corner of a face: places of its position and, where there is one, its normal, both from 0.
type Corner = (usize, Option<usize>);

struct Face<'a> {
    corners: Vec<Corner>,
    statement: Statement<'a>,
}

#[derive(Default)]
struct Group<'a> {
    name: String,
    faces: Vec<Face<'a>>,
}

#[derive(Default)]
struct Reader<'a> {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    /// Vertices with a coordinate that is not finite; no harm is done until a face asks for one.
    broken: BTreeMap<usize, Statement<'a>>,
    groups: Vec<Group<'a>>,
    model: Model,
}

impl<'a> Reader<'a> {
    fn take(&mut self, statement: &Statement<'a>) -> Result<()> {
        match statement.keyword() {
            "v" => {
                let position = vector(statement)?;
                if position.iter().any(|x| !x.is_finite()) {
                    self.broken.insert(self.positions.len(), statement.clone());
                }
                self.positions.push(position);
            }
            "vn" => self.normals.push(vector(statement)?),
            // `fo` is how older files write it.
            "f" | "fo" => self.face(statement)?,
            "o" | "g" => self.groups.push(Group {
                name: statement.rest().into(),
                faces: Vec::new(),
            }),
            "l" => self.model.leave_out("line elements"),
            "p" => self.model.leave_out("point elements"),
            "curv" | "curv2" | "surf" => self.model.leave_out("free-form curves and surfaces"),
            _ => {}
        }
        Ok(())
    }

    fn face(&mut self, statement: &Statement<'a>) -> Result<()> {
        let counts = [self.positions.len(), self.normals.len()];
        let corners: Vec<Corner> = statement
            .words()
            .map(|word| corner(word, counts))
            .collect::<Result<_>>()?;
        if corners.len() < 3 {
            self.model.leave_out("faces of fewer than three corners");
            return Ok(());
        }
        if self.groups.is_empty() {
            self.groups.push(Group::default());
        }
        if let Some(group) = self.groups.last_mut() {
            let statement = statement.clone();
            group.faces.push(Face { corners, statement });
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Model> {
        for group in std::mem::take(&mut self.groups) {
            if !group.faces.is_empty() {
                self.mesh(group)?;
            }
        }
        Ok(self.model)
    }

    fn mesh(&mut self, group: Group<'_>) -> Result<()> {
        let mut known: HashMap<Corner, u32> = HashMap::new();
        let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for face in &group.faces {
            self.check(face)
                .with_context(|| face.statement.to_string())?;
            let places: Vec<u32> = face
                .corners
                .iter()
                .map(|&corner| {
                    *known.entry(corner).or_insert_with(|| {
                        positions.push(self.positions[corner.0]);
                        // A file whose faces speak of normals and that has none gets its own.
                        normals.extend(corner.1.and_then(|n| self.normals.get(n)));
                        (positions.len() - 1) as u32
                    })
                })
                .collect();
            let loose = |i: &u32| Vec3::from(positions[*i as usize]).as_dvec3();
            let outline: Vec<DVec3> = places.iter().map(loose).collect();
            let triangles = polygon::triangles(&outline).unwrap_or_else(|| {
                self.model
                    .leave_out("outlines that cross themselves or have no area, filled as fans");
                polygon::fan(outline.len())
            });
            indices.extend(triangles.into_iter().flatten().map(|i| places[i]));
        }
        let name = match group.name.as_str() {
            "" => "unnamed",
            name => name,
        };
        // Normals that only some corners have are of no use: their count says so.
        let mesh = checked(name, positions, Some(normals), indices, CREASE)?;
        self.model.meshes.push(mesh);
        self.model
            .put(self.model.meshes.len() - 1, Affine3A::IDENTITY);
        Ok(())
    }

    /// Whether all that a face asks for is there, now that the whole file is read.
    fn check(&self, face: &Face<'_>) -> Result<()> {
        let [positions, normals] = [self.positions.len(), self.normals.len()];
        for (position, normal) in &face.corners {
            ensure!(
                *position < positions,
                "it asks for vertex {}, and there are {positions}",
                position + 1
            );
            if let Some(vertex) = self.broken.get(position) {
                bail!("a coordinate of its vertex ({vertex}) is not finite");
            }
            ensure!(
                normals == 0 || normal.is_none_or(|normal| normal < normals),
                "it asks for normal {}, and there are {normals}",
                normal.map_or(0, |normal| normal + 1)
            );
        }
        Ok(())
    }
}

/// The first three numbers of a statement: what follows them in `v` are weights or colours.
fn vector(statement: &Statement<'_>) -> Result<[f32; 3]> {
    let mut words = statement.words();
    let mut number = || {
        let word = words.next().context("three numbers are needed")?;
        let number = word.parse::<f32>();
        number.with_context(|| format!("{word:?} is not a number"))
    };
    Ok([number()?, number()?, number()?])
}

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`: from 1, or back from the last one so far where negative.
fn corner(word: &str, [positions, normals]: [usize; 2]) -> Result<Corner> {
    let mut parts = word.split('/');
    let position = parts.next().unwrap_or_default();
    let normal = parts.nth(1).filter(|normal| !normal.is_empty());
    ensure!(
        parts.next().is_none(),
        "{word:?} has more than three indices"
    );
    Ok((
        place(position, positions)?,
        normal.map(|normal| place(normal, normals)).transpose()?,
    ))
}

fn place(text: &str, count: usize) -> Result<usize> {
    let index: i64 = text
        .parse()
        .ok()
        .with_context(|| format!("{text:?} is not an index"))?;
    let place = match index {
        1.. => Some(index as usize - 1),
        _ => count.checked_add_signed(index as isize),
    };
    let place = place.filter(|_| index != 0);
    place.with_context(|| {
        format!(
            "index {index} means nothing here: they begin with 1, or with -{count} from the end"
        )
    })
}
