//! The size of each light's tiles: by their importance on screen, within a memory limit.

use crate::error::TileSizeError;

/// Texels along a side of a light's tiles: each face of a point light, the map of a spot, each cascade
/// of a directional light.
///
/// Sizes are powers of two, from the smallest tile of the atlas to a whole layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TileSize {
    /// This many, whatever the view. They are never made smaller: if all lights of fixed sizes do not fit the
    /// atlas together, that is an error.
    Fixed(u32),
    /// Enough for one texel per pixel at the far end of the light's range, if that is visible, within `least`
    /// and `most`. A directional light has no range and gets `most`.
    ///
    /// A size is kept as long as it gives 1 to 2.5 texels per pixel, so that small camera movements change
    /// nothing, and as long as the light is not visible at all.
    ///
    /// If the atlas has no room for all of them, lights that are not visible are reduced first, down to
    /// `least`. Then visible ones are halved in rounds until all fit, each at most once per round, starting
    /// with the least important (in octaves of the desired size; among equals, the last in the frame's list
    /// first). Statistics count the lights that wanted more.
    Auto {
        /// The fewest texels along a side.
        least: u32,
        /// The most texels along a side.
        most: u32,
    },
}

impl TileSize {
    /// Checks the numbers against the atlas's smallest tile and its layers.
    pub(crate) fn validate(self, smallest: u32, layer_side: u32) -> Result<(), TileSizeError> {
        let check = |field, texels: u32| {
            let is_size = texels.is_power_of_two() && (smallest..=layer_side).contains(&texels);
            match is_size {
                true => Ok(()),
                false => Err(TileSizeError::Size {
                    field,
                    texels,
                    least: smallest,
                    most: layer_side,
                }),
            }
        };
        match self {
            Self::Fixed(texels) => check("TileSize::Fixed", texels),
            Self::Auto { least, most } => {
                check("TileSize::Auto::least", least)?;
                check("TileSize::Auto::most", most)?;
                match least <= most {
                    true => Ok(()),
                    false => Err(TileSizeError::Order { least, most }),
                }
            }
        }
    }

    /// The largest that it may be.
    pub(crate) fn most(self) -> u32 {
        match self {
            Self::Fixed(texels) => texels,
            Self::Auto { most, .. } => most,
        }
    }

    fn least(self) -> u32 {
        match self {
            Self::Fixed(texels) => texels,
            Self::Auto { least, .. } => least,
        }
    }
}

/// A light's claim to texels. Its size has passed [`TileSize::validate`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct SizeRequest {
    pub size: TileSize,
    /// Six for a point light, one for a spot, one for each cascade.
    pub tiles: u32,
    /// Texels along a side for one a pixel, at least 0: see [`importance`](super::importance). 0 if the
    /// light lights nothing that is seen; infinite if it lights everything.
    pub importance: f64,
    /// What the last frame gave it.
    pub last: Option<Standing>,
}

/// What a light got, and what the next frame must know of why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Standing {
    /// Texels along a side.
    pub size: u32,
    /// Texels along a side if there were room for all.
    pub wanted: u32,
    /// The power of two that gives a texel a pixel, whatever sizes are allowed.
    octave: u32,
}

/// Importance is in a size's band from this share of it up to all of it. After a change to the size
/// that fits, importance is no less than half of it (or size 1): so it must change by a quarter at least
/// before the size changes back.
const BAND: f64 = 0.4;

/// The largest octave: `u32` has no larger power of two.
const LAST_OCTAVE: u32 = 31;

/// A size for each light, no more than `bound` texels in all.
///
/// A function of the lights' octaves, which have hysteresis, and not of their importance as it is: what
/// moves within its band changes no size, not of others either, nor which of them are halved. Sorting is
/// all that is not linear.
///
/// # Errors
/// [`TileSizeError::Space`] if they do not fit with every light at its least.
pub(crate) fn choose_sizes(
    requests: &[SizeRequest],
    bound: u64,
) -> Result<Vec<Standing>, TileSizeError> {
    let needed = texels_of(requests, |request| request.size.least());
    if needed > bound {
        return Err(TileSizeError::Space {
            lights: requests.len(),
            needed,
            bound,
        });
    }
    let mut standings: Vec<Standing> = requests.iter().map(unbounded).collect();
    let mut sizes = standings.iter();
    let mut total = texels_of(requests, |_| sizes.next().map_or(0, |light| light.size));
    let (seen, unseen) = by_rank(requests, &standings);
    // Every light at its least fits, so both loops end.
    for order in [unseen, seen] {
        let mut halved = true;
        while total > bound && halved {
            halved = false;
            for &light in &order {
                let (request, size) = (&requests[light], &mut standings[light].size);
                if *size <= request.size.least() {
                    continue;
                }
                *size /= 2;
                halved = true;
                total -= 3 * u64::from(request.tiles) * u64::from(*size).pow(2);
                if total <= bound {
                    break;
                }
            }
        }
    }
    Ok(standings)
}

