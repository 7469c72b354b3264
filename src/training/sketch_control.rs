//! Control by sketch: a series of control parameters and a release that make a body follow a path drawn
//! by a user, through rapier (thesis § 7.3).
//!
//! # How
//! What a control does to a falling body a second later is chaotic, so that one long optimisation over the
//! whole fall has no useful gradient. The path is therefore followed window by window, a short horizon
//! ahead (receding horizon): at every interval sequences of controls are drawn around the
//! best so far, tried with the free body, and the best ones kept (cross-entropy method); the first control
//! of the best sequence is then applied **in rapier**, and the next window begins from where rapier got.
//! The series that is returned is the one that rapier was given: replayed from the same release in a world
//! with the same time step, the body takes the same path.
//!
//! A [`SketchFollower`] does so for one of many bodies of a world, step by step, with all that is in it: winds, which it
//! reckons with, and obstacles and other bodies, from which it goes on as it can. [`Sketch::follow`] is one in a world of its own.
//!
//! Besides the release's velocity and heading only the body's three force factors are steered: nothing
//! pushes the body, and contacts go on.
//!
//! Measured (test and example `patterns`) with two leaves of 7.3 cm and sketches of five points over two
//! seconds (swing, glide, helix): mean distances of 1.2 to 5.4 cm, in about half a second each.

use super::experiment::Experiment;
use super::followed::{FollowParams, Followed};
use super::follower::SketchFollower;
use super::in_world::BodyInWorld;
use crate::coupling::Immersion;
use crate::error::Error;
use crate::flow::Uniform;
use crate::math::to_real;
use crate::motion::{DimensionlessNumbers, Sketch};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::na::Vector3;

impl Sketch {
    /// "Land here, pass there": from `start` through the `passes` to `landing`, at the pace at which the
    /// body falls broadside; times are shared out by descent.
    ///
    /// # Errors
    /// Those of [`Sketch::new`] and [`DimensionlessNumbers::of`]; [`Error::InvalidParameter`] if a point is
    /// not below the one before.
    ///
    /// ```
    /// use rapier3d_immersed::ThesisLaw;
    /// use rapier3d_immersed::motion::Sketch;
    /// use rapier3d_immersed::rapier3d::na::Vector3;
    /// use rapier3d_immersed::training::Experiment;
    ///
    /// let leaf = Experiment::thesis_leaf(ThesisLaw::new(ThesisLaw::ZIGZAG))?;
    /// let (start, passes) = (Vector3::y() * 2.0, [Vector3::new(0.3, 1.0, 0.0)]);
    /// let sketch = Sketch::landing(&leaf, start, &passes, Vector3::zeros())?;
    /// // The first meter takes as long as the second.
    /// assert!((sketch.at(0.5 * sketch.duration()) - passes[0]).norm() < 1e-9);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn landing(
        experiment: &Experiment,
        start: Vector3<f64>,
        passes: &[Vector3<f64>],
        landing: Vector3<f64>,
    ) -> Result<Self, Error> {
        let hydro = &experiment.body.hydro;
        let numbers = DimensionlessNumbers::of(
            hydro,
            &experiment.mass,
            &experiment.fluid,
            experiment.gravity,
        )?;
        let speed = Error::check_positive("speed of descent", numbers.broadside_descent())?;
        let mut points = vec![(0.0, start)];
        let (mut time, mut last) = (0.0, start);
        for point in passes.iter().chain(std::iter::once(&landing)) {
            let descent = last.y - point.y;
            Error::check(
                "height of a point",
                point.y,
                descent > 0.0,
                "below the one before",
            )?;
            time += descent / speed;
            points.push((time, *point));
            last = *point;
        }
        Self::new(points)
    }

    /// Finds a release and a series with which the body of `experiment`, in rapier with this `collider`,
    /// follows this path at the experiment's time step, in its wind. Release angle and spin are the experiment's, the
    /// velocity is that of the path, and the heading the best of eight.
    ///
    /// A path that cannot be followed is no error: the distances tell. Bodies cannot climb, and turn only as
    /// their lifts let them.
    ///
    /// ```
    /// use rapier3d_immersed::motion::Sketch;
    /// use rapier3d_immersed::rapier3d::{na::Vector3, prelude::*};
    /// use rapier3d_immersed::training::{Experiment, FollowParams};
    /// use rapier3d_immersed::{DryMass, Fluid, HydroProperties};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let collider = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
    /// let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), collider.clone());
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
    /// let mass = DryMass::of_body(&world.bodies, &world.colliders, leaf)?;
    /// let experiment = Experiment::new(hydro, mass, Fluid::AIR);
    ///
    /// let end = Vector3::new(0.15, -0.4, 0.0);
    /// let sketch = Sketch::new(vec![(0.0, Vector3::zeros()), (0.5, end)])?;
    /// let params = FollowParams { samples: 32, rounds: 2, ..FollowParams::default() };
    /// let followed = sketch.follow(&experiment, collider, &params)?;
    /// assert!(followed.mean_distance < 0.073); // the leaf's length
    /// // At run time: release the leaf as `followed.release` says and replay `followed.series`.
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names a parameter that cannot be; those of
    /// [`Experiment::released`].
    pub fn follow(
        &self,
        experiment: &Experiment,
        collider: ColliderBuilder,
        params: &FollowParams,
    ) -> Result<Followed, Error> {
        let windy = |immersion: &mut Immersion| {
            immersion.integrator = experiment.integrator;
            if experiment.wind != Vector3::zeros() {
                let velocity = to_real(experiment.wind);
                immersion.set_flow(Uniform { velocity });
            }
        };
        let mut immersion = Immersion::new(experiment.fluid);
        windy(&mut immersion);
        let mut follower = SketchFollower::new(self, experiment, &immersion, params)?;
        let mut own = BodyInWorld::with_collider(
            experiment.body.clone(),
            collider,
            experiment.fluid,
            &follower.release_state(),
            experiment.dt,
            experiment.gravity,
        )?;
        windy(&mut own.immersion);
        for _ in 0..follower.steps() {
            follower.before_step(own.handle, &own.world.bodies, &mut own.immersion);
            own.step();
        }
        follower.followed(own.handle, &own.world.bodies)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::viscous::{ThesisLaw, ViscousLaw};

    #[test]
    fn bad_goals_are_refused() {
        let point = Vector3::zeros();
        let mut leaf = Experiment::thesis_leaf(ThesisLaw::new([1.0; 3])).unwrap();
        leaf.body.law = ViscousLaw::default();
        assert!(Sketch::landing(&leaf, point, &[], Vector3::y()).is_err());
        let down = Vector3::y() * -0.05;
        let sketch = Sketch::new(vec![(0.0, point), (0.1, down)]).unwrap();
        let params = FollowParams {
            elites: 0,
            ..FollowParams::default()
        };
        let ball = ColliderBuilder::ball(0.01);
        assert!(sketch.follow(&leaf, ball, &params).is_err());
    }
}
