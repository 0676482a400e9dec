//! How a technique did, on one situation, in one round, or on all of a case.

use super::expect::Expect;
use super::seams::Rates;

/// The part of the pixels that may be wrong where [`Expect::Rare`] is said.
const RARE: f64 = 4e-6;

/// Counts of pixels, and what is to be said of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Pixels whose surface faces the light.
    pub counted: usize,
    /// Wrong pixels, edges included.
    pub wrong: usize,
    /// Lit falsely where resolution is no excuse, also where nothing was drawn.
    pub false_lit: usize,
    /// In shadow falsely where resolution is no excuse.
    pub false_shadow: usize,
    /// The largest of a round so far of `false_lit`, `false_shadow` and `wrong`, in per cent.
    pub worst: [f64; 3],
    /// Edges at a cube map's seams against those at face centres, where that is asked.
    pub rates: Option<Rates>,
    /// In how many situations.
    pub situations: usize,
    /// Of how many of these something is to be said.
    pub limits: Vec<&'static str>,
    /// What failed, by situation.
    pub failures: Vec<String>,
}

impl Outcome {
    /// Wrong pixels where resolution is no excuse.
    pub fn interior(&self) -> usize {
        self.false_lit + self.false_shadow
    }

    /// Adds what another situation, or another round, gave.
    pub fn add(&mut self, other: Self) {
        self.counted += other.counted;
        self.wrong += other.wrong;
        self.false_lit += other.false_lit;
        self.false_shadow += other.false_shadow;
        self.situations += other.situations;
        for (worst, other) in self.worst.iter_mut().zip(other.worst) {
            *worst = worst.max(other);
        }
        if let Some(rates) = other.rates {
            self.rates.get_or_insert_default().add(&rates);
        }
        for limit in other.limits {
            if !self.limits.contains(&limit) {
                self.limits.push(limit);
            }
        }
        self.failures.extend(other.failures);
    }

    /// Closes a round: fails where a known limit was left.
    pub fn end_round(&mut self, what: &str, expect: Expect) {
        let counts = [self.false_lit, self.false_shadow, self.wrong];
        self.worst = counts.map(|count| self.percent(count));
        let Expect::Limit(limit) = expect else {
            return;
        };
        let kinds = ["lit falsely", "in shadow falsely", "wrong with edges"];
        for ((share, at_most), kind) in self.worst.iter().zip(limit.at_most).zip(kinds) {
            if *share > at_most {
                self.failures.push(format!(
                    "{what}: {share:.4} % are {kind}, above the known limit of {at_most} %"
                ));
            }
        }
    }

    /// Closes all rounds: fails where more is wrong than is rare, or more at seams than elsewhere.
    pub fn end(&mut self, expect: Expect) {
        let allowed = RARE * self.counted as f64;
        let interior = self.interior();
        if matches!(expect, Expect::Rare(_)) && interior as f64 > allowed.max(1.0) {
            let counted = self.counted;
            let failure = format!("{interior} of {counted} pixels are wrong, more than rare");
            self.failures.push(failure);
        }
        self.failures
            .extend(self.rates.as_ref().and_then(Rates::failure));
    }

    /// Wrong pixels, edges included, in per cent of those that count.
    pub fn wrong_percent(&self) -> f64 {
        self.percent(self.wrong)
    }

    /// Interior errors in per cent of the pixels that count.
    pub fn interior_percent(&self) -> f64 {
        self.percent(self.interior())
    }

    fn percent(&self, count: usize) -> f64 {
        100.0 * count as f64 / self.counted.max(1) as f64
    }
}
