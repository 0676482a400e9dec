//! How naga lays out a WGSL struct, for tests that hold a Rust struct against it.

/// Name and offset of each member of a struct, and the struct's size, in bytes.
pub(crate) fn layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    let found = module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
            Some((members, *span as usize))
        }
        _ => None,
    });
    let (members, size) = found.unwrap_or_else(|| panic!("no struct {name} in the shader"));
    let members = members
        .iter()
        .map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize))
        .collect();
    (members, size)
}

/// Asserts that a Rust struct has the members of a WGSL struct, in its order and at its offsets,
/// and its size.
macro_rules! assert_layout {
    ($source:expr, $name:expr, $rust:ty, $($field:ident),+ $(,)?) => {
        let rust = vec![
            $((stringify!($field).to_string(), std::mem::offset_of!($rust, $field))),+
        ];
        let theirs = $crate::wgsl_layout::layout(&$source, $name);
        assert_eq!(theirs, (rust, size_of::<$rust>()));
    };
}
pub(crate) use assert_layout;
