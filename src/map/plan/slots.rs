//! The lights of a map, and which has which place in it.

use std::collections::HashMap;

use super::slot::Slot;
use super::sorting::Reached;
use crate::map::projection::{LightProjection, SlotLight};
use crate::scene::CasterFilter;
use crate::scene::Casters;

/// Frames in which a light reaches no caster after which its texels are given back: enough that a
/// caster which comes and goes does not have them made each time.
const IDLE: u32 = 60;

/// Changes of casters, times lights, beyond which every light asks the tree of casters anew instead of
/// looking at each change.
const MANY: usize = 1 << 17;

/// All slots of a map, and the lights of the last frame in them.
#[derive(Debug)]
pub(crate) struct Slots {
    slots: Vec<Slot>,
    /// For each light of the frame its slot.
    order: Vec<usize>,
    // Kept only for its memory: the casters that a light reaches.
    reached: Vec<u32>,
    /// Whether the casters went on without the slots.
    behind: bool,
}

impl Slots {
    /// `cull`: whether casters go only on the tiles they touch.
    pub fn new(count: usize, cull: bool) -> Self {
        Self {
            slots: (0..count).map(|_| Slot::new(cull)).collect(),
            order: Vec::new(),
            reached: Vec::new(),
            behind: false,
        }
    }

    /// Makes places for so many lights at least.
    pub fn grow(&mut self, count: usize) {
        if count > self.slots.len() {
            self.slots.resize_with(count, || Slot::new(true));
        }
    }

    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// The slot of a light of the frame.
    pub fn of_light(&self, light: usize) -> Option<usize> {
        self.order.get(light).copied()
    }

    /// Takes over a frame's lights, after the casters were updated.
    pub fn take_over(&mut self, lights: &[SlotLight], casters: &mut Casters) {
        let order = assign(lights, &self.slots, &self.order);
        let mut wanted = vec![None; self.slots.len()];
        for (light, &slot) in lights.iter().zip(&order) {
            wanted[slot] = Some(light);
        }
        self.order = order;
        let changes = casters.changes().len();
        // Who moved is not asked where most have.
        let most = 2 * changes > casters.records().len();
        let anew = std::mem::take(&mut self.behind) || most || changes * lights.len() > MANY;
        for (slot, light) in self.slots.iter_mut().zip(wanted) {
            let same = slot.slot_light() == light;
            let Some(light) = light else {
                if !same {
                    slot.leave_light(None);
                }
                continue;
            };
            if same && !anew {
                casters.changes().for_each(|change| slot.apply(&change));
                continue;
            }
            let sphere = light
                .projection
                .sphere()
                .filter(|_| slot.finds_few(casters));
            if !same {
                slot.leave_light(Some(&light.projection));
            }
            let reached = match sphere {
                Some((centre, range)) => {
                    self.reached.clear();
                    casters.within(centre, range, &mut self.reached);
                    Reached::Some(&self.reached)
                }
                None => Reached::All,
            };
            match same {
                true => slot.sort(casters, reached),
                false => slot.set_light(light.clone(), casters, reached),
            }
        }
    }

    /// Gives a slot another projection of its light, after it was taken over.
    pub fn refit(&mut self, slot: usize, projection: LightProjection, casters: &Casters) {
        let slot = &mut self.slots[slot];
        let filter = slot.slot_light().map_or(CasterFilter::ALL, |of| of.filter);
        let light = SlotLight { projection, filter };
        if slot.slot_light() != Some(&light) {
            slot.leave_light(Some(&light.projection));
            slot.set_light(light, casters, Reached::All);
        }
    }

    /// Counts the frames in which a light reaches no caster. Whether that is so short that its texels
    /// stay.
    pub fn needs_texels(&mut self, slot: usize, has_some: bool) -> bool {
        let slot = &mut self.slots[slot];
        slot.idle = match slot.casting {
            0 => slot.idle.saturating_add(1),
            _ => 0,
        };
        slot.casting > 0 || has_some && slot.idle < IDLE
    }

    /// Learns that casters were updated for a frame whose lights were refused: what changed is not
    /// known any more when the next one comes.
    pub fn miss_update(&mut self) {
        self.behind = true;
    }
}

impl std::ops::Deref for Slots {
    type Target = [Slot];

    fn deref(&self) -> &[Slot] {
        &self.slots
    }
}

impl std::ops::DerefMut for Slots {
    fn deref_mut(&mut self) -> &mut [Slot] {
        &mut self.slots
    }
}

/// For each light the slot it gets: the one that already holds it, wherever in the slice it was;
/// else the one that its predecessor at this place had, if that was of its kind; else a free one.
///
/// `lights` are no more than there are slots.
fn assign(lights: &[SlotLight], slots: &[Slot], before: &[usize]) -> Vec<usize> {
    let mut free = vec![true; slots.len()];
    let mut take = |slot: usize| std::mem::replace(&mut free[slot], false);
    let mut chosen: Vec<Option<usize>> = vec![None; lights.len()];
    let holds = |slot: usize, light: &SlotLight| slots[slot].slot_light() == Some(light);
    for (i, light) in lights.iter().enumerate() {
        let same = before.get(i).copied().filter(|&slot| holds(slot, light));
        chosen[i] = same.filter(|&slot| take(slot));
    }
    if chosen.iter().any(Option::is_none) {
        let mut holders: HashMap<_, Vec<usize>> = HashMap::new();
        for (index, slot) in slots.iter().enumerate().rev() {
            if let Some(light) = slot.light() {
                holders.entry(light.key()).or_default().push(index);
            }
        }
        for (choice, light) in chosen.iter_mut().zip(lights) {
            if choice.is_none() {
                let alike = holders
                    .get(&light.projection.key())
                    .into_iter()
                    .flatten()
                    .rev();
                *choice = alike
                    .copied()
                    .find(|&slot| holds(slot, light) && take(slot));
            }
        }
    }
    for (i, (choice, light)) in chosen.iter_mut().zip(lights).enumerate() {
        let like = |slot: usize| {
            let held = slots[slot].light();
            held.is_some_and(|held| held.is_like(&light.projection))
        };
        if choice.is_none() {
            *choice = before
                .get(i)
                .copied()
                .filter(|&slot| like(slot) && take(slot));
        }
    }
    let unused = |slot: &usize| slots[*slot].light().is_none();
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
    use crate::PointLight;

    fn light(x: f32) -> SlotLight {
        LightProjection::Point(PointLight::new(Vec3::X * x, 10.0)).into()
    }

    fn slots(lights: &[Option<f32>]) -> Vec<Slot> {
        let make = |x: &Option<f32>| {
            let mut slot = Slot::new(true);
            if let Some(light) = x.map(light) {
                slot.leave_light(Some(&light.projection));
                slot.set_light(light, &Casters::default(), Reached::All);
            }
            slot
        };
        lights.iter().map(make).collect()
    }

    #[test]
    fn lights_keep_their_slots_wherever_they_stand() {
        let slots = slots(&[Some(0.0), Some(1.0), Some(2.0), None]);
        let order = |lights: &[f32]| {
            let lights: Vec<SlotLight> = lights.iter().copied().map(light).collect();
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
