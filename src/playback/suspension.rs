//! Suspensions of particles that are too small for a wake (thesis § 7.3: dust, fine snow): drag, weight, flow and
//! turbulence, a hundred thousand at a time.

use super::particle::{Particle, ParticleMotion};
use crate::error::Error;
use crate::flow::FlowSample;
use crate::medium::Layer;
use crate::turbulence::{
    Eddies, NoiseStream, SeenFluctuation, Turbulence, TurbulenceState, decay, kolmogorov_constant,
    pass,
};
use rapier3d::math::{Real, Vector};
use rapier3d::pipeline::{PhysicsWorld, QueryFilter};
use rapier3d::prelude::Ray;
use std::ops::Range;

/// Particles whose flow is sampled together.
const BATCH: usize = 256;

/// One particle of a [`Suspension`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspended {
    /// Its center, m, world axes.
    pub position: Vector,
    /// Its velocity, m/s; zero once it has settled.
    pub velocity: Vector,
    /// Whether it lies on something.
    pub settled: bool,
    /// Number that it keeps for as long as it exists, from 0 in the order of insertion.
    pub number: u64,
    /// Fluid velocity where it is, fluctuation included, m/s.
    stream: Vector,
    fluctuation: SeenFluctuation,
    /// Time at which it came in, s.
    since: f64,
}

/// Equal particles in a moving fluid, without rapier's bodies.
///
/// Where a body's Reynolds number is below 10 its wake is steady and closed, and of the equations of an
/// [`Immersion`](crate::Immersion) little is left: a particle relaxes to the velocity of the fluid, plus that at which
/// it falls. A step solves this **exactly** for a flow that changes linearly along the way and a drag in proportion to the
/// velocity, so that it is stable at any `dt`, however short the relaxation. It allocates nothing. The factor on Stokes's drag is that of
/// the step's beginning: a particle that falls is exact, one that starts from rest is too fast in the first step if that is long.
///
/// What it has: weight and buoyancy, drag (Stokes's with the correction of Schiller and Naumann), added mass and
/// pressure gradient of a flow that accelerates, mean flow and turbulence of a [`Layer`]. What it leaves out: attitude and
/// rotation (a flake has the mean of all attitudes), lift, the history force, collisions with each other, and
/// any effect on the fluid. Particles end where they settle. For larger bodies there are [`Immersion`](crate::Immersion)
/// and [`Emitter`](super::Emitter).
///
/// ```
/// use rapier3d_immersed::playback::{Particle, Suspension};
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Fluid, Layer, flow::Uniform};
///
/// // Fine snow in a breeze over a floor.
/// let mut world = PhysicsWorld::new();
/// let floor = ColliderBuilder::cuboid(50.0, 0.1, 50.0).translation(Vector::Y * -0.1);
/// world.insert(RigidBodyBuilder::fixed(), floor);
/// world.step(); // rapier learns where the floor is
/// let flake = Particle::sphere(0.3e-3, 200.0)?; // m, kg/m³
/// let air = Layer::new(Fluid::AIR).with_flow(Uniform::new(1.0, 0.0, 0.0));
/// let mut snow = Suspension::new(air, flake)?;
/// snow.insert(Vector::Y * 1.0, Vector::ZERO);
/// for _ in 0..240 {
///     snow.step_in_world(1.0 / 60.0, &world);
/// }
/// // It fell for a little less than three seconds, at 0.34 m/s.
/// let flake = snow.particles()[0];
/// assert!(flake.settled && flake.position.y.abs() < 1e-3 && (2.85..3.0).contains(&flake.position.x));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct Suspension {
    layer: Layer,
    motion: ParticleMotion,
    particles: Vec<Suspended>,
    time: f64,
    steps: u64,
    next: u64,
    points: Vec<Vector>,
    samples: Vec<FlowSample>,
}

