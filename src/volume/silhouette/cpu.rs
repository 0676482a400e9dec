//! Extraction on the CPU: two bits of facing a triangle, then the edges between unequal ones.
//!
//! Most triangles tell their side by their plane, 64 at a time, and most blocks of edges have only
//! triangles that face alike: what is left is the silhouette's neighbourhood.

use glam::{Vec3, Vec4};
use wgpu::WriteOnly;

use super::light_side::light_side;
use crate::mesh::{BLOCK, BlockWords, Facings, LANES, MeshData, MeshKind};
use crate::volume::decide::facing::Counted;
use crate::volume::plan::params::InstanceParams;

/// What an extraction found. Kept for its memory.
#[derive(Debug, Default)]
pub(crate) struct CpuVolume {
    facings: Vec<Facings>,
    /// `edge << 1 | flipped`, once for each side.
    pub sides: Vec<u32>,
}

/// How many indices and sides a volume has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub front: u32,
    pub back: u32,
    pub sides: u32,
}

impl CpuVolume {
    /// Finds the volume of one instance, as `volume_facing.wgsl` and `volume_edges.wgsl` do.
    pub fn extract(
        &mut self,
        mesh: &MeshData,
        kind: MeshKind,
        instance: &InstanceParams,
    ) -> Counts {
        self.find_facings(mesh, instance);
        self.find_sides(mesh, kind);
        let corners = |side: fn(&Facings) -> u64| {
            let triangles = self.facings.iter().map(|word| side(word).count_ones());
            3 * triangles.sum::<u32>()
        };
        // Each below 2^32 because its region is.
        Counts {
            front: corners(|word| word.front),
            back: corners(|word| word.back),
            sides: self.sides.len() as u32,
        }
    }

    /// Writes the indices of the caps, those that count +1 before those that count -1, in as many
    /// bytes as they have.
    pub fn write_caps(&self, mesh: &MeshData, mut caps: WriteOnly<'_, [u8]>) {
        for side in [|word: &Facings| word.front, |word: &Facings| word.back] {
            for (word, triangles) in self.facings.iter().zip(mesh.triangles.chunks(LANES)) {
                for run in runs(side(word)) {
                    let indices: &[u8] = bytemuck::cast_slice(&triangles[run]);
                    if let Some(mut place) = caps.split_off(..indices.len()) {
                        place.copy_from_slice(indices);
                    }
                }
            }
        }
    }

    /// The triangles that are caps.
    pub fn caps<'a>(&'a self, mesh: &'a MeshData) -> impl Iterator<Item = &'a [u32; 3]> {
        let words = self.facings.iter().zip(mesh.triangles.chunks(LANES));
        words.flat_map(|(word, triangles)| {
            ones(word.front | word.back).filter_map(|place| triangles.get(place))
        })
    }

    fn find_facings(&mut self, mesh: &MeshData, instance: &InstanceParams) {
        let light = Vec4::from(instance.light);
        let rest = Vec3::from(instance.light_rest);
        let planes = mesh.planes();
        self.facings.clear();
        self.facings
            .extend(planes.facings(planes.light(light, rest)));
        for (word, triangles) in self.facings.iter_mut().zip(mesh.triangles.chunks(LANES)) {
            let present = u64::MAX >> (LANES - triangles.len());
            for place in ones(!(word.front | word.back) & present) {
                let corners = triangles[place].map(|v| Vec3::from(mesh.positions[v as usize]));
                let side = light_side(corners[0], corners[1], corners[2], light, rest);
                word.front |= u64::from(side > 0) << place;
                word.back |= u64::from(side < 0) << place;
            }
            if instance.both_sides == Counted::LightFacing as u32 {
                word.back = 0;
            }
            if instance.both_sides == Counted::AwayFacing as u32 {
                word.front = 0;
            }
        }
    }

