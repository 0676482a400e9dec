//! The lights of a map, and which has which place in it.

use super::slot::Slot;
use crate::PointLight;
use crate::mesh::Caster;
use crate::scene::Casters;

/// Frames in which a light reaches no caster after which its texels are given back: enough that a
/// caster which comes and goes does not have them made each time.
const IDLE: u32 = 60;

/// All slots of a map, and the lights of the last frame in them.
#[derive(Debug)]
pub(crate) struct Slots {
    slots: Vec<Slot>,
    /// For each light of the frame its slot.
    order: Vec<usize>,
    /// Frames in which a light changed its place in the host's list.
    reordered: u64,
    // Kept only for its memory: the casters that a light reaches.
    reached: Vec<u32>,
}

impl Slots {
    /// `cull`: whether casters go only on the faces they touch.
    pub fn new(count: usize, cull: bool) -> Self {
        Self {
            slots: (0..count).map(|_| Slot::new(cull)).collect(),
            order: Vec::new(),
            reordered: 0,
            reached: Vec::new(),
        }
    }

    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// The slot of a light of the frame.
    pub fn of_light(&self, light: usize) -> Option<usize> {
        self.order.get(light).copied()
    }

    pub fn reordered(&self) -> u64 {
        self.reordered
    }

    /// Takes over a frame's lights and casters, after the casters were compared.
    pub fn take_over(&mut self, lights: &[PointLight], casters: &mut Casters, all: &[Caster]) {
        let order = assign(lights, &self.slots, &self.order);
        let moved = order.iter().zip(&self.order).any(|(new, old)| new != old);
        self.reordered += u64::from(moved);
        let mut wanted = vec![None; self.slots.len()];
        for (light, &slot) in lights.iter().zip(&order) {
            wanted[slot] = Some(*light);
        }
        self.order = order;
        // Lights that change are sorted out once, after the casters.
        let mut changed = vec![false; self.slots.len()];
        for ((slot, light), changed) in self.slots.iter_mut().zip(&wanted).zip(&mut changed) {
            *changed = slot.light != *light;
            if *changed {
                let shown = slot.shown;
                slot.set_light(None, casters.records(), &[]);
                slot.shown = shown.filter(|_| light.is_some());
            }
        }
        for change in casters.update(all) {
            self.slots.iter_mut().for_each(|slot| slot.apply(&change));
        }
        for ((slot, light), changed) in self.slots.iter_mut().zip(wanted).zip(changed) {
            let Some(light) = light.filter(|_| changed) else {
                continue;
            };
            self.reached.clear();
            let (centre, range) = (light.position.as_dvec3(), f64::from(light.range));
            match slot.cull {
                true => casters.within(centre, range, &mut self.reached),
                false => self.reached.extend(0..casters.records().len() as u32),
            }
            slot.set_light(Some(light), casters.records(), &self.reached);
        }
    }

    /// Counts the frames in which a light reaches no caster. Gives the slots whose texels no light
    /// needs any more; where they share a texture, all of them or none.
    pub fn idle(&mut self, shared: bool) -> Vec<usize> {
        for slot in &mut self.slots {
            slot.idle = match slot.casting {
                0 => slot.idle.saturating_add(1),
                _ => 0,
            };
        }
        let no_light = self.order.is_empty();
        let idle = |slot: &Slot| no_light || slot.idle >= IDLE;
        let all = self.slots.iter().all(idle);
        (0..self.slots.len())
            .filter(|&index| all || !shared && idle(&self.slots[index]))
            .collect()
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
/// else the one that its predecessor at this place had; else a free one.
///
/// `lights` are no more than there are slots.
fn assign(lights: &[PointLight], slots: &[Slot], before: &[usize]) -> Vec<usize> {
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
