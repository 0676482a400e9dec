//! Which casters a light casts the shadows of, by what the host says.

use std::num::NonZeroU32;

/// A light's layers and its owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CasterFilter {
    pub layers: u32,
    pub owner: Option<NonZeroU32>,
}

impl CasterFilter {
    pub const ALL: Self = Self {
        layers: u32::MAX,
        owner: None,
    };

    /// Whether a caster on these layers, and of this owner, casts.
    pub fn admits(self, layers: u32, owner: Option<NonZeroU32>) -> bool {
        let owned = self.owner.is_some() && self.owner == owner;
        self.layers & layers != 0 && !owned
    }
}
