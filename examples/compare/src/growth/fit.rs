//! How fast something grows: the slope of a line through logarithms.

/// A power law through points: y is about x to the power of `slope`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    pub slope: f64,
    /// Standard error of the slope; `None` where two points leave nothing to tell it from.
    pub error: Option<f64>,
    pub points: usize,
}

/// The fit to the upper half of the range: the points whose x is at least the geometric mean of the
/// least and the greatest (below, what does not grow at all still counts), or the last two if
/// there is but one. Least squares in the logarithms. Points that are not above 0 have none and are
/// left out; `None` if fewer than two values of x remain.
pub fn upper(points: &[(f64, f64)]) -> Option<Fit> {
    let mut logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|(x, y)| *x > 0.0 && *y > 0.0)
        .map(|(x, y)| (x.ln(), y.ln()))
        .collect();
    logs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (logs.first()?.0, logs.last()?.0);
    let middle = 0.5 * (first + last);
    // A hair lower, so that rounding does not decide on a point that lies in the middle.
    let above = logs.partition_point(|(x, _)| *x < middle - 1e-9 * (last - first));
    least_squares(&logs[above.min(logs.len().saturating_sub(2))..])
}

/// How fast what comes on top of the first point grows: the fit to each y less that of the least x.
/// Where a cost that does not grow, as of a submission or of draws, is a good part of the points, this
/// tells the rest from it. `None` if the last y is not above the first by a quarter: that does not
/// grow.
pub fn added(points: &[(f64, f64)]) -> Option<Fit> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ((_, start), (_, end)) = (*sorted.first()?, *sorted.last()?);
    if end.is_nan() || end <= 1.25 * start {
        return None;
    }
    let rest: Vec<(f64, f64)> = sorted[1..].iter().map(|&(x, y)| (x, y - start)).collect();
    upper(&rest)
}

fn least_squares(points: &[(f64, f64)]) -> Option<Fit> {
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    if points.len() < 2 || spread <= 0.0 {
        return None;
    }
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    let missed = |p: &(f64, f64)| (p.1 - y - slope * (p.0 - x)).powi(2);
    let error = match points.len() {
        2 => None,
        _ => Some((points.iter().map(missed).sum::<f64>() / (count - 2.0) / spread).sqrt()),
    };
    Some(Fit {
        slope,
        error,
        points: points.len(),
    })
}

impl Fit {
    /// The slope in a word. A fifth of a power is what measured times leave open.
    pub fn word(&self) -> &'static str {
        match self.slope {
            slope if slope < 0.2 => "flat",
            slope if slope < 0.8 => "below linear",
            slope if slope <= 1.2 => "linear",
            _ => "above linear",
        }
    }
}
