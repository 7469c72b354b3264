//! The righting lever GZ of a vessel at a heel: by the crate's own forces, and by soundings that know nothing of it.

use crate::support::{Vec3, to_rapier};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::UnitQuaternion;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{DryMass, Fluid, ForceAndTorque, HydroProperties, Immersion, Medium};

/// A hull with its mass: x forward, y up, z to starboard, m.
#[derive(Clone, Debug)]
pub struct Vessel {
    pub hull: Surface,
    pub dry: DryMass,
}

impl Vessel {
    /// A hull that floats at y = 0, with its center of mass at this height over it, m, and radii of gyration of ⅖ of the
    /// beam about x and a quarter of the length about the others.
    pub fn new(hull: Surface, center: f64) -> Self {
        let middle = Vec3::zeros();
        let hydro = HydroProperties::from_surface(&hull, middle);
        let upright = rapier3d_immersed::rapier3d::na::Matrix3::identity();
        let under = hydro.hull.under_plane(&upright, 0.0, [0.0; 2]);
        let mass = under.volume * f64::from(Fluid::WATER.density());
        let extent = |axis: usize| {
            let along = hull.vertices().iter().map(|v| v[axis]);
            let low = along.clone().fold(f64::INFINITY, f64::min);
            along.fold(f64::NEG_INFINITY, f64::max) - low
        };
        let radii = Vec3::new(0.4 * extent(2), 0.25 * extent(0), 0.25 * extent(0));
        let moments = radii.component_mul(&radii) * mass;
        // Over the center of buoyancy along the ship, so that it floats on an even keel.
        let center = Vec3::new(under.moment.x / under.volume, center, 0.0);
        Self {
            hull,
            dry: DryMass {
                mass,
                center,
                inertia: rapier3d_immersed::rapier3d::na::Matrix3::from_diagonal(&moments),
            },
        }
    }

    /// A closed box that floats half sunk to this draft, m.
    pub fn barge([length, beam, depth]: [f64; 3], draft: f64, center: f64) -> Self {
        let shape = Cuboid::new(Vector::new(
            0.5 * length as f32,
            0.5 * depth as f32,
            0.5 * beam as f32,
        ));
        let hull = Surface::from_shape(&shape).expect("a box");
        Self::new(hull.map(|v| v + Vec3::y() * (0.5 * depth - draft)), center)
    }

    /// The vessel in a medium, let go at a heel, rad.
    pub fn afloat(&self, medium: Medium, pose: Pose, dt: f32) -> Afloat {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = dt;
        let body = RigidBodyBuilder::dynamic()
            .pose(pose)
            .additional_mass_properties(self.dry.to_mass_properties());
        let corners: Vec<Vector> = self.hull.vertices().iter().map(to_rapier).collect();
        let shape = SharedShape::convex_hull(&corners).expect("a hull has a volume");
        let (body, _) = world.insert(body, ColliderBuilder::new(shape).density(0.0));
        let mut immersion = Immersion::new(medium);
        let hydro = HydroProperties::from_surface(&self.hull, self.dry.center);
        immersion.insert(body, hydro);
        Afloat {
            world,
            immersion,
            body,
        }
    }

    /// GZ at these heels, m: the lever of the crate's buoyancy about the center of mass, with the vessel as high as its
    /// buoyancy carries its weight. It may not trim.
    pub fn levers(&self, heels: &[f64]) -> Vec<f64> {
        let mut scales = Scales::new(self);
        let lever = |heel: &f64| {
            let height = scales.height(*heel);
            -f64::from(scales.buoyancy(*heel, height).torque.x) / scales.weight
        };
        heels.iter().map(lever).collect()
    }

    /// Height of its origin over the water at a heel, m, where its buoyancy carries its weight.
    pub fn height(&self, heel: f64) -> f64 {
        Scales::new(self).height(heel)
    }

    /// The same by soundings: lines straight down through the hull's triangles on a grid, of which what is under water is
    /// added up.
    pub fn sounded_levers(&self, heels: &[f64]) -> Vec<f64> {
        let volume = self.dry.mass / f64::from(Fluid::WATER.density());
        let lever = |heel: &f64| {
            let turn = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), *heel);
            let soundings = Soundings::of(&self.hull.map(|v| turn * v));
            let reach = self.hull.size();
            // The waterline sinks as the vessel rises.
            let line = bisected([-reach, reach], |line| soundings.under(line)[0] < volume);
            let [under, moment] = soundings.under(line);
            moment / under - (turn * self.dry.center).z
        };
        heels.iter().map(lever).collect()
    }
}

/// A vessel in its world.
pub struct Afloat {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub body: RigidBodyHandle,
}

