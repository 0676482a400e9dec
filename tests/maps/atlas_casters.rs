//! Which casters a light of an atlas casts the shadows of, and those that only the host can draw.

use std::num::NonZeroU32;

use crate::atlas::{assert_few, atlas, descriptor, draw, layers, room, texels, wrong_texels};
use crate::common::own_pass::OwnPass;
use crate::common::shapes::{Shape, sphere};
use glam::{Affine3A, Vec3};
use host::gpu::Gpu;
use shadows::error::CasterMeshError;
use shadows::mesh::Bounds;
use shadows::{
    AtlasFrame, AtlasLight, Caster, CasterMesh, CubeFrame, CubeShadowMap, HostDraw, PointLight,
    ShadowAtlas, ShadowAtlasDescriptor, ShadowFrame, ShadowMap, SpotLight, StaticLayers, TileSize,
    glam, wgpu,
};

fn lamp() -> AtlasLight {
    AtlasLight::new(PointLight::new(Vec3::new(0.2, 0.1, 0.3), 7.0)).with_size(TileSize::Fixed(64))
}

#[test]
fn lights_and_casters_meet_on_layers() {
    let Some(gpu) = Gpu::for_test() else { return };
    let mut casters = room(&gpu);
    for (i, caster) in casters.iter_mut().enumerate() {
        caster.layers = 1 << (i % 3);
    }
    let lights = [lamp().with_layers(0b011), lamp().with_layers(0b100)];
    let mut atlas = atlas(&gpu, &descriptor(2));
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    let of = |layers: u32| -> Vec<Caster> {
        let on = casters.iter().filter(|caster| caster.layers & layers != 0);
        on.cloned().collect()
    };
    let check = |atlas: &ShadowAtlas, light: usize, casters: &[Caster]| {
        let others = AtlasLight::new(PointLight::new(Vec3::splat(1e4), 1.0));
        let mut lights = [others; 2];
        lights[light] = lamp();
        wrong_texels(&gpu, atlas, &lights[light..=light], casters)
    };
    assert_few(check(&atlas, 0, &of(0b011)), "the first light");
    // The broken twin: all casters on it.
    assert!(check(&atlas, 0, &casters).0 > 100);

    // A mask that changes has its light drawn anew, and no other.
    let lights = [lamp().with_layers(0b111), lights[1]];
    let frame = AtlasFrame {
        lights: &lights,
        ..frame
    };
    draw(&gpu, &mut atlas, &frame);
    assert_few(
        check(&atlas, 0, &casters),
        "the first light with all layers",
    );
    assert!((1..=6).contains(&atlas.statistics().tiles_rendered));
}

#[test]
fn a_lamp_shines_out_of_its_own_shade() {
    let Some(gpu) = Gpu::for_test() else { return };
    let owner = NonZeroU32::new(7).unwrap();
    let others = room(&gpu);
    let shade = Affine3A::from_scale(Vec3::splat(0.6));
    let mut shade = sphere(6, 9).caster(&gpu.device, shade);
    shade.owner = Some(owner);
    let casters = [&others[..], &[shade]].concat();
    let lights = [lamp().owned_by(owner)];
    let mut atlas = atlas(&gpu, &descriptor(2));
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw(&gpu, &mut atlas, &frame);
    assert_few(
        wrong_texels(&gpu, &atlas, &lights, &others),
        "without its shade",
    );
    // The broken twin: nobody's shade is in the way.
    assert!(wrong_texels(&gpu, &atlas, &lights, &casters).0 > 10_000);
}

/// A shape that the host draws, and the same as a mesh of ours.
struct Leaf {
    shape: Shape,
    mesh: CasterMesh,
    own: Caster,
}

impl Leaf {
    fn new(gpu: &Gpu) -> Self {
        let shape = sphere(6, 9);
        let bounds = Bounds {
            min: Vec3::splat(-1.0),
            max: Vec3::ONE,
        };
        let mesh = CasterMesh::host_drawn(&gpu.device, bounds, 100).unwrap();
        let own = shape.caster(&gpu.device, Affine3A::IDENTITY);
        Self { shape, mesh, own }
    }

    fn pass(&self, device: &wgpu::Device, casters: &[Caster], asked: &HostDraw<'_>) -> OwnPass {
        let place = |caster: &usize| {
            let transform = casters[*caster].world_from_object;
            let positions = &self.shape.positions;
            let of = move |&i: &u32| transform.transform_point3(positions[i as usize].into());
            self.shape.indices.iter().map(of)
        };
        let positions: Vec<Vec3> = asked.casters.iter().flat_map(place).collect();
        OwnPass::new(device, &asked.clip_from_world, &positions)
    }

