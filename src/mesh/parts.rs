//! Connected parts, by union and find.

/// Sets of vertices, each known by its lowest member.
pub(super) struct Parts {
    parents: Vec<u32>,
    /// How often two sets became one.
    joined: u32,
}

impl Parts {
    pub(super) fn new(vertices: usize) -> Self {
        Self {
            parents: (0u32..).take(vertices).collect(),
            joined: 0,
        }
    }

    pub(super) fn joined(&self) -> u32 {
        self.joined
    }

    /// The lowest vertex of a vertex's set; halves the path on the way (Tarjan and van Leeuwen
    /// 1984), so that a long strip does not cost its length again and again.
    pub(super) fn find(&mut self, mut vertex: u32) -> u32 {
        loop {
            let parent = self.parents[vertex as usize];
            if parent == vertex {
                return vertex;
            }
            let above = self.parents[parent as usize];
            self.parents[vertex as usize] = above;
            vertex = above;
        }
    }

    /// Joins the sets of a root and of a vertex and returns the root of the union.
    pub(super) fn join(&mut self, root: u32, vertex: u32) -> u32 {
        let other = self.find(vertex);
        if other == root {
            return root;
        }
        self.joined += 1;
        let (low, high) = (root.min(other), root.max(other));
        self.parents[high as usize] = low;
        low
    }
}
