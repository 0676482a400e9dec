//! Reference (being filled in).
