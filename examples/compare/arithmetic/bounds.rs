//! What some arithmetic makes wrong in the hard cases, and how wrong it may be.

use crate::hard::limits::{Known, ON_HARDWARE};

/// What is known of a variant, beside the limits that hold anyway.
pub fn of(variant: &str) -> &'static [Known] {
    match variant {
        "snapped" => ON_HARDWARE,
        _ => &[],
    }
}
