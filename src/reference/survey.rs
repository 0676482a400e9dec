//! Choosing among many configurations by time and error.

/// A configuration with its time and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate<T> {
    /// The measured configuration, such as a descriptor.
    pub configuration: T,
    /// In any unit, less is better. Noise may make it negative where it is a difference.
    pub time: f64,
    /// In any unit, less is better; 0 is exact.
    pub error: f64,
}

/// Configurations measured on one scene, to choose from.
///
/// ```
/// use shadows::reference::Survey;
///
/// // The host's own closures: milliseconds of a frame along its camera path, and the error there,
/// // such as `Comparison::rmse`.
/// let time = |size: &u32| Ok::<_, ()>(f64::from(*size) * 1e-3);
/// let error = |size: &u32| Ok(1.0 / f64::from(*size));
/// let survey = Survey::measure([4096, 512, 1024, 2048], 5, time, error)?;
/// assert_eq!(survey.front().len(), 4);
/// assert_eq!(survey.cheapest(0.0006).unwrap().configuration, 2048);
/// assert_eq!(survey.most_exact(1.5).unwrap().configuration, 1024);
/// # Ok::<(), ()>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Survey<T> {
    candidates: Vec<Candidate<T>>,
}

impl<T> Survey<T> {
    /// From configurations that were measured elsewhere. Those whose time or error is NaN or infinite are
    /// kept but never chosen.
    pub fn new(candidates: Vec<Candidate<T>>) -> Self {
        Self { candidates }
    }

    /// Measures each configuration: its error once, and its time as the median of `rounds` rounds (at least
    /// one). Each round measures every configuration once, starting with a different one, so that a machine
    /// that slows down affects all of them.
    ///
    /// # Errors
    /// The first error that a closure returns.
    pub fn measure<E>(
        configurations: impl IntoIterator<Item = T>,
        rounds: usize,
        mut time: impl FnMut(&T) -> Result<f64, E>,
        mut error: impl FnMut(&T) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let configurations: Vec<T> = configurations.into_iter().collect();
        let count = configurations.len();
        let errors = configurations
            .iter()
            .map(&mut error)
            .collect::<Result<Vec<f64>, E>>()?;
        let mut times = vec![Vec::with_capacity(rounds); count];
        for round in 0..rounds.max(1) {
            for turn in 0..count {
                let place = (round + turn) % count;
                times[place].push(time(&configurations[place])?);
            }
        }
        let measured = configurations.into_iter().zip(times).zip(errors);
        let candidates = measured
            .map(|((configuration, times), error)| Candidate {
                configuration,
                time: median(times),
                error,
            })
            .collect();
        Ok(Self { candidates })
    }

    /// All candidates, in the order given.
    pub fn candidates(&self) -> &[Candidate<T>] {
        &self.candidates
    }

    /// The Pareto front: the candidates that no other beats in both time and error, fastest first. Among
    /// equals, only the first given is listed.
    pub fn front(&self) -> Vec<&Candidate<T>> {
        let mut sorted: Vec<&Candidate<T>> = self.usable().collect();
        sorted.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error)));
        let mut best = f64::INFINITY;
        sorted.retain(|candidate| {
            let better = candidate.error < best;
            best = best.min(candidate.error);
            better
        });
        sorted
    }

    /// The fastest whose error is at most this; `None` if there is none.
    pub fn cheapest(&self, error_at_most: f64) -> Option<&Candidate<T>> {
        let front = self.front().into_iter();
        let mut exact = front.filter(|candidate| candidate.error <= error_at_most);
        exact.next()
    }

    /// The one with the smallest error whose time is at most this; `None` if there is none.
    pub fn most_exact(&self, time_at_most: f64) -> Option<&Candidate<T>> {
        let front = self.front().into_iter();
        let fast = front.take_while(|candidate| candidate.time <= time_at_most);
        fast.last()
    }

    fn usable(&self) -> impl Iterator<Item = &Candidate<T>> {
        let candidates = self.candidates.iter();
        candidates.filter(|candidate| candidate.time.is_finite() && candidate.error.is_finite())
    }
}

/// The mean of the middle two for an even count.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    0.5 * (values[(count - 1) / 2] + values[count / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survey(measured: &[(f64, f64)]) -> Survey<usize> {
        let candidates = measured.iter().enumerate();
        Survey::new(
            candidates
                .map(|(configuration, &(time, error))| Candidate {
                    configuration,
                    time,
                    error,
                })
                .collect(),
        )
    }

    fn names(front: Vec<&Candidate<usize>>) -> Vec<usize> {
        front
            .iter()
            .map(|candidate| candidate.configuration)
            .collect()
    }

    /// What the front is by definition, for comparison: nothing is at least as good in both and
    /// better in one.
    fn unbeaten(measured: &[(f64, f64)]) -> Vec<usize> {
        let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
        let unbeaten = |&i: &usize| !measured.iter().any(|&other| beats(other, measured[i]));
        let mut front: Vec<usize> = (0..measured.len()).filter(unbeaten).collect();
        front.sort_by(|&a, &b| measured[a].0.total_cmp(&measured[b].0));
        front
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let measured = [
            (5.0, 0.0),
            (1.0, 0.9),
            (2.0, 0.9),
            (3.0, 0.2),
            (2.5, 0.5),
            (4.0, 0.2),
        ];
        assert_eq!(names(survey(&measured).front()), [1, 4, 3, 0]);
        // Pseudo-random points, on a coarse grid so that some are equal in one.
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 26)
        };
        for count in 0..40 {
            let mut measured: Vec<(f64, f64)> = (0..count).map(|_| (random(), random())).collect();
            measured.sort_by(|a, b| a.partial_cmp(b).unwrap());
            measured.dedup();
            let front = names(survey(&measured).front());
            assert_eq!(front, unbeaten(&measured));
            // The twin: the front of the same points with one of its own missing.
            if let Some(&last) = front.last() {
                let mut fewer = measured.clone();
                fewer[last] = (f64::NAN, 0.0);
                assert_ne!(names(survey(&fewer).front()), front);
            }
        }
    }

    #[test]
    fn advice_keeps_to_its_limit() {
        let survey = survey(&[(5.0, 0.0), (1.0, 0.9), (3.0, 0.2), (0.1, f64::NAN)]);
        let cheapest = |limit| survey.cheapest(limit).map(|c| c.configuration);
        let most_exact = |limit| survey.most_exact(limit).map(|c| c.configuration);
        assert_eq!([0.0, 0.2, 0.5, 1.0].map(cheapest), [0, 2, 2, 1].map(Some));
        assert_eq!([1.0, 2.9, 3.0, 9.0].map(most_exact), [1, 1, 2, 0].map(Some));
        assert_eq!((cheapest(-0.1), most_exact(0.5)), (None, None));
    }

    #[test]
    fn rounds_are_interleaved_and_medians_taken() {
        let mut order = Vec::new();
        let mut clock = 0.0;
        let survey = Survey::measure(
            ["a", "b", "c"],
            3,
            |name| {
                order.push(*name);
                clock += 1.0;
                Ok::<_, ()>(clock)
            },
            |name| Ok(name.len() as f64),
        );
        let survey = survey.unwrap();
        assert_eq!(order.concat(), "abcbcacab");
        let times: Vec<f64> = survey.candidates().iter().map(|c| c.time).collect();
        assert_eq!(times, [6.0, 4.0, 5.0]);
        let failed = Survey::measure([1], 2, |_| Err::<f64, _>("no"), |_| Ok(0.0));
        assert_eq!(failed.err(), Some("no"));
    }
}
