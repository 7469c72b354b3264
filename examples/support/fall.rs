//! One body released in a fluid at rest: the run behind `drop`.

use super::recording::{Recording, components};
use super::{Quat, Vec3, track};
use clap::ValueEnum;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Normal};
use rapier3d_immersed::motion::Trajectory;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{
    DryMass, Error, Fluid, ForceAndTorque, ForceBreakdown, FreeBody, ImmersedBody,
};

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

/// A release with a random heading, a random tilt (2°) and a random spin (0.1 rad/s) on top.
pub fn shaken(release: BodyState, seed: u64) -> BodyState {
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let heading = random.random_range(0.0..std::f64::consts::TAU);
    let unit = Normal::new(0.0, 1.0).expect("a standard deviation of one");
    let mut draw = |scale: f64| Vec3::from_fn(|_, _| scale * unit.sample(&mut random));
    let mut tilt = draw(2.0_f64.to_radians());
    tilt.y = 0.0;
    let turn = Quat::from_axis_angle(&Vec3::y_axis(), heading) * Quat::from_scaled_axis(tilt);
    BodyState {
        orientation: turn * release.orientation,
        spin: release.spin + draw(0.1),
        ..release
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
    pub states: Vec<BodyState>,
    /// The same as a trajectory.
    pub trajectory: Trajectory,
    /// Force components of the same steps, if asked for and known.
    pub forces: Vec<Option<ForceBreakdown>>,
    /// Whether the run stayed finite and the body never had more kinetic energy than it began with
    /// and gravity and buoyancy have given it (5 % margin).
    pub stable: bool,
}

enum Simulator {
    Free(Box<FreeBody>),
    Rapier(Box<BodyInWorld>),
}

impl Fall {
    /// Runs.
    ///
    /// # Errors
    /// Those of [`BodyInWorld::new`].
    pub fn run(
        body: &ImmersedBody,
        dry: &DryMass,
        fluid: &Fluid,
        release: &BodyState,
        options: &FallOptions,
    ) -> Result<Self, Error> {
        let FallOptions { gravity, dt, .. } = *options;
        let mut free = FreeBody::new(body, dry, fluid)?;
        free.set_orientation(release.orientation);
        free.set_velocity(release.velocity, release.spin);
        let initial_energy = free.kinetic_energy();
        let mut simulator = match options.integrator {
            IntegratorName::Free => Simulator::Free(Box::new(free)),
            IntegratorName::Rapier => {
                let world = BodyInWorld::new(body.clone(), dry, *fluid, release, dt, gravity)?;
                Simulator::Rapier(Box::new(world))
            }
        };

        let weight = (dry.mass - f64::from(fluid.density()) * body.hydro.volume) * gravity;
        let slack = dry.mass * (gravity * dt).powi(2);
        let mut fall = Self {
            states: Vec::new(),
            trajectory: Trajectory {
                interval: dt,
                moments: Vec::new(),
            },
            forces: Vec::new(),
            stable: true,
        };
        let steps = (options.seconds / dt).round() as usize;
        for step in 0..=steps {
            if step > 0 {
                simulator.step(options);
            }
            let state = simulator.state();
            if !state.is_finite() {
                fall.stable = false;
                break;
            }
            let given = initial_energy - weight * state.position.y;
            let margin = 0.05 * (initial_energy + (weight * state.position.y).abs()) + slack;
            fall.stable &= kinetic_energy(dry, &state) <= given + margin;
            fall.trajectory.moments.push(state.moment(&body.hydro));
            fall.states.push(state);
            if options.forces {
                fall.forces.push(simulator.forces(options));
            }
        }
        Ok(fall)
    }

    /// Every step as a row of a table ([`track`]), with the components of force and torque where they were asked for.
    pub fn csv(&self) -> String {
        let parts = |f: &ForceBreakdown| {
            [
                f.added_mass,
                f.drag,
                f.translational_lift,
                f.rotational_lift,
                f.damping,
                f.buoyancy,
                f.weight,
                f.turbulence,
            ]
        };
        const NAMES: [&str; 8] = [
            "added_mass",
            "drag",
            "translational_lift",
            "rotational_lift",
            "damping",
            "buoyancy",
            "weight",
            "turbulence",
        ];
        let more: Vec<String> = NAMES
            .iter()
            .flat_map(|name| {
                let quantities = ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"];
                quantities.map(|quantity| format!("{name}_{quantity}"))
            })
            .filter(|_| !self.forces.is_empty())
            .collect();
        let forces = |step: usize| -> Vec<String> {
            let Some(forces) = self.forces.get(step) else {
                return Vec::new();
            };
            let six = |part: ForceAndTorque| {
                let (force, torque) = (part.force, part.torque);
                let six = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
                six.map(|x| x.to_string())
            };
            match forces {
                Some(forces) => parts(forces).into_iter().flat_map(six).collect(),
                None => vec![String::new(); more.len()],
            }
        };
        let rows = self.states.iter().enumerate();
        let rows =
            rows.map(|(step, state)| (step as f64 * self.trajectory.interval, state, forces(step)));
        track::csv(&more, rows)
    }

    /// The fall as an animation of so many frames per second has it.
    pub fn recording(&self, frame_rate: f64) -> Recording {
        let dt = self.trajectory.interval;
        let every = (1.0 / (frame_rate * dt)).round().max(1.0) as usize;
        let shown = || self.states.iter().enumerate().step_by(every);
        let forces = self.forces.iter().step_by(every);
        Recording {
            times: shown().map(|(step, _)| step as f64 * dt).collect(),
            frames: shown()
                .map(|(_, state)| vec![(state.position, state.orientation)])
                .collect(),
            forces: forces
                .map(|force| vec![components(&force.unwrap_or_default())])
                .collect(),
            ..Recording::default()
        }
    }
}

/// Of the body alone, J.
fn kinetic_energy(dry: &DryMass, state: &BodyState) -> f64 {
    let spin = state.orientation.inverse() * state.spin;
    0.5 * (dry.mass * state.velocity.norm_squared() + spin.dot(&(dry.inertia * spin)))
}

impl Simulator {
    fn step(&mut self, options: &FallOptions) {
        match self {
            Self::Free(body) => body.step(options.dt, Vec3::new(0.0, -options.gravity, 0.0)),
            Self::Rapier(world) => world.step(),
        }
    }

    fn state(&self) -> BodyState {
        match self {
            Self::Free(body) => BodyState::of(body),
            Self::Rapier(world) => world.state(),
        }
    }

    fn forces(&self, options: &FallOptions) -> Option<ForceBreakdown> {
        match self {
            Self::Free(body) => Some(body.forces(Vec3::new(0.0, -options.gravity, 0.0))),
            Self::Rapier(world) => world.forces(),
        }
    }
}
