//! One experiment, run by the crate's own integrator or in a rapier world.

use crate::support::fall::{from_rapier, to_rapier};
use rapier3d_immersed::motion::{Moment, Trajectory};
use rapier3d_immersed::rapier3d::math::Vector;
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::prelude::{PhysicsWorld, RigidBodyBuilder};
use rapier3d_immersed::training::Experiment;
use rapier3d_immersed::{Error, Immersion, Integrator};

/// Who integrates, and how finely. The experiment's own step is 1/240 s for plates and papers, and scaled
/// to the size of a disc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Runner {
    /// The crate's own free body in f64, at the experiment's step.
    Alone,
    /// The same at half the step.
    HalfStep,
    /// A rapier world (f32) whose step is so many times the experiment's; the fall is recorded at every
    /// step.
    Rapier(u32),
    /// The same under [`Integrator::FINE`].
    Fine(u32),
}

impl Runner {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alone => "stand-alone",
            Self::HalfStep => "dt/2",
            Self::Rapier(1) => "rapier, dt",
            Self::Rapier(4) => "rapier, 4 dt",
            Self::Rapier(_) => "rapier",
            Self::Fine(4) => "rapier, 4 dt, fine substeps",
            Self::Fine(_) => "rapier, fine substeps",
        }
    }

    /// Drops the body.
    ///
    /// # Errors
    /// Those of [`Experiment::run`].
    pub fn run(self, experiment: &Experiment) -> Result<Trajectory, Error> {
        match self {
            Self::Alone => experiment.run(),
            Self::HalfStep => Experiment {
                dt: 0.5 * experiment.dt,
                ..experiment.clone()
            }
            .run(),
            Self::Rapier(times) => in_rapier(experiment, experiment.dt * f64::from(times)),
            Self::Fine(times) => {
                let fine = Experiment {
                    integrator: Integrator::FINE,
                    ..experiment.clone()
                };
                in_rapier(&fine, experiment.dt * f64::from(times))
            }
        }
    }
}

/// The experiment in a rapier world of its own, stepped by `dt` seconds.
fn in_rapier(experiment: &Experiment, dt: f64) -> Result<Trajectory, Error> {
    let timed = Experiment {
        dt,
        ..experiment.clone()
    };
    timed.check()?;
    let hydro = &experiment.body.hydro;
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, -experiment.gravity as f32, 0.0);
    world.integration_parameters.dt = dt as f32;
    let body = world.insert_body(
        RigidBodyBuilder::dynamic()
            .rotation(experiment.release.rotation(hydro).to_scaled_axis())
            .linvel(to_rapier(&experiment.release.velocity))
            .angvel(to_rapier(&experiment.release.spin))
            .additional_mass_properties(experiment.mass.to_mass_properties())
            .can_sleep(false),
    );
    let mut immersion = Immersion::new(experiment.fluid);
    immersion.integrator = experiment.integrator;
    immersion.insert(body, experiment.body.clone());
    let plate = UnitQuaternion::from_rotation_matrix(&hydro.planform.axes);
    let center = experiment.release.orientation(hydro) * experiment.mass.center;
    let moment = |world: &PhysicsWorld| {
        let body = &world.bodies[body];
        let q = body.rotation();
        let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(f64::from);
        let attitude = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)) * plate;
        Moment {
            position: from_rapier(body.center_of_mass()) - center,
            normal: attitude * Vector3::z(),
            long_axis: attitude * Vector3::x(),
        }
    };
    let mut moments = vec![Moment {
        position: Vector3::zeros(),
        ..moment(&world)
    }];
    for _ in 0..timed.steps() {
        immersion.step(&mut world);
        moments.push(moment(&world));
    }
    Ok(Trajectory {
        interval: dt,
        moments,
    })
}
