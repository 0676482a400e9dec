//! Shaders with arithmetic that a driver may choose. WGSL has no `precise`: products and sums may be
//! contracted, sums reordered, quotients rounded in other ways. The text is parsed, its IR rewritten and
//! written again.

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Arena, Function, Handle, Module, Scalar, Span, Type, TypeInner, VectorSize};

use super::inline::Inline;
use super::rebuild::{Rules, rebuild};
use super::rules::{Arithmetic, Fused};
use super::snap::Snap;

/// What is rewritten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Where {
    Everywhere,
    /// The host's vertices.
    Host,
    /// Of shadow volumes, the caps.
    Caps,
    /// Of shadow volumes, the sides.
    Sides,
    /// Fragments.
    Fragments,
}

/// One way to compile all shaders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    pub name: &'static str,
    pub what: &'static str,
    place: Where,
    arithmetic: Arithmetic,
    /// Whether vertices are put on the rasteriser's grid.
    snapped: bool,
}

const PLAIN: Arithmetic = Arithmetic {
    fused: None,
    reassociated: false,
    reciprocal: false,
    approximate: false,
    matrices_first: false,
    no_remainder: false,
    wrong: false,
};

/// All that are tried. The first changes nothing.
pub const ALL: [Variant; 11] = [
    Variant {
        name: "as-written",
        what: "parsed and written again, small functions put in the place of their calls",
        place: Where::Everywhere,
        arithmetic: PLAIN,
        snapped: false,
    },
    Variant {
        name: "fma",
        what: "every product that is added is fused, in a * b + c * d the second",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            fused: Some(Fused::Right),
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "fma-other",
        what: "the same, but in a * b + c * d the first, and products of vectors summed from the last",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            fused: Some(Fused::Left),
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "reassociated",
        what: "(a + b) + c as a + (b + c), products of vectors and matrices summed from the last",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            reassociated: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "reciprocal",
        what: "x / y as x * (1 / y), normalize and length from a dot product",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            reciprocal: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "approximate",
        what: "quotients and square roots off by -1 to 2 units in the last place",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            approximate: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "remainder-lost",
        what: "what of the light's position f32 does not hold is 0 in the facing rule",
        place: Where::Everywhere,
        arithmetic: Arithmetic {
            no_remainder: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "host-order",
        what: "the host's vertices multiplied by the product of their matrices",
        place: Where::Host,
        arithmetic: Arithmetic {
            matrices_first: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "host-fma",
        what: "`fma` in the host's vertices alone",
        place: Where::Host,
        arithmetic: Arithmetic {
            fused: Some(Fused::Right),
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "caps-and-sides",
        what: "`fma` in the volumes' caps alone: sides are rounded in another way",
        place: Where::Caps,
        arithmetic: Arithmetic {
            fused: Some(Fused::Right),
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "snapped",
        what: "the host's and the volumes' vertices on the rasteriser's grid before depth is interpolated, as \
               hardware has them and llvmpipe has not",
        place: Where::Everywhere,
        arithmetic: PLAIN,
        snapped: true,
    },
];

/// No driver's: what the tests must find.
pub const WRONG: [Variant; 2] = [
    Variant {
        name: "wrong-sides",
        what: "products a thousandth too large in the volumes' sides",
        place: Where::Sides,
        arithmetic: Arithmetic {
            wrong: true,
            ..PLAIN
        },
        snapped: false,
    },
    Variant {
        name: "wrong-receivers",
        what: "products a thousandth too large in fragments",
        place: Where::Fragments,
        arithmetic: Arithmetic {
            wrong: true,
            ..PLAIN
        },
        snapped: false,
    },
];

impl Variant {
    /// The variant of this name, one of those that are wrong included.
    pub fn named(name: &str) -> Option<Self> {
        let mut variants = ALL.into_iter().chain(WRONG);
        variants.find(|variant| variant.name == name)
    }

    /// From now on this thread's shaders are compiled so; as they are written once the guard is dropped.
    /// Pictures are of `size` pixels.
    pub fn install(self, size: [u32; 2]) -> Installed {
        let rewrite = move |wgsl: &str| self.rewrite(wgsl, size);
        shadows::rewriting::set(Some(Box::new(rewrite)));
        Installed(())
    }

    /// A module's text with this arithmetic.
    ///
    /// # Panics
    /// If the text is not valid, or says what no shader of this repository says.
    pub fn rewrite(self, wgsl: &str, size: [u32; 2]) -> String {
        let module = naga::front::wgsl::parse_str(wgsl).expect("shaders parse");
        let module = with_types(module);
        let module = match self.snapped {
            true => made_anew(module, &Snap(size), &|_| true),
            false => module,
        };
        let module = made_anew(module, &Inline, &|_| true);
        let mut module = made_anew(module, &self.arithmetic, &|entry| self.is_about(entry));
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        let info = validated(&module);
        let flags = naga::back::wgsl::WriterFlags::empty();
        naga::back::wgsl::write_string(&module, &info, flags).expect("the IR came from WGSL")
    }

    fn is_about(self, entry: &naga::EntryPoint) -> bool {
        let name = entry.name.as_str();
        match self.place {
            Where::Everywhere => true,
            Where::Host => name == "host_vertex",
            Where::Caps => ["shadows_volume_light_cap", "shadows_volume_dark_cap"].contains(&name),
            Where::Sides => name == "shadows_volume_side",
            Where::Fragments => entry.stage == naga::ShaderStage::Fragment,
        }
    }
}

/// While it lives, the shaders that its thread makes are rewritten.
#[must_use]
pub struct Installed(());

impl Drop for Installed {
    fn drop(&mut self) {
        shadows::rewriting::set(None);
    }
}

/// The module with the types of what products of matrices are put together from.
fn with_types(mut module: Module) -> Module {
    let scalar = Scalar::F32;
    for size in [VectorSize::Bi, VectorSize::Tri, VectorSize::Quad] {
        let (columns, rows) = (size, size);
        for inner in [
            TypeInner::Vector { size, scalar },
            TypeInner::Matrix {
                columns,
                rows,
                scalar,
            },
        ] {
            module
                .types
                .insert(Type { name: None, inner }, Span::UNDEFINED);
        }
    }
    module
}

/// The module with the entry points of which `is_about` holds rewritten, and with them all that they call.
fn made_anew(
    mut module: Module,
    rules: &dyn Rules,
    is_about: &dyn Fn(&naga::EntryPoint) -> bool,
) -> Module {
    let info = validated(&module);
    // The rewritten follow those that they were made from: callees stay before their callers.
    let mut functions: Arena<Function> = module.functions.clone();
    let mut copies: Vec<Handle<Function>> = Vec::new();
    for (old, function) in module.functions.iter() {
        let callee = |old: Handle<Function>| copies[old.index()];
        let new = rebuild(&module, (function, &info[old]), rules, &callee);
        copies.push(functions.append(new, Span::UNDEFINED));
    }
    let callee = |old: Handle<Function>| copies[old.index()];
    let mut entry_points = module.entry_points.clone();
    for (place, entry) in entry_points.iter_mut().enumerate() {
        if is_about(entry) {
            let old = (
                &module.entry_points[place].function,
                info.get_entry_point(place),
            );
            entry.function = rebuild(&module, old, rules, &callee);
        }
    }
    module.functions = functions;
    module.entry_points = entry_points;
    module
}

fn validated(module: &Module) -> ModuleInfo {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    validator
        .validate(module)
        .unwrap_or_else(|error| panic!("{error:?}"))
}
