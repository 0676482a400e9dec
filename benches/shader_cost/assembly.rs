//! Counts the instructions of AMD's assembly, by kind, outside and inside of each loop.

use std::collections::BTreeMap;
use std::ops::AddAssign;

#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub valu: i64,
    pub texture: i64,
    pub memory: i64,
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.valu += other.valu;
        self.texture += other.texture;
        self.memory += other.memory;
    }
}

impl Counts {
    pub fn times(&self, trips: i64) -> Self {
        Self {
            valu: trips * self.valu,
            texture: trips * self.texture,
            memory: trips * self.memory,
        }
    }

    fn of(op: &str) -> Self {
        const MEMORY: [&str; 6] = ["buffer_", "tbuffer_", "global_", "flat_", "scratch_", "ds_"];
        let mut counts = Self::default();
        if op.starts_with("image_") {
            counts.texture = 1;
        } else if MEMORY.iter().any(|prefix| op.starts_with(prefix)) {
            counts.memory = 1;
        } else if op.starts_with("v_") {
            counts.valu = 1;
        }
        counts
    }
}

/// One line: a label, or an instruction, with the label that it may jump to.
enum Line<'a> {
    Label(u32),
    Op(&'a str, Option<u32>),
}

fn parse(line: &str) -> Option<Line<'_>> {
    let line = line.split(';').next()?.trim();
    let label = |text: &str| text.trim().parse().ok();
    if let Some(name) = line.strip_prefix("BB").and_then(|l| l.strip_suffix(':')) {
        return Some(Line::Label(label(name)?));
    }
    let op = line.split_whitespace().next()?;
    let target = line
        .rsplit_once("BB")
        .filter(|_| op.contains("branch"))
        .and_then(|(_, name)| label(name));
    Some(Line::Op(op, target))
}

/// Places of the outermost loops: from a label to the last branch back to it.
fn loops(lines: &[Line<'_>]) -> Vec<(usize, usize)> {
    let mut places = BTreeMap::new();
    let mut spans = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        match line {
            Line::Label(label) => {
                places.insert(*label, i);
            }
            Line::Op(_, Some(target)) => spans.extend(places.get(target).map(|&start| (start, i))),
            Line::Op(_, None) => {}
        }
    }
    spans.sort_unstable();
    let mut outermost: Vec<(usize, usize)> = Vec::new();
    for span in spans {
        match outermost.last_mut() {
            Some(last) if span.0 <= last.1 => last.1 = last.1.max(span.1),
            _ => outermost.push(span),
        }
    }
    outermost
}

/// What lies outside of loops, and in each outermost loop in order.
pub fn count(assembly: &str) -> (Counts, Vec<Counts>) {
    let lines: Vec<Line<'_>> = assembly.lines().filter_map(parse).collect();
    let spans = loops(&lines);
    let mut outside = Counts::default();
    let mut inside = vec![Counts::default(); spans.len()];
    for (i, line) in lines.iter().enumerate() {
        let Line::Op(op, _) = line else { continue };
        match spans.iter().position(|s| s.0 <= i && i <= s.1) {
            Some(place) => inside[place] += Counts::of(op),
            None => outside += Counts::of(op),
        }
    }
    (outside, inside)
}
