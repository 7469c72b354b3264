//! One numerical experiment: drop a body, record how it falls.

use crate::body::{DryMass, ImmersedBody};
use crate::dynamics::{FreeBody, Integrator};
use crate::error::Error;
use crate::flow::FlowSample;
use crate::fluid::Fluid;
use crate::geometry::{Ellipsoid, Surface};
use crate::hydro::HydroProperties;
use crate::hydro::viscous::{ThesisLaw, ViscousLaw};
use crate::math;
use crate::math::{to_real, to_rotation};
use crate::motion::{Moment, PlannedFor, Trajectory};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Rotation;
use rapier3d::na::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};

/// How a body is let go, in world axes with y up. A body that lies flat has its normal along y and its long
/// axis along x.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::Vector3;
/// use rapier3d_immersed::training::{Release, thin_ellipsoid};
///
/// // Edge down: turned by 90° about its long axis, which stays horizontal.
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let release = Release { tilt: quarter, tilt_axis: quarter, ..Release::default() };
/// let (leaf, _) = thin_ellipsoid([0.035, 0.02, 0.0002], 800.0)?;
/// let normal = release.orientation(&leaf) * leaf.planform.axes * Vector3::z();
/// assert!(normal.y.abs() < 1e-9);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Release {
    /// Release angle: tilt from lying flat, rad (default 10°, as in thesis Fig. 5.6).
    pub tilt: f64,
    /// Which axis stays horizontal, rad: 0 the short one, so that an end of the long axis dips, to
    /// π/2 the long one (default 3°: a body that dips exactly along an axis of symmetry stays in a
    /// plane for ever, which no real one does).
    pub tilt_axis: f64,
    /// Turn about the vertical that comes on top, rad (default 0).
    pub heading: f64,
    /// Velocity, m/s (default 0).
    pub velocity: Vector3<f64>,
    /// Angular velocity, rad/s (default 0).
    pub spin: Vector3<f64>,
}

impl Default for Release {
    fn default() -> Self {
        Self {
            tilt: 10f64.to_radians(),
            tilt_axis: 3f64.to_radians(),
            heading: 0.0,
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        }
    }
}

impl Release {
    /// Orientation of the frame of a body of this shape.
    pub fn orientation(&self, hydro: &HydroProperties) -> UnitQuaternion<f64> {
        let level = Rotation3::from_matrix_unchecked(Matrix3::new(
            1.0, 0.0, 0.0, //
            0.0, 0.0, 1.0, //
            0.0, -1.0, 0.0,
        ));
        let (sine, cosine) = math::sin_cos(self.tilt_axis);
        let axis = Unit::new_unchecked(Vector3::new(sine, 0.0, -cosine));
        let tilt = Rotation3::from_axis_angle(&axis, self.tilt);
        let heading = Rotation3::from_axis_angle(&Vector3::y_axis(), self.heading);
        UnitQuaternion::from_rotation_matrix(
            &(heading * tilt * level * hydro.planform.axes.inverse()),
        )
    }

    /// [`Release::orientation`] as rapier's rotation, for a body whose frame `hydro` refers to.
    pub fn rotation(&self, hydro: &HydroProperties) -> Rotation {
        to_rotation(self.orientation(hydro))
    }

    /// # Errors
    /// [`Error::InvalidParameter`] names what is not finite.
    pub fn check(&self) -> Result<(), Error> {
        Error::check_finite("tilt", self.tilt)?;
        Error::check_finite("tilt_axis", self.tilt_axis)?;
        Error::check_finite("heading", self.heading)?;
        Error::check_all_finite("release velocity", self.velocity.as_slice())?;
        Error::check_all_finite("release spin", self.spin.as_slice())
    }
}