fn texels_of(requests: &[SizeRequest], mut size: impl FnMut(&SizeRequest) -> u32) -> u64 {
    let texels = |request: &SizeRequest| u64::from(request.tiles) * u64::from(size(request)).pow(2);
    requests.iter().map(texels).sum()
}

/// The lights that are seen and those that are not, each from the first that is to be halved.
fn by_rank(requests: &[SizeRequest], standings: &[Standing]) -> (Vec<usize>, Vec<usize>) {
    let mut order: Vec<usize> = (0..requests.len()).rev().collect();
    order.sort_by_key(|&light| standings[light].octave);
    order
        .into_iter()
        .partition(|&light| requests[light].importance > 0.0)
}

/// What a light would get if there were room for all.
fn unbounded(request: &SizeRequest) -> Standing {
    let octave = octave(request.importance, request.last.map(|last| last.octave));
    let size = match request.size {
        TileSize::Fixed(texels) => texels,
        TileSize::Auto { least, most } => (1_u32 << octave).clamp(least, most),
    };
    Standing {
        size,
        wanted: size,
        octave,
    }
}

/// The power of two for a texel a pixel: the last one while importance is in its band, or while nothing
/// is known of it.
fn octave(importance: f64, last: Option<u32>) -> u32 {
    let size = |octave: u32| f64::from(1_u32 << octave);
    match last {
        Some(last) if importance == 0.0 => last,
        Some(last) if importance <= size(last) && importance >= BAND * size(last) => last,
        _ => (0..LAST_OCTAVE)
            .find(|&octave| importance <= size(octave))
            .unwrap_or(LAST_OCTAVE),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const AUTO: TileSize = TileSize::Auto {
        least: 64,
        most: 1024,
    };

    fn lamp(importance: f64) -> SizeRequest {
        SizeRequest {
            size: AUTO,
            tiles: 6,
            importance,
            last: None,
        }
    }

    fn sizes(requests: &[SizeRequest], bound: u64) -> Vec<u32> {
        let standings = choose_sizes(requests, bound).unwrap();
        standings.iter().map(|light| light.size).collect()
    }

    /// The next frame's requests, with other importances.
    fn then(requests: &mut [SizeRequest], bound: u64, importances: &[f64]) {
        let standings = choose_sizes(requests, bound).unwrap();
        let next = standings.into_iter().zip(importances);
        for (request, (standing, &importance)) in requests.iter_mut().zip(next) {
            (request.last, request.importance) = (Some(standing), importance);
        }
    }

    #[test]
    fn a_texel_a_pixel_within_what_is_allowed() {
        let wanted = [0.0, 10.0, 64.0, 64.5, 700.0, 1024.0, 5000.0, f64::INFINITY];
        let requests = wanted.map(lamp);
        assert_eq!(
            sizes(&requests, u64::MAX),
            [64, 64, 64, 128, 1024, 1024, 1024, 1024]
        );
        let fixed = SizeRequest {
            size: TileSize::Fixed(256),
            ..lamp(5000.0)
        };
        assert_eq!(sizes(&[fixed], u64::MAX), [256]);
    }

    #[test]
    fn a_size_changes_only_when_importance_leaves_its_band() {
        let mut lights = [lamp(300.0)];
        for (importance, size) in [
            (512.0, 512),
            (205.0, 512),
            (512.0, 512),
            (512.1, 1024),
            (410.0, 1024),
            (409.0, 512),
            (512.0, 512),
            (204.0, 256),
            (256.0, 256),
            (90.0, 128),
            // Out of sight it keeps what it has.
            (0.0, 128),
            (60.0, 128),
            (50.0, 64),
        ] {
            then(&mut lights, u64::MAX, &[importance]);
            assert_eq!(sizes(&lights, u64::MAX), [size], "{importance}");
        }
    }

    /// How many sizes change in all while a camera moves to and fro among many lights, in room for half of
    /// what they want.
    fn flips(to_and_fro: f64, hysteresis: bool) -> usize {
        let far: Vec<f64> = (0..300).map(|i| 32.0 * 1.013_f64.powi(i)).collect();
        let near: Vec<f64> = far.iter().map(|far| far * to_and_fro).collect();
        let mut lights: Vec<SizeRequest> = near.iter().copied().map(lamp).collect();
        let bound = texels_of(&lights, |light| unbounded(light).size) / 2;
        let first = sizes(&lights, bound);
        assert!(
            first
                .iter()
                .zip(&lights)
                .any(|(&size, light)| size < unbounded(light).size)
        );
        let mut flips = 0;
        for frame in 0..20 {
            then(
                &mut lights,
                bound,
                if frame % 2 == 0 { &far } else { &near },
            );
            if !hysteresis {
                lights.iter_mut().for_each(|light| light.last = None);
            }
            let now = sizes(&lights, bound);
            flips += now
                .iter()
                .zip(&first)
                .filter(|(now, first)| now != first)
                .count();
        }
        flips
    }

    #[test]
    fn a_camera_that_moves_to_and_fro_flips_no_size() {
        // A size that fits is more than half full, and is kept down to 0.4.
        assert_eq!(flips(1.25, true), 0);
        assert!(flips(1.25, false) > 300);
        assert!(flips(1.3, true) > 0);
    }

    #[test]
    fn the_least_important_are_halved_first() {
        let requests = [1000.0, 100.0, 400.0, 450.0, 0.0, 30.0].map(lamp);
        let texels = |sizes: &[u32]| sizes.iter().map(|&s| 6 * u64::from(s).pow(2)).sum::<u64>();
        for expected in [
            [1024, 128, 512, 512, 64, 64],
            [1024, 64, 512, 512, 64, 64],
            // Of equals, the last of the list.
            [1024, 64, 512, 256, 64, 64],
            [1024, 64, 256, 256, 64, 64],
            [512, 64, 256, 256, 64, 64],
            [512, 64, 256, 128, 64, 64],
            [512, 64, 128, 128, 64, 64],
            [256, 64, 128, 128, 64, 64],
            [256, 64, 128, 64, 64, 64],
            [256, 64, 64, 64, 64, 64],
            [128, 64, 64, 64, 64, 64],
            [64; 6],
        ] {
            assert_eq!(sizes(&requests, texels(&expected)), expected);
        }
        let bound = texels(&[64; 6]) - 1;
        let (lights, needed) = (6, bound + 1);
        let error = TileSizeError::Space {
            lights,
            needed,
            bound,
        };
        assert_eq!(choose_sizes(&requests, bound), Err(error));
    }

    #[test]
    fn what_is_not_seen_is_the_first_to_get_less_and_down_to_its_least() {
        let mut lights = [500.0, 500.0].map(lamp);
        then(&mut lights, u64::MAX, &[0.0, 100.0]);
        assert_eq!(sizes(&lights, u64::MAX), [512, 128]);
        let bound = 6 * (128 * 128 + 64 * 64);
        assert_eq!(sizes(&lights, bound), [64, 128]);
    }

    #[test]
    fn a_fixed_size_is_never_halved() {
        let fixed = SizeRequest {
            size: TileSize::Fixed(1024),
            tiles: 1,
            ..lamp(0.0)
        };
        let auto = lamp(2000.0);
        assert_eq!(sizes(&[fixed, auto], 1024 * 1024 + 6 * 64 * 64), [1024, 64]);
        let bound = 1024 * 1024 + 6 * 64 * 64 - 1;
        let error = choose_sizes(&[fixed, auto], bound).unwrap_err();
        let said = error.to_string();
        for number in ["2 lights", "1073152", "1073151"] {
            assert!(said.contains(number), "{said}");
        }
    }

    #[test]
    fn sizes_that_are_none_are_named() {
        let size = |field, texels| TileSizeError::Size {
            field,
            texels,
            least: 32,
            most: 2048,
        };
        for texels in [0, 16, 48, 4096, u32::MAX] {
            let error = size("TileSize::Fixed", texels);
            assert_eq!(TileSize::Fixed(texels).validate(32, 2048), Err(error));
            assert!(error.to_string().contains("power of two from 32 to 2048"));
            let auto = TileSize::Auto {
                least: texels,
                most: 2048,
            };
            let error = size("TileSize::Auto::least", texels);
            assert_eq!(auto.validate(32, 2048), Err(error));
            let auto = TileSize::Auto {
                least: 32,
                most: texels,
            };
            let error = size("TileSize::Auto::most", texels);
            assert_eq!(auto.validate(32, 2048), Err(error));
        }
        let (least, most) = (512, 256);
        let error = TileSizeError::Order { least, most };
        let auto = TileSize::Auto { least, most };
        assert_eq!(auto.validate(32, 2048), Err(error));
        for sound in [AUTO, TileSize::Fixed(32), TileSize::Fixed(2048)] {
            assert_eq!(sound.validate(32, 2048), Ok(()));
        }
    }

    fn request() -> impl Strategy<Value = SizeRequest> {
        let auto = (4..8_u32, 0..4_u32).prop_map(|(least, up)| TileSize::Auto {
            least: 1 << least,
            most: 1 << (least + up),
        });
        let size = prop_oneof![
            1 => (4..8_u32).prop_map(|size| TileSize::Fixed(1 << size)),
            6 => auto,
        ];
        let importance = prop_oneof![1 => Just(0.0), 1 => Just(f64::INFINITY), 8 => 1.0..3000.0];
        let last = prop::option::of(0..14_u32);
        (size, 1..9_u32, importance, last).prop_map(|(size, tiles, importance, octave)| {
            let last = octave.map(|octave| Standing {
                size: size.least(),
                wanted: size.least(),
                octave,
            });
            SizeRequest {
                size,
                tiles,
                importance,
                last,
            }
        })
    }

    /// One halving at a time: of a light that is not seen, or else of the one that was halved least
    /// often, or else of the least important, or else of the last.
    fn halved_one_by_one(requests: &[SizeRequest], bound: u64) -> Vec<Standing> {
        let mut standings: Vec<Standing> = requests.iter().map(unbounded).collect();
        let mut halvings = vec![0; requests.len()];
        loop {
            let mut given = standings.iter();
            if texels_of(requests, |_| given.next().unwrap().size) <= bound {
                return standings;
            }
            let next = (0..requests.len())
                .filter(|&i| standings[i].size > requests[i].size.least())
                .min_by_key(|&i| {
                    let seen = requests[i].importance > 0.0;
                    (seen, halvings[i], standings[i].octave, requests.len() - i)
                })
                .unwrap();
            standings[next].size /= 2;
            halvings[next] += 1;
        }
    }

    proptest! {
        #[test]
        fn sizes_are_what_halving_one_by_one_gives(
            requests in prop::collection::vec(request(), 0..40),
            share in 0.0..1.3_f64,
        ) {
            let least = texels_of(&requests, |request| request.size.least());
            let most = texels_of(&requests, |request| unbounded(request).size);
            let bound = (least as f64 + (most - least) as f64 * share) as u64;
            let standings = choose_sizes(&requests, bound).unwrap();
            prop_assert_eq!(&standings, &halved_one_by_one(&requests, bound));
            let mut given = standings.iter();
            prop_assert!(texels_of(&requests, |_| given.next().unwrap().size) <= bound);
            for (request, given) in requests.iter().zip(&standings) {
                prop_assert!(given.size.is_power_of_two() && given.size <= given.wanted);
                prop_assert!(given.size >= request.size.least());
            }
            // The same again is the same; more room makes nothing smaller.
            let again: Vec<SizeRequest> = requests
                .iter()
                .zip(&standings)
                .map(|(request, &given)| SizeRequest { last: Some(given), ..*request })
                .collect();
            prop_assert_eq!(&choose_sizes(&again, bound).unwrap(), &standings);
            let roomier = choose_sizes(&requests, bound + bound / 3 + 1).unwrap();
            prop_assert!(roomier.iter().zip(&standings).all(|(a, b)| a.size >= b.size));
            if least > 0 {
                prop_assert!(choose_sizes(&requests, least - 1).is_err());
            }
        }

        #[test]
        fn a_light_changes_no_other_where_there_is_room(
            requests in prop::collection::vec(request(), 1..40),
            which in any::<prop::sample::Index>(),
            importance in 0.0..3000.0,
        ) {
            let mut other = requests.clone();
            let which = which.index(other.len());
            other[which].importance = importance;
            let (before, after) = (
                choose_sizes(&requests, u64::MAX).unwrap(),
                choose_sizes(&other, u64::MAX).unwrap(),
            );
            for (light, (before, after)) in before.iter().zip(&after).enumerate() {
                prop_assert!(light == which || before == after);
            }
        }
    }
}
