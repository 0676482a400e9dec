//! Edges from triangles.
//!
//! Half-edges are put into buckets by their smaller vertex (a counting sort, linear and kind to
//! caches where vertices that are used together lie together); within a bucket, those of one edge
//! are brought together by sorting. A bucket of n costs n log n, so a vertex or an edge that a
//! million triangles share stays cheap.

use super::parts::Parts;
use super::triangles::Triangles;
use super::{Edge, EdgeUse, Topology};

/// Buckets no larger than this are sorted by insertion.
const SMALL: usize = 20;

/// A half-edge in the bucket of its smaller vertex: `larger vertex << 32 | 3 * triangle + corner`,
/// the corner being the one it starts from. In this order the uses of one edge follow each other
/// as their triangles do.
type Record = u64;

/// The edges, all their uses, and nothing else.
pub(super) struct Edges {
    pub(super) edges: Vec<Edge>,
    pub(super) uses: Vec<EdgeUse>,
}

/// Finds the edges, fills in the opposite vertices of `six` and completes the report.
///
/// `six` comes with the host's corners, and with the value for "no neighbour" between them.
pub(super) fn connect(
    triangles: &Triangles,
    vertices: usize,
    six: &mut [u32],
    report: &mut Topology,
) -> Edges {
    let uses = triangles.corners.len() * 3;
    let (ends, mut records) = into_buckets(&triangles.corners, vertices);
    let mut builder = Builder {
        triangles,
        six,
        report,
        edges: Vec::with_capacity(uses / 2),
        uses: Vec::with_capacity(uses),
        opposites: Vec::new(),
    };
    let mut parts = Parts::new(vertices);
    let mut begin = 0;
    for (&end, vertex) in ends.iter().zip(0u32..) {
        let bucket = &mut records[begin..end as usize];
        begin = end as usize;
        if bucket.is_empty() {
            continue;
        }
        sort(bucket);
        let mut root = parts.find(vertex);
        for uses in bucket.chunk_by(|a, b| a >> 32 == b >> 32) {
            root = parts.join(root, (uses[0] >> 32) as u32);
            builder.edge(vertex, uses);
        }
    }
    let Builder { edges, uses, .. } = builder;
    report.parts = triangles.vertices_used - parts.joined();
    report.closed =
        report.open_edges == 0 && report.non_manifold_edges == 0 && report.inconsistent_edges == 0;
    Edges { edges, uses }
}

/// All half-edges by their smaller vertex, and where each vertex's bucket ends.
fn into_buckets(triangles: &[[u32; 3]], vertices: usize) -> (Vec<u32>, Vec<Record>) {
    let mut ends = vec![0u32; vertices];
    for &[a, b, c] in triangles {
        ends[a.min(b) as usize] += 1;
        ends[b.min(c) as usize] += 1;
        ends[c.min(a) as usize] += 1;
    }
    let mut begin = 0;
    for end in &mut ends {
        (*end, begin) = (begin, begin + *end);
    }
    // Each bucket's cursor starts at its beginning and stops at its end.
    let mut records = vec![0; triangles.len() * 3];
    for (half_edge, &[a, b, c]) in (0u32..).step_by(3).zip(triangles) {
        for (corner, from, to) in [(0, a, b), (1, b, c), (2, c, a)] {
            let cursor = &mut ends[from.min(to) as usize];
            records[*cursor as usize] =
                u64::from(from.max(to)) << 32 | u64::from(half_edge + corner);
            *cursor += 1;
        }
    }
    (ends, records)
}

fn sort(bucket: &mut [Record]) {
    if bucket.len() > SMALL {
        bucket.sort_unstable();
        return;
    }
    for end in 1..bucket.len() {
        let record = bucket[end];
        let mut place = end;
        while place > 0 && bucket[place - 1] > record {
            bucket[place] = bucket[place - 1];
            place -= 1;
        }
        bucket[place] = record;
    }
}