    fn find_sides(&mut self, mesh: &MeshData, kind: MeshKind) {
        self.sides.clear();
        let firsts = (0u32..).step_by(BLOCK);
        let edges = mesh.edges.chunks(BLOCK).zip(firsts);
        for (block, (edges, first)) in mesh.blocks(kind).iter().zip(edges) {
            if !self.may_have_sides(block) {
                continue;
            }
            match kind {
                MeshKind::Closed => self.find_sides_closed(edges, first),
                MeshKind::General => self.find_sides_general(mesh, edges, first),
            }
        }
    }

    /// Whether the triangles of a block of edges are not all known to face alike.
    fn may_have_sides(&self, block: BlockWords<'_>) -> bool {
        let Some(words) = block.words else {
            return true;
        };
        let (mut front, mut back, mut any) = (u64::MAX, u64::MAX, 0);
        for word in words {
            let word = self.facings[*word as usize];
            front &= word.front;
            back &= word.back;
            any |= word.front | word.back;
        }
        let alike = front == u64::MAX || back == u64::MAX;
        !(any == 0 || (block.balanced && alike))
    }

    fn find_sides_closed(&mut self, edges: &[[u32; 4]], first: u32) {
        for (edge, &[_, _, there, back]) in (first..).zip(edges) {
            let sum = self.facing(there) - self.facing(back);
            if sum != 0 {
                self.push(edge, sum);
            }
        }
    }

    fn find_sides_general(&mut self, mesh: &MeshData, edges: &[[u32; 4]], first: u32) {
        for (edge, record) in (first..).zip(edges) {
            let mut sum = 0;
            mesh.for_each_use(record, MeshKind::General, |triangle, reversed| {
                let count = self.facing(triangle);
                sum += if reversed { -count } else { count };
            });
            self.push(edge, sum);
        }
    }

    fn facing(&self, triangle: u32) -> i32 {
        let word = self.facings[triangle as usize / LANES];
        let place = triangle as usize % LANES;
        let bit = |word: u64| (word >> place & 1) as i32;
        bit(word.front) - bit(word.back)
    }

    /// An edge that the caps' boundary runs through `sum` times.
    fn push(&mut self, edge: u32, sum: i32) {
        let side = edge << 1 | u32::from(sum < 0);
        for _ in 0..sum.unsigned_abs() {
            self.sides.push(side);
        }
    }
}

/// The places of the ones in a word.
fn ones(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = word.trailing_zeros() as usize;
        word &= word.wrapping_sub(1);
        (place < LANES).then_some(place)
    })
}

