//! Blob shadows against the area of the light that is seen: of ellipsoids exact but for quadrature, of
//! everything else an approximation whose error is measured here.

mod area;
mod ask;
mod calls;
mod decals;
mod errors;
mod meshes;
