//! One immersed body in a rapier world of its own.

use super::Experiment;
use crate::body::{DryMass, ImmersedBody};
use crate::coupling::Immersion;
use crate::dynamics::{ForceBreakdown, FreeBody};
use crate::error::Error;
use crate::fluid::Fluid;
use crate::hydro::HydroProperties;
use crate::math::{to_f64, to_quaternion, to_real, to_rotation};
use crate::motion::{Moment, Trajectory};
use rapier3d::dynamics::{RigidBody, RigidBodyBuilder, RigidBodyHandle};
use rapier3d::geometry::Collider;
use rapier3d::na::{UnitQuaternion, Vector3};
use rapier3d::pipeline::PhysicsWorld;

/// Where a body is, how it is turned and how it moves. World axes, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Center of mass, m (default 0).
    pub position: Vector3<f64>,
    /// Orientation of the body's frame (default: along the world's axes).
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the center of mass, m/s (default 0).
    pub velocity: Vector3<f64>,
    /// Angular velocity, rad/s (default 0).
    pub spin: Vector3<f64>,
}

impl Default for BodyState {
    fn default() -> Self {
        Self {
            position: Vector3::zeros(),
            orientation: UnitQuaternion::identity(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        }
    }
}

impl BodyState {
    /// The state of a free body.
    ///
    /// ```
    /// use rapier3d_immersed::training::{BodyState, Experiment};
    /// use rapier3d_immersed::{FreeBody, ThesisLaw};
    ///
    /// # fn main() -> Result<(), rapier3d_immersed::Error> {
    /// let card = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG))?;
    /// let state = BodyState::of(&card.released()?);
    /// assert_eq!(state.position.norm(), 0.0);
    /// # Ok(())
    /// # }
    /// ```
    pub fn of(body: &FreeBody) -> Self {
        Self {
            position: body.position,
            orientation: body.orientation(),
            velocity: body.linear_velocity(),
            spin: body.angular_velocity(),
        }
    }

    /// The state of one of rapier's bodies.
    pub fn of_rapier(body: &RigidBody) -> Self {
        Self {
            position: to_f64(body.center_of_mass()),
            orientation: UnitQuaternion::new_normalize(
                to_quaternion(*body.rotation()).into_inner(),
            ),
            velocity: to_f64(body.linvel()),
            spin: to_f64(body.angvel()),
        }
    }

    /// This state as a moment of a trajectory, for a body of this shape.
    pub fn moment(&self, hydro: &HydroProperties) -> Moment {
        let attitude =
            self.orientation * UnitQuaternion::from_rotation_matrix(&hydro.planform.axes);
        Moment {
            position: self.position,
            normal: attitude * Vector3::z(),
            long_axis: attitude * Vector3::x(),
        }
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let vectors = [self.position, self.velocity, self.spin];
        let turn = self.orientation.coords;
        vectors.iter().flatten().chain(&turn).all(|x| x.is_finite())
    }

    /// # Errors
    /// [`Error::InvalidParameter`] names what is not finite.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_all_finite("position", self.position.as_slice())?;
        Error::check_all_finite("orientation", self.orientation.coords.as_slice())?;
        Error::check_all_finite("velocity", self.velocity.as_slice())?;
        Error::check_all_finite("spin", self.spin.as_slice())
    }
}

