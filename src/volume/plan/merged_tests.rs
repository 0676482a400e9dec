use super::*;
use crate::volume::decide::method::Count;
use crate::volume::gpu::draw_pipelines::{Part, Style};
use crate::volume::plan::cache::Sources;
use crate::volume::plan::faces::Faces;

fn key(way: Way, faces: Faces) -> DrawKey {
    DrawKey {
        way,
        style: Style {
            count: Count::Fail,
            faces,
            clockwise: false,
            part: Part::Whole,
            clipped: false,
        },
        vertices: 3,
        back: false,
        own: false,
        sources: Sources::default(),
    }
}

fn seated(caster: u32, elements: u32) -> Seated {
    let member = Member {
        caster,
        count: 3 * elements,
        start: 300,
        grows_down: 0,
    };
    Seated {
        member,
        elements: elements.into(),
    }
}

#[test]
fn a_list_is_cut_into_blocks() {
    let (mut lists, mut merged) = (DrawLists::default(), MergedDraws::new(1 << 20));
    for (caster, elements) in [(7, 20), (8, 0), (9, 8)] {
        merged.seat(
            &mut lists,
            key(Way::Cpu, Faces::LightCap),
            seated(caster, elements),
        );
    }
    let [number] = merged.settle()[..] else {
        panic!("one draw")
    };
    let draw = merged.get(number).unwrap();
    let blocks = [[7, 300, 8], [7, 324, 8], [7, 348, 4], [9, 300, 8]];
    assert_eq!(draw.blocks(), blocks);
    assert_eq!(draw.block_count(), 4);
    assert_eq!(draw.block_bytes(), 0..4 * BLOCK_BYTES);
}

#[test]
fn seats_are_taken_again_and_full_draws_followed_by_others() {
    let (mut lists, mut merged) = (DrawLists::default(), MergedDraws::new(1 << 20));
    let sides = || key(Way::Compute, Faces::Sides);
    let mut seats: Vec<Seat> = (0..300)
        .map(|caster| merged.seat(&mut lists, sides(), seated(caster, 9)))
        .collect();
    let touched = merged.settle();
    assert_eq!((lists.len(), touched.len()), (2, 2));
    merged.finish(&touched);
    for seat in seats.drain(10..20) {
        merged.leave(&mut lists, seat);
    }
    assert_eq!(merged.settle(), touched[..1]);
    let first = merged.get(touched[0]).unwrap();
    let changed = first.changed();
    assert_eq!(changed.len(), 1, "ten in a row");
    assert_eq!(changed[0], (10, vec![Member::NONE; 10]));
    let seat = merged.seat(&mut lists, sides(), seated(1_000, 9));
    assert_eq!((seat.draw, seat.place), (touched[0], 10));
    for seat in seats.into_iter().chain([seat]) {
        merged.leave(&mut lists, seat);
    }
    assert!(lists.is_empty() && merged.settle().is_empty());
    assert!(merged.ends().all(|ends| ends == [0; 3]));
}

#[test]
fn what_would_fill_no_chunk_goes_into_another_draw() {
    // 64 members, 85 blocks.
    let (mut lists, mut merged) = (DrawLists::default(), MergedDraws::new(1_024));
    let sides = || key(Way::Compute, Faces::Sides);
    for caster in 0..10 {
        merged.seat(&mut lists, sides(), seated(caster, 20 * BLOCK));
    }
    // Four fit.
    assert_eq!(lists.len(), 3);
    let seat = merged.seat(&mut lists, sides(), seated(10, BLOCK));
    let larger = |blocks| seated(10, blocks * BLOCK);
    assert!(merged.keep(seat, &sides(), larger(5), false));
    assert!(!merged.keep(seat, &sides(), larger(6), false));
    let numbers = merged.settle();
    for number in numbers {
        let draw = merged.get(number).unwrap();
        assert!(draw.room[1] <= 85 && draw.room[1] >= draw.most);
    }
    assert!(
        merged
            .ends()
            .all(|[members, blocks, _]| members <= 64 && blocks <= 85)
    );
}

#[test]
fn what_is_found_anew_is_merged_anew_wherever_it_lies() {
    let (mut lists, mut merged) = (DrawLists::default(), MergedDraws::new(1 << 20));
    for (way, anew) in [(Way::Compute, 1), (Way::Cpu, 0)] {
        let sides = key(way, Faces::Sides);
        let seat = merged.seat(&mut lists, sides.clone(), seated(1, 9));
        merged.settle();
        assert!(merged.keep(seat, &sides, seated(1, 9), false));
        assert_eq!(merged.settle().len(), 0);
        assert!(merged.keep(seat, &sides, seated(1, 9), true));
        assert_eq!(merged.settle().len(), anew);
        assert!(!merged.keep(seat, &key(way, Faces::Fan), seated(1, 9), true));
    }
}
