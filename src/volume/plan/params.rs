//! What the shaders read, byte for byte.

use bytemuck::{Pod, Zeroable};

use crate::View;
use crate::volume::decide::facing;

/// `Batch` in `volume_dispatch.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct BatchParams {
    pub first_item: u32,
    /// See `settled` in `volume_light_side.wgsl`.
    pub zero: u32,
    pub padding: [u32; 2],
}

/// `Instance` in `volume_batch.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct InstanceParams {
    pub light: [f32; 4],
    pub light_rest: [f32; 3],
    pub both_sides: u32,
    pub facing_base: u32,
    pub cap_base: u32,
    pub side_base: u32,
    pub arguments: u32,
    pub triangle_count: u32,
    pub triangle_base: u32,
    pub edge_count: u32,
    pub edge_base: u32,
    pub use_base: u32,
    pub general: u32,
    pub position_stride: u32,
    pub position_offset: u32,
}

/// `Caster` in `volume_extrude.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CasterParams {
    pub world_from_object: [[f32; 4]; 4],
    pub far_plane: [f32; 4],
    pub apex: [f32; 4],
    pub position_stride: u32,
    pub position_offset: u32,
    pub edge_base: u32,
    pub side_vertices: u32,
    pub object_light: [f32; 4],
    pub object_light_rest: [f32; 3],
    pub both_sides: u32,
    pub anchor: [f32; 3],
    /// See `settled` in `volume_light_side.wgsl`.
    pub zero: u32,
    pub anchor_from_light: [f32; 3],
    pub padding: u32,
}

/// `Camera` in `volume_extrude.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct ViewParams {
    pub clip_from_world: [[f32; 4]; 4],
    pub depth_step: f32,
    pub padding: [u32; 3],
}

impl ViewParams {
    pub fn new(view: &View) -> Self {
        Self {
            clip_from_world: view.clip_from_world().to_cols_array_2d(),
            depth_step: facing::depth_step(view),
            padding: [0; 3],
        }
    }
}

/// `Light` in `volume_extrude.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct LightParams {
    pub homogeneous: [f32; 4],
}

/// The indirect arguments of one instance, before anything is counted.
///
/// Two indexed draws (index count, instances, first index, base vertex, first instance), and how many
/// sides there are.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Arguments {
    pub front: [u32; 5],
    pub back: [u32; 5],
    pub sides: u32,
}

impl Arguments {
    /// Bytes from an instance's arguments to those of its caps that count +1.
    pub const FRONT: u64 = 0;
    /// The same, caps that count -1.
    pub const BACK: u64 = 20;
    /// The same, to the number of sides.
    pub const SIDES: u64 = 40;

