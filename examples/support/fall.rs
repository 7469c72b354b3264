//! One body released in a fluid at rest: the run behind `drop`.

use super::statistics::Sample;
use super::{Quat, Vec3};
use clap::ValueEnum;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Normal};
use rapier3d_immersed::rapier3d::math::{Rotation, Vector};
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder, RigidBodyHandle};
use rapier3d_immersed::{DryMass, Error, Fluid, FreeBody, ImmersedBody};
use rapier3d_immersed::{ForceBreakdown, Immersion};
use std::fmt::Write;

/// Most steps of one run: what is recorded of them stays below 1 GB.
const MOST_STEPS: f64 = 4e6;

/// Integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    /// A rapier world with one immersed body, f32
    Rapier,
    /// The crate's own free body, f64
    Free,
}

/// State at the release.
#[derive(Clone, Copy, Debug)]
pub struct Release {
    /// Orientation of the body's frame.
    pub orientation: Quat,
    /// Velocity, m/s.
    pub velocity: Vec3,
    /// Angular velocity, world axes, rad/s.
    pub spin: Vec3,
}

impl Release {
    /// The same with a random heading, a random tilt (2°) and a random spin (0.1 rad/s).
    pub fn shaken(self, seed: u64) -> Self {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
        let heading = random.random_range(0.0..std::f64::consts::TAU);
        let unit = Normal::new(0.0, 1.0).expect("a standard deviation of one");
        let mut draw = |scale: f64| Vec3::from_fn(|_, _| scale * unit.sample(&mut random));
        let mut tilt = draw(2.0_f64.to_radians());
        tilt.y = 0.0;
        let turn = Quat::from_axis_angle(&Vec3::y_axis(), heading) * Quat::from_scaled_axis(tilt);
        Self {
            orientation: turn * self.orientation,
            velocity: self.velocity,
            spin: self.spin + draw(0.1),
        }
    }
}

/// How to run.
#[derive(Clone, Copy, Debug)]
pub struct FallOptions {
    /// Downward, m/s².
    pub gravity: f64,
    /// Step, s.
    pub dt: f64,
    /// Length of the run, s.
    pub seconds: f64,
    /// Who integrates.
    pub integrator: IntegratorName,
    /// Whether to record the components of the force.
    pub forces: bool,
}

