//! The triangles that remain after a weld.

use super::{Topology, area};

/// The welded triangles and where they came from.
pub(super) struct Triangles {
    /// Three representatives each, all different; order and corners as the host's.
    pub(super) corners: Vec<[u32; 3]>,
    /// The host's triangle of each; empty as long as none collapsed (then they are the same).
    hosts: Vec<u32>,
    /// Representatives in use.
    pub(super) vertices_used: u32,
}

/// Bits of a vertex's mark: an index names it; a welded triangle has it for a corner.
const NAMED: u8 = 1;
const CORNER: u8 = 2;

impl Triangles {
    /// Takes the triangles from a list of six indices each, and counts what is wrong with them.
    pub(super) fn welded(
        positions: &[[f32; 3]],
        six: &[u32],
        representatives: &[u32],
        report: &mut Topology,
    ) -> Self {
        let mut marks = vec![0u8; positions.len()];
        let mut corners = Vec::with_capacity(six.len() / 6);
        let mut hosts = Vec::new();
        let (sextuples, _) = six.as_chunks::<6>();
        for (host, &[a, _, b, _, c, _]) in (0u32..).zip(sextuples) {
            let welded = [a, b, c].map(|vertex| {
                marks[vertex as usize] |= NAMED;
                representatives[vertex as usize]
            });
            let [a, b, c] = welded;
            if a == b || b == c || c == a {
                if report.collapsed_triangles == 0 {
                    hosts.extend(0..host);
                }
                report.collapsed_triangles += 1;
                continue;
            }
            if report.collapsed_triangles > 0 {
                hosts.push(host);
            }
            let [p, q, r] = welded.map(|vertex| {
                marks[vertex as usize] |= CORNER;
                positions[vertex as usize]
            });
            report.zero_area_triangles += u32::from(area::is_zero(p, q, r));
            corners.push(welded);
        }
        report.unused_vertices = count(&marks, |mark| mark & NAMED == 0);
        Self {
            corners,
            hosts,
            vertices_used: count(&marks, |mark| mark & CORNER != 0),
        }
    }

    /// The host's number of a welded triangle.
    pub(super) fn host(&self, triangle: u32) -> u32 {
        self.hosts
            .get(triangle as usize)
            .copied()
            .unwrap_or(triangle)
    }
}

fn count(marks: &[u8], is: impl Fn(u8) -> bool) -> u32 {
    marks.iter().map(|&mark| u32::from(is(mark))).sum()
}
