//! Shadows on planes: casters projected onto a floor, a wall, a table.
//!
//! A point `X` casts the shadow `(P . L) X - (P . X) L` on the plane `P` under the light `L`, all homogeneous: one
//! matrix for point and directional lights (Blinn, "Me and My (Fake) Shadow", 1988). The result is exact at any
//! distance and scale, and complete if one plane receives everything: objects on the plane receive nothing.
//!
//! The matrix also projects what casts no shadow: anything behind the plane, and anything behind the light as seen
//! from the plane. Both are clipped here.

mod axes;
mod casters;
mod descriptor;
mod frame;
mod gpu;
mod light;
mod pairs;
mod shadow;
mod soft;
mod statistics;

pub use descriptor::{PlanarOutput, PlanarShadowDescriptor};
pub use frame::{PlanarFrame, PlanarLight, PlanarOutline, PlanarReceiver};
pub use shadow::PlanarShadow;
pub use soft::{
    LightShape, PlanarRectangle, PlanarSoftFrame, PlanarSoftShadow, PlanarSoftShadowDescriptor,
    PlanarSoftStatistics,
};
pub use statistics::PlanarStatistics;
