//! What shadow volumes have on the GPU: buffers, bind groups, pipelines, draw calls.

pub(crate) mod bind_groups;
pub(crate) mod buffers;
pub(crate) mod counter;
pub(crate) mod draw_calls;
pub(crate) mod draw_pipelines;
pub(crate) mod grown;
pub(crate) mod layout;
pub(crate) mod pipelines;
pub(crate) mod reset;
pub(crate) mod staged;
pub(crate) mod staged_draws;
pub(crate) mod staged_meshes;