impl Suspension {
    /// None yet, in this fluid with its flow and turbulence. Of the turbulence's
    /// [mode](crate::turbulence::LangevinMode) nothing is used: it is the fluid that fluctuates.
    ///
    /// # Errors
    /// Those of [`Particle::check`].
    pub fn new(layer: impl Into<Layer>, particle: Particle) -> Result<Self, Error> {
        let layer = layer.into();
        Ok(Self {
            motion: particle.motion(&layer.fluid)?,
            layer,
            particles: Vec::new(),
            time: 0.0,
            steps: 0,
            next: 0,
            points: Vec::with_capacity(BATCH),
            samples: Vec::with_capacity(BATCH),
        })
    }

    /// All particles; their order changes when some are taken out.
    pub fn particles(&self) -> &[Suspended] {
        &self.particles
    }

    /// Time that it has been stepped, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Makes room, so that so many more can be inserted without an allocation.
    pub fn reserve(&mut self, more: usize) {
        self.particles.reserve(more);
    }

    /// Lets a particle in at a place (m) with a velocity relative to the fluid there (m/s); it finds the turbulence as if it
    /// had been in it for long. Neither place nor velocity may be NaN or infinite: such a particle is not let in.
    pub fn insert(&mut self, position: Vector, slip: Vector) {
        if !(position + slip).is_finite() {
            return;
        }
        let number = self.next;
        self.next += 1;
        let mut sample = [FlowSample::default()];
        if let Some(flow) = &self.layer.flow {
            flow.sample(&[position], self.time, &mut sample);
        }
        let mean = finite(sample[0].velocity, Vector::ZERO);
        let mut fluctuation = SeenFluctuation::default();
        let mut stream = mean;
        if let Some(turbulence) = &self.layer.turbulence {
            let noise = NoiseStream::new(turbulence.seed, number).vector(self.steps, 1);
            fluctuation = SeenFluctuation::stationary(noise);
            let state = turbulence.source.at(position, self.time, 0.0);
            let eddies = self.eddies(&state, 0.0);
            stream += finite(noise * eddies.deviation, Vector::ZERO);
        }
        self.particles.push(Suspended {
            position,
            velocity: stream + slip,
            settled: false,
            number,
            stream,
            fluctuation,
            since: self.time,
        });
    }

    /// Takes out those for which `keep` is false.
    pub fn retain(&mut self, mut keep: impl FnMut(&Suspended) -> bool) {
        let mut place = 0;
        while let Some(particle) = self.particles.get(place) {
            if keep(particle) {
                place += 1;
            } else {
                self.particles.swap_remove(place);
            }
        }
    }

    /// Velocity at which a particle falls through fluid at rest under `gravity` (m/s², world axes), m/s.
    pub fn settling_velocity(&self, gravity: Vector) -> Vector {
        self.motion.settling_velocity(gravity)
    }

    /// One step of `dt` seconds under `gravity`, m/s²; nothing is in the way. A `dt` that is not positive does nothing.
    pub fn step(&mut self, dt: Real, gravity: Vector) {
        self.step_until(dt, gravity, |_, _| None);
    }

    /// The same in a rapier world, under its gravity: where a particle's way meets a collider it settles. The world should
    /// have been stepped since colliders were added.
    pub fn step_in_world(&mut self, dt: Real, world: &PhysicsWorld) {
        let colliders = world.query_pipeline_with_filter(QueryFilter::new().exclude_sensors());
        self.step_until(dt, world.gravity, |from, to| {
            let (_, share) = colliders.cast_ray(&Ray::new(from, to - from), 1.0, true)?;
            Some(from + (to - from) * share)
        });
    }

