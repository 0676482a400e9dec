//! A device without a window: how the examples, tests and benches get one, wait and read back.

use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, bail};
use shadows::{Support, wgpu};

/// A device, its queue and where they came from.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub info: wgpu::AdapterInfo,
    pub support: Support,
}

/// Set where a driver must be there (in CI): then tests fail instead of skipping.
pub const REQUIRE: &str = "SHADOWS_REQUIRE_GPU";

impl Gpu {
    /// The first adapter whose name, driver or back end contains `wanted` (any case); without
    /// `wanted`, a real GPU before a software driver and Vulkan before GL.
    pub fn new(wanted: Option<&str>) -> Result<Self> {
        pollster::block_on(Self::request(wanted, wgpu::Features::empty()))
    }

    /// For tests: a device, or `None` (said on stderr) where no driver is installed and none is
    /// required.
    pub fn for_test() -> Option<Self> {
        Self::for_test_without(wgpu::Features::empty())
    }

    /// The same without some of the device's features, as if it did not have them.
    pub fn for_test_without(features: wgpu::Features) -> Option<Self> {
        let wanted = std::env::var("SHADOWS_TEST_ADAPTER").ok();
        match pollster::block_on(Self::request(wanted.as_deref(), features)) {
            Ok(gpu) => Some(gpu),
            Err(error) if std::env::var_os(REQUIRE).is_some() => {
                panic!("{REQUIRE} is set, but: {error:#}")
            }
            Err(_) => {
                eprintln!("skipped: no adapter");
                None
            }
        }
    }

    async fn request(wanted: Option<&str>, refused: wgpu::Features) -> Result<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        adapters.sort_by_key(|adapter| preference(&adapter.get_info()));
        let names: Vec<String> = adapters.iter().map(|a| describe(&a.get_info())).collect();
        let chosen = adapters.into_iter().find(|adapter| match wanted {
            None => true,
            Some(part) => describe(&adapter.get_info())
                .to_lowercase()
                .contains(&part.to_lowercase()),
        });
        let Some(adapter) = chosen else {
            match wanted {
                Some(part) if !names.is_empty() => {
                    bail!(
                        "no adapter matches {part:?}; there are: {}",
                        names.join("; ")
                    )
                }
                _ => bail!(
                    "no GPU and no software driver found; on Debian and Ubuntu: apt-get install mesa-vulkan-drivers libvulkan1"
                ),
            }
        };
        let support = Support::of_adapter(&adapter);
        // For timing, for every kind of layered target, and for trying other arithmetic in shaders.
        let tools = adapter.features()
            & (wgpu::Features::TIMESTAMP_QUERY
                | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS
                | wgpu::Features::SELECTIVE_MULTIVIEW
                | wgpu::Features::MULTISAMPLE_ARRAY
                | wgpu::Features::SHADER_F64);
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("headless"),
                required_features: (support.features() | tools) - refused,
                required_limits: support.limits(),
                ..Default::default()
            })
            .await
            .context("the adapter refuses a device")?;
        Ok(Self {
            device,
            queue,
            info: adapter.get_info(),
            support,
        })
    }

    /// How far the places are apart to which the driver moves vertices, in pixels: Vulkan asks for 1/16 at
    /// most, GPUs have 1/256, and wgpu does not say.
    pub fn vertex_grid(&self) -> f64 {
        match self.info.name.contains("SwiftShader") {
            true => 1.0 / 16.0,
            false => 1.0 / 256.0,
        }
    }

    /// Records commands, submits them and waits; gives the time from submit to done.
    pub fn run(&self, record: impl FnOnce(&mut wgpu::CommandEncoder)) -> Duration {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        record(&mut encoder);
        let commands = encoder.finish();
        let start = Instant::now();
        self.queue.submit([commands]);
        self.wait();
        start.elapsed()
    }

    /// Waits until all that was submitted is done.
    pub fn wait(&self) {
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device was lost");
    }

    /// Runs `work` and panics with the message of any validation error it caused.
    pub fn checked<T>(&self, work: impl FnOnce() -> T) -> T {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = work();
        if let Some(error) = pollster::block_on(scope.pop()) {
            panic!("{error}");
        }
        result
    }

    /// A render target that can be read back.
    pub fn target(
        &self,
        size: [u32; 2],
        format: wgpu::TextureFormat,
        samples: u32,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("target"),
            size: wgpu::Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | if samples == 1 {
                    wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING
                } else {
                    wgpu::TextureUsages::empty()
                },
            view_formats: &[],
        })
    }

    /// One layer and aspect of a texture as tightly packed rows.
    pub fn read_texture(
        &self,
        texture: &wgpu::Texture,
        layer: u32,
        aspect: wgpu::TextureAspect,
    ) -> Vec<u8> {
        let bytes = texture
            .format()
            .block_copy_size(Some(aspect))
            .expect("this aspect cannot be copied");
        let row = texture.width() * bytes;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(padded) * u64::from(texture.height()),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        self.run(|encoder| {
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    texture,
                    mip_level: 0,
                    origin: wgpu::Origin3d {
                        z: layer,
                        ..Default::default()
                    },
                    aspect,
                },
                wgpu::TexelCopyBufferInfo {
                    buffer: &buffer,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset: 0,
                        bytes_per_row: Some(padded),
                        rows_per_image: None,
                    },
                },
                wgpu::Extent3d {
                    width: texture.width(),
                    height: texture.height(),
                    depth_or_array_layers: 1,
                },
            );
        });
        self.map(&buffer)
            .chunks(padded as usize)
            .flat_map(|padded| &padded[..row as usize])
            .copied()
            .collect()
    }

    /// The content of a buffer with the usage `COPY_SRC`.
    pub fn read_buffer(&self, source: &wgpu::Buffer) -> Vec<u8> {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: source.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        self.run(|encoder| encoder.copy_buffer_to_buffer(source, 0, &buffer, 0, source.size()));
        self.map(&buffer)
    }

    fn map(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        let slice = buffer.slice(..);
        slice.map_async(wgpu::MapMode::Read, |result| {
            result.expect("a readback buffer maps");
        });
        self.wait();
        slice
            .get_mapped_range()
            .expect("a readback buffer maps")
            .to_vec()
    }
}

/// Real GPUs first, then software drivers; Vulkan (or Metal, DX12) before GL.
fn preference(info: &wgpu::AdapterInfo) -> (u8, bool) {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    (kind, info.backend == wgpu::Backend::Gl)
}

/// One line that names an adapter.
pub fn describe(info: &wgpu::AdapterInfo) -> String {
    format!(
        "{} ({:?}, {} {})",
        info.name, info.backend, info.driver, info.driver_info
    )
}
