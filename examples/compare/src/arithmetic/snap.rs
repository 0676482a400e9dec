//! Vertices put where a rasteriser's grid has them.

use naga::{
    BinaryOperator as Op, Binding, BuiltIn, Expression as E, Handle, Literal, MathFunction as Math,
    SwizzleComponent, Type, TypeInner, VectorSize,
};

use super::rebuild::{Rules, Work};

type Value = Handle<E>;

/// Steps of a pixel.
const STEPS: f32 = 256.0;
/// Beyond so many steps from the picture's middle f32 has no room for a step.
const LAST: f32 = 8_388_608.0;

/// Of shadow volumes, the function that gives the corners that are the casters' own. Those far away may be
/// behind the eye, where hardware clips before it snaps.
const NEAR: &str = "near_point";
const HOST: &str = "host_vertex";

/// Positions in clip space whose place in a picture of so many pixels is a whole number of steps. Hardware
/// takes depth from triangles so moved, llvmpipe from those before.
pub struct Snap(pub [u32; 2]);

impl Rules for Snap {
    fn rewrite(&self, _: Value, _: &mut Work<'_>) -> Option<Value> {
        None
    }

    fn result(&self, value: Value, work: &mut Work<'_>) -> Value {
        let Some(result) = &work.function.result else {
            return value;
        };
        match work.function.name.as_deref() {
            Some(NEAR) => return self.snapped(value, work),
            Some(HOST) => {}
            _ => return value,
        }
        let ty = result.ty;
        let TypeInner::Struct { members, .. } = &work.module.types[ty].inner else {
            return value;
        };
        let place = |member: &naga::StructMember| is_position(member.binding.as_ref());
        let Some(position) = members.iter().position(place) else {
            return value;
        };
        let mut components = Vec::new();
        for index in 0..members.len() {
            let base = value;
            let index32 = u32::try_from(index).expect("few members");
            let member = work.add(E::AccessIndex {
                base,
                index: index32,
            });
            components.push(match index == position {
                true => self.snapped(member, work),
                false => member,
            });
        }
        work.add(E::Compose { ty, components })
    }
}

impl Snap {
    fn snapped(&self, clip: Value, work: &mut Work<'_>) -> Value {
        let pair = named(VectorSize::Bi, work);
        let [width, height] = self.0.map(|side| {
            let steps = 0.5 * STEPS * side as f32;
            work.add(E::Literal(Literal::F32(steps)))
        });
        let last = work.add(E::Literal(Literal::F32(LAST)));
        let zero = work.add(E::Literal(Literal::F32(0.0)));
        let steps = work.add(E::Compose {
            ty: pair,
            components: vec![width, height],
        });
        let [xy, zw] = [
            [SwizzleComponent::X, SwizzleComponent::Y],
            [SwizzleComponent::Z, SwizzleComponent::W],
        ]
        .map(|[a, b]| {
            work.add(E::Swizzle {
                size: VectorSize::Bi,
                vector: clip,
                pattern: [a, b, a, a],
            })
        });
        let w = work.add(E::AccessIndex {
            base: clip,
            index: 3,
        });
        let wide = work.add(E::Splat {
            size: VectorSize::Bi,
            value: w,
        });
        let mut binary = |op, left, right| work.add(E::Binary { op, left, right });
        let seen = binary(Op::Divide, xy, wide);
        let place = binary(Op::Multiply, seen, steps);
        let ahead = binary(Op::Greater, w, zero);
        let rounded = math(Math::Round, place, work);
        let mut binary = |op, left, right| work.add(E::Binary { op, left, right });
        let back = binary(Op::Divide, rounded, steps);
        let moved = binary(Op::Multiply, back, wide);
        let size = math(Math::Abs, place, work);
        let [across, down] = [0, 1].map(|index| work.add(E::AccessIndex { base: size, index }));
        let mut binary = |op, left, right| work.add(E::Binary { op, left, right });
        let near = [across, down].map(|part| binary(Op::Less, part, last));
        let xy = [ahead, near[0], near[1]]
            .into_iter()
            .fold(moved, |accept, condition| {
                work.add(E::Select {
                    condition,
                    accept,
                    reject: xy,
                })
            });
        let ty = named(VectorSize::Quad, work);
        work.add(E::Compose {
            ty,
            components: vec![xy, zw],
        })
    }
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

fn named(size: VectorSize, work: &Work<'_>) -> Handle<Type> {
    let scalar = naga::Scalar::F32;
    let inner = TypeInner::Vector { size, scalar };
    let found = work.module.types.get(&Type { name: None, inner });
    found.expect("added to every module")
}

fn is_position(binding: Option<&Binding>) -> bool {
    matches!(binding, Some(Binding::BuiltIn(BuiltIn::Position { .. })))
}
