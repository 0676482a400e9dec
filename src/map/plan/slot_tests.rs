use glam::{DVec3, Vec3};

use super::*;
use crate::PointLight;
use crate::scene::CasterBounds;

fn light(range: f32) -> SlotLight {
    LightProjection::Point(PointLight::new(Vec3::ZERO, range)).into()
}

fn caster(at: Vec3) -> Record {
    Record {
        bounds: CasterBounds {
            centre: at.as_dvec3(),
            half: DVec3::splat(0.1),
            radius: 0.2,
        },
        digest: 7,
        triangles: 12,
        mesh: 0,
        closed: true,
        solid: true,
        mirrored: false,
        host_drawn: false,
        layers: u32::MAX,
        owner: None,
        since: 0,
    }
}

fn come(caster: &Record) -> Change<'_> {
    Change {
        index: 0,
        old: None,
        new: Some(caster),
    }
}

/// A slot whose empty tiles were drawn and found to be right, and of which receivers know.
fn told() -> Slot {
    let mut slot = Slot::new(true);
    slot.leave_light(Some(&light(5.0).projection));
    slot.set_light(light(5.0), &Casters::default(), Reached::All);
    let all = slot.all();
    slot.schedule(all, all);
    slot.encoded(all);
    slot.schedule(0, 0);
    slot.settle();
    slot.tell();
    assert!(slot.is_told() && slot.stale() == 0 && slot.empty() == all);
    slot
}

#[test]
fn a_slot_that_settled_notices_all_that_may_come() {
    type Come = fn(&mut Slot);
    let changes: [(&str, Come); 7] = [
        ("texels forgotten", Slot::forget_texels),
        ("texels freed", Slot::texels_freed),
        ("texels doubted", Slot::doubt_texels),
        ("a tile spoiled", |slot| slot.spoil(2)),
        ("a caster", |slot| slot.apply(&come(&caster(Vec3::X)))),
        ("another light", |slot| {
            slot.leave_light(Some(&light(6.0).projection));
            slot.set_light(light(6.0), &Casters::default(), Reached::All);
        }),
        ("sorted again", |slot| {
            slot.sort(&Casters::default(), Reached::All)
        }),
    ];
    for (name, change) in changes {
        let mut slot = told();
        change(&mut slot);
        assert!(!slot.is_told(), "{name}");
        // It is settled anew, and receivers are to be told anew.
        slot.settle();
        assert!(!slot.is_told(), "{name}");
    }
    // What is as it was is no change, and what is out of range is none of its own.
    let mut slot = told();
    slot.apply(&come(&caster(9.0 * Vec3::X)));
    slot.schedule(0, 0);
    slot.settle();
    assert!(slot.is_told());
}

#[test]
fn a_tile_that_is_sorted_again_has_changed_only_if_its_casters_have() {
    let mut slot = told();
    let changes = |slot: &Slot| {
        slot.tiles
            .iter()
            .map(|tile| tile.change)
            .collect::<Vec<_>>()
    };
    let before = changes(&slot);
    slot.sort(&Casters::default(), Reached::All);
    assert_eq!(changes(&slot), before);
    slot.apply(&come(&caster(Vec3::X)));
    let with_it = changes(&slot);
    assert_ne!(with_it, before);
    // It is gone again, but who it was is not said.
    slot.sort(&Casters::default(), Reached::All);
    for (now, then) in changes(&slot).into_iter().zip(with_it) {
        let touched = then > 0.0;
        assert_eq!(now, if touched { then + 1.0 } else { then });
    }
}
