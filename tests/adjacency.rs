//! Adjacency: welding, edges, six indices a triangle, and the report on the mesh's topology.

#[path = "adjacency/area.rs"]
mod area;
#[path = "adjacency/cases.rs"]
mod cases;
#[path = "adjacency/errors.rs"]
mod errors;
#[path = "adjacency/large.rs"]
mod large;
#[path = "adjacency/naive.rs"]
mod naive;
#[path = "adjacency/random.rs"]
mod random;
#[path = "adjacency/shapes.rs"]
mod shapes;
#[path = "adjacency/tolerance.rs"]
mod tolerance;
