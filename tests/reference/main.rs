//! The reference against analytic answers, and its comparison against counts made by hand.

mod comparison;
mod flips;
mod input;
mod opacity;
mod published;
mod robustness;
mod rows;
mod scene;
mod visibility;