/// One immersed body that falls in a rapier world, with nothing else in it, for measurements,
/// comparisons and small studies. It never sleeps.
///
/// World, immersion and handle are open: set a flow, turbulence or another integrator, add obstacles,
/// or step them by hand.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::SharedShape;
/// use rapier3d_immersed::training::{BodyInWorld, BodyState};
/// use rapier3d_immersed::{Fluid, HydroProperties};
///
/// # fn main() -> Result<(), rapier3d_immersed::Error> {
/// // A ball of 10 cm and 100 kg/m³ under water.
/// let ball = SharedShape::ball(0.05);
/// let hydro = HydroProperties::from_shape(ball.as_ref())?;
/// let mass = rapier3d_immersed::DryMass {
///     mass: 100.0 * hydro.volume,
///     center: Default::default(),
///     inertia: rapier3d_immersed::rapier3d::na::Matrix3::identity() * (0.1 * hydro.volume),
/// };
/// let release = BodyState::default();
/// let mut world = BodyInWorld::new(hydro, &mass, Fluid::WATER, &release, 1.0 / 240.0, 9.81)?;
/// for _ in 0..24 {
///     world.step();
/// }
/// assert!(world.state().velocity.y > 1.0, "it rises");
/// assert!(world.forces().unwrap().buoyancy.force.y > 5.0);
/// # Ok(())
/// # }
/// ```
pub struct BodyInWorld {
    /// Rapier's part.
    pub world: PhysicsWorld,
    /// The fluid.
    pub immersion: Immersion,
    /// The body.
    pub handle: RigidBodyHandle,
}

impl BodyInWorld {
    /// A body of the given mass without a collider, released in `release`; `dt` is the world's time step
    /// (s), `gravity` acts along −y (m/s²).
    ///
    /// # Errors
    /// Those of [`FreeBody::new`]; [`Error::InvalidParameter`] names what is not finite, or a time step
    /// that is not positive.
    pub fn new(
        body: impl Into<ImmersedBody>,
        mass: &DryMass,
        fluid: Fluid,
        release: &BodyState,
        dt: f64,
        gravity: f64,
    ) -> Result<Self, Error> {
        let mut empty = Self::empty(fluid, dt, gravity)?;
        let builder = RigidBodyBuilder::dynamic()
            .can_sleep(false)
            .additional_mass_properties(mass.to_mass_properties());
        empty.handle = empty.world.insert_body(builder);
        empty.immerse(body.into(), mass, release)
    }

    /// The same with a collider, from which the body has its mass.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::ColliderBuilder;
    /// use rapier3d_immersed::training::{BodyInWorld, BodyState};
    /// use rapier3d_immersed::{Fluid, HydroProperties};
    ///
    /// # fn main() -> Result<(), rapier3d_immersed::Error> {
    /// let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
    /// let hydro = HydroProperties::from_shape(leaf.shape.as_ref())?;
    /// let release = BodyState::default();
    /// let dt = 1.0 / 240.0;
    /// let mut world = BodyInWorld::with_collider(hydro, leaf, Fluid::AIR, &release, dt, 9.81)?;
    /// world.step();
    /// assert!(world.state().velocity.y < 0.0);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Those of [`BodyInWorld::new`] and [`DryMass::of_body`].
    pub fn with_collider(
        body: impl Into<ImmersedBody>,
        collider: impl Into<Collider>,
        fluid: Fluid,
        release: &BodyState,
        dt: f64,
        gravity: f64,
    ) -> Result<Self, Error> {
        let mut empty = Self::empty(fluid, dt, gravity)?;
        let builder = RigidBodyBuilder::dynamic().can_sleep(false);
        let (handle, _) = empty.world.insert(builder, collider);
        empty.handle = handle;
        let mass = DryMass::of_body(&empty.world.bodies, &empty.world.colliders, handle)?;
        empty.immerse(body.into(), &mass, release)
    }

    fn empty(fluid: Fluid, dt: f64, gravity: f64) -> Result<Self, Error> {
        Error::check_positive("dt", dt)?;
        Error::check_finite("gravity", gravity)?;
        let mut world = PhysicsWorld::new();
        world.gravity = to_real(Vector3::y() * -gravity);
        world.integration_parameters.dt = dt as f32;
        Ok(Self {
            world,
            immersion: Immersion::new(fluid),
            handle: RigidBodyHandle::invalid(),
        })
    }

