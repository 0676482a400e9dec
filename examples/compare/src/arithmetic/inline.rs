//! Small functions put in the place of their calls, as drivers do before they choose their arithmetic.

use naga::{Expression, Function, Handle, Module, Statement};

use super::rebuild::{Rules, Work, operands};

type Value = Handle<Expression>;

pub struct Inline;

impl Rules for Inline {
    fn rewrite(&self, old: Value, work: &mut Work<'_>) -> Option<Value> {
        let Expression::CallResult(callee) = work.old(old) else {
            return None;
        };
        let module = work.module;
        let callee = &module.functions[*callee];
        let value = formula(module, callee)?;
        let [given, arguments] = [work.given(old), work.arguments(old)];
        if are_constant(&given, work.function) {
            return None;
        }
        Some(in_place(callee, value, &arguments, work))
    }
}

/// What a function gives that is no more than one formula, without variables and branches.
fn formula(module: &Module, function: &Function) -> Option<Value> {
    let [before @ .., last] = &*function.body else {
        return None;
    };
    let plain = |statement: &Statement| match statement {
        Statement::Emit(_) => true,
        Statement::Call {
            function: callee,
            arguments,
            result,
        } => {
            result.is_some()
                && !are_constant(arguments, function)
                && formula(module, &module.functions[*callee]).is_some()
        }
        _ => false,
    };
    match *last {
        Statement::Return { value } if before.iter().all(plain) => value,
        _ => None,
    }
}

/// Whether a function is given constants alone: there is no arithmetic to choose then, and in its place naga 30
/// would emit a constant twice once a pipeline's constants are known, which is not valid.
fn are_constant(arguments: &[Value], function: &Function) -> bool {
    let one = |value: &Value| is_constant(*value, function);
    !arguments.is_empty() && arguments.iter().all(one)
}

fn is_constant(value: Value, function: &Function) -> bool {
    use Expression as E;
    match &function.expressions[value] {
        E::Literal(_) | E::Constant(_) | E::ZeroValue(_) => true,
        E::Splat { value, .. } => is_constant(*value, function),
        E::Compose { components, .. } => are_constant(components, function),
        _ => false,
    }
}

fn in_place(callee: &Function, value: Value, arguments: &[Value], work: &mut Work<'_>) -> Value {
    let module = work.module;
    let mut made: Vec<Value> = Vec::new();
    for (handle, expression) in callee.expressions.iter() {
        let new = match expression {
            Expression::FunctionArgument(place) => arguments[*place as usize],
            Expression::CallResult(inner) => {
                let (function, given) = (&module.functions[*inner], call(callee, handle));
                let given: Vec<Value> = given.iter().map(|one| made[one.index()]).collect();
                let value = formula(module, function).expect("only formulas are called");
                in_place(function, value, &given, work)
            }
            other => {
                let mut copy = other.clone();
                operands(&mut copy, &mut |operand| *operand = made[operand.index()]);
                work.add(copy)
            }
        };
        made.push(new);
    }
    made[value.index()]
}

fn call(function: &Function, wanted: Value) -> &[Value] {
    let arguments = function.body.iter().find_map(|statement| match statement {
        Statement::Call {
            arguments, result, ..
        } if *result == Some(wanted) => Some(arguments),
        _ => None,
    });
    arguments.expect("every result is of a call")
}
