//! What a driver may make of products, sums and quotients.

use naga::{
    BinaryOperator as Op, Expression as E, Handle, Literal, MathFunction as Math, ScalarKind,
    SwizzleComponent, TypeInner, UnaryOperator, VectorSize,
};

use super::rebuild::{Rules, Work};

type Value = Handle<E>;

/// Which of two products that are added is multiplied and added at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fused {
    Right,
    Left,
}

/// What is done to the arithmetic of f32.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arithmetic {
    /// Products and sums come to `fma`, rounded once.
    pub fused: Option<Fused>,
    /// (a + b) + c is a + (b + c); products of vectors and matrices are summed from their last.
    pub reassociated: bool,
    /// x / y is x * (1 / y); normalize and length are made of a dot product.
    pub reciprocal: bool,
    /// Quotients and square roots are off by up to 2 units in the last place.
    pub approximate: bool,
    /// A * (B * v) is (A * B) * v.
    pub matrices_first: bool,
    /// The light's remainder is 0.
    pub no_remainder: bool,
    /// All products are a thousandth too large: no driver's, for tests.
    pub wrong: bool,
}

impl Rules for Arithmetic {
    fn rewrite(&self, old: Value, work: &mut Work<'_>) -> Option<Value> {
        match *work.old(old) {
            E::FunctionArgument(place) if self.no_remainder => no_remainder(work, place),
            _ if !is_f32(work.type_of(old)) => None,
            E::Binary { op, left, right } => self.binary((op, left, right), old, work),
            E::Math { fun, arg, arg1, .. } => self.math(fun, [Some(arg), arg1], old, work),
            _ => None,
        }
    }
}

impl Arithmetic {
    fn binary(
        &self,
        (op, left, right): (Op, Value, Value),
        old: Value,
        work: &mut Work<'_>,
    ) -> Option<Value> {
        match op {
            Op::Add | Op::Subtract => self
                .reassociated(op, left, right, work)
                .or_else(|| self.fused_sum(op, left, right, work)),
            Op::Multiply => self.product(left, right, old, work),
            Op::Divide => self.quotient(left, right, old, work),
            _ => None,
        }
    }

    /// `left + right` or `left - right` at once, if one of them is a product.
    fn fused_sum(&self, op: Op, left: Value, right: Value, work: &mut Work<'_>) -> Option<Value> {
        let order = match self.fused? {
            Fused::Right => [true, false],
            Fused::Left => [false, true],
        };
        order.into_iter().find_map(|from_right| {
            let (product, other) = match from_right {
                true => (right, left),
                false => (left, right),
            };
            let [a, b] = factors(product, work)?;
            let c = work.of(other);
            Some(match (op, from_right) {
                (Op::Subtract, true) => {
                    let a = negated(a, work);
                    fma([a, b, c], work)
                }
                (Op::Subtract, false) => {
                    let c = negated(c, work);
                    fma([a, b, c], work)
                }
                _ => fma([a, b, c], work),
            })
        })
    }

    /// (a ± b) ± c as a ± (b ± c).
    fn reassociated(&self, op: Op, left: Value, c: Value, work: &mut Work<'_>) -> Option<Value> {
        let E::Binary {
            op: inner,
            left: a,
            right: b,
        } = *work.old(left)
        else {
            return None;
        };
        if !self.reassociated || !matches!(inner, Op::Add | Op::Subtract) {
            return None;
        }
        let [a, b, c] = [a, b, c].map(|value| work.of(value));
        // a - b + c is a - (b - c), a - b - c is a - (b + c).
        let within = match inner == op {
            true => Op::Add,
            false => Op::Subtract,
        };
        let sum = binary(within, b, c, work);
        Some(binary(inner, a, sum, work))
    }

