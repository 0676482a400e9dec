//! Features and usages by their names in wgpu.

/// A set of flags that can name its members.
pub(super) trait Named: Copy {
    fn each(self) -> Vec<&'static str>;
}

impl Named for wgpu::Features {
    fn each(self) -> Vec<&'static str> {
        self.iter_names().map(|(name, _)| name).collect()
    }
}

impl Named for wgpu::BufferUsages {
    fn each(self) -> Vec<&'static str> {
        self.iter_names().map(|(name, _)| name).collect()
    }
}

impl Named for wgpu::TextureUsages {
    fn each(self) -> Vec<&'static str> {
        self.iter_names().map(|(name, _)| name).collect()
    }
}

/// As they are written in a host's code: `STORAGE | VERTEX`.
pub(super) fn names(flags: impl Named) -> String {
    match &flags.each()[..] {
        [] => "none".to_owned(),
        names => names.join(" | "),
    }
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn flags_are_named_as_a_host_writes_them() {
        let feature = wgpu::Features::DEPTH_CLIP_CONTROL | wgpu::Features::FLOAT32_BLENDABLE;
        assert_eq!(names(feature), "DEPTH_CLIP_CONTROL | FLOAT32_BLENDABLE");
        assert_eq!(names(wgpu::BufferUsages::STORAGE), "STORAGE");
        assert_eq!(names(wgpu::TextureUsages::empty()), "none");
    }
}