/// The places of the ones in a word, those that follow each other together.
fn runs(mut word: u64) -> impl Iterator<Item = std::ops::Range<usize>> {
    std::iter::from_fn(move || {
        let begin = word.trailing_zeros();
        if begin as usize == LANES {
            return None;
        }
        let end = begin + (word >> begin).trailing_ones();
        word &= u64::MAX.checked_shl(end).unwrap_or(0);
        Some(begin as usize..end as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from -1 to 1 (Steele and Vigna's LCG, 2021; its upper bits).
    fn random(state: &mut u64) -> f32 {
        *state = state.wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(1);
        ((*state >> 40) as f32) / 8_388_608.0 - 1.0
    }

    /// A closed, bumpy ball of `n` rings and sectors.
    fn ball(n: u32, size: f32, offset: f32) -> (MeshData, MeshKind) {
        let mut state = 7;
        let at = |i: u32, j: u32| match i {
            0 => 0,
            i if i == n => 1,
            i => 2 + (i - 1) * n + j % n,
        };
        let mut positions = vec![
            [offset, offset + size, offset],
            [offset, offset - size, offset],
        ];
        let mut indices = Vec::new();
        for i in 0..n {
            for j in 0..n {
                if i > 0 {
                    let (s, c) = (std::f32::consts::PI * i as f32 / n as f32).sin_cos();
                    let (x, z) = (std::f32::consts::TAU * j as f32 / n as f32).sin_cos();
                    let radius = size * (1.0 + 0.01 * random(&mut state));
                    positions.push([x * s, c, z * s].map(|p| p * radius + offset));
                    indices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                }
                indices.extend([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        MeshData::of(&positions, &indices.into_iter().collect::<Vec<u32>>())
    }

    /// An open, bumpy sheet of `n` times `n` squares: from far above, all of it faces alike.
    fn sheet(n: u32) -> (MeshData, MeshKind) {
        let mut state = 3;
        let at = |x, z| z * (n + 1) + x;
        let mut positions = Vec::new();
        let mut indices = Vec::new();
        for (z, x) in (0..=n).flat_map(|z| (0..=n).map(move |x| (z, x))) {
            positions.push([x as f32, 0.1 * random(&mut state), z as f32]);
            if x < n && z < n {
                let [a, b, c, d] = [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)];
                indices.extend([a, b, c, a, c, d]);
            }
        }
        MeshData::of(&positions, &indices)
    }

    /// Triangles anywhere, a third of them slivers, and edges that many of them share.
    fn soup(size: f32) -> (MeshData, MeshKind) {
        let mut state = 11;
        let mut point = |scale: [f32; 3]| scale.map(|s| s * size * random(&mut state));
        let mut positions: Vec<[f32; 3]> = (0..300).map(|_| point([1.0; 3])).collect();
        positions.extend((0..100).map(|_| point([1.0, 1e-7, 0.0])));
        let indices: Vec<u32> = (0..900).map(|i| i * i % 401 % 400).collect();
        MeshData::of(&positions, &indices)
    }

    fn meshes() -> Vec<(MeshData, MeshKind)> {
        vec![
            ball(40, 1.0, 0.0),
            ball(13, 1e-12, 0.0),
            ball(24, 1.0, 1e3),
            soup(1.0),
            soup(1e15),
            sheet(40),
        ]
    }

    /// Lights all over, and close to the planes of triangles.
    fn lights(mesh: &MeshData) -> Vec<InstanceParams> {
        let mut lights = Vec::new();
        let mut state = 5;
        for triangle in mesh.triangles.iter().step_by(mesh.triangles.len() / 25) {
            let [a, b, c] = triangle.map(|v| Vec3::from(mesh.positions[v as usize]));
            let in_plane = a + (b - a) * 3.0 - (c - a) * 1.7;
            let off = Vec3::from_array([(); 3].map(|()| random(&mut state))) * (b - a).length();
            for (light, rest) in [
                (in_plane.extend(1.0), off * 1e-8),
                ((in_plane + off * 1e-6).extend(1.0), Vec3::ZERO),
                ((a + off * 1e4).extend(1.0), Vec3::ZERO),
                (
                    ((b - a).normalize() * 1.5).extend(0.0),
                    off.normalize() * 1e-8,
                ),
            ] {
                for both_sides in [0, 1, 2] {
                    lights.push(InstanceParams {
                        light: light.to_array(),
                        light_rest: rest.to_array(),
                        both_sides,
                        ..bytemuck::Zeroable::zeroed()
                    });
                }
            }
        }
        lights
    }

    /// The rule for each triangle, then a look at every edge.
    fn plainly(mesh: &MeshData, kind: MeshKind, instance: &InstanceParams) -> [Vec<u32>; 3] {
        let (light, rest) = (instance.light.into(), instance.light_rest.into());
        let lowest = if instance.both_sides == 0 { 0 } else { -1 };
        let highest = if instance.both_sides == 2 { 0 } else { 1 };
        let facing = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|v| Vec3::from(mesh.positions[v as usize]));
            i32::from(light_side(a, b, c, light, rest).clamp(lowest, highest))
        };
        let facings: Vec<i32> = mesh.triangles.iter().map(facing).collect();
        let caps = |side| {
            let all = mesh.triangles.iter().zip(&facings);
            let some = all.filter(|(_, facing)| **facing == side);
            some.flat_map(|(corners, _)| *corners).collect()
        };
        let mut sides = Vec::new();
        for (edge, record) in (0..).zip(&mesh.edges) {
            let mut sum = 0;
            mesh.for_each_use(record, kind, |triangle, reversed| {
                let facing = facings[triangle as usize];
                sum += if reversed { -facing } else { facing };
            });
            let side = edge << 1 | u32::from(sum < 0);
            sides.extend((0..sum.unsigned_abs()).map(|_| side));
        }
        [caps(1), caps(-1), sides]
    }

    #[test]
    fn planes_and_blocks_find_what_a_plain_search_finds() {
        let mut volume = CpuVolume::default();
        for (place, (mesh, kind)) in meshes().into_iter().enumerate() {
            for instance in lights(&mesh) {
                let [front, back, sides] = plainly(&mesh, kind, &instance);
                let counts = volume.extract(&mesh, kind, &instance);
                assert_eq!(
                    counts.front as usize,
                    front.len(),
                    "mesh {place}, {instance:?}"
                );
                assert_eq!(
                    counts.back as usize,
                    back.len(),
                    "mesh {place}, {instance:?}"
                );
                let mut caps = vec![0_u32; front.len() + back.len()];
                volume.write_caps(
                    &mesh,
                    WriteOnly::from_mut(bytemuck::cast_slice_mut(&mut caps)),
                );
                assert_eq!(caps, [front, back].concat(), "mesh {place}, {instance:?}");
                assert_eq!(volume.sides, sides, "mesh {place}, {instance:?}");
            }
        }
    }

    #[test]
    fn a_border_is_extruded_though_all_around_it_faces_alike() {
        let (mesh, kind) = sheet(40);
        let mut volume = CpuVolume::default();
        let above = InstanceParams {
            light: [0.1, 1.0, 0.2, 0.0],
            both_sides: Counted::All as u32,
            ..bytemuck::Zeroable::zeroed()
        };
        volume.extract(&mesh, kind, &above);
        assert_eq!(volume.sides.len(), 4 * 40);
        // Most of them lie where skipping what faces alike would lose them.
        let is_alike = |words: &[u32]| {
            let mut words = words.iter().map(|&word| volume.facings[word as usize]);
            words.all(|word| word.front == u64::MAX)
        };
        let blocks: Vec<_> = mesh.blocks(kind).iter().collect();
        let lost = volume.sides.iter().filter(|side| {
            let block = &blocks[(**side >> 1) as usize / BLOCK];
            !block.balanced && block.words.is_some_and(is_alike)
        });
        assert!(lost.count() > 80);
    }

    #[test]
    fn planes_taken_at_their_word_are_wrong() {
        let (mesh, _) = ball(40, 1.0, 0.0);
        let planes = mesh.planes();
        let (mut differ, mut certain) = (0, 0);
        for instance in lights(&mesh) {
            let (light, rest) = (instance.light.into(), instance.light_rest.into());
            let wary = planes.light(light, rest);
            let rash = planes.facings(wary.rash());
            let both = rash
                .zip(planes.facings(wary))
                .zip(mesh.triangles.chunks(LANES));
            for ((rash, wary), triangles) in both {
                certain += (wary.front | wary.back).count_ones();
                for (place, corners) in triangles.iter().enumerate() {
                    let [a, b, c] = corners.map(|v| Vec3::from(mesh.positions[v as usize]));
                    let side = light_side(a, b, c, light, rest);
                    let [front, back] = [rash.front, rash.back].map(|word| word >> place & 1 == 1);
                    differ += usize::from((front, back) != (side > 0, side < 0));
                }
            }
        }
        assert!(differ > 20, "{differ}");
        // And they decide nearly all.
        let all = lights(&mesh).len() * mesh.triangles.len();
        assert!(f64::from(certain) > 0.98 * all as f64, "{certain} of {all}");
    }

    #[test]
    fn runs_of_ones_are_found() {
        for word in [
            0,
            1,
            u64::MAX,
            1 << 63,
            0b1011_0110,
            u64::MAX << 7,
            !(1 << 40),
        ] {
            let places: Vec<usize> = (0..64).filter(|i| word >> i & 1 == 1).collect();
            assert_eq!(ones(word).collect::<Vec<_>>(), places);
            assert_eq!(runs(word).flatten().collect::<Vec<_>>(), places);
            assert!(
                runs(word).count() <= 1 + places.windows(2).filter(|p| p[0] + 1 < p[1]).count()
            );
        }
    }
}
