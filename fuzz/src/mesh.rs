//! Meshes of any triangles, and what must be true of their adjacency.

use arbitrary::{Arbitrary, Result, Unstructured};
use shadows::error::MeshError;
use shadows::mesh::{Adjacency, MeshKind};

use crate::{Number, list};

/// Vertices and what may be indices into them.
#[derive(Clone, Debug)]
pub struct Mesh {
    positions: Vec<[Number; 3]>,
    indices: Vec<u8>,
    /// Whether indices beyond the vertices stay as they are.
    wild: bool,
}

/// A box: the corners of [`corner`].
const BOX: [u8; 36] = [
    0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5,
    7, 4, 7, 6,
];

fn corner(place: u8) -> [Number; 3] {
    [0, 1, 2].map(|axis| Number(f32::from(place >> axis & 1)))
}

/// A soup of triangles, or a box, some of it changed.
impl<'a> Arbitrary<'a> for Mesh {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let mut mesh = Self {
            positions: (0..8).map(corner).collect(),
            indices: BOX.to_vec(),
            wild: u.ratio(1, 32)?,
        };
        if u.arbitrary()? {
            mesh.positions = list(u, 0, 24)?;
            mesh.indices = list(u, 0, 96)?;
            return Ok(mesh);
        }
        for _ in 0..u.int_in_range(0..=4)? {
            let place = u.choose_index(mesh.indices.len())?;
            mesh.indices[place] = u.arbitrary()?;
        }
        for _ in 0..u.int_in_range(0..=4)? {
            let place = u.choose_index(mesh.positions.len())?;
            mesh.positions[place] = u.arbitrary()?;
        }
        Ok(mesh)
    }
}

impl Mesh {
    pub fn positions(&self) -> Vec<[f32; 3]> {
        let array = |p: &[Number; 3]| p.map(|number| number.0);
        self.positions.iter().map(array).collect()
    }

    pub fn indices(&self) -> Vec<u32> {
        let vertices = if self.wild {
            u32::MAX
        } else {
            self.positions.len().max(1) as u32
        };
        self.indices
            .iter()
            .map(|&index| u32::from(index) % vertices)
            .collect()
    }

    /// As [`indices`](Self::indices), cut to whole triangles.
    pub fn whole_triangles(&self) -> Vec<u32> {
        let mut indices = self.indices();
        indices.truncate(indices.len() / 3 * 3);
        indices
    }

    pub fn adjacency(&self) -> std::result::Result<Adjacency, MeshError> {
        Adjacency::new(&self.positions(), &self.whole_triangles())
    }
}

/// Panics unless the adjacency keeps what its documentation promises for a list of indices.
pub fn check(adjacency: &Adjacency, indices: &[u32]) {
    check_representatives(adjacency);
    let corners: Vec<u32> = adjacency.indices().iter().copied().step_by(2).collect();
    assert_eq!(corners, indices, "the corners are the host's");
    let vertices = adjacency.vertex_count();
    assert!(adjacency.indices().iter().all(|&index| index < vertices));

    let triangles = adjacency.triangles();
    let topology = adjacency.topology();
    let collapsed = topology.collapsed_triangles as usize;
    assert_eq!(triangles.len() + collapsed, indices.len() / 3);
    assert_eq!(adjacency.edge_uses().len(), 3 * triangles.len());
    let mut closed = true;
    let mut next = 0;
    let mut before = [0, 0];
    for edge in adjacency.edges() {
        let [a, b] = edge.vertices;
        let sorted = [a.min(b), a.max(b)];
        assert!(
            a != b && sorted > before,
            "each edge is there once, in order"
        );
        before = sorted;
        assert_eq!(edge.first_use, next, "uses lie edge after edge");
        next += edge.use_count;
        let uses = adjacency.uses(edge);
        assert!(!uses.is_empty() && !uses[0].reversed());
        closed &= uses.len() == 2 && uses[1].reversed();
        for side in uses {
            let [from, to] = if side.reversed() { [b, a] } else { [a, b] };
            let [x, y, z] = triangles[side.triangle() as usize];
            assert!([[x, y], [y, z], [z, x]].contains(&[from, to]));
        }
    }
    assert_eq!(next as usize, adjacency.edge_uses().len());
    assert_eq!(closed, topology.closed);
    assert_eq!(closed, adjacency.kind() == MeshKind::Closed);
    let _ = topology.to_string();
}

fn check_representatives(adjacency: &Adjacency) {
    let representatives = adjacency.representatives();
    assert_eq!(representatives.len(), adjacency.vertex_count() as usize);
    for (vertex, &representative) in representatives.iter().enumerate() {
        assert!(representative as usize <= vertex);
        assert_eq!(representatives[representative as usize], representative);
    }
    let own = |vertex: &u32| representatives[*vertex as usize] == *vertex;
    assert!(adjacency.triangles().iter().flatten().all(own));
}
