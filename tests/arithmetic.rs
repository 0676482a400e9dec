//! Whatever arithmetic a driver may choose, shadows are right.
#![allow(dead_code)] // parts of the example

#[path = "../examples/compare/args.rs"]
mod args;
#[path = "../examples/compare/arithmetic/mod.rs"]
mod arithmetic;
#[path = "../examples/compare/date.rs"]
mod date;
#[path = "../examples/compare/hard/mod.rs"]
mod hard;
#[path = "../examples/host/mod.rs"]
mod host;
#[path = "../examples/compare/measure.rs"]
mod measure;
#[path = "../examples/compare/output.rs"]
mod output;
#[path = "../examples/compare/progress.rs"]
mod progress;
#[path = "../examples/compare/shadow.rs"]
mod shadow;
#[path = "../examples/compare/soft.rs"]
mod soft;
#[path = "../examples/compare/stage.rs"]
mod stage;
#[path = "../examples/compare/table.rs"]
mod table;
#[path = "../examples/compare/technique.rs"]
mod technique;

use arithmetic::variant::{ALL, Variant, WRONG};
use host::gpu::Gpu;

#[test]
fn explore() {
    let Some(gpu) = Gpu::for_test() else { return };
    let env = |name: &str| std::env::var(name).unwrap_or_default();
    let (cases, techs, variants, rounds) = (env("CASES"), env("TECHS"), env("VARIANTS"), env("ROUNDS").parse().unwrap_or(1));
    let has = |list: &str, name: &str| list.is_empty() || list.split(',').any(|part| name.starts_with(part));
    let techniques: Vec<_> = hard::techniques().unwrap().into_iter().filter(|t| has(&techs, &t.name)).collect();
    let bar = progress::progress(1, "");
    for case in hard::cases::all().filter(|case| has(&cases, case.name)) {
        for v in ALL.iter().chain(&WRONG).filter(|v| has(&variants, v.name)) {
            let start = std::time::Instant::now();
            let _i = v.install(hard::SIZE);
            let row = hard::tried(&gpu, &case, &techniques, rounds, &bar).unwrap();
            print!("{:30} {:16} {:?}", case.name, v.name, start.elapsed());
            for (t, o) in techniques.iter().zip(&row.outcomes) {
                if let Some(o) = o { print!(" | {} {:.4} {}+{}{}", t.name, o.wrong_percent(), o.false_lit, o.false_shadow, if o.failures.is_empty() { "" } else { " FAILS" }); }
            }
            println!();
            if std::env::var("SAY").is_ok() { for (t, o) in techniques.iter().zip(&row.outcomes) { for f in o.iter().flat_map(|o| &o.failures) { println!("    {}: {f}", t.name); } } }
        }
    }
}
