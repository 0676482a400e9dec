//! The casters within a light's reach, found through a tree of boxes where that pays.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// Children of a node, and casters of a leaf.
const WIDTH: usize = 16;

/// Fewer casters are looked through one by one.
const FEWEST: usize = 512;

/// What building a tree costs for each caster, and moving a caster in it, in looks at a sphere.
/// (Measured: 70 to 90 ns, 17 to 40, and 0.8.)
const BUILD: usize = 100;
const MOVE: usize = 30;

/// Bounding spheres of all casters by their index (centre, radius), and who of them lies within a
/// light's reach.
///
/// A tree costs before it saves anything, and who knows how often lights will move: so it is built
/// once what it would have saved (less the casters that it would have moved) adds up to what it
/// costs, let go when that is used up, and built anew when casters have moved and it has wasted as
/// much (ski rental: Karlin et al., "Competitive Snoopy Caching", 1988).
#[derive(Default)]
pub(crate) struct CasterSpheres {
    spheres: Vec<DVec4>,
    tree: Option<Tree>,
    /// Looks that a tree saves, or would, less what it costs; 0 to [`BUILD`] for each caster.
    credit: usize,
    /// Looks in vain since the tree was built.
    wasted: usize,
}

impl CasterSpheres {
    pub fn push(&mut self, sphere: DVec4) {
        self.spheres.push(sphere);
        self.follow(|tree| tree.push(sphere));
    }

    pub fn set(&mut self, index: usize, sphere: DVec4) {
        self.spheres[index] = sphere;
        self.follow(|tree| tree.set(index, sphere));
    }

    pub fn truncate(&mut self, count: usize) {
        while self.spheres.len() > count {
            self.spheres.pop();
            self.follow(Tree::pop);
        }
    }

    fn follow(&mut self, change: impl FnOnce(&mut Tree)) {
        self.credit = self.credit.saturating_sub(MOVE);
        if self.credit == 0 {
            self.tree = None;
        }
        if let Some(tree) = &mut self.tree {
            change(tree);
        }
    }

    /// Appends the indices of all casters whose spheres reach into a sphere, in any order.
    pub fn within(&mut self, centre: DVec3, range: f64, found: &mut Vec<u32>) {
        let count = self.spheres.len();
        let price = BUILD * count;
        let before = found.len();
        let looks = match &self.tree {
            Some(tree) => {
                let looks = tree.within(centre, range, found);
                self.wasted += looks - (found.len() - before);
                looks
            }
            None => {
                let all = (0..).zip(&self.spheres);
                let near = all.filter(|(_, sphere)| reaches(sphere, centre, range));
                found.extend(near.map(|(index, _)| index));
                2 * (found.len() - before) // or so
            }
        };
        self.credit = (self.credit + count.saturating_sub(looks)).min(price);
        let due = match &self.tree {
            Some(tree) => tree.is_worn() && self.wasted >= price,
            None => self.credit == price && count >= FEWEST,
        };
        if due {
            self.build();
        }
    }

    fn build(&mut self) {
        self.tree = Some(Tree::new(&self.spheres));
        self.credit = BUILD * self.spheres.len();
        self.wasted = 0;
    }
}

fn reaches(sphere: &DVec4, centre: DVec3, range: f64) -> bool {
    let reach = range + sphere.w;
    sphere.xyz().distance_squared(centre) <= reach * reach
}

/// Bounds of some spheres: a box around their centres, and the largest radius.
#[derive(Clone, Copy)]
struct Node {
    min: DVec3,
    max: DVec3,
    radius: f64,
}

impl Node {
    const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
        radius: 0.0,
    };

    fn holds(&self, sphere: &DVec4) -> bool {
        let at = sphere.xyz();
        at.cmpge(self.min).all() && at.cmple(self.max).all() && sphere.w <= self.radius
    }

    fn grow(&mut self, sphere: &DVec4) {
        self.min = self.min.min(sphere.xyz());
        self.max = self.max.max(sphere.xyz());
        self.radius = self.radius.max(sphere.w);
    }

    /// False only if [`reaches`] is for all spheres inside: subtraction, square and sum round
    /// monotonically, so no rounding makes this gap larger than theirs.
    fn reaches(&self, centre: DVec3, range: f64) -> bool {
        let gap = (self.min - centre).max(centre - self.max).max(DVec3::ZERO);
        let reach = range + self.radius;
        gap.length_squared() <= reach * reach
    }
}

/// Casters in the order of a Morton curve, every sixteen neighbours a leaf, every sixteen nodes a
/// node (Lauterbach et al., "Fast BVH Construction on GPUs", 2009). A caster that moves keeps its
/// leaf and stretches the boxes above it.
struct Tree {
    /// Along the curve: index and sphere.
    casters: Vec<(u32, DVec4)>,
    /// Where each caster stands in `casters`.
    place: Vec<u32>,
    /// From the leaves up, each level a sixteenth of the one below it.
    levels: Vec<Vec<Node>>,
    /// Casters that moved, came or went since it was built.
    changes: usize,
}

