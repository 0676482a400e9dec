//! Where a volume ends.
//!
//! **At infinity**, unless something nearer is known to do.
//!
//! **At the light's range**: in a plane across the axis from the light through the caster's middle,
//! not on a sphere. The plane touches the sphere of the range from outside, so no chord cuts through
//! lit space.
//!
//! **Behind the receivers**: in the plane of that side of their box which the caster's shadow
//! reaches first, the box being no larger than what the light reaches (see `reach.rs`). Where rays start before that plane, they reach every receiver before it, and cross
//! the volume cut off there as they cross the endless one: up to the receiver, which is what z-pass
//! counts, and with a cap in the plane on the whole, which is what z-fail needs. (The depth format
//! may not tell the cap from a receiver; it is set back, and "behind" is right wherever it is seen.)
//!
//! All of it in f64, with room for what a vertex shader's f32 makes of it: of the far points, which may
//! be much farther from everything than the caster's middle is; of the receivers; and as both are seen by
//! the eye (see [`displacement`]). A caster without any thickness needs it most.

use glam::{DVec3, DVec4, Vec4Swizzles as _};

use crate::volume::decide::reach::Reach;
use crate::volume::decide::world_box::{WorldBox, displacement, rounding};
use crate::volume::frame::Situation;
use crate::{HomogeneousLight, View};

/// Where far vertices go: see `far_point` in volume_extrude.wgsl.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FarEnd {
    /// Its normal, 0 for infinity. For a point light over its distance from the light; for a
    /// directional light with its distance from the origin.
    pub plane: DVec4,
    /// The fan's own point, homogeneous.
    pub apex: DVec4,
}

impl FarEnd {
    pub fn is_infinite(&self) -> bool {
        self.plane.xyz() == DVec3::ZERO
    }
}

/// What ends volumes in one frame.
#[derive(Debug)]
pub(crate) struct Ends {
    light: HomogeneousLight,
    /// Of a point light.
    pub range: Option<f64>,
    /// Least and greatest corner of what may be shadowed: of the receivers' box what the light reaches,
    /// rounding included.
    receivers: Option<[DVec3; 2]>,
    /// Whether it reaches nothing of it.
    pub reaches_nothing: bool,
    /// Where rays start.
    origins: Vec<DVec4>,
    /// How far the viewer is from the world's origin, or the farthest of several.
    eye: f64,
}

/// How much farther planes are than they need to be, relative to their distance.
const ROOM: f64 = 1e-3;

impl Ends {
    pub fn new(of: &Situation, reach: &Reach, origins: Vec<DVec4>) -> Self {
        let range = of.range.filter(|_| !of.light.is_directional());
        let corners = of.views.iter().flat_map(View::near_corners);
        let eye = corners.map(DVec3::length).fold(0.0, f64::max);
        let told = of.receivers;
        let told = told.map(|bounds| [bounds.min, bounds.max].map(|corner| corner.as_dvec3()));
        let reached = reach.part_of(told);
        let reaches_nothing = reached.is_none();
        let receivers = reached.unwrap_or(told);
        let receivers = receivers.map(|[min, max]| {
            let slack = displacement(min.abs().max(max.abs()).length() + eye);
            [min - slack, max + slack]
        });
        Self {
            light: of.light,
            range: range.map(f64::from),
            receivers,
            reaches_nothing,
            origins,
            eye,
        }
    }

    /// The corners of the receivers' box.
    pub fn receivers(&self) -> Option<[DVec4; 8]> {
        let [min, max] = self.receivers?;
        Some(std::array::from_fn(|corner| {
            let pick = |axis: usize| {
                if corner >> axis & 1 == 0 {
                    min[axis]
                } else {
                    max[axis]
                }
            };
            DVec4::new(pick(0), pick(1), pick(2), 1.0)
        }))
    }

    /// The end of all volumes that may have none nearer.
    pub fn infinite(&self, world: &WorldBox) -> FarEnd {
        let light = self.light.0.xyz().as_dvec3();
        FarEnd {
            plane: DVec4::ZERO,
            apex: (world.centre() - light).normalize_or_zero().extend(0.0),
        }
    }

