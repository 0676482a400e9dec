//! The bindings of a sampler, and their place in a host's shader.

use crate::error::PcfError;

/// The resources of a sampler and a map, in the order of their bindings.
pub(super) struct Bound<'a> {
    pub map: &'a wgpu::TextureView,
    pub sampler: &'a wgpu::Sampler,
    pub lights: wgpu::BindingResource<'a>,
    /// Only disks have them.
    pub parameters: Option<&'a wgpu::Buffer>,
    pub offsets: Option<&'a wgpu::TextureView>,
}

impl<'a> Bound<'a> {
    /// As entries of a bind group, from `first` on.
    pub fn entries(self, first: u32) -> Vec<wgpu::BindGroupEntry<'a>> {
        let resources = [
            Some(wgpu::BindingResource::TextureView(self.map)),
            Some(wgpu::BindingResource::Sampler(self.sampler)),
            Some(self.lights),
            self.parameters.map(wgpu::Buffer::as_entire_binding),
            self.offsets.map(wgpu::BindingResource::TextureView),
        ];
        (first..)
            .zip(resources.into_iter().flatten())
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect()
    }
}

/// The place of a sampler's module in a host's shader:
/// [`PcfSampler::wgsl_module_at`](crate::PcfSampler::wgsl_module_at).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ModulePlace<'a> {
    /// The bind group. Default 0.
    pub group: u32,
    /// The first of its bindings in that group; the others follow. Default 0.
    pub first_binding: u32,
    /// A prefix for every name: letters, digits and underscores, not starting with a digit or with two
    /// underscores. Default none.
    pub prefix: &'a str,
}

impl<'a> ModulePlace<'a> {
    pub(super) fn validated_prefix(&self) -> Result<&'a str, PcfError> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let prefix = self.prefix;
        let begins_well =
            !prefix.starts_with(|c: char| c.is_ascii_digit()) && !prefix.starts_with("__");
        match prefix.chars().all(is_word) && begins_well {
            true => Ok(prefix),
            false => Err(PcfError::Prefix),
        }
    }
}
