//! What maps of all kinds have in common: what is out of range there, each refuses in the same words.

use crate::common::noop;
use shadows::error::{
    BiasError, CubeShadowMapError, MapSettingsError, ShadowAtlasError, ShadowMapError,
};
use shadows::{
    Bias, CasterSides, CubeShadowMap, CubeShadowMapDescriptor, MapSettings, Radius, ShadowAtlas,
    ShadowAtlasDescriptor, ShadowMap, ShadowMapDescriptor, wgpu,
};

/// What a cube map, a flat map and an atlas say of it.
fn said(settings: MapSettings) -> [Option<MapSettingsError>; 3] {
    let (device, _) = noop();
    let cube = CubeShadowMapDescriptor {
        size: 16,
        settings,
        ..Default::default()
    };
    let flat = ShadowMapDescriptor {
        size: 16,
        settings,
        ..Default::default()
    };
    let atlas = ShadowAtlasDescriptor {
        settings,
        ..Default::default()
    };
    let of_cube = |error| match error {
        CubeShadowMapError::Settings(error) => error,
        other => panic!("{other}"),
    };
    let of_flat = |error| match error {
        ShadowMapError::Settings(error) => error,
        other => panic!("{other}"),
    };
    let of_atlas = |error| match error {
        ShadowAtlasError::Settings(error) => error,
        other => panic!("{other}"),
    };
    [
        CubeShadowMap::new(&device, &cube).err().map(of_cube),
        ShadowMap::new(&device, &flat).err().map(of_flat),
        ShadowAtlas::new(&device, &atlas).err().map(of_atlas),
    ]
}

/// The same of all three; errors as they are told, for a NaN is equal to none.
fn refused(settings: MapSettings) -> MapSettingsError {
    let [first, second, third] = said(settings).map(|error| error.expect("it must be refused"));
    assert_eq!(first.to_string(), second.to_string());
    assert_eq!(first.to_string(), third.to_string());
    first
}

#[test]
fn formats_that_no_map_can_have_are_refused() {
    for format in [
        wgpu::TextureFormat::Rgba8Unorm,
        wgpu::TextureFormat::Stencil8,
        wgpu::TextureFormat::Depth24PlusStencil8,
    ] {
        let settings = MapSettings {
            format,
            ..Default::default()
        };
        assert_eq!(refused(settings), MapSettingsError::Format(format));
    }
}

#[test]
fn a_reach_out_of_range_is_refused() {
    for reach in [
        Radius::Texels(0.0),
        Radius::Texels(64.5),
        Radius::World(-1.0),
        Radius::World(f32::INFINITY),
        Radius::World(f32::NAN),
    ] {
        let settings = MapSettings {
            reach,
            ..Default::default()
        };
        let told = refused(settings).to_string();
        assert!(told.starts_with(&format!("the reach {reach:?}")), "{told}");
    }
}

#[test]
fn a_bias_out_of_range_is_refused_by_the_name_of_its_field() {
    for value in [-1.0, f32::INFINITY] {
        let settings = MapSettings {
            bias: Bias {
                constant: value,
                ..Bias::default()
            },
            ..Default::default()
        };
        let MapSettingsError::Bias(BiasError {
            field, value: told, ..
        }) = refused(settings)
        else {
            panic!("the bias is what is wrong");
        };
        assert_eq!((field, told), ("constant", value));
    }
}

/// The broken twin of all of the above: what is in range, nobody refuses.
#[test]
fn what_is_in_range_is_taken() {
    let formats = [
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureFormat::Depth24Plus,
        wgpu::TextureFormat::Depth16Unorm,
    ];
    let reaches = [
        Radius::Texels(64.0),
        Radius::Texels(0.5),
        Radius::World(2.0),
    ];
    let sides = [CasterSides::Nearest, CasterSides::Both, CasterSides::Far];
    let biases = [Bias::default(), Bias::NONE, Bias::default()];
    for (((format, reach), sides), bias) in formats.into_iter().zip(reaches).zip(sides).zip(biases)
    {
        let settings = MapSettings {
            format,
            bias,
            sides,
            reach,
        };
        assert_eq!(said(settings), [None; 3], "{settings:?}");
    }
}