/// One triangle's side of an edge.
#[derive(Clone, Copy)]
struct Side {
    triangle: u32,
    /// The vertex the triangle's half-edge starts from.
    from: u32,
    /// The third vertex, welded.
    opposite: u32,
    /// Place in the list of six of the triangle's opposite vertex across this edge.
    across: usize,
    /// The third vertex as the host has it.
    host_opposite: u32,
}

struct Builder<'a> {
    triangles: &'a Triangles,
    six: &'a mut [u32],
    report: &'a mut Topology,
    edges: Vec<Edge>,
    uses: Vec<EdgeUse>,
    /// Scratch memory.
    opposites: Vec<u32>,
}

impl Builder<'_> {
    /// Adds the edge from `low` to the larger vertex in its records.
    fn edge(&mut self, low: u32, records: &[Record]) {
        let [record, rest @ ..] = records else {
            return;
        };
        let high = (record >> 32) as u32;
        let first = self.side(*record);
        let to = if first.from == low { high } else { low };
        self.edges.push(Edge {
            vertices: [first.from, to],
            first_use: self.uses.len() as u32,
            use_count: records.len() as u32,
        });
        self.uses.push(EdgeUse::new(first.triangle, false));
        match rest {
            // The triangle's own third corner already stands for the neighbour it lacks.
            [] => self.report.open_edges += 1,
            [second] => self.pair(high, first, self.side(*second)),
            [second, ..] => self.many(high, first, self.side(*second), rest),
        }
    }

    fn pair(&mut self, high: u32, first: Side, second: Side) {
        let same_direction = first.from == second.from;
        self.report.inconsistent_edges += u32::from(same_direction);
        let duplicate = first.opposite == second.opposite && first.opposite > high;
        self.report.duplicate_triangles += u32::from(duplicate);
        self.uses
            .push(EdgeUse::new(second.triangle, !same_direction));
        self.six[first.across] = second.host_opposite;
        self.six[second.across] = first.host_opposite;
    }

    /// An edge of three triangles or more: the neighbour of each is the first that runs the other
    /// way or, if none does, the first other one.
    fn many(&mut self, high: u32, first: Side, second: Side, rest: &[Record]) {
        self.report.non_manifold_edges += 1;
        self.opposites.clear();
        self.opposites.push(first.opposite);
        let mut first_reversed = None;
        for &record in rest {
            let side = self.side(record);
            let reversed = side.from != first.from;
            self.uses.push(EdgeUse::new(side.triangle, reversed));
            self.opposites.push(side.opposite);
            self.six[side.across] = first.host_opposite;
            if reversed && first_reversed.is_none() {
                first_reversed = Some(side.host_opposite);
            }
        }
        self.six[first.across] = first_reversed.unwrap_or(second.host_opposite);
        if let Some(neighbour) = first_reversed {
            for &record in rest {
                let side = self.side(record);
                if side.from == first.from {
                    self.six[side.across] = neighbour;
                }
            }
        }
        self.report.duplicate_triangles += duplicates(&mut self.opposites, high);
    }

    fn side(&self, record: Record) -> Side {
        let half_edge = record as u32;
        let (triangle, corner) = (half_edge / 3, half_edge % 3);
        let third = if corner == 0 { 2 } else { corner as usize - 1 };
        let corners = self.triangles.corners[triangle as usize];
        let sextuple = self.triangles.host(triangle) as usize * 6;
        Side {
            triangle,
            from: corners[corner as usize],
            opposite: corners[third],
            across: sextuple + 2 * corner as usize + 1,
            host_opposite: self.six[sextuple + 2 * third],
        }
    }
}

/// Triangles over one edge that repeat another's third vertex. Each triangle is counted only at
/// the edge between its two smallest vertices, where the third is larger than both.
fn duplicates(opposites: &mut Vec<u32>, high: u32) -> u32 {
    opposites.retain(|&opposite| opposite > high);
    opposites.sort_unstable();
    let pairs = opposites.windows(2);
    pairs.map(|pair| u32::from(pair[0] == pair[1])).sum()
}
