//! Shadow volumes against the exact answer: not one interior pixel may be wrong.

#[path = "volume/chain.rs"]
mod chain;
#[path = "volume/choices.rs"]
mod choices;
#[path = "volume/combinations.rs"]
mod combinations;
#[path = "volume/count_bound.rs"]
mod count_bound;
#[path = "volume/count_errors.rs"]
mod count_errors;
#[path = "volume/counts.rs"]
mod counts;
#[path = "volume/debug_errors.rs"]
mod debug_errors;
#[path = "volume/debug_views.rs"]
mod debug_views;
#[path = "volume/errors.rs"]
mod errors;
#[path = "volume/far_away.rs"]
mod far_away;
#[path = "volume/flat_end.rs"]
mod flat_end;
#[path = "volume/hard.rs"]
mod hard;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "volume/kept.rs"]
mod kept;
#[path = "volume/light_pass.rs"]
mod light_pass;
#[path = "volume/near_light.rs"]
mod near_light;
#[path = "volume/near_plane.rs"]
mod near_plane;
#[path = "volume/passes.rs"]
mod passes;
#[path = "volume/pictures.rs"]
mod pictures;
#[path = "volume/pipelines.rs"]
mod pipelines;
#[path = "volume/random.rs"]
mod random;
#[path = "volume/receivers.rs"]
mod receivers;
#[path = "volume/screen.rs"]
mod screen;
#[path = "volume/singular.rs"]
mod singular;
#[path = "volume/stage.rs"]
mod stage;
#[path = "volume/start_from.rs"]
mod start_from;
#[path = "volume/survey.rs"]
mod survey;
#[path = "volume/truth.rs"]
mod truth;
#[path = "volume/views.rs"]
mod views;
#[path = "volume/ways.rs"]
mod ways;

use host::shapes;