    fn product(&self, left: Value, right: Value, old: Value, work: &mut Work<'_>) -> Option<Value> {
        let [l, r] = [left, right].map(|value| work.of(value));
        let (a, b) = (work.type_of(left).clone(), work.type_of(right).clone());
        match (a, b) {
            (TypeInner::Matrix { columns, .. }, TypeInner::Vector { .. }) => {
                if let (
                    true,
                    E::Binary {
                        op: Op::Multiply,
                        left: m,
                        right: v,
                    },
                ) = (self.matrices_first, work.old(right).clone())
                    && matches!(work.type_of(m), TypeInner::Matrix { .. })
                {
                    let [m, v] = [m, v].map(|value| work.of(value));
                    let both = binary(Op::Multiply, l, m, work);
                    return Some(binary(Op::Multiply, both, v, work));
                }
                let TypeInner::Matrix { rows, .. } = *work.type_of(left) else {
                    return None;
                };
                self.matrix_times(l, (columns, rows), r, work)
            }
            (TypeInner::Vector { size, .. }, TypeInner::Matrix { columns, .. }) => {
                let ty = vector_type(columns, work)?;
                self.sums().then(|| {
                    let column = |n, work: &mut Work<'_>| {
                        let column = part(r, n, work);
                        self.dot(l, column, size, work)
                    };
                    let components = (0..columns as u32).map(|n| column(n, work)).collect();
                    work.add(E::Compose { ty, components })
                })
            }
            (TypeInner::Matrix { columns, rows, .. }, TypeInner::Matrix { columns: n, .. }) => {
                let ty = matrix_type(n, rows, work)?;
                self.sums().then(|| {
                    let column = |n, work: &mut Work<'_>| {
                        let column = part(r, n, work);
                        let made = self.matrix_times(l, (columns, rows), column, work);
                        made.expect("sums are made otherwise")
                    };
                    let components = (0..n as u32).map(|n| column(n, work)).collect();
                    work.add(E::Compose { ty, components })
                })
            }
            (TypeInner::Matrix { .. }, _) | (_, TypeInner::Matrix { .. }) => None,
            _ => self.wrong.then(|| {
                let product = binary(Op::Multiply, l, r, work);
                let much = literal(1.001, old, work);
                binary(Op::Multiply, product, much, work)
            }),
        }
    }

    fn quotient(
        &self,
        left: Value,
        right: Value,
        old: Value,
        work: &mut Work<'_>,
    ) -> Option<Value> {
        let [l, r] = [left, right].map(|value| work.of(value));
        if self.reciprocal {
            let one = literal(1.0, right, work);
            let inverse = binary(Op::Divide, one, r, work);
            return Some(binary(Op::Multiply, l, inverse, work));
        }
        self.approximate.then(|| {
            let quotient = binary(Op::Divide, l, r, work);
            off_by_units(quotient, old, work)
        })
    }

    fn math(
        &self,
        fun: Math,
        arguments: [Option<Value>; 2],
        old: Value,
        work: &mut Work<'_>,
    ) -> Option<Value> {
        let argument = arguments[0]?;
        let a = work.of(argument);
        let b = arguments[1].map(|b| work.of(b));
        let size = match *work.type_of(argument) {
            TypeInner::Vector { size, .. } => Some(size),
            _ => None,
        };
        match (fun, size, b) {
            (Math::Dot, Some(size), Some(b)) if self.sums() => Some(self.dot(a, b, size, work)),
            (Math::Cross, Some(_), Some(b)) if self.fused.is_some() => Some(self.cross(a, b, work)),
            (Math::Length, Some(size), _) if self.sums() || self.reciprocal => {
                let squared = self.dot(a, a, size, work);
                Some(math(Math::Sqrt, squared, work))
            }
            (Math::Normalize, Some(size), _) if self.sums() || self.reciprocal => {
                let squared = self.dot(a, a, size, work);
                let inverse = math(Math::InverseSqrt, squared, work);
                Some(binary(Op::Multiply, a, inverse, work))
            }
            (Math::Sqrt | Math::InverseSqrt | Math::Length | Math::Normalize, ..)
                if self.approximate =>
            {
                let root = math(fun, a, work);
                Some(off_by_units(root, old, work))
            }
            _ => None,
        }
    }

    /// Whether sums of products are made in another way.
    fn sums(&self) -> bool {
        self.fused.is_some() || self.reassociated
    }

    fn dot(&self, a: Value, b: Value, size: VectorSize, work: &mut Work<'_>) -> Value {
        let pair = |n| [part(a, n, work), part(b, n, work)];
        let pairs: Vec<_> = (0..size as u32).map(pair).collect();
        self.sum_of_products(pairs, work)
    }

    fn matrix_times(
        &self,
        matrix: Value,
        (columns, rows): (VectorSize, VectorSize),
        vector: Value,
        work: &mut Work<'_>,
    ) -> Option<Value> {
        if !self.sums() {
            return None;
        }
        let mut pairs = Vec::new();
        for n in 0..columns as u32 {
            let (column, value) = (part(matrix, n, work), part(vector, n, work));
            pairs.push([column, work.add(E::Splat { size: rows, value })]);
        }
        Some(self.sum_of_products(pairs, work))
    }

    fn cross(&self, a: Value, b: Value, work: &mut Work<'_>) -> Value {
        use SwizzleComponent::{X, Y, Z};
        let mut turn = |vector, pattern| {
            work.add(E::Swizzle {
                size: VectorSize::Tri,
                vector,
                pattern,
            })
        };
        let (yzx, zxy) = ([Y, Z, X, X], [Z, X, Y, X]);
        let [ay, bz, az, by] = [turn(a, yzx), turn(b, zxy), turn(a, zxy), turn(b, yzx)];
        match self.fused {
            Some(Fused::Right) => {
                let first = binary(Op::Multiply, ay, bz, work);
                let az = negated(az, work);
                fma([az, by, first], work)
            }
            _ => {
                let second = binary(Op::Multiply, az, by, work);
                let second = negated(second, work);
                fma([ay, bz, second], work)
            }
        }
    }

    /// From the first product on; from the last where sums are reassociated or the left is fused.
    fn sum_of_products(&self, mut pairs: Vec<[Value; 2]>, work: &mut Work<'_>) -> Value {
        if self.reassociated || self.fused == Some(Fused::Left) {
            pairs.reverse();
        }
        let mut pairs = pairs.into_iter();
        let [a, b] = pairs.next().expect("a vector has components");
        let first = binary(Op::Multiply, a, b, work);
        pairs.fold(first, |sum, [a, b]| match self.fused {
            Some(_) => fma([a, b, sum], work),
            None => {
                let product = binary(Op::Multiply, a, b, work);
                binary(Op::Add, sum, product, work)
            }
        })
    }
}

