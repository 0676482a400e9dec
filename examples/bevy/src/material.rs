//! A material of Bevy's that reads the atlas: a colour, and what is shown, before the atlas's bindings in group 3.

use std::sync::OnceLock;

use bevy_app::{App, Plugin};
use bevy_asset::{Asset, Assets, Handle, uuid_handle};
use bevy_ecs::system::{SystemParamItem, lifetimeless::SRes};
use bevy_pbr::{Material, MaterialPlugin};
use bevy_reflect::TypePath;
use bevy_render::RenderApp;
use bevy_render::material_bind_groups::FallbackBuffer;
use bevy_render::render_asset::RenderAssets;
use bevy_render::render_resource::*;
use bevy_render::renderer::RenderDevice;
use bevy_render::storage::GpuShaderBuffer;
use bevy_shader::{Shader, ShaderRef};
use shadows::ModulePlace;
use shadows::glam::Vec3;

use crate::shadow::Shadows;

/// Where the atlas is bound: Bevy has groups 0 to 2, and its materials the last that there is.
const PLACE: ModulePlace<'_> = ModulePlace {
    group: 3,
    first_binding: 1,
    prefix: "",
};

/// Materials name their shader before there is a device.
const SHADER: Handle<Shader> = uuid_handle!("6a0e7c0e-3a52-4c8e-9d53-51f8a1b9f20b");
/// What `shadows` adds to the layout, which Bevy asks of the type and not of a value.
static LAYOUT: OnceLock<Vec<BindGroupLayoutEntry>> = OnceLock::new();

/// To be added after `ShadowPlugin`.
pub struct LitPlugin;

impl Plugin for LitPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(MaterialPlugin::<Lit>::default());
    }

    fn finish(&self, app: &mut App) {
        let shadows = app.sub_app(RenderApp).world().resource::<Shadows>();
        LAYOUT.get_or_init(|| shadows.sampler.layout_entries(PLACE.first_binding));
        let module = shadows.sampler.wgsl_module_at(&PLACE);
        let source = module.expect("no prefix") + include_str!("lit.wgsl");
        let shader = Shader::from_wgsl(source, "lit.wgsl");
        let mut shaders = app.world_mut().resource_mut::<Assets<Shader>>();
        shaders.insert(&SHADER, shader).expect("a name of its own");
    }
}

#[derive(Asset, TypePath, Clone)]
pub struct Lit {
    pub color: Vec3,
    /// 0 the scene, above that the visibility of a light alone.
    pub shown: u32,
}

impl Material for Lit {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }

    /// Bevy's own.
    fn enable_shadows() -> bool {
        false
    }
}

impl AsBindGroup for Lit {
    type Data = ();
    type Param = SRes<Shadows>;

    fn label() -> &'static str {
        "lit"
    }

    fn bind_group_data(&self) {}

    fn bind_group_layout_entries(_: &RenderDevice, _: bool) -> Vec<BindGroupLayoutEntry> {
        let own = BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let shadows = LAYOUT.get().expect("the plugin has finished");
        std::iter::once(own)
            .chain(shadows.iter().copied())
            .collect()
    }

    fn build_bind_group(
        &self,
        _: &BindGroupLayout,
        _: &RenderDevice,
        _: &mut SystemParamItem<'_, '_, Self::Param>,
        _: bool,
        _: &mut BindGroupBuilder,
    ) -> Result<(), AsBindGroupError> {
        Err(AsBindGroupError::CreateBindGroupDirectly)
    }

    fn as_bind_group(
        &self,
        layout: &BindGroupLayoutDescriptor,
        device: &RenderDevice,
        pipelines: &PipelineCache,
        _: &FallbackBuffer,
        _: &RenderAssets<GpuShaderBuffer>,
        shadows: &mut SystemParamItem<'_, '_, Self::Param>,
    ) -> Result<PreparedBindGroup, AsBindGroupError> {
        // The lights' sizes are fixed: after the first frame the atlas has the texture that it keeps.
        if shadows.atlas.statistics().layers == 0 {
            return Err(AsBindGroupError::RetryNextUpdate);
        }
        let values = [self.color.x, self.color.y, self.color.z, self.shown as f32];
        let buffer = device.create_buffer_with_data(&BufferInitDescriptor {
            label: Some("lit"),
            contents: bytemuck::cast_slice(&values),
            usage: BufferUsages::UNIFORM,
        });
        let own = BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        };
        let entries = shadows.sampler.entries(&shadows.atlas, PLACE.first_binding);
        let mut entries = entries.expect("the sampler reads atlases");
        entries.insert(0, own);
        let layout = pipelines.get_bind_group_layout(layout);
        Ok(PreparedBindGroup {
            bindings: BindingResources(Vec::new()),
            bind_group: device.create_bind_group(Self::label(), &layout, &entries),
        })
    }
}
