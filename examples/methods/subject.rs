//! What falls: the leaf of the thesis, and a circle of paper whose falls were measured.

use crate::Failure;
use crate::support::Vec3;
use crate::support::leaf::{Blade, Outline};
use crate::support::scene::Kind;
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};
use rapier3d_immersed::Fluid;
use rapier3d_immersed::motion::DimensionlessNumbers;
use rapier3d_immersed::rapier3d::geometry::{ColliderBuilder, SharedShape};
use rapier3d_immersed::rapier3d::math::{Pose, Vector};
use rapier3d_immersed::rapier3d::prelude::MassProperties;
use rapier3d_immersed::training::{Experiment, Release};
use std::f64::consts::{FRAC_PI_2, TAU};

/// m/s².
pub const GRAVITY: f64 = 9.81;
/// 70 g/m² of 69.4 µm, in the air of the published analysis (`tests/data/paper`).
const GRAMMAGE: f64 = 0.070;
const THICKNESS: f64 = 69.4e-6;
/// Radius of the circle, m.
pub const RADIUS: f64 = 0.024;

/// A body, its fluid, and how it is let go.
#[derive(Clone)]
pub struct Subject {
    pub kind: Kind,
    pub fluid: Fluid,
    /// Longest extent, m.
    pub length: f64,
    /// The release that others are shaken from.
    pub release: Release,
    /// Standard deviations of the tilt, rad, and of each component of the spin, rad/s.
    shake: [f64; 2],
}

/// A release in a world.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Center of mass, m.
    pub place: Vec3,
    pub release: Release,
    /// Of whatever is random about the fall.
    pub seed: u64,
}

fn plate([length, width, thickness]: [f64; 3], density: f64) -> Result<Kind, Failure> {
    let blade = Blade {
        outline: Outline::Elliptic,
        length,
        width,
        thickness,
        camber: [0.0; 2],
    };
    let points = Outline::Elliptic.points(length, width, 40);
    let outline: Vec<Vec3> = points.iter().map(|p| Vec3::new(p[0], 0.0, p[1])).collect();
    let solid = blade.solid_of(64, 2)?;
    Ok(Kind::new(&solid, density, Some(&outline))?)
}

impl Subject {
    /// 7.3 × 4.2 × 0.03 cm (thesis Fig. 5.14), 400 kg/m³ (the thesis prints none), let go nearly flat.
    pub fn leaf() -> Result<Self, Failure> {
        Ok(Self {
            kind: plate([0.073, 0.042, 3e-4], 400.0)?,
            fluid: Fluid::AIR,
            length: 0.073,
            release: Release {
                tilt: 0.35,
                tilt_axis: 80f64.to_radians(),
                ..Release::default()
            },
            shake: [0.15, 0.5],
        })
    }

    /// Paper of 24 mm radius, let go edge down. How evenly the robot dropped it is not known: the deviations are those
    /// that `training::fidelity` takes.
    pub fn paper() -> Result<Self, Failure> {
        let size = [2.0 * RADIUS, 2.0 * RADIUS, THICKNESS];
        Ok(Self {
            kind: plate(size, GRAMMAGE / THICKNESS)?,
            fluid: Fluid::new(1.2754, 1.48e-5)?,
            length: 2.0 * RADIUS,
            release: Release {
                tilt: FRAC_PI_2 - 1e-3,
                ..Release::default()
            },
            shake: [0.1, 0.3],
        })
    }

    /// A release like that of the subject, at a random heading.
    pub fn shaken(&self, random: &mut impl Rng) -> Release {
        let spread = self.shake;
        let heading = random.random_range(0.0..TAU);
        let mut normal = || -> f64 { StandardNormal.sample(random) };
        Release {
            tilt: self.release.tilt + spread[0] * normal(),
            tilt_axis: self.release.tilt_axis + spread[0] * normal(),
            heading,
            spin: Vec3::from_fn(|_, _| spread[1] * normal()),
            ..self.release
        }
    }

    /// Any attitude, up to some ten meters and rounds per second.
    pub fn wild(&self, random: &mut impl Rng) -> Release {
        let tilt = random.random_range(-1.0..1.0_f64).acos();
        let tilt_axis = random.random_range(0.0..TAU);
        let heading = random.random_range(0.0..TAU);
        let mut normal = || -> f64 { StandardNormal.sample(random) };
        Release {
            tilt,
            tilt_axis,
            heading,
            velocity: Vec3::from_fn(|_, _| 3.0 * normal()),
            spin: Vec3::from_fn(|_, _| 20.0 * normal()),
        }
    }

    pub fn numbers(&self) -> Result<DimensionlessNumbers, Failure> {
        let hydro = &self.kind.body.hydro;
        Ok(DimensionlessNumbers::of(
            hydro,
            &self.kind.dry,
            &self.fluid,
            GRAVITY,
        )?)
    }

    /// The same as a numerical experiment.
    pub fn experiment(&self) -> Experiment {
        let body = (*self.kind.body).clone();
        Experiment {
            release: self.release,
            ..Experiment::new(body, self.kind.dry, self.fluid)
        }
    }

    /// What it collides as, with its mass.
    pub fn collider(&self) -> ColliderBuilder {
        let mass: MassProperties = self.kind.dry.to_mass_properties();
        ColliderBuilder::new(self.kind.collision.clone()).mass_properties(mass)
    }
}

/// Shapes to try the methods on, of some centimeters: three flat ones, three round ones, and one of two parts.
pub fn shapes() -> Vec<(&'static str, SharedShape)> {
    let tetrahedron = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
    let corners = tetrahedron.map(|p| Vector::new(p[0] as f32, p[1] as f32, p[2] as f32) * 0.02);
    let bar = |x: f32, y: f32| {
        let at = Vector::new(x, y, 0.0);
        let half = if x == 0.0 {
            [0.03, 0.005]
        } else {
            [0.005, 0.02]
        };
        (
            Pose::from_translation(at),
            SharedShape::cuboid(half[0], half[1], 0.005),
        )
    };
    vec![
        ("card", SharedShape::cuboid(0.04, 0.0002, 0.02)),
        ("disc", SharedShape::cylinder(0.0005, 0.02)),
        ("strip", SharedShape::cuboid(0.06, 0.0002, 0.006)),
        ("ball", SharedShape::ball(0.02)),
        ("capsule", SharedShape::capsule_y(0.02, 0.01)),
        ("cube", SharedShape::cuboid(0.02, 0.02, 0.02)),
        (
            "tetrahedron",
            SharedShape::convex_hull(&corners).expect("four corners of a tetrahedron"),
        ),
        (
            "L of two bars",
            SharedShape::compound(vec![bar(0.0, 0.0), bar(0.035, 0.015)]),
        ),
    ]
}
