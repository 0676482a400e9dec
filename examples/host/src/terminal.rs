//! Output that may end early: whoever reads it may stop (`compare ... | head -1`), which `println!`
//! answers with a panic.

use std::io::{self, ErrorKind, Write as _};

use anyhow::{Context as _, Result};

/// A line for whoever asked.
///
/// # Errors
/// If it cannot be written, unless nobody reads any more.
pub fn say(line: &str) -> Result<()> {
    match writeln!(io::stdout(), "{line}") {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to the standard output"),
    }
}

/// A line beside the results. Where it cannot be written, there is nobody left to tell.
pub fn note(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}
