//! Our rendition of other engines' receivers: that it is their light, their map and their projection
//! that are measured, and no mistake of ours.

use compare::shadow::{Shadow, ShadowInputs};
use compare::stage::Stage;
use compare::technique::{Config, Technique};
use host::gpu::Gpu;
use host::peers::{PEERS, WARPED};
use host::scene::{LightKind, moved_light, spheres};
use shadows::glam::Vec3;
use shadows::reference::ReferenceImage;

/// Wrong pixels away from every edge.
fn interior(
    gpu: &Gpu,
    (stage, reference): (&Stage, &ReferenceImage),
    technique: &Technique,
    inputs: &ShadowInputs,
) -> usize {
    let mut shadow = Shadow::new(gpu, &stage.renderer, technique.clone()).unwrap();
    let picture = gpu.checked(|| stage.picture(gpu, &mut shadow, inputs).unwrap());
    let error = reference.compare(&picture.visibility, shadow.interior());
    let error = error.unwrap();
    assert!(error.lit_facing > 1_000, "{} pixels", error.lit_facing);
    error.false_lit_interior + error.false_shadow_interior
}

#[test]
fn on_spheres_each_is_right_away_from_edges_and_not_where_its_light_is_elsewhere() {
    let Some(gpu) = Gpu::for_test() else {
        return;
    };
    let mut seen = 0;
    for light in [LightKind::Point, LightKind::Spot, LightKind::Directional] {
        let mut scene = spheres();
        scene.shine_as(light).unwrap();
        let stage = Stage::new(&gpu, scene, [320, 180]).unwrap();
        let reference = stage.reference(|_| ()).unwrap();
        let mut elsewhere = stage.inputs.clone();
        elsewhere.light = moved_light(elsewhere.light, Vec3::new(0.5, 0.0, 0.4));
        for peer in PEERS.iter().chain([&WARPED]) {
            let technique = Technique {
                name: peer.name.into(),
                config: Config::Peer { peer, size: 1024 },
            };
            if !technique.config.applies_to(light) {
                assert!(!technique.config.limit().is_empty());
                continue;
            }
            seen += 1;
            let on = (&stage, &reference);
            let wrong = interior(&gpu, on, &technique, &stage.inputs);
            assert_eq!(wrong, 0, "{} {light:?}", peer.name);
            let broken = interior(&gpu, on, &technique, &elsewhere);
            assert!(broken > 0, "{} {light:?}: a moved light", peer.name);
        }
    }
    // The matrix of wgpu's example does for two kinds.
    assert_eq!(seen, PEERS.len() + 1 + 1);
}

#[test]
fn every_peer_is_a_technique() {
    for peer in PEERS.iter().chain([&WARPED]) {
        let is_it =
            |config: &Config| matches!(config, Config::Peer { peer: p, .. } if p.name == peer.name);
        let rows = compare::table::ROWS.iter();
        let count = rows.filter(|row| is_it(&row.at(64).config)).count();
        assert_eq!(count, 1, "{}", peer.name);
    }
}