    /// The end at the range, where there is one and the caster lies on one side of the light.
    pub fn at_range(&self, world: &WorldBox) -> Option<FarEnd> {
        let range = self.range?;
        let light = self.light.0.xyz().as_dvec3();
        let axis = (world.centre() - light).normalize_or_zero();
        let from_light = axis.dot(light);
        let (nearest, farthest) = (world.nearest(axis), world.farthest(axis));
        let castable = is_castable(nearest - from_light, world.reach(light));
        if !(castable && world.excludes(self.light)) {
            return None;
        }
        // Beyond the caster, too, or its far part would be turned inside out.
        let distance = self.room(range.max(farthest - from_light), light);
        Some(FarEnd {
            plane: (axis / distance).extend(0.0),
            apex: (light + axis * distance).extend(1.0),
        })
    }

    /// The nearest of the end given and those behind the receivers.
    pub fn behind_receivers(&self, world: &WorldBox, other: FarEnd) -> FarEnd {
        let Some([min, max]) = self.receivers else {
            return other;
        };
        let sides = [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .flat_map(|axis| [(-axis, -axis.dot(min)), (axis, axis.dot(max))]);
        let length = |end: &FarEnd| match end.is_infinite() {
            true => f64::INFINITY,
            false => world.centre().distance(end.apex.xyz()),
        };
        sides
            .filter_map(|(normal, place)| match self.light.is_directional() {
                true => self.across_direction(world, normal, place),
                false => self.across_point(world, normal, place),
            })
            .fold(other, |best, end| match length(&end) < length(&best) {
                true => end,
                false => best,
            })
    }

    /// The end of a point light's volume in the plane `normal . p = place`, or a little beyond.
    fn across_point(&self, world: &WorldBox, normal: DVec3, place: f64) -> Option<FarEnd> {
        let light = self.light.0.xyz().as_dvec3();
        let from_light = normal.dot(light);
        let nearest = world.nearest(normal) - from_light;
        let farthest = world.farthest(normal) - from_light;
        // A vertex is cast as far as the plane is over what lies between it and the light along
        // the normal. Rounding must not change that by more than there is room for.
        let reach = world.reach(light);
        let error = rounding(DVec3::splat(light.abs().max_element() + reach)).x;
        if !(is_castable(nearest, reach) && nearest * ROOM > error) {
            return None;
        }
        let distance = self.room((place - from_light).max(farthest), light);
        let plane = normal / distance;
        let before = |p: &DVec4| plane.dot(p.xyz() - light * p.w) < (1.0 - ROOM) * p.w;
        let toward = world.centre() - light;
        self.origins.iter().all(before).then(|| FarEnd {
            plane: plane.extend(0.0),
            apex: (light + toward / plane.dot(toward)).extend(1.0),
        })
    }

    /// A distance from the light, and so much more that what is drawn there is not drawn before it.
    ///
    /// Far points may be a hundred times as far from the light as the plane they are in (see
    /// [`is_castable`]). Their displacement is a fifth of [`ROOM`], which leaves the rest for the light's
    /// and the eye's, unless those are far from the world's origin.
    fn room(&self, distance: f64, light: DVec3) -> f64 {
        let drawn = 2.0 * displacement(100.0 * distance + light.length() + self.eye);
        (distance * (1.0 + ROOM)).max(distance + drawn)
    }

    /// The same for a directional light.
    fn across_direction(&self, world: &WorldBox, normal: DVec3, place: f64) -> Option<FarEnd> {
        let direction = -self.light.0.xyz().as_dvec3().normalize();
        let along = normal.dot(direction);
        if along < 1e-2 {
            return None;
        }
        let last = place.max(world.farthest(normal));
        let thickness = last - world.nearest(normal);
        // The far points, and the caster's own surface, which lies before them.
        let farthest_point = world.reach(DVec3::ZERO) + thickness / along * (1.0 + ROOM);
        let place = last + ROOM * thickness + 2.0 * displacement(farthest_point + self.eye);
        let before = |p: &DVec4| normal.dot(p.xyz()) < place * p.w;
        let to_plane = (place - normal.dot(world.centre())) / along;
        self.origins.iter().all(before).then(|| FarEnd {
            plane: normal.extend(place),
            apex: (world.centre() + direction * to_plane).extend(1.0),
        })
    }
}

/// Whether all of a caster that reaches so far from the light can be cast onto a plane, to which no part
/// of it is nearer along the normal than `nearest`. A vertex that is all but level with the light is cast
/// too far along the plane, and where the light is to a millionth, to the wrong side.
fn is_castable(nearest: f64, reach: f64) -> bool {
    nearest > 1e-2 * reach
}

#[cfg(test)]
mod tests {
    use crate::scene::CasterFilter;
    use glam::{Vec3, camera::rh};

