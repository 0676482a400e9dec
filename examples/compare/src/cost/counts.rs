//! What `benches/shader_cost` counted.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};
use shadows::Kernel;

/// Instructions of a receiver over a lighting shader without shadows.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub struct Count {
    pub valu: i64,
    pub texture: i64,
}

#[derive(Deserialize)]
struct Row {
    name: String,
    #[serde(flatten)]
    count: Count,
}

/// Counts by name.
pub struct Counts(BTreeMap<String, Count>);

impl Counts {
    /// From what `--out` or `--keep` of that bench has written.
    ///
    /// # Errors
    /// If it is not there or is no such file.
    pub fn read(file: &Path) -> Result<Self> {
        let shown = file.display().to_string();
        let text = std::fs::read_to_string(file).with_context(|| shown.clone())?;
        Self::parse(&text).context(shown)
    }

    /// # Errors
    /// If it is no array of such rows.
    pub fn parse(text: &str) -> Result<Self> {
        let rows: Vec<Row> = serde_json::from_str(text)?;
        Ok(Self(
            rows.into_iter().map(|row| (row.name, row.count)).collect(),
        ))
    }

    /// # Errors
    /// If it was not counted: no receiver may be missing without a word.
    pub fn of(&self, name: &str) -> Result<Count> {
        self.0.get(name).copied().with_context(|| {
            format!("{name} was not counted; cargo bench --bench shader_cost -- --out FILE")
        })
    }
}

/// A kernel in the counts.
pub fn kernel_name(kernel: Kernel) -> &'static str {
    kernel.function().trim_start_matches("shadows_cube_")
}
