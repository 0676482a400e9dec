//! The margin around what is known of a map.

/// Gives texels that are not known the mean of their known neighbours, eight at most, `margin` times over, so that
/// the content grows by a texel each time. Values are row-major.
pub(super) fn grow(values: &mut [f32], known: &mut [bool], width: u32, margin: u32) {
    let width = width as usize;
    let mut edge: Vec<usize> = (0..values.len()).filter(|&at| known[at]).collect();
    for _ in 0..margin {
        let mut next: Vec<usize> = edge
            .iter()
            .flat_map(|&at| neighbours(at, width, values.len()))
            .filter(|&at| !known[at])
            .collect();
        next.sort_unstable();
        next.dedup();
        let grown: Vec<f32> = next
            .iter()
            .map(|&at| {
                let near = neighbours(at, width, known.len()).filter(|&other| known[other]);
                let (sum, count) = near.fold((0.0, 0), |(sum, count), other| {
                    (sum + f64::from(values[other]), count + 1)
                });
                (sum / f64::from(count)) as f32
            })
            .collect();
        if next.is_empty() {
            return;
        }
        for (&at, value) in next.iter().zip(grown) {
            (values[at], known[at]) = (value, true);
        }
        edge = next;
    }
}

/// The texels around one, inside the map.
pub(super) fn neighbours(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y, height) = (at % width, at / width, count / width);
    let columns = x.saturating_sub(1)..=(x + 1).min(width - 1);
    let rows = y.saturating_sub(1)..=(y + 1).min(height - 1);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
        .filter(move |&other| other != at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_grows_by_its_margin_and_no_more() {
        let mut values = vec![0.0; 7 * 5];
        let mut known = vec![false; 7 * 5];
        for (at, value) in [(2 * 7 + 1, 0.5), (2 * 7 + 2, 1.0)] {
            (values[at], known[at]) = (value, true);
        }
        grow(&mut values, &mut known, 7, 1);
        assert_eq!(known.iter().filter(|known| **known).count(), 4 * 3);
        assert_eq!([values[7], values[7 + 1], values[7 + 3]], [0.5, 0.75, 1.0]);
        assert_eq!(values[2 * 7 + 4], 0.0);
        grow(&mut values, &mut known, 7, 1);
        assert_eq!(known.iter().filter(|known| **known).count(), 5 * 5);
        grow(&mut values, &mut known, 7, 9);
        assert!(known.iter().all(|known| *known));
        let nothing = &mut vec![false; 4];
        grow(&mut [0.0; 4], nothing, 2, 3);
        assert_eq!(nothing, &[false; 4]);
    }
}
