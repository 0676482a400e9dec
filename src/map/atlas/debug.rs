//! A debug view of the layers of an atlas.

use wgpu::util::DeviceExt as _;

use super::ShadowAtlas;
use crate::error::DebugPassError;
use crate::map::overlay::Overlay;
use crate::map::plan::{Place, Tile};
use crate::map::projection::TileProjection;
use crate::map::statistics::TileState;

const SHADER: &str = include_str!("../../../shaders/atlas_debug.wgsl");

/// Parameters of an [`AtlasDebug`].
#[derive(Clone, Debug)]
pub struct AtlasDebugDescriptor<'a> {
    /// Name shown in debuggers. Default none.
    pub label: Option<&'a str>,
    /// Format of the pass's only colour attachment. Default `Rgba8Unorm`.
    pub color_format: wgpu::TextureFormat,
    /// The pass's depth-stencil format, if it has one; neither tested nor written. Default `None`.
    pub depth_stencil_format: Option<wgpu::TextureFormat>,
    /// Samples of the pass, 1 or 4. Default 1.
    pub sample_count: u32,
}

impl Default for AtlasDebugDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            color_format: wgpu::TextureFormat::Rgba8Unorm,
            depth_stencil_format: None,
            sample_count: 1,
        }
    }
}

/// Draws all tiles of an atlas into a host's pass, to show their content.
///
/// The viewport is divided into equal cells, one per layer, row by row, with as many columns as rows or one
/// more. Each shows the layer's tiles in their places. White is at the light, black at its range or beyond
/// (along the tile's axis), and dark blue where there is no caster; areas without a tile are left untouched.
/// The outline shows the tile's state after the last `prepare`: orange rendered, green kept, grey empty, blue
/// hidden, red postponed ([`TileState`](crate::TileState)).
#[derive(Debug)]
pub struct AtlasDebug {
    label: String,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    shown: Option<Shown>,
}

/// The tiles of one frame.
#[derive(Debug)]
struct Shown {
    group: wgpu::BindGroup,
    instances: wgpu::Buffer,
    count: u32,
}

/// `Tile` in WGSL.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Instance {
    corners: [f32; 4],
    texels: [f32; 4],
    outline: [f32; 4],
}

impl AtlasDebug {
    /// Creates the pipeline.
    ///
    /// # Errors
    /// [`DebugPassError`] if a format or the sample count of the pass does not fit.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &AtlasDebugDescriptor<'_>,
    ) -> Result<Self, DebugPassError> {
        let label = match descriptor.label {
            Some(label) => format!("shadows atlas debug {label}"),
            None => "shadows atlas debug".to_owned(),
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some(&label),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            }],
        });
        Ok(Self {
            pipeline: pipeline(device, &label, &layout, descriptor)?,
            layout,
            label,
            shown: None,
        })
    }

    /// Reads the layout of the tiles from the last `prepare` of an atlas. To be called each frame, before
    /// [`render`](Self::render).
    pub fn prepare(&mut self, device: &wgpu::Device, atlas: &ShadowAtlas) {
        let instances = atlas.debug_instances();
        if instances.is_empty() {
            self.shown = None;
            return;
        }
        self.shown = Some(Shown {
            group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&self.label),
                layout: &self.layout,
                entries: &[wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(atlas.view()),
                }],
            }),
            instances: device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(&self.label),
                contents: bytemuck::cast_slice(&instances),
                usage: wgpu::BufferUsages::VERTEX,
            }),
            count: instances.len() as u32,
        });
    }

    /// Draws into the pass's viewport, after the atlas was encoded. Replaces the pass's pipeline, bind group
    /// 0 and vertex buffer 0.
    pub fn render(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Some(shown) = &self.shown else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &shown.group, &[]);
        pass.set_vertex_buffer(0, shown.instances.slice(..));
        pass.draw(0..4, 0..shown.count);
    }
}

impl ShadowAtlas {
    /// All tiles that lie in a layer.
    fn debug_instances(&self) -> Vec<Instance> {
        let layers = self.gpu.texture().layers().max(1);
        let columns = (1..).find(|&n| n * n >= layers).unwrap_or(1);
        let grid = [columns, layers.div_ceil(columns)].map(|count| count as f32);
        let mut instances = Vec::new();
        for (index, slot) in self.slots.iter().enumerate() {
            let tiles = self.residents.places(index).iter().zip(&slot.tiles);
            for (number, (place, tile)) in tiles.enumerate() {
                let state = self.plans.get(index).map(|plan| plan.state(slot, number));
                let near_per_range = self.near_per_range(tile, slot.projection(number));
                let [r, g, b] = outline(state.unwrap_or_default());
                instances.push(Instance {
                    corners: corners(place, self.layer_size, columns, grid),
                    texels: [place.x, place.y, place.size, place.layer].map(|n| n as f32),
                    outline: [r, g, b, near_per_range],
                });
            }
        }
        instances
    }

    /// By which depths are read; 0 for parallel rays.
    fn near_per_range(&self, tile: &Tile, next: Option<TileProjection>) -> f32 {
        match tile.shown.or(next) {
            Some(TileProjection::Face(light)) => {
                self.gpu.near_plane().of_point(&light) / light.range
            }
            Some(TileProjection::Flat(frame)) if frame.perspective => frame.near / frame.range,
            _ => 0.0,
        }
    }
}

/// Where a tile is in the viewport: left and top, right and bottom in clip space.
fn corners(place: &Place, layer_size: u32, columns: u32, [across, down]: [f32; 2]) -> [f32; 4] {
    let (column, row) = (place.layer % columns, place.layer / columns);
    let within = |texel: u32| texel as f32 / layer_size as f32;
    let x = |texel| (column as f32 + within(texel)) * 2.0 / across - 1.0;
    let y = |texel| 1.0 - (row as f32 + within(texel)) * 2.0 / down;
    let (right, bottom) = (place.x + place.size, place.y + place.size);
    [x(place.x), y(place.y), x(right), y(bottom)]
}

fn outline(state: TileState) -> [f32; 3] {
    match state {
        TileState::Rendered => [1.0, 0.55, 0.0],
        TileState::Kept => [0.1, 0.7, 0.2],
        TileState::Empty => [0.45, 0.45, 0.45],
        TileState::Hidden => [0.2, 0.4, 1.0],
        TileState::Postponed => [0.9, 0.1, 0.1],
    }
}

fn pipeline(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    descriptor: &AtlasDebugDescriptor<'_>,
) -> Result<wgpu::RenderPipeline, DebugPassError> {
    let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4];
    let overlay = Overlay {
        label,
        shader: SHADER,
        layout,
        buffers: &[Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Instance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &attributes,
        })],
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        constants: &[],
        format: descriptor.color_format,
        depth_stencil: descriptor.depth_stencil_format,
        samples: descriptor.sample_count,
    };
    overlay.pipeline(device)
}
