//! No shader decides a branch by a uniform buffer alone.
//!
//! Mesa's lavapipe puts such a buffer's values into a copy of the shader at every draw and compiles
//! it anew, and keeps all copies: most of a frame's time, and memory without bound.

use std::collections::HashMap;

use crate::modules::{JOINED, LAYERED, PULLED, joined};
use crate::pcf::{host, samplers, textbooks};
use naga::{
    AddressSpace, Block, Expression, Function, Handle, LocalVariable, Module, Span, Statement,
};
use shadows::{MapKind, PcfDescriptor, PcfSampler};

/// What a value depends on; the later takes in the earlier.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Source {
    Constant,
    /// Uniform buffers, and constants.
    Uniform,
    Other,
}

/// One call of a function.
struct Walk<'a> {
    module: &'a Module,
    function: &'a Function,
    arguments: Vec<Source>,
    locals: HashMap<Handle<LocalVariable>, Source>,
    results: HashMap<Handle<Expression>, Source>,
    returned: Source,
    branches: Vec<Span>,
}

/// The source text of all conditions that depend on uniform buffers, and on nothing else but
/// constants.
fn uniform_branches(wgsl: &str) -> Vec<String> {
    let module = naga::front::wgsl::parse_str(wgsl).unwrap();
    let entries = module.entry_points.iter();
    entries
        .flat_map(|entry| {
            let arguments = vec![Source::Other; entry.function.arguments.len()];
            Walk::over(&module, &entry.function, arguments).branches
        })
        .map(|span| wgsl[span.to_range().unwrap()].to_owned())
        .collect()
}

impl<'a> Walk<'a> {
    fn over(module: &'a Module, function: &'a Function, arguments: Vec<Source>) -> Self {
        let mut walk = Self {
            module,
            function,
            arguments,
            locals: HashMap::new(),
            results: HashMap::new(),
            returned: Source::Constant,
            branches: Vec::new(),
        };
        // What a loop stores late is read early: twice is enough, as sources only grow.
        for _ in 0..2 {
            walk.branches.clear();
            walk.block(&function.body, false);
        }
        walk
    }

    /// `nested`: in a branch or a loop, so that what is stored differs from one pixel to the next.
    fn block(&mut self, block: &Block, nested: bool) {
        for statement in block {
            match statement {
                Statement::Block(block) => self.block(block, nested),
                Statement::If {
                    condition,
                    accept,
                    reject,
                } => {
                    self.decide(*condition);
                    self.block(accept, true);
                    self.block(reject, true);
                }
                Statement::Switch { selector, cases } => {
                    self.decide(*selector);
                    for case in cases {
                        self.block(&case.body, true);
                    }
                }
                Statement::Loop {
                    body, continuing, ..
                } => {
                    self.block(body, true);
                    self.block(continuing, true);
                }
                Statement::Store { pointer, value } => self.store(*pointer, *value, nested),
                Statement::Call {
                    function,
                    arguments,
                    result,
                } => {
                    let arguments = arguments.iter().map(|&a| self.source(a)).collect();
                    let function = &self.module.functions[*function];
                    let called = Self::over(self.module, function, arguments);
                    self.branches.extend(called.branches);
                    if let Some(result) = result {
                        self.results.insert(*result, called.returned);
                    }
                }
                Statement::Return { value: Some(value) } => {
                    let source = if nested {
                        Source::Other
                    } else {
                        self.source(*value)
                    };
                    self.returned = self.returned.max(source);
                }
                _ => {}
            }
        }
    }

    fn decide(&mut self, condition: Handle<Expression>) {
        if self.source(condition) == Source::Uniform {
            self.branches
                .push(self.function.expressions.get_span(condition));
        }
    }