    /// The same over anything: `hit` is given where a particle was and where it would be, and says where it settles in
    /// between, if it does.
    pub fn step_until(
        &mut self,
        dt: Real,
        gravity: Vector,
        mut hit: impl FnMut(Vector, Vector) -> Option<Vector>,
    ) {
        if !(dt > 0.0 && gravity.is_finite()) {
            return;
        }
        let until = self.time + f64::from(dt);
        // The same for all where the turbulence is.
        let common = match self.layer.turbulence.as_ref().map(|own| &own.source) {
            Some(Turbulence::Homogeneous(state)) => Some(self.eddies(state, dt)),
            _ => None,
        };
        let mut first = 0;
        while first < self.particles.len() {
            let range = first..(first + BATCH).min(self.particles.len());
            first = range.end;
            self.sample(range.clone(), dt, until);
            let mut place = 0;
            for index in range {
                let before = self.particles[index];
                if before.settled {
                    continue;
                }
                let mean = self.samples[place].velocity;
                place += 1;
                let after = self.moved(before, mean, (dt, until), (gravity, common));
                self.particles[index] = match hit(before.position, after.position) {
                    Some(position) if position.is_finite() => Suspended {
                        position,
                        velocity: Vector::ZERO,
                        settled: true,
                        ..after
                    },
                    _ => after,
                };
            }
        }
        self.time = until;
        self.steps += 1;
    }

    /// Samples the mean flow where those of a batch that have not settled will be, about.
    fn sample(&mut self, range: Range<usize>, dt: Real, until: f64) {
        let moving = self.particles[range].iter().filter(|one| !one.settled);
        let ahead = moving.map(|one| one.position + one.velocity * dt);
        self.points.clear();
        self.points.extend(ahead);
        self.samples.clear();
        self.samples
            .resize(self.points.len(), FlowSample::default());
        if let Some(flow) = &self.layer.flow {
            flow.sample(&self.points, until, &mut self.samples);
        }
    }

    /// A particle at the end of a step, with the mean flow there.
    #[inline]
    fn moved(
        &self,
        mut particle: Suspended,
        mean: Vector,
        (dt, until): (Real, f64),
        (gravity, common): (Vector, Option<Eddies<Real>>),
    ) -> Suspended {
        let slip = particle.velocity - particle.stream;
        // A flow that is no number moves nothing.
        let mut stream = finite(mean, particle.stream);
        if let Some(turbulence) = &self.layer.turbulence {
            let eddies = common.unwrap_or_else(|| {
                let age = until - particle.since;
                let state = turbulence.source.at(particle.position, until, age);
                self.eddies(&state, dt)
            });
            let noise = NoiseStream::new(turbulence.seed, particle.number).vector(self.steps, 0);
            let mut seen = particle.fluctuation.normalized.to_array();
            let fluctuation = pass(&mut seen, &eddies, slip.length_squared(), noise.to_array());
            let fluctuation = Vector::from_array(fluctuation);
            if (fluctuation + Vector::from_array(seen)).is_finite() {
                particle.fluctuation.normalized = Vector::from_array(seen);
                stream += fluctuation;
            }
        }
        let change = stream - particle.stream;
        let rate = self.motion.drag_rate(slip.length());
        let (kept, lost) = decay(rate * dt);
        // Relative to the fluid it tends to this velocity, of weight, and of how far it lags behind a change of the flow.
        let pull = gravity * self.motion.weight - change * ((1.0 - self.motion.carried) / dt);
        let tends = pull / rate;
        let after = tends + (slip - tends) * kept;
        let position = particle.position
            + (particle.stream + stream) * (0.5 * dt)
            + tends * dt
            + (slip - tends) * (lost / rate);
        if (position + after).is_finite() {
            (particle.position, particle.velocity) = (position, stream + after);
            particle.stream = stream;
        }
        particle
    }

    /// The turbulence for a step.
    fn eddies(&self, state: &TurbulenceState, dt: Real) -> Eddies<Real> {
        let viscosity = self.layer.fluid.kinematic_viscosity();
        let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
        let c0 = if c0.is_finite() { c0 } else { 0.0 };
        Eddies::new(state, c0, dt)
    }
}

fn finite(v: Vector, otherwise: Vector) -> Vector {
    if v.is_finite() { v } else { otherwise }
}