    use super::*;
    use crate::DepthConvention;
    use crate::mesh::Bounds;

    const BOX: Bounds = Bounds {
        min: Vec3::new(-10.0, 0.0, -8.0),
        max: Vec3::new(12.0, 5.0, 9.0),
    };

    fn ends(light: HomogeneousLight, eye: Vec3) -> Ends {
        let camera = rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
        let projection = rh::proj::directx::perspective_infinite_reverse(0.9, 1.0, 0.1);
        let view = View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap();
        let origins = view.near_corners().map(|corner| corner.extend(1.0));
        let situation = Situation {
            light,
            range: Some(200.0),
            cone: None,
            filter: CasterFilter::ALL,
            views: vec![view],
            target_size: None,
            receivers: Some(BOX),
        };
        Ends::new(&situation, &Reach::new(&situation), origins.to_vec())
    }

    /// How far beyond the plane a point is: 0 on it, 1 as far as the light is before it.
    fn beyond(end: &FarEnd, light: HomogeneousLight, point: DVec3) -> f64 {
        let normal = end.plane.xyz();
        match light.is_directional() {
            true => normal.dot(point) - end.plane.w,
            false => normal.dot(point - light.0.xyz().as_dvec3()) - 1.0,
        }
    }

    fn lights() -> Vec<HomogeneousLight> {
        vec![
            HomogeneousLight::point(Vec3::new(0.0, 4.0, 0.0)),
            HomogeneousLight::point(Vec3::new(-9.0, 3.0, 7.0)),
            HomogeneousLight::point(Vec3::new(300.0, 400.0, 100.0)),
            HomogeneousLight::directional(Vec3::new(0.3, 1.0, 0.2)),
            HomogeneousLight::directional(Vec3::new(3.0, -0.5, 0.2)),
        ]
    }

    #[test]
    fn receivers_and_the_caster_are_before_the_end_and_no_nearer_one_was_taken() {
        let mut found = 0;
        for light in lights() {
            let ends = ends(light, Vec3::new(5.0, 4.0, 6.0));
            for x in -3..=3 {
                let centre = DVec3::new(3.0 * f64::from(x), 1.5, f64::from(x * x) - 3.0);
                let world = WorldBox::new(centre, DVec3::new(0.5, 0.3, 0.7));
                let infinite = ends.infinite(&world);
                let end = ends.behind_receivers(&world, infinite);
                if end.is_infinite() {
                    continue;
                }
                found += 1;
                let before = |point: DVec3| beyond(&end, light, point) < 0.0;
                let corners = ends.receivers().unwrap();
                assert!(
                    corners.iter().all(|c| before(c.xyz())),
                    "{light:?}, {centre}"
                );
                assert!(beyond(&end, light, end.apex.xyz()).abs() < 1e-9);
                // On the ray through the middle, at the box's surface and a little more.
                let light = light.0.as_dvec4();
                let direction = (centre * light.w - light.xyz()).normalize();
                let run = (end.apex.xyz() - centre).dot(direction);
                let inside = |t: f64| {
                    let p = centre + direction * t;
                    p.cmpge(BOX.min.as_dvec3() - 1e-9).all()
                        && p.cmple(BOX.max.as_dvec3() + 1e-9).all()
                };
                assert!(run > 0.0 && !inside(run), "{centre}: {run}");
                let exit = (0..)
                    .map(|i| 0.01 * f64::from(i))
                    .find(|t| !inside(*t))
                    .unwrap();
                assert!(
                    run < exit + 0.02 + 2e-3 * (exit + 600.0),
                    "{centre}: {run}, {exit}"
                );
            }
        }
        assert!(found > 15, "{found}");
    }

