//! Which light has which place in a map.

use super::slot::Slot;
use crate::PointLight;

/// For each light the slot it gets: the one that already holds it, wherever in the slice it was;
/// else the one that its predecessor at this place had; else a free one.
///
/// `lights` are no more than there are slots.
pub(super) fn assign(lights: &[PointLight], slots: &[Slot], before: &[usize]) -> Vec<usize> {
    let mut free = vec![true; slots.len()];
    let mut take = |slot: usize| std::mem::replace(&mut free[slot], false);
    let mut chosen: Vec<Option<usize>> = vec![None; lights.len()];
    let holds = |slot: usize, light: &PointLight| slots[slot].light.as_ref() == Some(light);
    for (i, light) in lights.iter().enumerate() {
        let same = before.get(i).copied().filter(|&slot| holds(slot, light));
        chosen[i] = same.filter(|&slot| take(slot));
    }
    for (i, light) in lights.iter().enumerate() {
        if chosen[i].is_none() {
            chosen[i] = (0..slots.len()).find(|&slot| holds(slot, light) && take(slot));
        }
    }
    for (i, choice) in chosen.iter_mut().enumerate() {
        if choice.is_none() {
            *choice = before.get(i).copied().filter(|&slot| take(slot));
        }
    }
    let unused = |slot: &usize| slots[*slot].light.is_none();
    let mut rest = (0..slots.len())
        .filter(unused)
        .chain((0..slots.len()).filter(|slot| !unused(slot)))
        .filter(|&slot| take(slot));
    chosen
        .into_iter()
        .filter_map(|choice| choice.or_else(|| rest.next()))
        .collect()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn light(x: f32) -> PointLight {
        PointLight::new(Vec3::X * x, 10.0)
    }

    fn slots(lights: &[Option<f32>]) -> Vec<Slot> {
        let make = |x: &Option<f32>| {
            let mut slot = Slot::new(true);
            slot.light = x.map(light);
            slot
        };
        lights.iter().map(make).collect()
    }

    #[test]
    fn lights_keep_their_slots_wherever_they_stand() {
        let slots = slots(&[Some(0.0), Some(1.0), Some(2.0), None]);
        let order = |lights: &[f32]| {
            let lights: Vec<PointLight> = lights.iter().copied().map(light).collect();
            assign(&lights, &slots, &[0, 1, 2])
        };
        assert_eq!(order(&[0.0, 1.0, 2.0]), [0, 1, 2]);
        assert_eq!(order(&[1.0, 2.0]), [1, 2], "the first was removed");
        assert_eq!(order(&[2.0, 1.0, 0.0]), [2, 1, 0], "they changed places");
        assert_eq!(order(&[0.0, 1.5, 2.0]), [0, 1, 2], "one moved");
        assert_eq!(
            order(&[7.0, 0.0, 1.0, 2.0]),
            [3, 0, 1, 2],
            "one came in front"
        );
        let twice = order(&[1.0, 1.0]);
        assert_eq!(twice[1], 1);
        assert_ne!(twice[0], 1, "two lights never share a slot");
    }
}