/// A body, a release, and how long and how finely its fall is computed.
///
/// ```
/// use rapier3d_immersed::Fluid;
/// use rapier3d_immersed::motion::Classifier;
/// use rapier3d_immersed::training::{Experiment, thin_ellipsoid};
///
/// // A leaf of 7 × 4 cm in air, let go at 30°.
/// let (hydro, mass) = thin_ellipsoid([0.035, 0.02, 0.0002], 400.0)?;
/// let mut experiment = Experiment::new(hydro, mass, Fluid::AIR);
/// experiment.release.tilt = 30f64.to_radians();
/// experiment.seconds = 2.0;
/// let fall = experiment.run()?;
/// assert_eq!(fall.moments.len(), 241); // 120 a second, and the release
/// // It falls at about a meter a second, far more slowly than a stone.
/// let descent = -fall.moments[240].position.y / 2.0;
/// assert!((0.5..1.5).contains(&descent));
/// println!("{:?}", Classifier::default().classify(&fall).regime);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Experiment {
    /// The body that falls, and its law.
    pub body: ImmersedBody,
    /// The body's own mass.
    pub mass: DryMass,
    /// The fluid that it falls through.
    pub fluid: Fluid,
    /// Velocity of the fluid, m/s, world axes: a steady, uniform wind (default 0).
    pub wind: Vector3<f64>,
    /// Gravity along −y, m/s² (default 9.81).
    pub gravity: f64,
    /// How it is let go.
    pub release: Release,
    /// Length of the fall, s (default 3; the thesis does not print its own).
    pub seconds: f64,
    /// Time step and interval of the record, s (default 1/120; substeps are the integrator's).
    pub dt: f64,
    /// How finely a step is integrated.
    pub integrator: Integrator,
}

impl Experiment {
    /// An experiment with default release, length and step.
    pub fn new(body: impl Into<ImmersedBody>, mass: DryMass, fluid: Fluid) -> Self {
        Self {
            body: body.into(),
            mass,
            fluid,
            wind: Vector3::zeros(),
            gravity: 9.81,
            release: Release::default(),
            seconds: 3.0,
            dt: 1.0 / 120.0,
            integrator: Integrator::default(),
        }
    }