    fn immerse(
        mut self,
        body: ImmersedBody,
        mass: &DryMass,
        release: &BodyState,
    ) -> Result<Self, Error> {
        release.check()?;
        // What cannot fly is an error here, where run time would only warn and leave it to rapier.
        FreeBody::new(&body, mass, self.immersion.fluid())?;
        let rapier = &mut self.world.bodies[self.handle];
        let origin = release.position - release.orientation * mass.center;
        rapier.set_translation(to_real(origin), true);
        rapier.set_rotation(to_rotation(release.orientation), true);
        rapier.set_linvel(to_real(release.velocity), true);
        rapier.set_angvel(to_real(release.spin), true);
        // Rapier would do so at the first step; until then its center of mass is not where it is released.
        rapier.recompute_mass_properties_from_colliders(&self.world.colliders);
        self.immersion.insert(self.handle, body);
        Ok(self)
    }

    /// Steps the world once.
    pub fn step(&mut self) {
        self.immersion.step(&mut self.world);
    }

    /// The state of the body in rapier.
    pub fn state(&self) -> BodyState {
        BodyState::of_rapier(&self.world.bodies[self.handle])
    }

    /// The forces on the body; `None` before the first step, with which it enters the fluid.
    pub fn forces(&self) -> Option<ForceBreakdown> {
        self.immersion.forces(&self.world.bodies, self.handle)
    }
}

impl Experiment {
    /// The state in which the body is released, its center of mass at the origin.
    pub fn release_state(&self) -> BodyState {
        BodyState {
            position: Vector3::zeros(),
            orientation: self.release.orientation(&self.body.hydro),
            velocity: self.release.velocity,
            spin: self.release.spin,
        }
    }

