//! Shadows on planes: casters projected onto a floor, a wall, a table.
//!
//! A point `X` casts the shadow `(P . L) X - (P . X) L` on the plane `P` under the light `L`, all homogeneous: one
//! matrix for point and directional lights (Blinn, "Me and My (Fake) Shadow", 1988). It is exact, at any distance and
//! scale, and it is the whole truth where one plane receives everything. What stands on the plane receives nothing.
//!
//! The matrix projects what casts no shadow, too: what is behind the plane, and what is behind the light as seen from
//! it. Both are cut off here.

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
