//! glTF 2.0, as JSON or binary: the triangles of the default scene, with the nodes' transforms and
//! instances. What does not cast is ignored or, where one might miss it, left out and told.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use gltf::mesh::Mode;
use gltf::{Document, Node, Primitive, Semantic};
use shadows::glam::{Affine3A, DMat4, Mat4};

use super::{Model, checked};

mod accessor;
mod document;
mod instances;

use accessor::Buffers;

/// Without normals, glTF asks for flat shading.
const CREASE: f64 = 0.0;

pub(super) fn parse(bytes: &[u8], base: Option<&Path>) -> Result<Model> {
    let mut model = Model::default();
    let (document, binary) = document::read(bytes, &mut model)?;
    let buffers = Buffers::read(&document, base, binary)?;
    let mut left = document.nodes().count();
    let mut stack: Vec<_> = roots(&document, &mut model)
        .into_iter()
        .map(|node| (node, DMat4::IDENTITY))
        .collect();
    let mut reader = Reader {
        document: &document,
        buffers,
        model,
        known: HashMap::new(),
    };
    // A stack, as a file may nest nodes deeper than calls can go. glTF nodes form trees, but nothing
    // has checked that; more visits than nodes means that one has two parents.
    while let Some((node, parent)) = stack.pop() {
        ensure!(left > 0, "its nodes do not form trees");
        left -= 1;
        let local = Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let world = parent * local;
        let named = || format!("node {}", node.index());
        reader.node(&node, world).with_context(named)?;
        stack.extend(node.children().map(|child| (child, world)));
    }
    Ok(reader.model)
}

/// Where what is drawn begins: the default scene's nodes, else the first one's, and in a file without
/// scenes all nodes that are nobody's child.
fn roots<'a>(document: &'a Document, model: &mut Model) -> Vec<Node<'a>> {
    let default = document.default_scene();
    if let Some(scene) = default.or_else(|| document.scenes().next()) {
        for _ in 1..document.scenes().count() {
            model.leave_out("scenes that are not the default one");
        }
        return scene.nodes().collect();
    }
    let children: BTreeSet<usize> = document
        .nodes()
        .flat_map(|node| node.children())
        .map(|child| child.index())
        .collect();
    let nodes = document.nodes();
    nodes
        .filter(|node| !children.contains(&node.index()))
        .collect()
}

struct Reader<'a> {
    document: &'a Document,
    buffers: Buffers,
    model: Model,
    /// Place in the model's meshes by the file's mesh and primitive; `None` for what has no triangles.
    known: HashMap<(usize, usize), Option<usize>>,
}

impl Reader<'_> {
    fn node(&mut self, node: &Node, world: DMat4) -> Result<()> {
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        if node.skin().is_some() {
            self.model
                .leave_out("skins, their meshes standing as modelled");
        }
        let placed = self.instances(node)?;
        for primitive in mesh.primitives() {
            let key = (mesh.index(), primitive.index());
            let place = match self.known.get(&key) {
                Some(place) => *place,
                None => {
                    let name = match mesh.name() {
                        Some(name) => name.to_owned(),
                        None => format!("mesh {}", mesh.index()),
                    };
                    let place = self.primitive(&name, &primitive)?;
                    self.known.insert(key, place);
                    place
                }
            };
            for instance in place.iter().flat_map(|_| &placed) {
                let transform = Affine3A::from_mat4((world * *instance).as_mat4());
                ensure!(transform.is_finite(), "its transform is not finite");
                self.model.put(place.unwrap_or_default(), transform);
            }
        }
        Ok(())
    }

    /// Node space from each instance's, or the node's own alone.
    fn instances(&self, node: &Node) -> Result<Vec<DMat4>> {
        match node.extension_value(document::INSTANCING) {
            Some(extension) => instances::read(self.document, &self.buffers, extension)
                .context(document::INSTANCING),
            None => Ok(vec![DMat4::IDENTITY]),
        }
    }

    /// Reads the triangles of a primitive, if it has some, and says where they are.
    fn primitive(&mut self, name: &str, primitive: &Primitive) -> Result<Option<usize>> {
        match primitive.mode() {
            Mode::Points => self.model.leave_out("primitives of points"),
            Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
                self.model.leave_out("primitives of lines");
            }
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => {
                if primitive.morph_targets().next().is_some() {
                    self.model.leave_out("primitives' morph targets");
                }
                let context = || format!("mesh {name:?}");
                let mesh = self.triangles(name, primitive).with_context(context)?;
                if !mesh.indices.is_empty() {
                    self.model.meshes.push(mesh);
                    return Ok(Some(self.model.meshes.len() - 1));
                }
                self.model.leave_out("primitives without triangles");
            }
        }
        Ok(None)
    }

    fn triangles(&self, name: &str, primitive: &Primitive) -> Result<super::Mesh> {
        let positions = primitive.get(&Semantic::Positions);
        let positions = positions.context("it has no positions")?;
        let positions = self.buffers.floats::<3>(&positions)?;
        let normals = primitive.get(&Semantic::Normals);
        let normals = normals.map(|a| self.buffers.floats::<3>(&a)).transpose()?;
        let indices = match primitive.indices() {
            Some(accessor) => self.buffers.indices(&accessor)?,
            None => (0..positions.len() as u32).collect(),
        };
        let list = match primitive.mode() {
            Mode::TriangleStrip => strip(&indices),
            Mode::TriangleFan => fan(&indices),
            _ => indices,
        };
        checked(name, positions, normals, list, CREASE)
    }
}

/// Every second triangle of a strip turns the other way.
fn strip(indices: &[u32]) -> Vec<u32> {
    let triangles = indices.windows(3).enumerate();
    triangles
        .flat_map(|(i, t)| match i % 2 {
            0 => [t[0], t[1], t[2]],
            _ => [t[0], t[2], t[1]],
        })
        .collect()
}

fn fan(indices: &[u32]) -> Vec<u32> {
    let Some((first, rest)) = indices.split_first() else {
        return Vec::new();
    };
    let sides = rest.windows(2);
    sides.flat_map(|side| [*first, side[0], side[1]]).collect()
}
