//! The parts of `compare`, shared with its tests and with the examples that make pictures for the docs.

pub mod animation;
pub mod args;
pub mod arithmetic;
pub mod atlas;
pub mod cost;
pub mod date;
pub mod growth;
pub mod hard;
pub mod label;
pub mod lamps;
pub mod measure;
pub mod output;
pub mod plot;
pub mod progress;
pub mod report;
pub mod scenes;
pub mod shadow;
pub mod sheet;
pub mod snippet;
pub mod soft;
pub mod stage;
pub mod survey;
pub mod sweep;
pub mod table;
pub mod technique;
pub mod temporal;
