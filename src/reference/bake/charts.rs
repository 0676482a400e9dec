//! Which triangles are one chart.

use std::collections::HashMap;

/// Position and texture coordinates, bit by bit.
pub(super) type Vertex = [u32; 5];

/// Triangles joined by vertices that they share.
#[derive(Default)]
pub(super) struct Charts {
    /// Of each triangle one that it is joined with, itself for the first of a chart.
    parents: Vec<u32>,
    of_vertices: HashMap<Vertex, u32>,
}

impl Charts {
    pub fn add(&mut self, vertices: [Vertex; 3]) {
        let own = self.parents.len() as u32;
        self.parents.push(own);
        for vertex in vertices {
            let other = *self.of_vertices.entry(vertex).or_insert(own);
            let (a, b) = (self.of(own), self.of(other));
            self.parents[a.max(b) as usize] = a.min(b);
        }
    }

    /// The first triangle of a chart.
    pub fn of(&mut self, mut triangle: u32) -> u32 {
        while self.parents[triangle as usize] != triangle {
            let parent = self.parents[triangle as usize];
            self.parents[triangle as usize] = self.parents[parent as usize];
            triangle = parent;
        }
        triangle
    }
}