    /// The card of thesis Fig. 5.6, under the thesis's law with coefficients C̃. The thesis prints a = 3.5 cm
    /// and b = 2 cm. Our reading of what it leaves open: in air, an ellipsoid of semi-axes
    /// 3.5 × 2 × 0.01 cm, 800 kg/m³. The third is the c that the thesis prints for its other cards, and a card
    /// as light as that is what its coefficients show their patterns on: between 800 and 900 kg/m³, all four
    /// do ([`ThesisLaw::STEADY_DESCENT`] and what follows it); at twice the mass per area the last two swing or spiral, and the
    /// zigzag fades.
    ///
    /// Not all of Fig. 5.6 comes out of one reading. Its distances d (SD 1.25, ZZ 5.69, AZ 13.72, AR 22.43 cm) are
    /// 0.6, 2.5, 20 and 140 cm here after 3 s (medians of five releases around 10°): the law as printed feeds energy into the tumbling card, which makes 90
    /// half turns a second. A card of twice the mass that is let go exactly about its short axis is off by a
    /// factor of 1.15 on average after 5 s (1.0, 5.9, 16, 21 cm), but then its zigzag has come to rest and its autorotation is chaotic. So the printed
    /// distances ask for a heavier card or a longer fall than the patterns do.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn thesis_card(law: ThesisLaw) -> Result<Self, Error> {
        Self::of_ellipsoid([0.035, 0.02, 0.0001], 800.0, law)
    }

    /// The leaf of thesis Fig. 5.14 in air: 7.3 × 4.2 × 0.03 cm. The thesis does not print its
    /// density: 400 kg/m³ here.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a coefficient of the law cannot be.
    pub fn thesis_leaf(law: ThesisLaw) -> Result<Self, Error> {
        Self::of_ellipsoid([0.0365, 0.021, 0.00015], 400.0, law)
    }

    /// The same experiment, computed finely enough for labels: steps of 1/240 s in substeps of a tenth of a
    /// chord with two evaluations each.
    ///
    /// A finer step still changes labels, because chaos makes the boundaries between patterns fuzzy; with
    /// this one, as many as a milliradian at the release does (of 729: 78 and 72 for the card under the
    /// thesis's law, 31 and 29 for the leaf under the default law, against steps of 1/1920 s), and of
    /// the nodes whose neighbours all agree less than one in a hundred (0 of 352, 3 of 484).
    pub fn for_training(mut self) -> Self {
        self.dt = 1.0 / 240.0;
        self.integrator = Integrator::FINE;
        self
    }

    fn of_ellipsoid(semi_axes: [f64; 3], density: f64, law: ThesisLaw) -> Result<Self, Error> {
        let (hydro, mass) = thin_ellipsoid(semi_axes, density)?;
        let body = ImmersedBody::new(hydro).with_law(ViscousLaw::Thesis(law))?;
        Ok(Self::new(body, mass, Fluid::AIR))
    }

    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names what cannot be; more than 10⁷
    /// steps are refused.
    pub fn check(&self) -> Result<(), Error> {
        self.release.check()?;
        Error::check_all_finite("wind", self.wind.as_slice())?;
        Error::check_finite("gravity", self.gravity)?;
        Error::check_positive("dt", self.dt)?;
        Error::check_positive("seconds", self.seconds)?;
        Error::check_range("seconds / dt", self.seconds / self.dt, 1.0, 1e7)?;
        self.body.law.check()?;
        self.mass.check()
    }

    /// The body as released.
    ///
    /// # Errors
    /// Those of [`Experiment::check`] and [`FreeBody::new`].
    pub fn released(&self) -> Result<FreeBody, Error> {
        self.check()?;
        let mut body = FreeBody::new(&self.body, &self.mass, &self.fluid)?;
        body.integrator = self.integrator;
        body.set_orientation(self.release.orientation(&self.body.hydro));
        body.set_velocity(self.release.velocity, self.release.spin);
        Ok(body)
    }

    /// Gravity as a vector, m/s².
    pub fn gravity_vector(&self) -> Vector3<f64> {
        Vector3::new(0.0, -self.gravity, 0.0)
    }

    /// The fluid's motion, for [`FreeBody::step_in`].
    pub(super) fn flow(&self) -> FlowSample {
        FlowSample {
            velocity: to_real(self.wind),
            ..FlowSample::default()
        }
    }

    /// Advances a body by one step.
    pub fn advance(&self, body: &mut FreeBody) {
        body.step_in(self.dt, self.gravity_vector(), &self.flow());
    }

    /// What controls that are planned with this experiment are planned for.
    pub fn planned_for(&self) -> PlannedFor {
        PlannedFor {
            body: self.body.clone(),
            mass: self.mass,
            fluid: self.fluid,
            wind: self.wind,
            gravity: self.gravity_vector(),
            orientation: self.release.orientation(&self.body.hydro),
            velocity: self.release.velocity,
            spin: self.release.spin,
            dt: self.dt,
        }
    }

    /// Number of steps.
    pub fn steps(&self) -> usize {
        (self.seconds / self.dt).round() as usize
    }

    /// Drops the body.
    ///
    /// # Errors
    /// Those of [`Experiment::released`].
    pub fn run(&self) -> Result<Trajectory, Error> {
        Ok(self.fall(self.released()?))
    }

    /// Drops a body from the state it is in.
    pub fn fall(&self, mut body: FreeBody) -> Trajectory {
        let steps = self.steps();
        let mut moments = Vec::with_capacity(steps + 1);
        moments.push(Moment::of(&body));
        for _ in 0..steps {
            self.advance(&mut body);
            moments.push(Moment::of(&body));
        }
        Trajectory {
            interval: self.dt,
            moments,
        }
    }
}

impl Moment {
    /// The state of a free body.
    pub fn of(body: &FreeBody) -> Self {
        Self {
            position: body.position,
            normal: body.normal(),
            long_axis: body.long_axis(),
        }
    }
}

