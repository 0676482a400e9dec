//! Which of the tiles that should be drawn are drawn this frame.

use super::slot::Slot;

/// Tiles of one light that are drawn together or not at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Job {
    pub slot: usize,
    pub tiles: u8,
    pub age: u32,
    pub importance: f64,
}

impl Job {
    fn cost(&self) -> u32 {
        self.tiles.count_ones()
    }
}

/// The jobs of a light among which a budget may choose, and the tiles about which it has no say.
///
/// A point light that moved has all its stale faces drawn together, since receivers are given one
/// position for all of them. Tiles that do not belong with what receivers are given must be drawn at
/// once.
pub(crate) fn jobs_of(
    index: usize,
    slot: &Slot,
    tiles: u8,
    pinned: bool,
    view: f64,
) -> (u8, Vec<Job>) {
    if pinned || tiles == 0 {
        return (tiles, Vec::new());
    }
    let job = |mask: u8| {
        let of_mask = || (0..slot.tiles.len()).filter(|bit| mask & 1 << bit != 0);
        Job {
            slot: index,
            tiles: mask,
            age: of_mask().map(|bit| slot.tiles[bit].age).max().unwrap_or(0),
            importance: view * of_mask().map(|bit| slot.tiles[bit].change).sum::<f64>(),
        }
    };
    if slot.waits_for_all() {
        return (0, vec![job(tiles)]);
    }
    let must = tiles & (slot.foreign() | slot.urgent());
    let jobs = (0..slot.tiles.len())
        .map(|bit| 1 << bit)
        .filter(|bit| tiles & !must & bit != 0)
        .map(job)
        .collect();
    (must, jobs)
}

/// Chooses jobs for a budget of tiles: half of it (rounded up) goes to those that have waited
/// longest, the rest to the most important.
///
/// Jobs are whole, so the first half may overdraw by at most five tiles (a point light that moved).
/// Every frame at least half the budget goes to the oldest, and nothing gets in before them, so no
/// job waits longer than [`longest_wait`].
pub(crate) fn choose(mut jobs: Vec<Job>, budget: u32) -> Vec<Job> {
    let mut chosen = Vec::new();
    let mut used = 0;
    jobs.sort_by(|a, b| {
        b.age
            .cmp(&a.age)
            .then(b.importance.total_cmp(&a.importance))
    });
    let mut rest = jobs.into_iter().peekable();
    while used < budget.div_ceil(2) {
        let Some(job) = rest.next() else { break };
        used += job.cost();
        chosen.push(job);
    }
    let mut rest: Vec<Job> = rest.collect();
    rest.sort_by(|a, b| b.importance.total_cmp(&a.importance));
    for job in rest {
        if used + job.cost() <= budget {
            used += job.cost();
            chosen.push(job);
        }
    }
    chosen
}

/// The most frames that a stale tile can wait, visible all the while.
pub(crate) fn longest_wait(tiles: usize, budget: u32) -> u32 {
    (tiles as u32).div_ceil(budget.div_ceil(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(slot: usize, tiles: u8, age: u32, importance: f64) -> Job {
        Job {
            slot,
            tiles,
            age,
            importance,
        }
    }

    #[test]
    fn half_goes_to_the_oldest_and_half_to_the_most_important() {
        let jobs = vec![
            job(0, 1, 0, 9.0),
            job(1, 1, 5, 1.0),
            job(2, 1, 4, 2.0),
            job(3, 1, 0, 8.0),
            job(4, 1, 0, 10.0),
        ];
        let slots: Vec<usize> = choose(jobs, 4).iter().map(|job| job.slot).collect();
        assert_eq!(slots, [1, 2, 4, 0]);
    }

    #[test]
    fn a_light_that_moved_goes_out_whole_even_over_the_budget() {
        let jobs = vec![job(0, 0b11_1111, 3, 1.0), job(1, 1, 0, 5.0)];
        let chosen = choose(jobs, 2);
        assert_eq!(chosen.len(), 1);
        assert_eq!(chosen[0].tiles, 0b11_1111);
    }

    #[test]
    fn nothing_waits_longer_than_the_stated_bound() {
        // Everything changes all the time, and one light always matters most.
        for (lights, budget) in [(4, 1), (4, 3), (16, 5), (1, 6)] {
            let mut ages = vec![0; lights * 6];
            let mut oldest = 0;
            for _ in 0..1000 {
                let jobs = ages
                    .iter()
                    .enumerate()
                    .map(|(i, &age)| job(i, 1, age, 1.0 / (i + 1) as f64))
                    .collect();
                ages.iter_mut().for_each(|age| *age += 1);
                for job in choose(jobs, budget) {
                    ages[job.slot] = 0;
                }
                oldest = ages.iter().copied().max().unwrap().max(oldest);
            }
            let bound = longest_wait(6 * lights, budget);
            assert!(oldest <= bound, "{oldest} over {bound}");
        }
    }
}
