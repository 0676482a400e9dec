//! What a host uploads.

use glam::Vec3;
use shadows::reference::bake::{BakedLight, LightMap, TexelRectangle};
use shadows::{PointLight, glam, wgpu};

use super::yard::Yard;
use crate::common::noop;

#[test]
fn bytes_are_what_the_map_says() {
    let yard = Yard::new(32);
    let map = yard.bake(&BakedLight::new(yard.lamp()), 16);
    let other = yard.bake(&BakedLight::new(PointLight::new(Vec3::Y * 9.0, 40.0)), 16);
    let (r8, r32) = (map.r8(), map.r32());
    let rgba = LightMap::rgba8(&[&map, &other]).unwrap();
    assert_eq!(
        [r8.bytes_per_row, r32.bytes_per_row, rgba.bytes_per_row],
        [128, 512, 512]
    );
    let floats: &[f32] = bytemuck::cast_slice(&r32.bytes);
    assert_eq!(floats, map.visibility());
    let mut between = 0;
    for place in 0..map.visibility().len() {
        let [own, others] = [&map, &other].map(|map| 255.0 * map.visibility()[place]);
        assert!((own - f32::from(r8.bytes[place])).abs() <= 0.5);
        let [r, g, b, a] = [0, 1, 2, 3].map(|k| rgba.bytes[4 * place + k]);
        assert_eq!((r, b, a), (r8.bytes[place], 255, 255));
        assert!((others - f32::from(g)).abs() <= 0.5);
        between += usize::from((1..255).contains(&r));
    }
    assert!(between > 50, "{between} edges");
    assert_ne!(map.visibility(), other.visibility());
}

#[test]
fn maps_of_the_same_texels_are_equal_however_long_they_took() {
    let yard = Yard::new(8);
    let light = BakedLight::new(yard.lamp());
    let map = yard.bake(&light, 4);
    let again = (0..100).map(|_| yard.bake(&light, 4));
    let other = again
        .into_iter()
        .find(|again| again.seconds() != map.seconds());
    assert_eq!(
        map,
        other.expect("100 bakes of the same time in nanoseconds")
    );
    assert_ne!(map, yard.bake(&light, 5));
    assert_ne!(map, Yard::new(9).bake(&light, 4));
}

/// wgpu's own validation takes format, size and layout of each as they are, down to the last mip level.
#[test]
fn images_fit_their_textures() {
    let (device, queue) = noop();
    let yard = Yard::new(35);
    let first = yard.bake(&BakedLight::new(yard.lamp()), 1);
    let levels = std::iter::successors(Some(first), LightMap::half);
    let levels: Vec<LightMap> = levels.collect();
    assert_eq!(levels.len(), 8, "140 texels to 1");
    let images =
        [LightMap::r8, LightMap::r32].map(|image| -> Vec<_> { levels.iter().map(image).collect() });
    for levels in images {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: levels[0].size,
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: levels[0].format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let write = |level: usize, bytes: &[u8]| {
            let to = wgpu::TexelCopyTextureInfo {
                mip_level: level as u32,
                ..texture.as_image_copy()
            };
            let image = &levels[level];
            crate::common::validation_error(&device, || {
                queue.write_texture(to, bytes, image.layout(), image.size);
            })
        };
        for (level, image) in levels.iter().enumerate() {
            assert_eq!(write(level, &image.bytes), None);
        }
        // The twin: a level with the bytes of a smaller one.
        assert!(write(0, &levels[1].bytes).is_some());
    }
}

#[test]
fn a_rectangle_is_a_scale_and_an_offset() {
    let rectangle = TexelRectangle {
        x: 32,
        y: 8,
        width: 16,
        height: 4,
    };
    assert_eq!(rectangle.scale_and_offset([64, 16]), [0.25, 0.25, 0.5, 0.5]);
}