impl Tree {
    fn new(spheres: &[DVec4]) -> Self {
        let mut all = Node::EMPTY;
        spheres.iter().for_each(|sphere| all.grow(sphere));
        // One scale for all axes; a flat world has nothing to say on the third.
        let scale = 2_097_151.0 / (all.max - all.min).max_element().max(f64::MIN_POSITIVE);
        let mut order: Vec<(u64, u32)> = (0..)
            .zip(spheres)
            .map(|(index, sphere)| (morton((sphere.xyz() - all.min) * scale), index))
            .collect();
        order.sort_unstable();
        let mut tree = Self {
            casters: Vec::with_capacity(spheres.len()),
            place: vec![0; spheres.len()],
            levels: Vec::new(),
            changes: 0,
        };
        let mut count = spheres.len().div_ceil(WIDTH);
        while tree.levels.is_empty() || count > WIDTH {
            tree.levels.push(vec![Node::EMPTY; count]);
            count = count.div_ceil(WIDTH);
        }
        for (place, (_, index)) in order.into_iter().enumerate() {
            tree.place[index as usize] = place as u32;
            tree.casters.push((index, spheres[index as usize]));
            tree.stretch(place);
        }
        tree
    }

    fn is_worn(&self) -> bool {
        self.changes >= self.place.len() / 8
    }

    fn set(&mut self, index: usize, sphere: DVec4) {
        let place = self.place[index] as usize;
        self.casters[place].1 = sphere;
        self.stretch(place);
        self.changes += 1;
    }

    fn push(&mut self, sphere: DVec4) {
        let place = self.casters.len();
        self.casters.push((self.place.len() as u32, sphere));
        self.place.push(place as u32);
        self.stretch(place);
        self.changes += 1;
    }

    /// Takes out the caster with the highest index; the last along the curve takes its place.
    fn pop(&mut self) {
        let Some(place) = self.place.pop() else {
            return;
        };
        self.casters.swap_remove(place as usize);
        if let Some(&(moved, _)) = self.casters.get(place as usize) {
            self.place[moved as usize] = place;
            self.stretch(place as usize);
        }
        self.changes += 1;
    }

    /// Makes the boxes above a place hold what is there.
    fn stretch(&mut self, place: usize) {
        let sphere = self.casters[place].1;
        let mut at = place;
        for level in &mut self.levels {
            at /= WIDTH;
            if at >= level.len() {
                level.resize(at + 1, Node::EMPTY);
            }
            if level[at].holds(&sphere) {
                return; // and so do those above it
            }
            level[at].grow(&sphere);
        }
    }

    /// Gives how many spheres and boxes it looked at.
    fn within(&self, centre: DVec3, range: f64, found: &mut Vec<u32>) -> usize {
        let top = self.levels.len() - 1;
        self.descend(top, 0..self.levels[top].len(), centre, range, found)
    }

    fn descend(
        &self,
        level: usize,
        nodes: std::ops::Range<usize>,
        centre: DVec3,
        range: f64,
        found: &mut Vec<u32>,
    ) -> usize {
        let mut looks = nodes.len();
        for at in nodes {
            if !self.levels[level][at].reaches(centre, range) {
                continue;
            }
            let below = match level {
                0 => self.casters.len(),
                _ => self.levels[level - 1].len(),
            };
            let children = (at * WIDTH).min(below)..((at + 1) * WIDTH).min(below);
            if level > 0 {
                looks += self.descend(level - 1, children, centre, range, found);
                continue;
            }
            looks += children.len();
            let near = self.casters[children]
                .iter()
                .filter(|(_, sphere)| reaches(sphere, centre, range));
            found.extend(near.map(|(index, _)| index));
        }
        looks
    }
}

