//! glTF 2.0, as JSON or binary: the triangles of the default scene, with the nodes' transforms.

use std::collections::HashMap;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;
use gltf::{Accessor, Node, Primitive, buffer};
use shadows::glam::{Affine3A, DMat4, Mat4};

use super::{Model, checked};

/// Without normals, glTF asks for flat shading.
const CREASE: f64 = 0.0;

pub(super) fn parse(bytes: &[u8], base: Option<&Path>) -> Result<Model> {
    let gltf::Gltf { document, blob } =
        gltf::Gltf::from_slice(bytes).context("it is not a valid glTF file")?;
    // Not `gltf::import`: that would load the images too.
    let buffers = gltf::import_buffers(&document, base, blob).context("cannot read its buffers")?;
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    let scene = scene.context("it has no scene")?;
    let mut reader = Reader {
        buffers,
        model: Model::default(),
        known: HashMap::new(),
    };
    // A stack, as a file may nest nodes deeper than calls can go. glTF nodes form trees, but nothing
    // has checked that; more visits than nodes means that one has two parents.
    let mut left = document.nodes().count();
    let mut stack: Vec<_> = scene.nodes().map(|n| (n, DMat4::IDENTITY)).collect();
    while let Some((node, parent)) = stack.pop() {
        ensure!(left > 0, "its nodes do not form trees");
        left -= 1;
        let local = Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let world = parent * local;
        reader.node(&node, world)?;
        stack.extend(node.children().map(|child| (child, world)));
    }
    Ok(reader.model)
}

struct Reader {
    buffers: Vec<buffer::Data>,
    model: Model,
    /// Place in the model's meshes by the file's mesh and primitive.
    known: HashMap<(usize, usize), usize>,
}

impl Reader {
    fn node(&mut self, node: &Node, world: DMat4) -> Result<()> {
        let Some(mesh) = node.mesh() else {
            return Ok(());
        };
        let transform = Affine3A::from_mat4(world.as_mat4());
        ensure!(
            transform.is_finite(),
            "node {} has a transform that is not finite",
            node.index()
        );
        for primitive in mesh.primitives() {
            let key = (mesh.index(), primitive.index());
            let place = match self.known.get(&key) {
                Some(place) => *place,
                None => {
                    let name = match mesh.name() {
                        Some(name) => name.to_owned(),
                        None => format!("mesh {}", mesh.index()),
                    };
                    let read = self.primitive(&name, &primitive)?;
                    self.model.meshes.push(read);
                    self.known.insert(key, self.model.meshes.len() - 1);
                    self.model.meshes.len() - 1
                }
            };
            self.model.put(place, transform);
        }
        Ok(())
    }

    fn primitive(&self, name: &str, primitive: &Primitive) -> Result<super::Mesh> {
        if primitive.mode() != Mode::Triangles {
            bail!(
                "mesh {name:?} is drawn as {:?}; only triangle lists can be loaded",
                primitive.mode()
            );
        }
        let reader = primitive.reader(|b| self.buffers.get(b.index()).map(|d| d.0.as_slice()));
        let vectors =
            [gltf::Semantic::Positions, gltf::Semantic::Normals].map(|s| primitive.get(&s));
        let [positions, normals] = vectors;
        let positions = positions.with_context(|| format!("mesh {name:?} has no positions"))?;
        // The reader panics on accessors of another type or without elements.
        for accessor in [Some(&positions), normals.as_ref()].into_iter().flatten() {
            expect(accessor, Dimensions::Vec3, &[DataType::F32], name)?;
        }
        let outside = || format!("mesh {name:?} reaches outside its buffer");
        let positions: Vec<_> = reader.read_positions().with_context(outside)?.collect();
        let normals = match normals {
            Some(_) => Some(reader.read_normals().with_context(outside)?.collect()),
            None => None,
        };
        let indices = match primitive.indices() {
            Some(accessor) => {
                let types = [DataType::U8, DataType::U16, DataType::U32];
                expect(&accessor, Dimensions::Scalar, &types, name)?;
                let indices = reader.read_indices().with_context(outside)?;
                indices.into_u32().collect()
            }
            None => (0..positions.len() as u32).collect(),
        };
        checked(name, positions, normals, indices, CREASE)
    }
}

fn expect(
    accessor: &Accessor,
    dimensions: Dimensions,
    types: &[DataType],
    mesh: &str,
) -> Result<()> {
    ensure!(
        accessor.count() > 0
            && accessor.dimensions() == dimensions
            && types.contains(&accessor.data_type())
            && accessor.sparse().is_none_or(|s| s.count() > 0),
        "mesh {mesh:?}: accessor {} has the wrong type or no elements",
        accessor.index()
    );
    let stride = accessor.view().and_then(|view| view.stride());
    ensure!(
        stride.is_none_or(|stride| stride >= accessor.size()),
        "mesh {mesh:?}: the elements of accessor {} overlap",
        accessor.index()
    );
    Ok(())
}
