// What the advice of `compare --sweep` says; see sweep.rs beside it.
vec![
("cube-2x2 4096", {
let map = CubeShadowMapDescriptor {
    size: 4096,
    ..Default::default()
};
let sampler = PcfDescriptor::default();
Config::Cube { map, sampler }
}),
("cube-7x7 256", {
let map = CubeShadowMapDescriptor {
    size: 256,
    ..Default::default()
};
let sampler = PcfDescriptor {
    kernel: Kernel::Weighted7,
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-disk 512", {
let map = CubeShadowMapDescriptor {
    size: 512,
    ..Default::default()
};
let sampler = PcfDescriptor {
    kernel: Kernel::RandomDisk(RandomDisk { radius: Radius::Texels(3.0), around: 8, rings: 4, size: 8, early_out: true }),
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-vogel 1024", {
let map = CubeShadowMapDescriptor::default();
let sampler = PcfDescriptor {
    kernel: Kernel::Vogel(VogelDisk { radius: Radius::Texels(3.0), taps: 16 }),
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-pcss 2048", {
let map = CubeShadowMapDescriptor {
    size: 2048,
    ..Default::default()
};
let sampler = PcfDescriptor {
    kernel: Kernel::ContactHardening(ContactHardening { light_size: 0.1, max_radius: Radius::Texels(12.0), search_taps: 16, taps: 32 }),
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-textbook 512", {
let map = CubeShadowMapDescriptor {
    size: 512,
    encoding: DepthEncoding::LinearDistance,
    settings: MapSettings {
        bias: Bias { normal_offset: 0.0, constant: 0.0, slope_scale: 0.0, position_ulps: 0.0 },
        sides: CasterSides::Both,
        ..Default::default()
    },
    cull_casters: false,
    ..Default::default()
};
let sampler = PcfDescriptor {
    kernel: Kernel::Hard,
    map: MapKind::Cube(DepthEncoding::LinearDistance),
    textbook: true,
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-2x2 1024, linear 16 bits", {
let map = CubeShadowMapDescriptor {
    encoding: DepthEncoding::LinearDistance,
    settings: MapSettings {
        format: wgpu::TextureFormat::Depth16Unorm,
        ..Default::default()
    },
    ..Default::default()
};
let sampler = PcfDescriptor {
    map: MapKind::Cube(DepthEncoding::LinearDistance),
    ..Default::default()
};
Config::Cube { map, sampler }
}),
("cube-2x2 1024, fourfold bias", {
let map = CubeShadowMapDescriptor {
    settings: MapSettings {
        bias: Bias { normal_offset: 0.4, constant: 0.2, slope_scale: 0.0, position_ulps: 4.0 },
        ..Default::default()
    },
    ..Default::default()
};
let sampler = PcfDescriptor::default();
Config::Cube { map, sampler }
}),
("cube-2x2 1024, far sides", {
let map = CubeShadowMapDescriptor {
    settings: MapSettings {
        sides: CasterSides::Far,
        ..Default::default()
    },
    ..Default::default()
};
let sampler = PcfDescriptor::default();
Config::Cube { map, sampler }
}),
("flat-disk-full 256", {
let map = ShadowMapDescriptor {
    size: 256,
    ..Default::default()
};
let sampler = PcfDescriptor {
    kernel: Kernel::RandomDisk(RandomDisk { radius: Radius::Texels(3.0), around: 8, rings: 4, size: 8, early_out: false }),
    map: MapKind::FLAT,
    ..Default::default()
};
Config::Flat { map, sampler }
}),
("volume z-fail, vertex", {
let volumes = ShadowVolumeDescriptor {
    method: Method::ZFail,
    silhouettes: Silhouettes::Vertex,
    ..Default::default()
};
Config::Volume(volumes)
}),
("volume-textbook", {
let volumes = ShadowVolumeDescriptor {
    method: Method::ZFail,
    caps: Caps::Full,
    extrusion: Extrusion::Infinite,
    culling: false,
    ..Default::default()
};
Config::Volume(volumes)
}),
]
