//! The bodies of the thesis's section 4.6, and what moves them.

use crate::support::recording::Recording;
use crate::support::shape::{Lengths, MeshArgs, ShapeArgs, ShapeName};
use crate::support::specimen::{Specimen, TiltAxis};
use crate::support::{Quat, Vec3, airplane, from_rapier};
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::parry::shape::Ball;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceTable, TurbulentLayer};
use rapier3d_immersed::{DryMass, Fluid, HydroProperties, ImmersedBody, StochasticLaw, ViscousLaw};
use std::sync::Arc;

const GRAVITY: f64 = 9.81;
/// Density of paper, kg/m³: the thesis's "density number .8".
const PAPER: f64 = 800.0;
/// Density of rubber, kg/m³; the thesis does not say.
const RUBBER: f64 = 1100.0;
/// Full extents of the rubber ellipsoid, m.
const ELLIPSOID: [f64; 3] = [0.08, 0.02, 0.04];
/// Full extents of the elliptic piece of paper, m.
const ELLIPSE: [f64; 3] = [0.08, 0.02, 0.0001];
/// Speed at which the airplane is thrown, m/s.
const THROW: f64 = 0.2;

/// What moves the body besides its weight.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Physics {
    /// Kirchhoff's equations alone.
    Kirchhoff,
    /// … with constant drag and lift.
    Viscous,
    /// … and the thesis's random increments of the body's velocity, in its order.
    Increments,
    /// … or turbulence of the fluid that the body sees.
    FluidSeen,
}

impl Physics {
    pub fn name(self) -> &'static str {
        match self {
            Self::Kirchhoff => "Kirchhoff alone",
            Self::Viscous => "no turbulence",
            Self::Increments => "Langevin, the body's velocity (thesis)",
            Self::FluidSeen => "Langevin, the fluid's velocity (default)",
        }
    }
}

/// What a body looks like from its center of mass, m.
#[derive(Clone)]
pub enum Look {
    /// An ellipsoid with these semi-axes along the body's axes.
    Ellipsoid(Vec3),
    /// Closed lines.
    Lines(Vec<Vec<Vec3>>),
}

/// A body to be dropped.
#[derive(Clone)]
pub struct Case {
    pub hydro: HydroProperties,
    pub dry: DryMass,
    pub look: Look,
    /// Its surface about its center of mass.
    pub solid: Surface,
    /// U0 of (4.1), m/s, and longest extent, m: the scales of the turbulence.
    pub u0: f64,
    pub length: f64,
    pub fluid: Fluid,
    pub law: StochasticLaw,
    pub release: BodyState,
    /// Time step and length of the run, s.
    pub dt: f64,
    pub seconds: f64,
}

/// A state every step.
pub struct Flight {
    pub states: Vec<BodyState>,
    pub dt: f64,
}

fn specimen(shape: ShapeName, size: &[f64]) -> Specimen {
    let asked = ShapeArgs {
        shape: Some(shape),
        size: Some(Lengths(size.to_vec())),
        mesh: MeshArgs::default(),
    };
    let shaped = asked.try_shaped().expect("the thesis's sizes");
    Specimen::new(&shaped).expect("the thesis's bodies")
}

impl Case {
    /// A specimen of the given density, kg/m³, every 5 ms over 1.5 s.
    fn of(specimen: &Specimen, semi_axes: Vec3, density: f64, fluid: Fluid) -> Self {
        let numbers = specimen.numbers(density, &fluid, GRAVITY);
        Self {
            hydro: specimen.hydro.clone(),
            dry: specimen.dry_mass(density),
            look: Look::Ellipsoid(semi_axes),
            solid: specimen.solid.clone(),
            u0: numbers.expect("a body with a mass").u0,
            length: specimen.span,
            fluid,
            law: StochasticLaw::default(),
            release: BodyState::default(),
            dt: 0.005,
            seconds: 1.5,
        }
    }

    /// The elliptic piece of paper of Fig. 4.3, released at an angle in degrees.
    pub fn paper(angle: f64) -> Self {
        let ellipse = specimen(ShapeName::Ellipse, &ELLIPSE);
        // The specimen's thickness is along its second axis.
        let semi_axes = Vec3::new(ELLIPSE[0], ELLIPSE[2], ELLIPSE[1]) / 2.0;
        let mut case = Self::of(&ellipse, semi_axes, PAPER, Fluid::AIR);
        case.release.orientation = ellipse.released_at(angle.to_radians(), TiltAxis::Short);
        case
    }

    /// The rubber ellipsoid of Fig. 4.5; the long axis dips by 30°, and the body is turned about it by `roll` degrees.
    pub fn ellipsoid(roll: f64) -> Self {
        let ellipsoid = specimen(ShapeName::Ellipsoid, &ELLIPSOID);
        let semi_axes = Vec3::from(ELLIPSOID) / 2.0;
        let mut case = Self::of(&ellipsoid, semi_axes, RUBBER, Fluid::WATER);
        case.release.orientation = Quat::from_axis_angle(&Vec3::z_axis(), -30f64.to_radians())
            * Quat::from_axis_angle(&Vec3::x_axis(), roll.to_radians());
        case
    }