    fn store(&mut self, pointer: Handle<Expression>, value: Handle<Expression>, nested: bool) {
        let source = if nested {
            Source::Other
        } else {
            self.source(value)
        };
        let mut root = pointer;
        loop {
            match self.function.expressions[root] {
                Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                    root = base;
                }
                Expression::LocalVariable(local) => {
                    let stored = self.locals.entry(local).or_insert(Source::Constant);
                    *stored = source.max(*stored);
                    return;
                }
                _ => return,
            }
        }
    }

    fn source(&self, expression: Handle<Expression>) -> Source {
        use Expression as E;
        let of = |parts: &[Handle<Expression>]| {
            let parts = parts.iter().map(|&part| self.source(part));
            parts.max().unwrap_or(Source::Constant)
        };
        match &self.function.expressions[expression] {
            E::Literal(_) | E::Constant(_) | E::Override(_) | E::ZeroValue(_) => Source::Constant,
            E::FunctionArgument(place) => self.arguments[*place as usize],
            E::GlobalVariable(global) => match self.module.global_variables[*global].space {
                AddressSpace::Uniform => Source::Uniform,
                _ => Source::Other,
            },
            E::LocalVariable(local) => {
                let stored = self.locals.get(local);
                stored.copied().unwrap_or(Source::Constant)
            }
            E::CallResult(_) => self.results.get(&expression).copied().unwrap(),
            E::Load { pointer: part }
            | E::Splat { value: part, .. }
            | E::Swizzle { vector: part, .. }
            | E::AccessIndex { base: part, .. }
            | E::Unary { expr: part, .. }
            | E::As { expr: part, .. }
            | E::Relational { argument: part, .. } => self.source(*part),
            E::Access { base, index } => of(&[*base, *index]),
            E::Binary { left, right, .. } => of(&[*left, *right]),
            E::Select {
                condition,
                accept,
                reject,
            } => of(&[*condition, *accept, *reject]),
            E::Compose { components, .. } => of(components),
            E::Math {
                arg,
                arg1,
                arg2,
                arg3,
                ..
            } => {
                let all: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3]
                    .into_iter()
                    .flatten()
                    .collect();
                of(&all)
            }
            _ => Source::Other,
        }
    }
}

fn assert_none(what: &str, wgsl: &str) {
    assert_eq!(uniform_branches(wgsl), [""; 0], "{what}");
}

/// The broken twin: with a branch by uniform values alone, which must be found.
fn assert_found(wgsl: &str, from: &str, to: &str, condition: &str) {
    let broken = wgsl.replace(from, to);
    assert_ne!(wgsl, broken, "{from}");
    let found = uniform_branches(&broken);
    assert!(found.iter().any(|text| text == condition), "{found:?}");
}

/// Every text a sampler may give, and what it is for.
fn receivers() -> Vec<(PcfDescriptor<'static>, PcfSampler)> {
    samplers().into_iter().chain(textbooks()).collect()
}

#[test]
fn receivers_of_maps_have_none() {
    for (descriptor, sampler) in receivers() {
        let wgsl = sampler.wgsl_module(0) + &host(&descriptor);
        assert_none(&format!("{descriptor:?}"), &wgsl);
        // What decides by the light is the same for receivers of one kind, which folds away.
        if descriptor.map == MapKind::FLAT {
            let from = "let away = select(1.0, local.x, spot);";
            let to = "var away = 1.0; if spot { away = local.x; }";
            assert_found(&wgsl, from, to, "shadows_flat_spot(light)");
        }
    }
}

#[test]
fn volumes_have_none() {
    let pulled = joined(PULLED);
    let condition = "light.homogeneous.w == 0.0";
    let selected = format!("return select(from_point, -light.homogeneous.xyz, {condition});");
    let branch = format!("if {condition} {{ return -light.homogeneous.xyz; }} return from_point;");
    assert_found(&pulled, &selected, &branch, condition);
    for names in JOINED {
        assert_none(&names.join(", "), &joined(names));
    }
}

#[test]
fn receivers_of_projected_shadows_have_none() {
    for (name, wgsl) in crate::projected::modules(0) {
        assert_none(name, &wgsl);
        if name.contains("uniform") {
            let from = "    if shaded {";
            let to = "    if shadow.levels > 9.0 { return vec3f(1.0); }\n    if shaded {";
            assert_found(&wgsl, from, to, "shadow.levels > 9.0");
        }
    }
}

#[test]
fn no_shader_is_left_out() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
    let files = std::fs::read_dir(folder).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut left: Vec<String> = names.map(|name| name.replace(".wgsl", "")).collect();
    let all = JOINED.iter().chain(LAYERED);
    left.retain(|name| !all.clone().any(|shader| shader.contains(&name.as_str())));
    // The rest is a sampler's, and stands in the text of some.
    let texts = receivers().into_iter().map(|(_, sampler)| sampler.wgsl());
    let texts: Vec<String> = texts.collect();
    // Names differ from one kind of map to the other.
    let plain = |text: &str| {
        text.replace("_flat_", "_")
            .replace("_cube_", "_")
            .replace("Flat", "")
    };
    let plain = |text: &str| plain(text).replace("Cube", "");
    let texts: Vec<String> = texts.iter().map(|text| plain(text)).collect();
    let is_in = |file: &str, text: &String| text.contains(plain(file).trim());
    left.retain(|name| !texts.iter().any(|text| is_in(&joined(&[name]), text)));
    assert_eq!(left, [""; 0]);
    // The twin: a file that is in none.
    assert!(
        !texts
            .iter()
            .any(|text| is_in("fn shadows_cube_other() {}", text))
    );
}