fn is_f32(ty: &TypeInner) -> bool {
    let scalar = match *ty {
        TypeInner::Scalar(scalar)
        | TypeInner::Vector { scalar, .. }
        | TypeInner::Matrix { scalar, .. } => scalar,
        _ => return false,
    };
    scalar == naga::Scalar::F32
}

/// The factors of a product of numbers or vectors, of its components, or of its opposite.
fn factors(product: Value, work: &mut Work<'_>) -> Option<[Value; 2]> {
    match *work.old(product) {
        E::Binary {
            op: Op::Multiply,
            left,
            right,
        } => {
            let whole = work.type_of(product).clone();
            if matches!(whole, TypeInner::Matrix { .. }) {
                return None;
            }
            let mut as_wide = |factor: Value| {
                let value = work.of(factor);
                match (&whole, work.type_of(factor)) {
                    (_, TypeInner::Matrix { .. }) => None,
                    (TypeInner::Vector { size, .. }, TypeInner::Scalar(_)) => {
                        let size = *size;
                        Some(work.add(E::Splat { size, value }))
                    }
                    _ => Some(value),
                }
            };
            Some([as_wide(left)?, as_wide(right)?])
        }
        E::AccessIndex { base, index }
            if matches!(work.type_of(base), TypeInner::Vector { .. }) =>
        {
            let both = factors(base, work)?;
            Some(both.map(|factor| part(factor, index, work)))
        }
        E::Unary {
            op: UnaryOperator::Negate,
            expr,
        } => {
            let [a, b] = factors(expr, work)?;
            Some([negated(a, work), b])
        }
        _ => None,
    }
}

