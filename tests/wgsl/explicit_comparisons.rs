//! No shader negates a comparison of floats. Drivers compile shaders as if nothing were NaN, and may make
//! `x >= 0` of `!(x < 0)`, which is another answer where x is not a number: what is meant for such x is
//! said of what makes it so.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::modules::{JOINED, LAYERED, joined};
use crate::pcf::{host, samplers, textbooks};
use naga::valid::{Capabilities, FunctionInfo, ValidationFlags, Validator};
use naga::{BinaryOperator, Expression, Function, Handle, Module, ScalarKind, UnaryOperator};

/// One function, and what naga knows of its values.
struct Values<'a> {
    module: &'a Module,
    function: &'a Function,
    info: &'a FunctionInfo,
}

impl Values<'_> {
    fn negated(&self) -> impl Iterator<Item = Handle<Expression>> {
        let all = self.function.expressions.iter();
        all.filter(|(_, expression)| match expression {
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => self.compares_floats(*expr),
            _ => false,
        })
        .map(|(handle, _)| handle)
    }

    /// Whether a truth value is one of a comparison of floats, or of several.
    fn compares_floats(&self, value: Handle<Expression>) -> bool {
        match self.function.expressions[value] {
            Expression::Binary { op, left, right } => match op {
                BinaryOperator::Less
                | BinaryOperator::LessEqual
                | BinaryOperator::Greater
                | BinaryOperator::GreaterEqual
                | BinaryOperator::Equal
                | BinaryOperator::NotEqual => self.is_float(left),
                BinaryOperator::And
                | BinaryOperator::InclusiveOr
                | BinaryOperator::LogicalAnd
                | BinaryOperator::LogicalOr => {
                    self.compares_floats(left) || self.compares_floats(right)
                }
                _ => false,
            },
            Expression::Relational { argument, .. } => self.compares_floats(argument),
            Expression::Select { accept, reject, .. } => {
                self.compares_floats(accept) || self.compares_floats(reject)
            }
            Expression::Unary { expr, .. } => self.compares_floats(expr),
            _ => false,
        }
    }

    fn is_float(&self, value: Handle<Expression>) -> bool {
        let inner = self.info[value].ty.inner_with(&self.module.types);
        inner.scalar_kind() == Some(ScalarKind::Float)
    }
}

/// The source text of every comparison of floats that is negated.
fn negated(wgsl: &str) -> Vec<String> {
    let module = naga::front::wgsl::parse_str(wgsl)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(wgsl)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(wgsl)));
    let functions = module
        .functions
        .iter()
        .map(|(handle, function)| (function, &info[handle]));
    let entries = module.entry_points.iter().enumerate();
    let entries = entries.map(|(place, entry)| (&entry.function, info.get_entry_point(place)));
    let mut found = Vec::new();
    for (function, info) in functions.chain(entries) {
        let values = Values {
            module: &module,
            function,
            info,
        };
        let spans = values.negated();
        let spans = spans.map(|handle| function.expressions.get_span(handle).to_range().unwrap());
        let texts = spans.map(|range| wgsl[range].to_owned());
        // naga makes a negation of `a || b`, too: if a is not so, b is asked for.
        found.extend(texts.filter(|text| text.starts_with('!')));
    }
    found
}

/// The text of every receiver.
fn receivers() -> Vec<String> {
    let hosts = samplers().into_iter();
    let hosts = hosts.map(|(descriptor, sampler)| sampler.wgsl_module(0) + &host(&descriptor));
    let textbooks = textbooks().into_iter();
    hosts
        .chain(textbooks.map(|(_, sampler)| sampler.wgsl_module(0)))
        .collect()
}

fn shaders() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders")
}

#[test]
fn no_comparison_of_floats_is_negated() {
    let receivers = receivers();
    let all = || JOINED.iter().chain(LAYERED).copied();
    let others = all().map(joined);
    for wgsl in receivers.iter().cloned().chain(others) {
        assert_eq!(negated(&wgsl), [""; 0], "{wgsl}");
    }
    // Every file was looked at, by its name or as a part of a receiver.
    let named: BTreeSet<&str> = all().flatten().copied().collect();
    for file in std::fs::read_dir(shaders()).unwrap() {
        let path = file.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        // Some are filled in: their functions' names are not.
        let function = text.lines().find_map(|line| line.strip_prefix("fn "));
        let function = function
            .and_then(|line| line.split_once('('))
            .map(|(name, _)| name);
        let is_part = |receiver: &String| {
            receiver.contains(text.trim()) || function.is_some_and(|name| receiver.contains(name))
        };
        assert!(
            named.contains(name.as_str()) || receivers.iter().any(is_part),
            "{name}"
        );
    }
}

#[test]
fn a_negated_comparison_is_found() {
    let with = |condition: &str| {
        format!(
            "@fragment
             fn main(@location(0) x: vec2f, @location(1) @interpolate(flat) n: u32) -> @location(0) vec4f {{
                 let spot = n > 2u;
                 if {condition} {{ return vec4f(1.0); }}
                 return vec4f(0.0);
             }}"
        )
    };
    for condition in [
        "!(x.x < 0.0)",
        "spot & !(x.y > 0.0)",
        "!(spot & (x.y > 0.0))",
        "!all(x < vec2f(1.0))",
        "!(x.x == x.x)",
        "!(select(x.x, x.y, spot) >= 0.0)",
    ] {
        assert_eq!(negated(&with(condition)).len(), 1, "{condition}");
    }
    for condition in [
        "x.x >= 0.0",
        "!spot",
        "!(n < 3u)",
        "x.x < 0.0 || !(n == 1u)",
    ] {
        assert_eq!(negated(&with(condition)), [""; 0], "{condition}");
    }
    // As the receivers once had it.
    let (was, is) = ("!(left <= 0.0)", "(left > 0.0)");
    let old = receivers()
        .into_iter()
        .find(|wgsl| wgsl.contains(is))
        .unwrap();
    assert_eq!(negated(&old.replace(is, was)), [was]);
}
