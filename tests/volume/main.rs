//! Shadow volumes against the exact answer: not one interior pixel may be wrong.

mod chain;
mod choices;
mod combinations;
mod count_bound;
mod count_errors;
mod counts;
mod debug_errors;
mod debug_views;
mod errors;
mod far_away;
mod flat_end;
mod hard;
mod kept;
mod light_pass;
mod many;
mod merged;
mod meshes;
mod near_light;
mod near_plane;
mod one_pass;
mod passes;
mod pictures;
mod pipelines;
mod random;
mod receivers;
mod screen;
mod singular;
mod stage;
mod start_from;
mod survey;
mod truth;
mod views;
mod ways;
mod without_stencil;

use host::shapes;