    /// Drops the body as [`Experiment::run`] does, but in a rapier world of its own (in single precision)
    /// whose step is the experiment's `dt`.
    ///
    /// ```
    /// use rapier3d_immersed::ThesisLaw;
    /// use rapier3d_immersed::training::Experiment;
    ///
    /// # fn main() -> Result<(), rapier3d_immersed::Error> {
    /// let card = Experiment {
    ///     seconds: 0.5,
    ///     ..Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG))?
    /// };
    /// let (alone, rapier) = (card.run()?, card.run_in_rapier()?);
    /// let apart = alone.moments[60].position - rapier.moments[60].position;
    /// assert!(apart.norm() < 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Those of [`Experiment::run`].
    pub fn run_in_rapier(&self) -> Result<Trajectory, Error> {
        self.check()?;
        let release = self.release_state();
        let (body, fluid) = (self.body.clone(), self.fluid);
        let mut fall = BodyInWorld::new(body, &self.mass, fluid, &release, self.dt, self.gravity)?;
        fall.immersion.integrator = self.integrator;
        let hydro = &self.body.hydro;
        let mut moments = Vec::with_capacity(self.steps() + 1);
        moments.push(release.moment(hydro));
        for _ in 0..self.steps() {
            fall.step();
            moments.push(fall.state().moment(hydro));
        }
        Ok(Trajectory {
            interval: self.dt,
            moments,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::viscous::{ThesisLaw, ViscousLaw};
    use crate::motion::Regime;
    use crate::training::fidelity::Plate;
    use rapier3d::geometry::ColliderBuilder;
    use rapier3d::na::Matrix3;

    /// A fall in rapier is recorded from its release on like the stand-alone one, and is the same at first.
    #[test]
    fn a_fall_in_rapier_is_recorded_like_one_alone() {
        let plate = Plate::new(1.0 / 8.0, Regime::PeriodicTumbling).unwrap();
        let law = ViscousLaw::default();
        let mut experiment = plate.experiment(&law, 0.8, 1).unwrap();
        // Rounding of single precision grows a hundredfold in a turn of the plate.
        experiment.seconds = 0.25;
        let alone = experiment.run().unwrap();
        let rapier = experiment.run_in_rapier().unwrap();
        assert_eq!(alone.moments.len(), rapier.moments.len());
        for (a, b) in alone.moments.iter().zip(&rapier.moments) {
            assert!((a.position - b.position).norm() < 1e-4, "{a:?} {b:?}");
            assert!((a.normal - b.normal).norm() < 1e-2, "{a:?} {b:?}");
        }
        experiment.gravity = f64::NAN;
        assert!(experiment.run_in_rapier().is_err());
    }

    /// A ball whose center of mass lies off its frame's origin starts with that center where it was
    /// released, however it is turned.
    #[test]
    fn the_center_of_mass_is_where_it_is_released() {
        let ball = ColliderBuilder::ball(0.1).density(100.0);
        let hydro = HydroProperties::from_shape(ball.shape.as_ref()).unwrap();
        let mass = DryMass {
            mass: 1.0,
            center: Vector3::new(0.05, 0.0, 0.02),
            inertia: Matrix3::identity() * 0.01,
        };
        let release = BodyState {
            position: Vector3::new(1.0, 2.0, -1.0),
            orientation: UnitQuaternion::from_euler_angles(0.3, -1.0, 2.0),
            velocity: Vector3::x(),
            spin: Vector3::z() * 3.0,
        };
        let place = |world: Result<BodyInWorld, Error>| {
            let world = world.unwrap();
            let state = world.state();
            assert!((state.orientation.angle_to(&release.orientation)).abs() < 1e-3);
            assert_eq!(
                (state.velocity, state.spin),
                (release.velocity, release.spin)
            );
            assert_eq!(world.forces(), None);
            state.position
        };
        let (water, dt) = (Fluid::WATER, 0.01);
        let given = BodyInWorld::new(hydro.clone(), &mass, water, &release, dt, 9.81);
        assert!((place(given) - release.position).norm() < 1e-6);
        let shifted = ball.translation(rapier3d::math::Vector::new(0.03, 0.04, 0.0));
        let own = BodyInWorld::with_collider(hydro, shifted, water, &release, dt, 9.81);
        assert!((place(own) - release.position).norm() < 1e-6);
    }

    /// The two ways to give a leaf its mass are the same fall.
    #[test]
    fn mass_given_and_mass_of_the_collider() {
        let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(400.0);
        let hydro = HydroProperties::from_shape(leaf.shape.as_ref()).unwrap();
        let release = BodyState {
            orientation: UnitQuaternion::from_euler_angles(0.3, 0.0, 0.1),
            ..BodyState::default()
        };
        let (air, dt) = (Fluid::AIR, 1.0 / 240.0);
        let mut own =
            BodyInWorld::with_collider(hydro.clone(), leaf, air, &release, dt, 9.81).unwrap();
        let (bodies, colliders) = (&own.world.bodies, &own.world.colliders);
        let mass = DryMass::of_body(bodies, colliders, own.handle).unwrap();
        let mut given = BodyInWorld::new(hydro, &mass, air, &release, dt, 9.81).unwrap();
        for _ in 0..60 {
            own.step();
            given.step();
        }
        let (own, given) = (own.state(), given.state());
        assert!(
            (own.position - given.position).norm() < 1e-4,
            "{own:?} {given:?}"
        );
        assert!(own.position.y < -0.1);
    }

    #[test]
    fn what_cannot_fly_is_refused() {
        let card = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG)).unwrap();
        let build = |mass: &DryMass, release: &BodyState, dt: f64, gravity: f64| {
            BodyInWorld::new(card.body.clone(), mass, card.fluid, release, dt, gravity).is_ok()
        };
        let (mass, release) = (card.mass, card.release_state());
        assert!(build(&mass, &release, 0.01, 9.81));
        assert!(!build(&mass, &release, 0.0, 9.81));
        assert!(!build(&mass, &release, 0.01, f64::NAN));
        assert!(!build(&DryMass { mass: 0.0, ..mass }, &release, 0.01, 9.81));
        let lost = BodyState {
            position: Vector3::repeat(f64::NAN),
            ..release
        };
        assert!(!lost.is_finite() && release.is_finite());
        assert!(!build(&mass, &lost, 0.01, 9.81));
    }
}