/// A solid ellipsoid, semi-axes in m along x, y, z of its frame, density in kg/m³. The thesis computes
/// with such proxies.
///
/// ```
/// use rapier3d_immersed::training::thin_ellipsoid;
///
/// let (hydro, mass) = thin_ellipsoid([0.035, 0.02, 0.0002], 800.0)?;
/// let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.035 * 0.02 * 0.0002;
/// assert!((mass.mass / (800.0 * volume) - 1.0).abs() < 1e-12);
/// assert!((hydro.volume / volume - 1.0).abs() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Errors
/// [`Error::InvalidParameter`] if a semi-axis or the density is not positive and finite.
pub fn thin_ellipsoid(
    semi_axes: [f64; 3],
    density: f64,
) -> Result<(HydroProperties, DryMass), Error> {
    for axis in semi_axes {
        Error::check_positive("semi-axis", axis)?;
    }
    Error::check_positive("density", density)?;
    let semi_axes = Vector3::from(semi_axes);
    let ball = Surface::from_shape(SharedShape::ball(1.0).as_ref())?;
    let surface = ball.map(|v| v.component_mul(&semi_axes));
    let hydro = HydroProperties::from_surface(&surface, Vector3::zeros());
    let mass = density * Ellipsoid { semi_axes }.volume();
    let [a, b, c] = semi_axes.map(|s| s * s).into();
    let mass = DryMass {
        mass,
        center: Vector3::zeros(),
        inertia: Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b)) * (mass / 5.0),
    };
    mass.check()?;
    Ok((hydro, mass))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_release_tilts_the_long_axis_down() {
        let mut experiment = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG)).unwrap();
        experiment.release.tilt_axis = 0.0;
        let body = experiment.released().unwrap();
        let tilt = 10f64.to_radians();
        assert!((body.normal().y - tilt.cos()).abs() < 1e-9);
        assert!((body.long_axis().y + tilt.sin()).abs() < 1e-9);
        experiment.release.tilt_axis = std::f64::consts::FRAC_PI_2;
        let body = experiment.released().unwrap();
        assert!(body.long_axis().y.abs() < 1e-9 && (body.normal().y - tilt.cos()).abs() < 1e-9);
    }

    #[test]
    fn a_fall_is_recorded_from_its_release() {
        let experiment = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG)).unwrap();
        let fall = experiment.run().unwrap();
        assert_eq!(fall.moments.len(), 361);
        assert!((fall.duration() - 3.0).abs() < 1e-12);
        assert_eq!(fall.moments[0].position, Vector3::zeros());
        assert!(fall.moments[360].position.y < -1.0);
        let released = experiment.released().unwrap();
        assert_eq!(experiment.fall(released), fall);
    }

    /// In a steady uniform wind a body that is released with the wind's velocity falls as in still fluid, and
    /// drifts with it (Galilei).
    #[test]
    fn wind_carries_the_fall() {
        let mut still = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG)).unwrap();
        still.seconds = 1.0;
        let mut windy = still.clone();
        windy.wind = Vector3::new(2.0, 0.0, -1.0);
        windy.release.velocity = windy.wind;
        let (still, windy, wind) = (still.run().unwrap(), windy.run().unwrap(), windy.wind);
        for (i, (a, b)) in still.moments.iter().zip(&windy.moments).enumerate() {
            let drift = wind * (i as f64 * still.interval);
            assert!((b.position - a.position - drift).norm() < 1e-6, "{i}");
            assert!((b.normal - a.normal).norm() < 1e-5, "{i}");
        }
    }

    #[test]
    fn bad_experiments_are_refused() {
        let good = Experiment::thesis_card(ThesisLaw::new(ThesisLaw::ZIGZAG)).unwrap();
        let spoil = |change: fn(&mut Experiment)| {
            let mut bad = good.clone();
            change(&mut bad);
            bad.run().unwrap_err()
        };
        spoil(|e| e.dt = f64::NAN);
        spoil(|e| e.dt = 0.0);
        spoil(|e| e.seconds = -1.0);
        spoil(|e| e.seconds = 1e12);
        spoil(|e| e.release.spin.x = f64::INFINITY);
        spoil(|e| e.mass.mass = 0.0);
        spoil(|e| e.wind.z = f64::NAN);
        assert!(thin_ellipsoid([0.1, 0.1, 0.0], 1.0).is_err());
        assert!(thin_ellipsoid([0.1, 0.1, 0.1], f64::NAN).is_err());
    }
}