    #[test]
    fn a_flat_caster_in_the_receivers_side_ends_farther_than_it_is_drawn_wrong() {
        for half in [1.0, 300.0, 1e4, 1e6] {
            let eye = Vec3::new(0.1 * half, 5.0, 9.0);
            let direction = DVec3::new(0.3, 1.0, 0.2);
            let light = HomogeneousLight::directional(direction.as_vec3());
            let camera = rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
            let projection = rh::proj::directx::perspective_infinite_reverse(0.9, 1.0, 0.1);
            let view = View::new(projection * camera, DepthConvention::InfiniteReverse).unwrap();
            let level = Vec3::new(half, 0.0, half);
            let situation = Situation {
                light,
                range: None,
                cone: None,
                filter: CasterFilter::ALL,
                views: vec![view],
                target_size: None,
                receivers: Some(Bounds {
                    min: -level,
                    max: level,
                }),
            };
            let origins = view.near_corners().map(|corner| corner.extend(1.0));
            let ends = Ends::new(&situation, &Reach::new(&situation), origins.to_vec());
            let world = WorldBox::new(DVec3::ZERO, level.as_dvec3());
            let end = ends.behind_receivers(&world, ends.infinite(&world));
            assert_eq!(end.plane.xyz(), DVec3::NEG_Y);
            // What a matrix makes of a corner and of the point behind it, rounded at every step.
            let rows = [0, 1, 3].map(|row| view.clip_from_world().row(row));
            let below = end.plane.w;
            let run = below / direction.y;
            for corner in [Vec3::ZERO, level, -level, level * Vec3::new(1.0, 0.0, -1.0)] {
                let behind = (corner.as_dvec3() - direction * run).as_vec3();
                for point in [corner, behind] {
                    let moved = rows.map(|row| {
                        let clip = row.x * point.x + row.y * point.y + row.z * point.z + row.w;
                        let exact = row.as_dvec4().dot(point.as_dvec3().extend(1.0));
                        (f64::from(clip) - exact) / row.xyz().as_dvec3().length()
                    });
                    // Half of the way from one to the other is each one's own.
                    assert!(
                        DVec3::from(moved).length() < 0.5 * below,
                        "{half}: {moved:?}"
                    );
                }
            }
            assert!(below < 1e-5 * (half as f64 + 20.0), "{half}: {below}");
        }
    }

    #[test]
    fn ends_are_a_thousandth_farther_than_receivers_or_as_far_as_these_are_drawn_wrong() {
        let far = Vec3::new(3e5, -2e5, 1e5);
        for (origin, far_away) in [(Vec3::ZERO, false), (far, true)] {
            let light = origin + Vec3::new(0.5, 4.0, 1.0);
            let eye = origin + Vec3::new(-4.5, 6.0, 13.5);
            let ends = ends(HomogeneousLight::point(light), eye);
            for distance in [0.5, 4.5, 200.0] {
                let room = ends.room(distance, light.as_dvec3()) - distance;
                // A far point that is seen from its side, and the receiver before it.
                let away = f64::from(light.length() + eye.length());
                let moved = 2.0 * displacement(99.0 * distance + away);
                assert!(room > moved, "{room}, {moved}");
                let more = room > 1.000_001 * ROOM * distance;
                assert_eq!(more, far_away, "{distance}: {room}");
            }
        }
    }

    #[test]
    fn no_ray_starts_beyond_the_end() {
        let light = HomogeneousLight::directional(Vec3::new(0.2, 1.0, 0.1));
        let world = WorldBox::new(DVec3::new(1.0, 1.0, 1.0), DVec3::splat(0.5));
        let end = |eye| {
            let ends = ends(light, eye);
            ends.behind_receivers(&world, ends.infinite(&world)).plane
        };
        let above = end(Vec3::new(5.0, 4.0, 6.0));
        assert_eq!(above.xyz(), DVec3::NEG_Y);
        assert_ne!(end(Vec3::new(5.0, -1.0, 6.0)).xyz(), DVec3::NEG_Y);
    }

    #[test]
    fn what_is_too_near_a_plane_through_the_light_is_not_cast_onto_it() {
        let light = HomogeneousLight::point(Vec3::new(0.0, 2.0, 0.0));
        let ends = ends(light, Vec3::new(0.0, 4.0, 6.0));
        let level = WorldBox::new(DVec3::new(4.0, 2.0, 0.0), DVec3::splat(0.3));
        let end = ends.behind_receivers(&level, ends.infinite(&level));
        assert_eq!(end.plane.xyz().normalize(), DVec3::X);
        let around = WorldBox::new(DVec3::new(0.0, 2.0, 0.0), DVec3::splat(0.3));
        assert!(
            ends.behind_receivers(&around, ends.infinite(&around))
                .is_infinite()
        );
        assert!(ends.at_range(&around).is_none());
    }
}
