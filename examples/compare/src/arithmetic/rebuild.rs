//! A function of naga's IR made anew, expression by expression.

use naga::valid::FunctionInfo;
use naga::{Arena, Block, Expression, Function, Handle, Module, Range, Span, Statement, TypeInner};

type Value = Handle<Expression>;

/// What is made of single expressions.
pub trait Rules {
    /// The new expression for an old one; `None`: the same of what its operands have become.
    fn rewrite(&self, old: Value, work: &mut Work<'_>) -> Option<Value>;

    /// What is returned in the place of a value.
    fn result(&self, value: Value, _work: &mut Work<'_>) -> Value {
        value
    }
}

/// A function that is being made anew.
pub struct Work<'a> {
    pub module: &'a Module,
    pub function: &'a Function,
    info: &'a FunctionInfo,
    new: Arena<Expression>,
    handles: Vec<Value>,
    /// For each old expression the new one, and all that was made for it.
    made: Vec<(Value, std::ops::Range<usize>)>,
    /// For each old call its arguments.
    calls: Vec<(Value, Vec<Value>)>,
}

/// How a function is made anew.
struct How<'a> {
    rules: &'a dyn Rules,
    callee: &'a dyn Fn(Handle<Function>) -> Handle<Function>,
}

/// The function with its expressions rewritten, and its calls sent to other functions by `callee`. Calls
/// whose result the rules have rewritten are calls no more.
pub fn rebuild(
    module: &Module,
    (function, info): (&Function, &FunctionInfo),
    rules: &dyn Rules,
    callee: &dyn Fn(Handle<Function>) -> Handle<Function>,
) -> Function {
    let mut work = Work {
        module,
        function,
        info,
        new: Arena::new(),
        handles: Vec::new(),
        made: Vec::new(),
        calls: Vec::new(),
    };
    calls(&function.body, &mut work.calls);
    for (old, expression) in function.expressions.iter() {
        let start = work.new.len();
        let value = rules.rewrite(old, &mut work).unwrap_or_else(|| {
            let mut copy = expression.clone();
            operands(&mut copy, &mut |operand| *operand = work.of(*operand));
            if let Expression::CallResult(function) = &mut copy {
                *function = callee(*function);
            }
            work.add(copy)
        });
        work.made.push((value, start..work.new.len()));
    }
    let how = How { rules, callee };
    let body = work.block(&function.body, &how);
    let named = function.named_expressions.iter();
    let named_expressions = named.map(|(old, name)| (work.of(*old), name.clone()));
    let named_expressions = named_expressions.collect();
    Function {
        name: function.name.clone(),
        arguments: function.arguments.clone(),
        result: function.result.clone(),
        local_variables: locals(&work),
        named_expressions,
        expressions: work.new,
        body,
        diagnostic_filter_leaf: function.diagnostic_filter_leaf,
    }
}

impl Work<'_> {
    /// What an old expression has become.
    pub fn of(&self, old: Value) -> Value {
        self.made[old.index()].0
    }

    /// An old expression's type.
    pub fn type_of(&self, old: Value) -> &TypeInner {
        self.info[old].ty.inner_with(&self.module.types)
    }

    pub fn old(&self, old: Value) -> &Expression {
        &self.function.expressions[old]
    }

    /// The arguments of the call that has this result, as they were.
    pub fn given(&self, result: Value) -> Vec<Value> {
        let call = self.calls.iter().find(|(call, _)| *call == result);
        let (_, arguments) = call.expect("every result is of a call");
        arguments.clone()
    }

    /// The same, as they have become.
    pub fn arguments(&self, result: Value) -> Vec<Value> {
        let given = self.given(result);
        given.iter().map(|old| self.of(*old)).collect()
    }

    pub fn add(&mut self, expression: Expression) -> Value {
        let handle = self.new.append(expression, Span::UNDEFINED);
        self.handles.push(handle);
        handle
    }

    fn block(&mut self, old: &Block, how: &How<'_>) -> Block {
        let mut block = Block::new();
        for statement in old.iter() {
            match statement {
                Statement::Emit(range) => {
                    for old in range.clone() {
                        self.emit(old, &mut block);
                    }
                }
                Statement::Call {
                    result: Some(result),
                    ..
                } if !matches!(self.new[self.of(*result)], Expression::CallResult(_)) => {
                    self.emit(*result, &mut block);
                }
                Statement::Return { value: Some(value) } => {
                    let start = self.new.len();
                    let value = how.rules.result(self.of(*value), self);
                    self.emit_made(start..self.new.len(), &mut block);
                    let value = Some(value);
                    block.push(Statement::Return { value }, Span::UNDEFINED);
                }
                other => block.push(self.statement(other, how), Span::UNDEFINED),
            }
        }
        block
    }

    /// What was made for an old expression, but for what counts as emitted at the function's start.
    fn emit(&self, old: Value, block: &mut Block) {
        self.emit_made(self.made[old.index()].1.clone(), block);
    }

    fn emit_made(&self, made: std::ops::Range<usize>, block: &mut Block) {
        for handle in &self.handles[made] {
            if !self.new[*handle].needs_pre_emit() {
                let range = Range::new_from_bounds(*handle, *handle);
                block.push(Statement::Emit(range), Span::UNDEFINED);
            }
        }
    }

    fn statement(&mut self, old: &Statement, how: &How<'_>) -> Statement {
        use Statement as S;
        let mut new = old.clone();
        inner_blocks(&mut new, &mut |block| *block = self.block(block, how));
        let set = |value: &mut Value| *value = self.of(*value);
        match &mut new {
            S::Block(_)
            | S::Return { value: None }
            | S::Break
            | S::Continue
            | S::Kill
            | S::ControlBarrier(_)
            | S::MemoryBarrier(_) => {}
            S::If { condition: one, .. } | S::Switch { selector: one, .. } => set(one),
            S::Loop { break_if, .. } => break_if.iter_mut().for_each(set),
            S::Store { pointer, value } => [pointer, value].into_iter().for_each(set),
            S::Atomic {
                pointer,
                value,
                result,
                ..
            } => {
                set(pointer);
                set(value);
                result.iter_mut().for_each(set);
            }
            S::Call {
                function,
                arguments,
                result,
            } => {
                *function = (how.callee)(*function);
                arguments.iter_mut().chain(result).for_each(set);
            }
            other => panic!("no shader here has {other:?}"),
        }
        new
    }
}

