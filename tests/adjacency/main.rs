//! Adjacency: welding, edges, six indices a triangle, and the report on the mesh's topology.

mod area;
mod cases;
mod errors;
mod large;
mod naive;
mod random;
mod shapes;
mod tolerance;
