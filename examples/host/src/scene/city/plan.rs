//! Where the town's avenues, streets and blocks are.

use shadows::glam::{Vec2, vec2};

/// Height of pavements above the road.
pub const PAVEMENT: f32 = 0.15;
/// The middles of the avenues, which run along z, and of the streets, along x.
const AVENUES: [f32; 5] = [-88.0, -44.0, 0.0, 44.0, 88.0];
const STREETS: [f32; 6] = [106.0, 58.0, 10.0, -38.0, -86.0, -134.0];
/// The main avenue's number, and the place of the square among the blocks.
const MAIN: usize = 2;
const SQUARE: [usize; 2] = [2, 1];

/// From the middle of an avenue to the kerb and to the houses.
pub fn avenue_half(avenue: usize) -> [f32; 2] {
    if avenue == MAIN {
        [4.6, 8.6]
    } else {
        STREET_HALF
    }
}

/// The same of a street.
pub const STREET_HALF: [f32; 2] = [3.4, 6.0];

/// A rectangle of x and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    pub min: Vec2,
    pub max: Vec2,
}

/// What lies between four streets.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Within the kerbs.
    pub kerb: Area,
    /// Where houses may stand.
    pub houses: Area,
    /// Without houses.
    pub square: bool,
}

/// All of them.
pub fn blocks() -> impl Iterator<Item = Block> {
    (0..AVENUES.len() - 1).flat_map(|i| (0..STREETS.len() - 1).map(move |j| block(i, j)))
}

/// The one without houses.
pub fn market() -> Area {
    block(SQUARE[0], SQUARE[1]).kerb
}

fn block(i: usize, j: usize) -> Block {
    let area = |at: usize| {
        let [low, high] = [
            STREETS[j + 1] + STREET_HALF[at],
            STREETS[j] - STREET_HALF[at],
        ];
        Area {
            min: vec2(AVENUES[i] + avenue_half(i)[at], low),
            max: vec2(AVENUES[i + 1] - avenue_half(i + 1)[at], high),
        }
    };
    Block {
        kerb: area(0),
        houses: area(1),
        square: [i, j] == SQUARE,
    }
}

/// A road between two crossings: its ends, and from its middle to the kerb and the houses.
#[derive(Clone, Copy, Debug)]
pub struct Road {
    pub from: Vec2,
    pub to: Vec2,
    pub half: [f32; 2],
    pub main: bool,
}

/// All of them: the avenues' pieces, then the streets'.
pub fn roads() -> Vec<Road> {
    let mut roads = Vec::new();
    for (i, &x) in AVENUES.iter().enumerate() {
        roads.extend(STREETS.windows(2).map(|ends| Road {
            from: vec2(x, ends[0] - STREET_HALF[0]),
            to: vec2(x, ends[1] + STREET_HALF[0]),
            half: avenue_half(i),
            main: i == MAIN,
        }));
    }
    for z in STREETS {
        roads.extend((0..AVENUES.len() - 1).map(|i| Road {
            from: vec2(AVENUES[i] + avenue_half(i)[0], z),
            to: vec2(AVENUES[i + 1] - avenue_half(i + 1)[0], z),
            half: STREET_HALF,
            main: false,
        }));
    }
    roads
}

/// What is painted on the road: broken lines and crossings, as least and greatest x and z.
pub fn markings() -> Vec<(Vec2, Vec2)> {
    let mut all = Vec::new();
    for road in roads() {
        let length = road.from.distance(road.to);
        let along = (road.to - road.from) / length;
        let aside = along.perp();
        let mut add = |at: f32, off: f32, half: Vec2| {
            let middle = road.from + along * at + aside * off;
            let reach = (along * half.x + aside * half.y).abs();
            all.push((middle - reach, middle + reach));
        };
        if road.main {
            for at in 0..(length / 4.0) as u32 {
                add(4.0 * at as f32 + 2.0, 0.0, vec2(0.9, 0.06));
            }
        }
        // Zebra crossings on the main avenue and the streets at the square.
        if road.main {
            for end in [1.9, length - 1.9] {
                for stripe in -4..=4 {
                    add(end, stripe as f32 * 0.95, vec2(1.3, 0.24));
                }
            }
        }
    }
    all
}

/// Whether the middle of a row of houses, on its front, is where the church looks over the square.
pub fn faces_market(middle: Vec2) -> bool {
    let market = market();
    let across = market.min.y - 2.0 * STREET_HALF[0] - (STREET_HALF[1] - STREET_HALF[0]);
    (middle.y - across).abs() < 0.1 && middle.x > market.min.x && middle.x < market.max.x
}