impl Afloat {
    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    pub fn body(&self) -> &RigidBody {
        &self.world.bodies[self.body]
    }
}

/// A vessel that is put at places by hand, to read its buoyancy.
struct Scales {
    afloat: Afloat,
    /// N.
    weight: f64,
    /// Of the hull, m.
    corners: Vec<Vec3>,
}

impl Scales {
    fn new(vessel: &Vessel) -> Self {
        // Nothing to speak of above, as in the books.
        let above = Fluid::new(1e-3, 1e-3).expect("thin air");
        let medium = Medium::layered(above, Fluid::WATER);
        let mut afloat = vessel.afloat(medium, Pose::IDENTITY, 1e-6);
        afloat.step();
        Self {
            weight: vessel.dry.mass * -f64::from(afloat.world.gravity.y),
            afloat,
            corners: vessel.hull.vertices().to_vec(),
        }
    }

    fn buoyancy(&mut self, heel: f64, height: f64) -> ForceAndTorque {
        let Afloat {
            world,
            immersion,
            body,
        } = &mut self.afloat;
        world.bodies[*body].set_position(heeled(heel, height), false);
        let forces = immersion.forces(&world.bodies, *body);
        forces.expect("it is immersed").buoyancy
    }

    fn height(&mut self, heel: f64) -> f64 {
        // Where it touches the water from above, and from below.
        let turn = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), heel);
        let heights = self.corners.iter().map(|v| (turn * v).y);
        let lowest = heights.clone().fold(f64::INFINITY, f64::min);
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let weight = self.weight;
        bisected([-highest, -lowest], |height| {
            f64::from(self.buoyancy(heel, height).force.y) > weight
        })
    }
}

/// To starboard (z goes down) by an angle, rad, with the origin at a height, m.
pub fn heeled(heel: f64, height: f64) -> Pose {
    Pose::new(Vector::Y * height as f32, Vector::X * heel as f32)
}

/// Where a condition that holds at the low end begins to fail.
fn bisected([mut low, mut high]: [f64; 2], mut holds: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Where vertical lines on a grid go through a closed surface.
struct Soundings {
    /// Area that each line stands for, m².
    area: f64,
    /// Height, z, and +1 where the line leaves the body upward, −1 where it enters it.
    crossings: Vec<[f64; 3]>,
}

impl Soundings {
    const LINES: f64 = 500.0;

    fn of(hull: &Surface) -> Self {
        let step = hull.size() / Self::LINES;
        let mut crossings = Vec::new();
        for [a, b, c] in hull.corners() {
            // Twice the area seen from above; positive where the outside is below.
            let flat = |u: Vec3, v: Vec3| u.x * v.z - u.z * v.x;
            let whole = flat(b - a, c - a);
            if whole == 0.0 {
                continue;
            }
            let range = |axis: usize| {
                let low = a[axis].min(b[axis]).min(c[axis]);
                let high = a[axis].max(b[axis]).max(c[axis]);
                // Off all corners and edges that have round numbers.
                let at = move |i: i64| (i as f64 + 0.412_703) * step;
                let first = (low / step - 0.412_703).ceil() as i64;
                (first..).map(at).take_while(move |at| *at < high)
            };
            for x in range(0) {
                for z in range(2) {
                    let p = Vec3::new(x, 0.0, z);
                    let shares = [flat(b - p, c - p), flat(c - p, a - p), flat(a - p, b - p)];
                    let [s, t, u] = shares.map(|share| share / whole);
                    if s >= 0.0 && t >= 0.0 && u >= 0.0 {
                        crossings.push([s * a.y + t * b.y + u * c.y, z, -whole.signum()]);
                    }
                }
            }
        }
        Self {
            area: step * step,
            crossings,
        }
    }

    /// Volume under a height, and its moment along z.
    fn under(&self, line: f64) -> [f64; 2] {
        let crossings = self.crossings.iter();
        let [volume, moment] = crossings.fold([0.0; 2], |[volume, moment], [y, z, sign]| {
            let part = y.min(line) * sign;
            [volume + part, moment + part * z]
        });
        [volume * self.area, moment * self.area]
    }
}

/// Where a curve over these heels first goes through zero from above, rad.
pub fn vanishing(heels: &[f64], levers: &[f64]) -> Option<f64> {
    let i =
        (1..heels.len()).find(|i| heels[*i] > 0.02 && levers[i - 1] > 0.0 && levers[*i] <= 0.0)?;
    let share = levers[i - 1] / (levers[i - 1] - levers[i]);
    Some(heels[i - 1] + share * (heels[i] - heels[i - 1]))
}