fn locals(work: &Work<'_>) -> Arena<naga::LocalVariable> {
    let mut locals = work.function.local_variables.clone();
    for (_, local) in locals.iter_mut() {
        local.init = local.init.map(|init| work.of(init));
    }
    locals
}

/// The calls with a result in a block and those within it.
fn calls(block: &Block, found: &mut Vec<(Value, Vec<Value>)>) {
    for statement in block.iter() {
        if let Statement::Call {
            arguments,
            result: Some(result),
            ..
        } = statement
        {
            found.push((*result, arguments.clone()));
        }
        inner_blocks(&mut statement.clone(), &mut |inner| calls(inner, found));
    }
}

/// Hands `each` every block that a statement holds.
fn inner_blocks(statement: &mut Statement, each: &mut dyn FnMut(&mut Block)) {
    match statement {
        Statement::Block(inner) => each(inner),
        Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(each),
        Statement::Switch { cases, .. } => cases.iter_mut().for_each(|case| each(&mut case.body)),
        Statement::Loop {
            body, continuing, ..
        } => [body, continuing].into_iter().for_each(each),
        _ => {}
    }
}

/// Hands `each` every expression that an expression is made of.
pub fn operands(expression: &mut Expression, each: &mut dyn FnMut(&mut Value)) {
    use Expression as E;
    match expression {
        E::Literal(_)
        | E::Constant(_)
        | E::Override(_)
        | E::ZeroValue(_)
        | E::FunctionArgument(_)
        | E::GlobalVariable(_)
        | E::LocalVariable(_)
        | E::CallResult(_)
        | E::AtomicResult { .. } => {}
        E::Compose { components, .. } => components.iter_mut().for_each(each),
        E::Access { base, index } => [base, index].into_iter().for_each(each),
        E::AccessIndex { base: one, .. }
        | E::Splat { value: one, .. }
        | E::Swizzle { vector: one, .. }
        | E::Load { pointer: one }
        | E::Unary { expr: one, .. }
        | E::Derivative { expr: one, .. }
        | E::Relational { argument: one, .. }
        | E::As { expr: one, .. }
        | E::ArrayLength(one) => each(one),
        E::Binary { left, right, .. } => [left, right].into_iter().for_each(each),
        E::Select {
            condition,
            accept,
            reject,
        } => [condition, accept, reject].into_iter().for_each(each),
        E::Math {
            arg,
            arg1,
            arg2,
            arg3,
            ..
        } => {
            each(arg);
            [arg1, arg2, arg3].into_iter().flatten().for_each(each);
        }
        E::ImageSample {
            image,
            sampler,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref,
            ..
        } => {
            [image, sampler, coordinate]
                .into_iter()
                .for_each(&mut *each);
            let optional = [array_index, offset, depth_ref];
            optional.into_iter().flatten().for_each(&mut *each);
            match level {
                naga::SampleLevel::Exact(one) | naga::SampleLevel::Bias(one) => each(one),
                naga::SampleLevel::Gradient { x, y } => [x, y].into_iter().for_each(each),
                naga::SampleLevel::Auto | naga::SampleLevel::Zero => {}
            }
        }
        E::ImageLoad {
            image,
            coordinate,
            array_index,
            sample,
            level,
        } => {
            [image, coordinate].into_iter().for_each(&mut *each);
            let optional = [array_index, sample, level];
            optional.into_iter().flatten().for_each(each);
        }
        E::ImageQuery { image, query } => {
            each(image);
            if let naga::ImageQuery::Size { level: Some(level) } = query {
                each(level);
            }
        }
        other => panic!("no shader here has {other:?}"),
    }
}
