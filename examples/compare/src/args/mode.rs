//! What the command line asks for, and which options that has a use for.

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Command};

use super::Args;
use super::values::is_file;

/// What may be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// A few techniques, side by side.
    Compare,
    Sweep,
    HardCases,
    Temporal,
    Growth,
    Arithmetic,
    Cost,
}

use Mode::{Arithmetic, Compare, Cost, Growth, HardCases, Sweep, Temporal};

/// The modes that have a use for an option. The others have scenes, sizes and techniques of their own.
/// Options that are not here are of use to all.
const USES: [(&str, &[Mode]); 19] = [
    ("scenes", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("ground", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("time", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("lights", &[Compare]),
    ("light", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("light_kind", &[Compare, Sweep, Temporal, Arithmetic]),
    ("range", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("camera", &[Compare, Sweep, Temporal, Cost, Arithmetic]),
    ("techniques", &[Compare, Sweep, Temporal, Arithmetic]),
    ("size", &[Compare, Sweep, Cost, Arithmetic]),
    ("face", &[Compare, Temporal, Cost, Arithmetic]),
    ("frames", &[Compare, Sweep, Growth]),
    ("seed", &[Compare]),
    ("export", &[Compare]),
    ("error_at_most", &[Sweep]),
    ("time_at_most", &[Sweep]),
    ("cases", &[HardCases]),
    ("rounds", &[HardCases, Arithmetic]),
    ("steps", &[Temporal]),
];

impl Mode {
    fn of(args: &Args) -> Self {
        match args {
            _ if args.sweep => Sweep,
            _ if args.hard_cases => HardCases,
            _ if args.temporal.is_some() => Temporal,
            _ if args.growth.is_some() => Growth,
            _ if args.arithmetic.is_some() => Arithmetic,
            _ if args.cost.is_some() => Cost,
            _ => Compare,
        }
    }

    /// The option that asks for it; comparing is what is done unasked.
    fn option(self) -> Option<&'static str> {
        match self {
            Compare => None,
            Sweep => Some("--sweep"),
            HardCases => Some("--hard-cases"),
            Temporal => Some("--temporal"),
            Growth => Some("--growth"),
            Arithmetic => Some("--arithmetic"),
            Cost => Some("--cost"),
        }
    }
}

/// Whether that is a few techniques, side by side.
pub fn compares(args: &Args) -> bool {
    Mode::of(args) == Compare
}

/// Nothing that is given may be ignored. (By hand, as clap forgets that an option `requires` one that
/// another given one conflicts with.)
///
/// # Errors
/// The option that would be.
pub fn check(args: &Args, matches: &ArgMatches, command: &mut Command) -> Result<(), clap::Error> {
    let mode = Mode::of(args);
    let given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
    let idle = USES
        .iter()
        .find(|(id, modes)| given(id) && !modes.contains(&mode));
    if let Some((id, modes)) = idle {
        let option = command.get_arguments().find(|a| a.get_id() == *id);
        let option = option.and_then(|a| a.get_long()).unwrap_or(id);
        let users: Vec<&str> = modes.iter().filter_map(|mode| mode.option()).collect();
        let message = match (mode.option(), users.as_slice()) {
            (Some(mode), _) => {
                format!("--{option} cannot be used with {mode}, which has no use for it")
            }
            (None, users) => format!("--{option} is of no use without {}", users.join(" or ")),
        };
        return Err(command.error(ErrorKind::ArgumentConflict, message));
    }
    if given("ground") && !args.scenes.iter().any(|scene| is_file(scene)) {
        let message =
            "--ground is of no use without a model file: the built-in scenes bring their own";
        return Err(command.error(ErrorKind::ArgumentConflict, message));
    }
    Ok(())
}
