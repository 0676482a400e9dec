//! Offsets in the unit disk.

use std::f32::consts::TAU;

use wgpu::util::DeviceExt as _;

use super::Kernel;
use super::disk::RandomDisk;

/// The texture of a disk's offsets; nothing for other kernels.
pub(super) fn create(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    kernel: Kernel,
) -> Option<wgpu::TextureView> {
    let (side, texels) = match kernel {
        Kernel::RandomDisk(disk) => (disk.size, random_disk(&disk)),
        Kernel::Vogel(disk) => (1, vogel(disk.taps)),
        Kernel::ContactHardening(contact) => (1, vogel(contact.taps)),
        _ => return None,
    };
    let texture = device.create_texture_with_data(
        queue,
        &wgpu::TextureDescriptor {
            label: Some(&format!("{label} offsets")),
            size: wgpu::Extent3d {
                width: side,
                height: side,
                depth_or_array_layers: texels.len() as u32 / (side * side),
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        bytemuck::cast_slice(&texels),
    );
    Some(texture.create_view(&wgpu::TextureViewDescriptor::default()))
}

/// `taps` offsets on Vogel's spiral, two in each entry, from the centre out.
pub(super) fn vogel(taps: u32) -> Vec<[f32; 4]> {
    let golden_angle = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    let point = |i: u32| {
        let radius = ((i as f32 + 0.5) / taps as f32).sqrt();
        let (sine, cosine) = (i as f32 * golden_angle).sin_cos();
        [radius * cosine, radius * sine]
    };
    (0..taps.div_ceil(2))
        .map(|pair| {
            let [a, b] = [point(2 * pair), point(2 * pair + 1)];
            [a[0], a[1], b[0], b[1]]
        })
        .collect()
}

/// The texels of the `n x n x d` texture, layer by layer: one jittered offset in every stratum of
/// `around x rings`, warped onto the disk so that all strata have the same area.
pub(super) fn random_disk(disk: &RandomDisk) -> Vec<[f32; 4]> {
    let (size, taps) = (disk.size, disk.taps());
    let mut random = Random(1);
    let mut columns = Vec::with_capacity((size * size) as usize);
    for _ in 0..size * size {
        let points: Vec<[f32; 2]> = (0..taps).map(|k| stratum(disk, k, &mut random)).collect();
        columns.push(points);
    }
    (0..taps as usize / 2)
        .flat_map(|layer| {
            columns.iter().map(move |points| {
                let [a, b] = [points[2 * layer], points[2 * layer + 1]];
                [a[0], a[1], b[0], b[1]]
            })
        })
        .collect()
}

/// Offset `k`: strata are taken ring by ring from the outermost.
fn stratum(disk: &RandomDisk, k: u32, random: &mut Random) -> [f32; 2] {
    let ring = disk.rings - 1 - k / disk.around;
    let across = (ring as f32 + random.next()) / disk.rings as f32;
    let angle = ((k % disk.around) as f32 + random.next()) / disk.around as f32 * TAU;
    let (sine, cosine) = angle.sin_cos();
    [across.sqrt() * cosine, across.sqrt() * sine]
}

/// Numbers in 0 .. 1 (PCG, O'Neill 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let mixed = ((self.0 >> 18) ^ self.0) >> 27;
        let turned = (mixed as u32).rotate_right((self.0 >> 59) as u32);
        (turned >> 8) as f32 / (1 << 24) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vogel_points_lie_in_the_disk_around_its_centre() {
        for taps in [4, 5, 16, 64] {
            let table = vogel(taps);
            let points: Vec<[f32; 2]> = (0..taps as usize)
                .map(|i| {
                    let [a, b, c, d] = table[i / 2];
                    if i % 2 == 0 { [a, b] } else { [c, d] }
                })
                .collect();
            assert!(points.iter().all(|[x, y]| x * x + y * y <= 1.0));
            // Even in area: half of them within the circle of half the area.
            let inner = points.iter().filter(|[x, y]| x * x + y * y < 0.5).count();
            assert_eq!(inner, (taps as usize).div_ceil(2), "{taps}");
        }
    }

    #[test]
    fn every_column_has_one_offset_in_each_stratum_and_the_outermost_first() {
        let disk = RandomDisk {
            around: 8,
            rings: 8,
            size: 4,
            ..RandomDisk::DEFAULT
        };
        let texels = random_disk(&disk);
        assert_eq!(texels.len(), 4 * 4 * 32);
        for column in 0..16 {
            let points = (0..32).flat_map(|layer| {
                let [a, b, c, d] = texels[layer * 16 + column];
                [[a, b], [c, d]]
            });
            let mut seen = [false; 64];
            let mut rings = Vec::new();
            for [x, y] in points {
                let ring = ((x * x + y * y) * 8.0) as usize;
                let around = (y.atan2(x).rem_euclid(TAU) / TAU * 8.0) as usize;
                seen[ring * 8 + around] = true;
                rings.push(ring);
            }
            // Rounding may carry a point over the edge of its stratum now and then.
            assert!(seen.iter().filter(|&&s| s).count() >= 62);
            assert!(rings[..8].iter().all(|&ring| ring == 7), "{rings:?}");
            assert!(rings.is_sorted_by(|a, b| a >= b));
        }
        // Another column has other offsets, another run the same.
        assert_ne!(texels[0], texels[1]);
        assert_eq!(texels, random_disk(&disk));
    }
}