/// a * b + c, rounded once: in f64 the product is exact. (Software drivers make of `fma` what it was made
/// from.)
fn fma(terms: [Value; 3], work: &mut Work<'_>) -> Value {
    let mut to = |expr, width| {
        work.add(E::As {
            expr,
            kind: ScalarKind::Float,
            convert: Some(width),
        })
    };
    let [a, b, c] = terms.map(|term| to(term, 8));
    let product = binary(Op::Multiply, a, b, work);
    let sum = binary(Op::Add, product, c, work);
    work.add(E::As {
        expr: sum,
        kind: ScalarKind::Float,
        convert: Some(4),
    })
}

fn binary(op: Op, left: Value, right: Value, work: &mut Work<'_>) -> Value {
    work.add(E::Binary { op, left, right })
}

fn negated(expr: Value, work: &mut Work<'_>) -> Value {
    let op = UnaryOperator::Negate;
    work.add(E::Unary { op, expr })
}

fn part(base: Value, index: u32, work: &mut Work<'_>) -> Value {
    work.add(E::AccessIndex { base, index })
}

fn math(fun: Math, arg: Value, work: &mut Work<'_>) -> Value {
    work.add(E::Math {
        fun,
        arg,
        arg1: None,
        arg2: None,
        arg3: None,
    })
}

/// A number as wide as an old expression.
fn literal(number: f32, like: Value, work: &mut Work<'_>) -> Value {
    let value = work.add(E::Literal(Literal::F32(number)));
    widened(value, like, work)
}

fn widened(value: Value, like: Value, work: &mut Work<'_>) -> Value {
    match *work.type_of(like) {
        TypeInner::Vector { size, .. } => work.add(E::Splat { size, value }),
        _ => value,
    }
}

/// A number as wide as `like` moved by -1, 0, 1 or 2 units in the last place, by its own bits. 0 and what
/// is no number stay.
fn off_by_units(value: Value, like: Value, work: &mut Work<'_>) -> Value {
    let word = |number, work: &mut Work<'_>| {
        let value = work.add(E::Literal(Literal::U32(number)));
        widened(value, like, work)
    };
    let cast = |expr, kind, work: &mut Work<'_>| {
        let convert = None;
        work.add(E::As {
            expr,
            kind,
            convert,
        })
    };
    let bits = cast(value, ScalarKind::Uint, work);
    let [three, one, exponent, none] = [3, 1, 0x7f80_0000, 0].map(|number| word(number, work));
    let shifted = binary(Op::ShiftRight, bits, three, work);
    let units = binary(Op::And, shifted, three, work);
    let more = binary(Op::Add, bits, units, work);
    let moved = binary(Op::Subtract, more, one, work);
    let exponents = binary(Op::And, bits, exponent, work);
    let finite = binary(Op::NotEqual, exponents, exponent, work);
    let some = binary(Op::NotEqual, exponents, none, work);
    let moved = cast(moved, ScalarKind::Float, work);
    let accept = work.add(E::Select {
        condition: finite,
        accept: moved,
        reject: value,
    });
    work.add(E::Select {
        condition: some,
        accept,
        reject: value,
    })
}

/// 0 for the remainder that `light_side` is given.
fn no_remainder(work: &mut Work<'_>, place: u32) -> Option<Value> {
    let argument = work.function.arguments.get(place as usize)?;
    let is_it = work.function.name.as_deref() == Some("light_side")
        && argument.name.as_deref() == Some("rest");
    is_it.then(|| work.add(E::ZeroValue(argument.ty)))
}

fn vector_type(size: VectorSize, work: &Work<'_>) -> Option<Handle<naga::Type>> {
    let scalar = naga::Scalar::F32;
    named(TypeInner::Vector { size, scalar }, work)
}

fn matrix_type(
    columns: VectorSize,
    rows: VectorSize,
    work: &Work<'_>,
) -> Option<Handle<naga::Type>> {
    let scalar = naga::Scalar::F32;
    named(
        TypeInner::Matrix {
            columns,
            rows,
            scalar,
        },
        work,
    )
}

fn named(inner: TypeInner, work: &Work<'_>) -> Option<Handle<naga::Type>> {
    work.module.types.get(&naga::Type { name: None, inner })
}