    /// The casters with all that the host draws as meshes of ours.
    fn as_ours(&self, casters: &[Caster]) -> Vec<Caster> {
        let ours = |caster: &Caster| match caster.mesh.is_host_drawn() {
            true => Caster::new(self.own.mesh.clone(), caster.world_from_object),
            false => caster.clone(),
        };
        casters.iter().map(ours).collect()
    }
}

fn draw_with(gpu: &Gpu, atlas: &mut ShadowAtlas, frame: &AtlasFrame<'_>, leaf: &Leaf) -> u32 {
    let mut asked = 0;
    gpu.checked(|| {
        atlas.prepare(&gpu.device, &gpu.queue, frame).unwrap();
        gpu.run(|encoder| {
            atlas.encode_with(encoder, |pass, draw| {
                asked += 1;
                leaf.pass(&gpu.device, frame.casters, draw).draw(pass);
            });
        });
    });
    asked
}

#[test]
fn what_only_the_host_can_draw_lies_among_the_others_and_is_kept_like_them() {
    let Some(gpu) = Gpu::for_test() else { return };
    let leaf = Leaf::new(&gpu);
    let mut casters = room(&gpu);
    let at = |x: f32| {
        Affine3A::from_scale_rotation_translation(
            Vec3::splat(0.6),
            glam::Quat::IDENTITY,
            Vec3::new(x, -2.0, 0.5),
        )
    };
    casters.push(Caster::new(leaf.mesh.clone(), at(0.3)));
    casters.push(Caster::new(leaf.mesh.clone(), at(-1.2)));
    let spot = SpotLight::new(Vec3::new(0.0, 4.0, 0.5), Vec3::NEG_Y, 0.6, 9.0);
    let lights = [
        lamp(),
        AtlasLight::new(spot).with_size(TileSize::Fixed(128)),
    ];
    let descriptor = ShadowAtlasDescriptor {
        static_layers: StaticLayers::AtLeast(1),
        ..descriptor(2)
    };
    let mut atlas = atlas(&gpu, &descriptor);
    for step in 0..6 {
        // One of ours moves among them, so that what is static goes to a layer below it.
        casters[0].world_from_object.translation = Vec3::new(0.2 * step as f32, -1.0, 1.0).into();
        let frame = AtlasFrame {
            lights: &lights,
            casters: &casters,
            ..Default::default()
        };
        let asked = draw_with(&gpu, &mut atlas, &frame, &leaf);
        let wrong = wrong_texels(&gpu, &atlas, &lights, &leaf.as_ours(&casters));
        assert_few(wrong, &format!("step {step}"));
        let copied = atlas.statistics().tiles_copied;
        // Where its tile was copied from a layer with the leaves the host is not asked again.
        assert!(
            step < 4 || copied > 0 && asked == 0,
            "{step}: {copied}, {asked}"
        );
        // The broken twin: without the leaves.
        let without = &casters[..casters.len() - 2];
        assert!(wrong_texels(&gpu, &atlas, &lights, without).0 > 100);
    }
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    draw_with(&gpu, &mut atlas, &frame, &leaf);
    assert_eq!(
        draw_with(&gpu, &mut atlas, &frame, &leaf),
        0,
        "nothing changed"
    );
    leaf.mesh.bump_revision();
    assert!(
        draw_with(&gpu, &mut atlas, &frame, &leaf) > 0,
        "it said that it had"
    );
}

#[test]
fn a_host_that_is_not_asked_loses_its_leaves_for_a_frame_and_no_longer() {
    let Some(gpu) = Gpu::for_test() else { return };
    let leaf = Leaf::new(&gpu);
    let transform = Affine3A::from_translation(Vec3::new(0.3, -3.0, 0.5));
    let mut casters = room(&gpu);
    casters.push(Caster::new(leaf.mesh.clone(), transform));
    let lights = [lamp()];
    let frame = AtlasFrame {
        lights: &lights,
        casters: &casters,
        ..Default::default()
    };
    let mut atlas = atlas(&gpu, &descriptor(2));
    draw(&gpu, &mut atlas, &frame);
    let ours = leaf.as_ours(&casters);
    assert!(wrong_texels(&gpu, &atlas, &lights, &ours).0 > 100);
    assert!(atlas.statistics().tiles_incomplete > 0, "it says so");
    assert!(draw_with(&gpu, &mut atlas, &frame, &leaf) > 0);
    assert_few(wrong_texels(&gpu, &atlas, &lights, &ours), "asked");
    assert_eq!(atlas.statistics().tiles_incomplete, 0);
    let tiles = atlas.tiles(0, 0);
    assert!(
        texels(&layers(&gpu, &atlas), &tiles[3])
            .iter()
            .any(|&depth| depth > 0.0)
    );
}

#[test]
fn nothing_to_draw_is_refused() {
    let Some(gpu) = Gpu::for_test() else { return };
    let leaf = Leaf::new(&gpu);
    let none = CasterMesh::host_drawn(&gpu.device, leaf.mesh.bounds(), 0);
    assert_eq!(none.unwrap_err(), CasterMeshError::NoTriangles);
}