impl FallOptions {
    /// # Errors
    /// The flag to blame and what is wrong.
    pub fn check(&self) -> Result<(), (&'static str, String)> {
        let steps = self.seconds / self.dt;
        if steps > MOST_STEPS {
            return Err((
                "--seconds",
                format!("{steps:.0} steps are more than {MOST_STEPS:.0}"),
            ));
        }
        if steps < 4.0 {
            return Err(("--dt", "the run has to be at least four steps long".into()));
        }
        Ok(())
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Fall {
    /// Every step, the release included; ends early at a state that is not finite.
    pub samples: Vec<Sample>,
    /// Force components of the same steps, if asked for and known.
    pub forces: Vec<Option<ForceBreakdown>>,
    /// Whether the run stayed finite and the body never had more kinetic energy than it began with
    /// and gravity and buoyancy have given it (5 % margin).
    pub stable: bool,
}

enum Simulator {
    Free(Box<FreeBody>),
    Rapier(Box<World>),
}

struct World {
    world: PhysicsWorld,
    immersion: Immersion,
    body: RigidBodyHandle,
}

impl Fall {
    /// Runs.
    ///
    /// # Errors
    /// Those of [`FreeBody::new`].
    pub fn run(
        body: &ImmersedBody,
        dry: &DryMass,
        fluid: &Fluid,
        release: &Release,
        options: &FallOptions,
    ) -> Result<Self, Error> {
        let plate_axes = UnitQuaternion::from_rotation_matrix(&body.hydro.planform.axes);
        let mut free = FreeBody::new(body, dry, fluid)?;
        free.set_orientation(release.orientation);
        free.set_velocity(release.velocity, release.spin);
        let initial_energy = free.kinetic_energy();
        let mut simulator = match options.integrator {
            IntegratorName::Free => Simulator::Free(Box::new(free)),
            IntegratorName::Rapier => {
                Simulator::Rapier(Box::new(World::new(body, dry, fluid, release, options)))
            }
        };

        let weight = (dry.mass - f64::from(fluid.density()) * body.hydro.volume) * options.gravity;
        let slack = dry.mass * (options.gravity * options.dt).powi(2);
        let mut fall = Self {
            samples: Vec::new(),
            forces: Vec::new(),
            stable: true,
        };
        let steps = (options.seconds / options.dt).round() as usize;
        for step in 0..=steps {
            if step > 0 {
                simulator.step(options);
            }
            let sample = simulator.sample(step as f64 * options.dt, &plate_axes);
            if !sample.is_finite() {
                fall.stable = false;
                break;
            }
            let given = initial_energy - weight * sample.position.y;
            let margin = 0.05 * (initial_energy + (weight * sample.position.y).abs()) + slack;
            fall.stable &= kinetic_energy(dry, &sample) <= given + margin;
            fall.samples.push(sample);
            if options.forces {
                fall.forces.push(simulator.forces(options));
            }
        }
        Ok(fall)
    }

    /// Every step as a line of comma-separated values.
    pub fn csv(&self) -> String {
        const COMPONENTS: [&str; 8] = [
            "added_mass",
            "drag",
            "translational_lift",
            "rotational_lift",
            "damping",
            "buoyancy",
            "weight",
            "turbulence",
        ];
        let mut text = String::from("t,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz");
        for name in COMPONENTS {
            for quantity in ["fx", "fy", "fz", "tx", "ty", "tz"] {
                write!(text, ",{name}_{quantity}").expect("a string takes anything");
            }
        }
        text.push('\n');
        for (sample, forces) in self.samples.iter().zip(&self.forces) {
            let (x, q) = (sample.position, sample.orientation.coords);
            let (v, w) = (sample.velocity, sample.spin);
            let mut row = vec![sample.time, x.x, x.y, x.z, q.x, q.y, q.z, q.w];
            row.extend([v.x, v.y, v.z, w.x, w.y, w.z]);
            let mut fields: Vec<String> = row.iter().map(f64::to_string).collect();
            match forces {
                Some(f) => {
                    let parts = [
                        f.added_mass,
                        f.drag,
                        f.translational_lift,
                        f.rotational_lift,
                        f.damping,
                        f.buoyancy,
                        f.weight,
                        f.turbulence,
                    ];
                    for part in parts {
                        let (force, torque) = (part.force, part.torque);
                        let six = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
                        fields.extend(six.map(|x| x.to_string()));
                    }
                }
                None => fields.extend(vec![String::new(); 6 * COMPONENTS.len()]),
            }
            text.push_str(&fields.join(","));
            text.push('\n');
        }
        text
    }
}

/// Of the body alone, J.
fn kinetic_energy(dry: &DryMass, sample: &Sample) -> f64 {
    let spin = sample.orientation.inverse() * sample.spin;
    0.5 * (dry.mass * sample.velocity.norm_squared() + spin.dot(&(dry.inertia * spin)))
}

impl World {
    fn new(
        body: &ImmersedBody,
        dry: &DryMass,
        fluid: &Fluid,
        release: &Release,
        options: &FallOptions,
    ) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -options.gravity as f32, 0.0);
        world.integration_parameters.dt = options.dt as f32;
        let q = release.orientation.coords.map(|x| x as f32);
        let rapier_body = RigidBodyBuilder::dynamic()
            .rotation(Rotation::from_xyzw(q.x, q.y, q.z, q.w).to_scaled_axis())
            .linvel(to_rapier(&release.velocity))
            .angvel(to_rapier(&release.spin))
            .additional_mass_properties(dry.to_mass_properties())
            .can_sleep(false);
        let handle = world.insert_body(rapier_body);
        let mut immersion = Immersion::new(*fluid);
        immersion.insert(handle, body.clone());
        Self {
            world,
            immersion,
            body: handle,
        }
    }
}

impl Simulator {
    fn step(&mut self, options: &FallOptions) {
        match self {
            Self::Free(body) => body.step(options.dt, Vec3::new(0.0, -options.gravity, 0.0)),
            Self::Rapier(world) => world.immersion.step(&mut world.world),
        }
    }

    fn sample(&self, time: f64, plate_axes: &Quat) -> Sample {
        let (position, orientation, velocity, spin) = match self {
            Self::Free(body) => (
                body.position,
                body.orientation(),
                body.linear_velocity(),
                body.angular_velocity(),
            ),
            Self::Rapier(world) => {
                let body = &world.world.bodies[world.body];
                let q = body.rotation();
                let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(f64::from);
                (
                    from_rapier(body.center_of_mass()),
                    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)),
                    from_rapier(body.linvel()),
                    from_rapier(body.angvel()),
                )
            }
        };
        Sample {
            time,
            position,
            orientation,
            velocity,
            spin,
            normal: orientation * (plate_axes * Vec3::z()),
        }
    }

    fn forces(&self, options: &FallOptions) -> Option<ForceBreakdown> {
        match self {
            Self::Free(body) => Some(body.forces(Vec3::new(0.0, -options.gravity, 0.0))),
            Self::Rapier(world) => world.immersion.forces(&world.world.bodies, world.body),
        }
    }
}

/// From rapier's single precision.
pub fn from_rapier(v: Vector) -> Vec3 {
    Vec3::new(v.x.into(), v.y.into(), v.z.into())
}

/// To rapier's single precision.
pub fn to_rapier(v: &Vec3) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}
