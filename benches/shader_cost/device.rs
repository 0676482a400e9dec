//! A device that compiles and does nothing else: RADV's null winsys (`RADV_FORCE_FAMILY`).
//!
//! wgpu cannot make its device there (it has no memory to give), so this speaks Vulkan itself.

use std::collections::BTreeMap;
use std::ffi::CStr;

use anyhow::{Context as _, Result};
use ash::{khr, vk};

pub struct Device {
    // Unloads the driver when it goes.
    _entry: ash::Entry,
    pub raw: ash::Device,
    executables: khr::pipeline_executable_properties::Device,
    pub name: String,
    pub driver: String,
}

/// One stage as the driver compiled it.
#[derive(Debug, Default, Clone)]
pub struct Stage {
    pub name: String,
    statistics: BTreeMap<String, u32>,
    pub assembly: String,
}

impl Stage {
    pub fn statistic(&self, name: &str) -> Result<u32> {
        self.statistics
            .get(name)
            .copied()
            .with_context(|| format!("the driver states no {name:?}"))
    }
}

/// The characters before the zero.
fn text(chars: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = chars.iter().map(|&c| c as u8).collect();
    CStr::from_bytes_until_nul(&bytes)
        .map(|text| text.to_string_lossy().into_owned())
        .unwrap_or_default()
}

impl Device {
    pub fn new() -> Result<Self> {
        // SAFETY: the loader's library is a Vulkan loader, every structure lives through its call, and
        // the features and extensions asked for are RADV's.
        unsafe {
            let entry = ash::Entry::load()?;
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let instance = entry.create_instance(
                &vk::InstanceCreateInfo::default().application_info(&application),
                None,
            )?;
            let physical = instance.enumerate_physical_devices()?;
            let physical = *physical.first().context("no device")?;
            let mut driver = vk::PhysicalDeviceDriverProperties::default();
            let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
            instance.get_physical_device_properties2(physical, &mut properties);
            let name = text(&properties.properties.device_name);
            let raw = create(&instance, physical)?;
            let executables = khr::pipeline_executable_properties::Device::new(&instance, &raw);
            let driver = text(&driver.driver_info);
            Ok(Self {
                _entry: entry,
                raw,
                executables,
                name,
                driver,
            })
        }
    }

    /// `22.3.6` of `Mesa 22.3.6`.
    pub fn mesa_version(&self) -> Option<&str> {
        self.driver.split_whitespace().nth(1)
    }

    /// The stages of a pipeline that was made with its statistics and representations captured.
    pub fn stages(&self, pipeline: vk::Pipeline) -> Result<Vec<Stage>> {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline is this device's, and the indices are those it was said to have.
        unsafe {
            let executables = self.executables.get_pipeline_executable_properties(&info)?;
            (0..)
                .zip(&executables)
                .map(|(index, executable)| {
                    let of = vk::PipelineExecutableInfoKHR::default()
                        .pipeline(pipeline)
                        .executable_index(index);
                    let statistics = self.executables.get_pipeline_executable_statistics(&of)?;
                    Ok(Stage {
                        name: text(&executable.name),
                        statistics: statistics
                            .iter()
                            .map(|s| (text(&s.name), value(s)))
                            .collect(),
                        assembly: self.assembly(&of)?,
                    })
                })
                .collect()
        }
    }

    /// By hand: ash's helper leaves no room for the texts.
    unsafe fn assembly(&self, of: &vk::PipelineExecutableInfoKHR<'_>) -> Result<String> {
        let get = self
            .executables
            .fp()
            .get_pipeline_executable_internal_representations_khr;
        let handle = self.raw.handle();
        let mut count = 0;
        // SAFETY: called first for the count, then for the sizes, then with room of those sizes.
        unsafe {
            get(handle, of, &mut count, std::ptr::null_mut()).result()?;
            let mut list =
                vec![vk::PipelineExecutableInternalRepresentationKHR::default(); count as usize];
            get(handle, of, &mut count, list.as_mut_ptr()).result()?;
            let mut room: Vec<Vec<u8>> =
                list.iter().map(|entry| vec![0; entry.data_size]).collect();
            for (entry, room) in list.iter_mut().zip(&mut room) {
                entry.p_data = room.as_mut_ptr().cast();
            }
            get(handle, of, &mut count, list.as_mut_ptr()).result()?;
            let found = list
                .iter()
                .zip(&room)
                .find(|(entry, _)| text(&entry.name).contains("ssembly"));
            let (_, text) = found.context("no assembly")?;
            Ok(String::from_utf8_lossy(text)
                .trim_end_matches('\0')
                .to_owned())
        }
    }
}

fn value(statistic: &vk::PipelineExecutableStatisticKHR<'_>) -> u32 {
    // SAFETY: the format says which of the union's fields is there.
    unsafe {
        match statistic.format {
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => statistic.value.u64 as u32,
            vk::PipelineExecutableStatisticFormatKHR::INT64 => statistic.value.i64 as u32,
            vk::PipelineExecutableStatisticFormatKHR::FLOAT64 => statistic.value.f64 as u32,
            _ => statistic.value.b32,
        }
    }
}

/// A device with the features that wgpu-hal asks of RADV.
unsafe fn create(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<ash::Device> {
    let mut executable = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
        .pipeline_executable_info(true);
    let mut robustness = vk::PhysicalDeviceRobustness2FeaturesEXT::default()
        .robust_buffer_access2(true)
        .robust_image_access2(true);
    let mut v11 = vk::PhysicalDeviceVulkan11Features::default().multiview(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .robust_image_access(true)
        .subgroup_size_control(true)
        .shader_zero_initialize_workgroup_memory(true)
        .dynamic_rendering(true);
    let features = vk::PhysicalDeviceFeatures::default()
        .robust_buffer_access(true)
        .depth_clamp(true)
        .sample_rate_shading(true)
        .vertex_pipeline_stores_and_atomics(true)
        .fragment_stores_and_atomics(true);
    let extensions = [
        khr::pipeline_executable_properties::NAME.as_ptr(),
        ash::ext::robustness2::NAME.as_ptr(),
    ];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(0)
        .queue_priorities(&[1.0])];
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&features)
        .push_next(&mut executable)
        .push_next(&mut robustness)
        .push_next(&mut v11)
        .push_next(&mut v13);
    // SAFETY: the caller's.
    Ok(unsafe { instance.create_device(physical, &info, None)? })
}