/// The bits of three numbers from 0 to 2^21 - 1 in turn.
fn morton(at: DVec3) -> u64 {
    let spread = |x: f64| {
        // Shifts of Karras, "Thinking Parallel, Part III", 2012, here for 21 bits.
        let mut bits = x as u64 & 0x1f_ffff;
        for (shift, mask) in [
            (32, 0x001f_0000_0000_ffff),
            (16, 0x001f_0000_ff00_00ff),
            (8, 0x100f_00f0_0f00_f00f),
            (4, 0x10c3_0c30_c30c_30c3),
            (2, 0x1249_2492_4924_9249),
        ] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(at.x) | spread(at.y) << 1 | spread(at.z) << 2
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sphere(scale: f64) -> impl Strategy<Value = DVec4> {
        let radius = prop_oneof![9 => 0.0..0.5, 1 => 0.0..20.0];
        (prop::array::uniform3(-10.0..10.0), radius)
            .prop_map(move |(at, radius): ([f64; 3], f64)| DVec3::from(at).extend(radius) * scale)
    }

    fn found(casters: &mut CasterSpheres, centre: DVec3, range: f64) -> Vec<u32> {
        let mut found = Vec::new();
        casters.within(centre, range, &mut found);
        found.sort_unstable();
        found
    }

    fn of(spheres: &[DVec4]) -> CasterSpheres {
        let mut casters = CasterSpheres::default();
        spheres.iter().for_each(|sphere| casters.push(*sphere));
        casters
    }

    #[derive(Clone, Debug)]
    enum Step {
        Set(usize, DVec4),
        Push(DVec4),
        Truncate(usize),
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(96))]

        #[test]
        fn the_tree_finds_what_looking_at_all_finds(
            start in prop::collection::vec(sphere(1.0), 1..700),
            steps in prop::collection::vec(
                prop_oneof![
                    6 => (0..700_usize, sphere(3.0)).prop_map(|(at, s)| Step::Set(at, s)),
                    2 => sphere(2.0).prop_map(Step::Push),
                    1 => (0..30_usize).prop_map(Step::Truncate),
                ],
                0..60,
            ),
            lights in prop::collection::vec((sphere(1.0), 0.0..15.0), 1..8),
        ) {
            let mut plain = of(&start);
            let mut tree = of(&start);
            tree.build();
            tree.credit = usize::MAX / 2; // keep it, whatever it costs
            for step in steps {
                let count = plain.spheres.len();
                for casters in [&mut plain, &mut tree] {
                    match step {
                        Step::Set(at, sphere) if at < count => casters.set(at, sphere),
                        Step::Set(..) => {}
                        Step::Push(sphere) => casters.push(sphere),
                        Step::Truncate(by) => casters.truncate(count.saturating_sub(by).max(1)),
                    }
                }
            }
            prop_assert!(tree.tree.is_some() && plain.tree.is_none());
            for (light, range) in lights {
                let all = found(&mut plain, light.xyz(), range);
                prop_assert_eq!(found(&mut tree, light.xyz(), range), all);
            }
        }
    }

    /// Casters a unit apart, which lights casters two dozen of.
    fn field(count: usize) -> Vec<DVec4> {
        let side = (count as f64).sqrt().ceil();
        let place = |i: usize| DVec3::new(i as f64 % side, 0.0, (i as f64 / side).floor());
        (0..count).map(|i| place(i).extend(0.3)).collect()
    }

    #[test]
    fn a_tree_whose_boxes_are_not_stretched_loses_casters() {
        let mut casters = of(&field(1000));
        casters.build();
        let far = DVec3::new(500.0, 0.0, 0.0);
        casters.set(17, far.extend(0.3));
        assert_eq!(found(&mut casters, far, 1.0), [17]);
        // The broken twin: the caster moves, its boxes do not.
        let mut twin = of(&field(1000));
        twin.build();
        let tree = twin.tree.as_mut().unwrap();
        let place = tree.place[17] as usize;
        tree.casters[place].1 = far.extend(0.3);
        assert!(found(&mut twin, far, 1.0).is_empty());
    }

    #[test]
    fn a_tree_is_built_when_looks_in_vain_have_cost_as_much_and_again_when_it_is_worn() {
        let mut casters = of(&field(4096));
        let at = DVec3::new(20.0, 0.0, 20.0);
        let mut queries = 0;
        while casters.tree.is_none() {
            found(&mut casters, at, 2.5);
            queries += 1;
        }
        assert!(queries > BUILD && queries < BUILD + 3, "{queries}");
        let looks = |casters: &CasterSpheres| {
            let tree = casters.tree.as_ref().unwrap();
            tree.within(at, 2.5, &mut Vec::new())
        };
        let fresh = looks(&casters);
        assert!(fresh < 4096 / 10, "{fresh} looks");
        // Everything changes places, as far as may be.
        let field = field(4096);
        for i in 0..4096 {
            casters.set(i, field[i * 2039 % 4096]);
        }
        let worn = looks(&casters);
        assert!(worn > 2000, "{worn} looks at boxes as wide as the field");
        for _ in 0..2 * BUILD {
            found(&mut casters, at, 2.5);
        }
        assert_eq!(looks(&casters), fresh, "the same places under other names");
    }

    #[test]
    fn a_tree_that_only_costs_is_let_go_and_not_built_where_all_moves() {
        let mut casters = of(&field(4096));
        casters.build();
        let all = field(4096);
        let move_all = |casters: &mut CasterSpheres| (0..4096).for_each(|i| casters.set(i, all[i]));
        (0..BUILD / MOVE).for_each(|_| move_all(&mut casters));
        assert!(casters.tree.is_some());
        move_all(&mut casters);
        assert!(casters.tree.is_none(), "no light asked for it");
        for _ in 0..BUILD {
            move_all(&mut casters);
            for k in 0..16 {
                found(&mut casters, DVec3::X * f64::from(k), 2.5);
            }
        }
        assert!(
            casters.tree.is_none(),
            "16 lights save less than 4096 moves cost"
        );
    }

    #[test]
    fn few_casters_never_have_a_tree() {
        let mut casters = of(&field(FEWEST - 1));
        for _ in 0..10 * BUILD {
            found(&mut casters, DVec3::ZERO, 1.0);
        }
        assert!(casters.tree.is_none());
    }
}
