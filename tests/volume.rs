//! Shadow volumes against the exact answer: not one interior pixel may be wrong.

#[path = "volume/chain.rs"]
mod chain;
#[path = "volume/choices.rs"]
mod choices;
#[path = "volume/combinations.rs"]
mod combinations;
#[path = "volume/counts.rs"]
mod counts;
#[path = "volume/errors.rs"]
mod errors;
#[path = "volume/far_away.rs"]
mod far_away;
#[path = "volume/hard.rs"]
mod hard;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "volume/light_pass.rs"]
mod light_pass;
#[path = "volume/passes.rs"]
mod passes;
#[path = "volume/pictures.rs"]
mod pictures;
#[path = "volume/random.rs"]
mod random;
#[path = "volume/screen.rs"]
mod screen;
#[path = "volume/shapes.rs"]
mod shapes;
#[path = "volume/stage.rs"]
mod stage;
#[path = "volume/truth.rs"]
mod truth;
#[path = "volume/ways.rs"]
mod ways;
