//! Maps in a bind group of the host's, beside its own bindings: the same picture as through groups of their own.

use crate::common::shapes::cuboid;
use crate::{cubes, ground};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::PcfError;
use shadows::{
    CubeShadowMap, CubeShadowMapDescriptor, DirectionalLight, FlatLight, Kernel, MapKind,
    ModulePlace, PcfDescriptor, PcfSampler, PointLight, ShadowFrame, ShadowMap,
    ShadowMapDescriptor, VogelDisk, glam, wgpu,
};
use wgpu::util::DeviceExt as _;

/// A lamp and a sun over one box, and what reads them: five bindings and three.
struct Stage {
    lamp: CubeShadowMap,
    sun: ShadowMap,
    disks: PcfSampler,
    squares: PcfSampler,
    /// The host's own: how much of the ground is shown.
    scale: wgpu::Buffer,
}

impl Stage {
    fn new(gpu: &Gpu) -> Self {
        let mesh = cuboid(Vec3::splat(0.4)).mesh(&gpu.device);
        let place = Affine3A::from_translation(Vec3::new(0.3, 0.8, 0.2));
        let casters = [shadows::Caster::new(mesh, place)];
        let descriptor = CubeShadowMapDescriptor {
            size: 128,
            ..Default::default()
        };
        let light = PointLight::new(Vec3::new(0.0, 3.0, 0.0), 30.0);
        let sun = FlatLight::Directional(DirectionalLight::new(Vec3::new(0.6, 1.0, 0.2)));
        let descriptor_of_sun = ShadowMapDescriptor {
            size: 128,
            ..Default::default()
        };
        let mut map = ShadowMap::new(&gpu.device, &descriptor_of_sun).unwrap();
        map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(sun, &casters))
            .unwrap();
        gpu.run(|encoder| map.encode(encoder));
        let sampler = |kernel, map| {
            let descriptor = PcfDescriptor {
                kernel,
                map,
                ..Default::default()
            };
            PcfSampler::new(&gpu.device, &gpu.queue, &descriptor).unwrap()
        };
        Self {
            lamp: cubes::fresh(gpu, &descriptor, light, &casters),
            sun: map,
            disks: sampler(Kernel::Vogel(VogelDisk::default()), MapKind::CUBE),
            squares: sampler(Kernel::Weighted3, MapKind::FLAT),
            scale: gpu
                .device
                .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                    label: None,
                    contents: bytemuck::cast_slice(&[4.4_f32, 0.0, 0.0, 0.0]),
                    usage: wgpu::BufferUsages::UNIFORM,
                }),
        }
    }

    /// Both maps in groups of their own, after the host's.
    fn groups_of_their_own(&self, gpu: &Gpu) -> Vec<u8> {
        let modules = self.squares.wgsl_module(1) + &self.disks.wgsl_module(2);
        let layouts = [
            &host_layout(gpu, Vec::new()),
            self.squares.bind_group_layout(),
            self.disks.bind_group_layout(),
        ];
        let groups = [
            self.host_group(gpu, layouts[0], Vec::new()),
            self.squares.bind_group(&gpu.device, &self.sun).unwrap(),
            self.disks.bind_group(&gpu.device, &self.lamp).unwrap(),
        ];
        picture(gpu, &modules, ["", ""], &layouts, &groups)
    }

    /// Both in group 0, each after what stands before it. The sun first: Mesa 22.3's lavapipe ends in a
    /// segmentation fault where a loop depends on the fourth uniform buffer of a shader (docs/drivers.md).
    fn one_group(&self, gpu: &Gpu) -> Vec<u8> {
        let (sun, lamp) = (1, 1 + self.squares.layout_entries(0).len() as u32);
        let place = |first_binding, prefix| ModulePlace {
            group: 0,
            first_binding,
            prefix,
        };
        let modules = self.disks.wgsl_module_at(&place(lamp, "lamp_")).unwrap()
            + &self.squares.wgsl_module_at(&place(sun, "sun_")).unwrap();
        let mut entries = self.disks.layout_entries(lamp);
        entries.extend(self.squares.layout_entries(sun));
        let layout = host_layout(gpu, entries);
        let mut entries = self.disks.entries(&self.lamp, lamp).unwrap();
        entries.extend(self.squares.entries(&self.sun, sun).unwrap());
        let group = self.host_group(gpu, &layout, entries);
        picture(gpu, &modules, ["lamp_", "sun_"], &[&layout], &[group])
    }

    fn host_group<'a>(
        &'a self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        others: Vec<wgpu::BindGroupEntry<'a>>,
    ) -> wgpu::BindGroup {
        let mut entries = others;
        entries.push(wgpu::BindGroupEntry {
            binding: 0,
            resource: self.scale.as_entire_binding(),
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &entries,
        })
    }
}

fn host_layout(gpu: &Gpu, others: Vec<wgpu::BindGroupLayoutEntry>) -> wgpu::BindGroupLayout {
    let mut entries = others;
    entries.push(wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    });
    gpu.device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        })
}

/// The ground: red what the lamp lights, green what the sun does.
fn picture(
    gpu: &Gpu,
    modules: &str,
    [lamp, sun]: [&str; 2],
    layouts: &[&wgpu::BindGroupLayout],
    groups: &[wgpu::BindGroup],
) -> Vec<u8> {
    let module = format!("{modules}\n@group(0) @binding(0) var<uniform> scale: vec4f;");
    let show = format!(
        "let place = vec3f(unit.x, 0.0, unit.y) * scale.x;
        let lamp = {lamp}shadows_visibility(place, at.xy);
        return vec4f(lamp, {sun}shadows_flat_visibility(place), 0.0, 1.0);"
    );
    ground::picture(gpu, (&module, &show), layouts, groups)
}

#[test]
fn shadows_live_inside_a_group_of_the_hosts() {
    let Some(gpu) = Gpu::for_test() else { return };
    let stage = Stage::new(&gpu);
    let apart = stage.groups_of_their_own(&gpu);
    let together = stage.one_group(&gpu);
    assert!(apart == together);
    // Both cast, and not the same.
    for channel in [0, 1] {
        let dark = apart.iter().skip(channel).step_by(4);
        let dark = dark.filter(|&&lit| lit < 128).count();
        assert!((50..2000).contains(&dark), "{channel}: {dark}");
    }
    // The broken twin: each reads the other's map.
    let differ = apart.chunks_exact(4).filter(|pixel| pixel[0] != pixel[1]);
    assert!(differ.count() > 100);
}

#[test]
fn a_prefix_that_begins_no_name_is_refused() {
    let (device, queue) = crate::common::noop();
    let sampler = PcfSampler::new(&device, &queue, &PcfDescriptor::default()).unwrap();
    let module = |prefix| {
        sampler.wgsl_module_at(&ModulePlace {
            prefix,
            ..Default::default()
        })
    };
    assert_eq!(module("").unwrap(), sampler.wgsl_module(0));
    // One that has the words that it stands before.
    for prefix in ["a", "_9", "Shadows_shadows_"] {
        let text = module(prefix).unwrap();
        crate::common::validate(&text).unwrap();
        assert!(text.contains(&format!("fn {prefix}shadows_visibility(")));
        assert!(text.contains(&format!("struct {prefix}ShadowsLight ")));
    }
    for prefix in ["9", "__", "a-", "a b", "é", "a\n"] {
        assert_eq!(module(prefix).unwrap_err(), PcfError::Prefix, "{prefix}");
    }
}