    /// Arguments of an empty volume whose caps will lie in `cap_base .. cap_end` (in indices).
    pub fn new(cap_base: u32, cap_end: u32) -> Self {
        Self {
            front: [0, 1, cap_base, 0, 0],
            back: [0, 1, cap_end, 0, 0],
            sides: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::mem::offset_of;

    use naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;
    use crate::DepthConvention;
    use crate::volume::decide::near_plane::NearPlane;
    use crate::volume::gpu::draw_pipelines::Feed;
    use crate::volume::plan::limits::WORKGROUP;
    use crate::volume::plan::merged::{BLOCK, Member};
    use crate::volume::plan::work::Merge;
    use crate::volume::silhouette;
    use crate::wgsl_layout::assert_layout;

    const CONVENTIONS: [DepthConvention; 3] = [
        DepthConvention::InfiniteReverse,
        DepthConvention::FiniteReverse,
        DepthConvention::Standard,
    ];

    fn parse(source: &str) -> naga::Module {
        naga::front::wgsl::parse_str(source)
            .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)))
    }

    fn sources(depth: DepthConvention, near: NearPlane) -> [String; 5] {
        [
            silhouette::facing_source(),
            silhouette::edges_source(),
            silhouette::merge_source(),
            Feed::Pulled.source(depth, near),
            Feed::Records.source(depth, near),
        ]
    }

    #[test]
    fn every_shader_is_valid_without_any_capability() {
        let every = CONVENTIONS.into_iter().flat_map(|depth| {
            let near = NearPlane::of(wgpu::Features::empty(), depth);
            sources(depth, near)
        });
        for source in every {
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&parse(&source))
                .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
        }
    }

    #[test]
    fn faces_cut_at_the_near_plane_need_clip_distances_alone() {
        for depth in [DepthConvention::FiniteReverse, DepthConvention::Standard] {
            for source in &sources(depth, NearPlane::Cut)[3..] {
                let is_valid = |capabilities| {
                    let mut validator = Validator::new(ValidationFlags::all(), capabilities);
                    validator.validate(&parse(source)).is_ok()
                };
                assert!(is_valid(Capabilities::CLIP_DISTANCES), "{source}");
                assert!(!is_valid(Capabilities::empty()), "{source}");
            }
        }
    }

    #[test]
    fn rust_and_wgsl_agree_on_every_offset() {
        let [facing, edges, merge, draw, vertex] =
            sources(DepthConvention::Standard, NearPlane::Passed);
        assert_layout!(merge, "Batch", BatchParams, first_item, zero, padding);
        assert_layout!(
            merge,
            "Merge",
            Merge,
            first_member,
            member_count,
            first_block,
            draw,
            element_words,
            block_vertices,
            padding
        );
        assert_layout!(merge, "Member", Member, caster, count, start, grows_down);
        for source in [facing, edges] {
            assert_layout!(source, "Batch", BatchParams, first_item, zero, padding);
            assert_layout!(
                source,
                "Instance",
                InstanceParams,
                light,
                light_rest,
                both_sides,
                facing_base,
                cap_base,
                side_base,
                arguments,
                triangle_count,
                triangle_base,
                edge_count,
                edge_base,
                use_base,
                general,
                position_stride,
                position_offset
            );
        }
        for source in [draw, vertex] {
            assert_layout!(
                source,
                "Caster",
                CasterParams,
                world_from_object,
                far_plane,
                apex,
                position_stride,
                position_offset,
                edge_base,
                side_vertices,
                object_light,
                object_light_rest,
                both_sides,
                anchor,
                zero,
                anchor_from_light
            );
            assert_layout!(source, "Camera", ViewParams, clip_from_world, depth_step);
            assert_layout!(source, "Light", LightParams, homogeneous);
        }
    }

    #[test]
    fn rust_and_wgsl_agree_on_the_constants() {
        let of_extraction = [
            ("WORKGROUP", WORKGROUP),
            ("ARGS_STRIDE", size_of::<Arguments>() as u32 / 4),
            ("ARGS_FRONT", offset_of!(Arguments, front) as u32 / 4),
            ("ARGS_BACK", offset_of!(Arguments, back) as u32 / 4),
            ("ARGS_SIDES", offset_of!(Arguments, sides) as u32 / 4),
        ];
        assert_eq!(Arguments::FRONT, offset_of!(Arguments, front) as u64);
        assert_eq!(Arguments::BACK, offset_of!(Arguments, back) as u64);
        assert_eq!(Arguments::SIDES, offset_of!(Arguments, sides) as u64);
        let of_merging = [("WORKGROUP", WORKGROUP), ("BLOCK", BLOCK)];
        for (source, constants) in [
            (silhouette::facing_source(), &of_extraction[..]),
            (silhouette::edges_source(), &of_extraction),
            (silhouette::merge_source(), &of_merging),
        ] {
            let module = parse(&source);
            for &(name, value) in constants {
                let (_, constant) = module
                    .constants
                    .iter()
                    .find(|(_, c)| c.name.as_deref() == Some(name))
                    .unwrap_or_else(|| panic!("{name} is in the shader"));
                let literal = &module.global_expressions[constant.init];
                let naga::Expression::Literal(naga::Literal::U32(found)) = literal else {
                    panic!("{name} is {literal:?}");
                };
                assert_eq!(*found, value, "{name}");
            }
            for entry in &module.entry_points {
                assert_eq!(entry.workgroup_size, [WORKGROUP, 1, 1]);
            }
        }
    }
}