    /// The same as the fluid feels a mesh of so many triangles around it and rings of them.
    pub fn meshed_ellipsoid(around: u32, rings: u32) -> Self {
        let (vertices, triangles) = Ball::new(0.5).to_trimesh(around, rings);
        let stretch = Vec3::from(ELLIPSOID);
        let stretched = |v| from_rapier(v).component_mul(&stretch);
        let vertices: Vec<Vec3> = vertices.into_iter().map(stretched).collect();
        let mesh = Surface::new(&vertices, &triangles).expect("a ball's mesh is closed");
        Self {
            hydro: HydroProperties::from_surface(&mesh, Vec3::zeros()),
            ..Self::ellipsoid(10.0)
        }
    }

    /// The folded airplane of Fig. 4.4 with its own mass, thrown level along +x; `bank` is how far its right wing is
    /// down, rad.
    pub fn airplane(bank: f64) -> Self {
        let kind = airplane::kind(PAPER).expect("the thesis's airplane");
        let from_center = |face: &Vec<Vec3>| face.iter().map(|v| v - kind.dry.center).collect();
        let from_center = kind.outline.iter().map(from_center).collect();
        let ratio = PAPER / f64::from(Fluid::AIR.density());
        let level = Quat::from_axis_angle(&Vec3::x_axis(), -std::f64::consts::FRAC_PI_2);
        let release = BodyState {
            orientation: Quat::from_axis_angle(&Vec3::x_axis(), bank) * level,
            velocity: Vec3::x() * THROW,
            ..BodyState::default()
        };
        Self {
            hydro: kind.body.hydro.clone(),
            dry: kind.dry,
            look: Look::Lines(from_center),
            solid: kind.solid.map(|v| v - kind.dry.center),
            u0: ((ratio - 1.0) * GRAVITY * airplane::THICKNESS).sqrt(),
            length: airplane::SIDE,
            fluid: Fluid::AIR,
            law: StochasticLaw::default(),
            release,
            dt: 0.005,
            seconds: 1.5,
        }
    }

    pub fn world(&self, physics: Physics, seed: u64) -> BodyInWorld {
        let law = match physics {
            Physics::Kirchhoff => ViscousLaw::Inviscid,
            _ => ViscousLaw::Stochastic(self.law),
        };
        let body = ImmersedBody::new(self.hydro.clone())
            .with_law(law)
            .expect("the coefficients are valid");
        let mut world =
            BodyInWorld::new(body, &self.dry, self.fluid, &self.release, self.dt, GRAVITY)
                .expect("the thesis's bodies can fly");
        let mode = match physics {
            Physics::Kirchhoff | Physics::Viscous => return world,
            Physics::Increments => LangevinMode::FractionalStep,
            Physics::FluidSeen => LangevinMode::FluidSeen,
        };
        world.immersion.set_turbulence(TurbulentLayer {
            source: self.turbulence(),
            mode,
            seed,
        });
        world
    }

    /// The thesis's inflow: the body's mean falling speed (4.1) over its length.
    pub fn turbulence(&self) -> Turbulence {
        Turbulence::History {
            table: Arc::new(TurbulenceTable::default_history()),
            velocity_scale: self.u0 as f32,
            length_scale: self.length as f32,
        }
    }

    pub fn fly(&self, physics: Physics, seed: u64) -> Flight {
        let mut world = self.world(physics, seed);
        let steps = (self.seconds / self.dt).round() as usize;
        let states = (0..=steps).map(|step| {
            if step > 0 {
                world.step();
            }
            world.state()
        });
        Flight {
            states: states.collect(),
            dt: self.dt,
        }
    }
}

impl Flight {
    /// The way from the release to the end, m.
    pub fn way(&self) -> Vec3 {
        let [first, last] = [0, self.states.len() - 1].map(|i| self.states[i].position);
        last - first
    }

    /// As an animation has it.
    pub fn recording(&self) -> Recording {
        let states = self.states.iter();
        Recording {
            times: (0..self.states.len())
                .map(|step| step as f64 * self.dt)
                .collect(),
            frames: states
                .map(|state| vec![(state.position, state.orientation)])
                .collect(),
            ..Recording::default()
        }
    }

    /// Turning of the body summed up over the run, turns.
    pub fn turns(&self) -> f64 {
        let pairs = self.states.windows(2);
        let angles = pairs.map(|p| p[0].orientation.angle_to(&p[1].orientation));
        angles.sum::<f64>() / std::f64::consts::TAU
    }
}

/// A row of the thesis's Table 4.2.
pub struct Row {
    pub body: &'static str,
    pub triangles: u32,
    /// What the thesis measured, ms a step.
    pub thesis: f64,
    /// Its time step is the row's.
    pub case: Case,
}

/// Table 4.2 of the thesis, all six rows. It does not say which ellipsoids: ours are that of Fig. 4.5, of as many
/// triangles (twice those around, times the rings less one).
pub fn table_4_2() -> [Row; 6] {
    let (coarse, fine) = (
        Case::meshed_ellipsoid(20, 9),
        Case::meshed_ellipsoid(40, 17),
    );
    let rows = [
        ("ellipsoid 1", 320, 0.001, 1.59, coarse.clone()),
        ("ellipsoid 1", 320, 0.005, 1.63, coarse.clone()),
        ("ellipsoid 1", 320, 0.010, 1.65, coarse),
        ("ellipsoid 2", 1280, 0.005, 1.71, fine),
        ("piece of paper", 1024, 0.005, 1.73, Case::paper(30.0)),
        ("paper airplane", 288, 0.005, 1.86, Case::airplane(0.1)),
    ];
    rows.map(|(body, triangles, dt, thesis, case)| Row {
        body,
        triangles,
        thesis,
        case: Case { dt, ..case },
    })
}