/// Texels of a map of one light that differ from those of one drawn afresh without a host, and how many
/// of its tiles the last frame drew.
type Judged = (usize, u32);

fn differing(gpu: &Gpu, of: &wgpu::Texture, truth: &wgpu::Texture) -> usize {
    let layers = of.depth_or_array_layers().min(6);
    let read = |texture, layer| -> Vec<f32> {
        let bytes = gpu.read_texture(texture, layer, wgpu::TextureAspect::All);
        bytemuck::pod_collect_to_vec(&bytes)
    };
    let differ = |(a, b): &(f32, f32)| (a - b).abs() > 1e-5 * a.max(*b);
    let of_layer = |layer| {
        let pairs = read(of, layer).into_iter().zip(read(truth, layer));
        pairs.filter(differ).count()
    };
    (0..layers).map(of_layer).sum()
}

/// A frame of a cube map with the host's leaves, or without asking it.
fn cube_frame(
    gpu: &Gpu,
    map: &mut CubeShadowMap,
    casters: &[Caster],
    leaf: &Leaf,
    asks: bool,
) -> Judged {
    let frame = CubeFrame::new(PointLight::new(Vec3::ZERO, 9.0), casters);
    let mut truth = CubeShadowMap::new(&gpu.device, &Default::default()).unwrap();
    let ours = leaf.as_ours(casters);
    gpu.checked(|| {
        map.prepare(&gpu.device, &gpu.queue, &frame).unwrap();
        truth
            .prepare(
                &gpu.device,
                &gpu.queue,
                &CubeFrame {
                    casters: &ours,
                    ..frame
                },
            )
            .unwrap();
        gpu.run(|encoder| {
            truth.encode(encoder);
            match asks {
                true => map.encode_with(encoder, |pass, draw| {
                    leaf.pass(&gpu.device, casters, draw).draw(pass);
                }),
                false => map.encode(encoder),
            }
        });
    });
    let drawn = map.statistics().faces_rendered;
    (differing(gpu, map.texture(), truth.texture()), drawn)
}

/// The same of a flat map.
fn flat_frame(
    gpu: &Gpu,
    map: &mut ShadowMap,
    casters: &[Caster],
    leaf: &Leaf,
    asks: bool,
) -> Judged {
    let light = SpotLight::new(Vec3::ZERO, Vec3::NEG_Y, 0.9, 9.0);
    let mut truth = ShadowMap::new(&gpu.device, &Default::default()).unwrap();
    let ours = leaf.as_ours(casters);
    gpu.checked(|| {
        map.prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, casters))
            .unwrap();
        truth
            .prepare(&gpu.device, &gpu.queue, &ShadowFrame::new(light, &ours))
            .unwrap();
        gpu.run(|encoder| {
            truth.encode(encoder);
            match asks {
                true => map.encode_with(encoder, |pass, draw| {
                    leaf.pass(&gpu.device, casters, draw).draw(pass);
                }),
                false => map.encode(encoder),
            }
        });
    });
    let drawn = u32::from(map.statistics().rendered);
    (differing(gpu, map.texture(), truth.texture()), drawn)
}

#[test]
fn maps_of_one_light_ask_the_host_too() {
    let Some(gpu) = Gpu::for_test() else { return };
    let leaf = Leaf::new(&gpu);
    let mut casters = room(&gpu);
    let transform = Affine3A::from_translation(Vec3::new(0.3, -3.0, 0.5));
    casters.push(Caster::new(leaf.mesh.clone(), transform));
    let mut cube = CubeShadowMap::new(&gpu.device, &Default::default()).unwrap();
    let mut flat = ShadowMap::new(&gpu.device, &Default::default()).unwrap();
    let mut both = |asks: bool| {
        [
            cube_frame(&gpu, &mut cube, &casters, &leaf, asks),
            flat_frame(&gpu, &mut flat, &casters, &leaf, asks),
        ]
    };
    // Not asked, a host loses its leaves for a frame: the broken twin.
    let [(cube_lost, _), (flat_lost, _)] = both(false);
    assert!(
        cube_lost > 1000 && flat_lost > 1000,
        "{cube_lost} {flat_lost}"
    );
    // An outline may go by a texel here and there: another order of multiplication.
    let [cube_asked, flat_asked] = both(true);
    assert!(cube_asked.0 < 40 && cube_asked.1 > 0, "{cube_asked:?}");
    assert!(flat_asked.0 < 40 && flat_asked.1 == 1, "{flat_asked:?}");
    // Then it is kept.
    let kept = both(true).map(|(_, drawn)| drawn);
    assert_eq!(kept, [0, 0]);
    assert_eq!(
        both(false).map(|(_, drawn)| drawn),
        [0, 0],
        "nothing to draw"
    );
}
