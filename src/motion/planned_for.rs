//! What a series of controls was planned for, and what differs in another body.

use crate::body::{DryMass, ImmersedBody};
use crate::error::Error;
use crate::fluid::Fluid;
use rapier3d::na::{UnitQuaternion, Vector3};

/// The body, the fluid, the release and the time step that series of controls were planned for. World axes, y
/// up. Played under other conditions they show something else.
///
/// ```
/// use rapier3d_immersed::Fluid;
/// use rapier3d_immersed::motion::PlannedFor;
/// use rapier3d_immersed::training::thin_ellipsoid;
///
/// let (leaf, mass) = thin_ellipsoid([0.035, 0.02, 0.0002], 400.0)?;
/// let air = PlannedFor::new(leaf, mass, Fluid::AIR, 1.0 / 120.0);
/// let water = PlannedFor { fluid: Fluid::WATER, dt: 1.0 / 60.0, ..air.clone() };
/// assert!(air.check_same(&air).is_ok());
/// let text = air.check_same(&water).unwrap_err().to_string();
/// assert!(text.contains("density of the fluid 997") && text.contains("time step"), "{text}");
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PlannedFor {
    /// The body and its law.
    pub body: ImmersedBody,
    /// The body's own mass.
    pub mass: DryMass,
    /// The fluid.
    pub fluid: Fluid,
    /// Velocity of the fluid, m/s.
    pub wind: Vector3<f64>,
    /// Gravity, m/s².
    pub gravity: Vector3<f64>,
    /// Orientation of the body's frame at the release. A turn about the vertical is no difference.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the center of mass at the release, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity at the release, rad/s.
    pub spin: Vector3<f64>,
    /// Time step, s.
    pub dt: f64,
}

/// Relative difference from which on a number is another one. Rapier computes in f32, and its sums of masses of
/// several colliders are good to some 10⁻⁵.
const ANOTHER: f64 = 1e-3;
/// Tilt by which a release may be off, rad: three times what planners allow for by default.
const ANOTHER_TILT: f64 = 0.1;

impl PlannedFor {
    /// A body in still fluid that is released at rest, its frame aligned with the world's, under 9.81 m/s².
    pub fn new(body: impl Into<ImmersedBody>, mass: DryMass, fluid: Fluid, dt: f64) -> Self {
        Self {
            body: body.into(),
            mass,
            fluid,
            wind: Vector3::zeros(),
            gravity: Vector3::y() * -9.81,
            orientation: UnitQuaternion::identity(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            dt,
        }
    }

    /// # Errors
    /// Those of [`ImmersedBody::check`] and [`DryMass::check`]; [`Error::InvalidParameter`] names what is not
    /// finite, or a time step that is not positive.
    pub fn check(&self) -> Result<(), Error> {
        self.body.check()?;
        self.mass.check()?;
        Error::check_all_finite("wind", self.wind.as_slice())?;
        Error::check_all_finite("gravity", self.gravity.as_slice())?;
        Error::check_all_finite("orientation", self.orientation.coords.as_slice())?;
        Error::check_all_finite("release velocity", self.velocity.as_slice())?;
        Error::check_all_finite("release spin", self.spin.as_slice())?;
        Error::check_positive("dt", self.dt)?;
        Ok(())
    }

    /// Whether `now` is what this says. Numbers may differ by a thousandth, the release by 0.1 rad of tilt
    /// and by what gravity gives in one step (g·dt, in m/s of the center and of the ends of the long axis); how
    /// the body is turned about the vertical does not matter, unless there is wind.
    ///
    /// # Errors
    /// [`Error::NotAsPlanned`] names all that differs.
    pub fn check_same(&self, now: &Self) -> Result<(), Error> {
        let mut found = Vec::new();
        let mut number = |what: &str, unit: &str, planned: f64, now: f64| {
            // False for what is no number.
            let same = (now - planned).abs() <= ANOTHER * planned.abs();
            if !same {
                found.push(format!("{what} {now:.4} {unit} (planned: {planned:.4})"));
            }
        };
        let [planned_plate, plate] = [&self.body.hydro.planform, &now.body.hydro.planform];
        let long = planned_plate.half_extents.x;
        for (axis, name) in ["length", "width", "thickness"].into_iter().enumerate() {
            let [planned, now] = [planned_plate, plate].map(|p| 2e3 * p.half_extents[axis]);
            number(name, "mm", planned, now);
        }
        let volumes = [self, now].map(|x| 1e6 * x.body.hydro.volume);
        number("volume", "cm³", volumes[0], volumes[1]);
        number("mass", "g", 1e3 * self.mass.mass, 1e3 * now.mass.mass);
        let density = |x: &Self| f64::from(x.fluid.density());
        number("density of the fluid", "kg/m³", density(self), density(now));
        let viscosity = |x: &Self| 1e6 * f64::from(x.fluid.kinematic_viscosity());
        number(
            "viscosity of the fluid",
            "mm²/s",
            viscosity(self),
            viscosity(now),
        );
        number("time step", "ms", 1e3 * self.dt, 1e3 * now.dt);
        let mut difference = |what: &str, size: f64, most: f64| {
            let same = size <= most;
            if !same {
                found.push(what.to_string());
            }
        };
        let inertia = self.mass.inertia;
        let off = (now.mass.inertia - inertia).norm();
        difference(
            "distribution of the mass",
            off,
            10.0 * ANOTHER * inertia.norm(),
        );
        let center = |x: &Self| x.mass.center - x.body.hydro.centroid;
        let off = (center(now) - center(self)).norm();
        difference("center of mass", off, ANOTHER * long);
        let law = f64::from(self.body.law != now.body.law);
        difference("law", law, 0.0);
        let gravity = self.gravity.norm();
        let off = (now.gravity - self.gravity).norm();
        difference("gravity", off, ANOTHER * gravity);
        let step = gravity * self.dt;
        difference("wind", (now.wind - self.wind).norm(), step);
        // The release, but for its heading: as the body sees it.
        let up = |x: &Self| x.orientation.inverse() * Vector3::y();
        difference(
            "tilt of the release",
            up(self).angle(&up(now)),
            ANOTHER_TILT,
        );
        if self.wind.norm() > step {
            let turned = self.orientation.angle_to(&now.orientation);
            difference("heading of the release in the wind", turned, ANOTHER_TILT);
        }
        let motion = |x: &Self| {
            let inverse = x.orientation.inverse();
            (inverse * x.velocity, inverse * x.spin)
        };
        let ((v, w), (v_now, w_now)) = (motion(self), motion(now));
        let slack = step + ANOTHER_TILT * v.norm();
        difference("velocity of the release", (v_now - v).norm(), slack);
        let slack = step + ANOTHER_TILT * w.norm() * long;
        difference("spin of the release", (w_now - w).norm() * long, slack);
        if found.is_empty() {
            return Ok(());
        }
        Err(Error::NotAsPlanned {
            differences: found.join(", "),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::HydroProperties;
    use crate::hydro::viscous::{ThesisLaw, ViscousLaw};
    use rapier3d::geometry::SharedShape;

    fn leaf() -> PlannedFor {
        let shape = SharedShape::cuboid(0.0365, 0.00015, 0.021);
        let hydro = HydroProperties::from_shape(shape.as_ref()).unwrap();
        let mass = DryMass::of_shape(shape.as_ref(), 400.0).unwrap();
        PlannedFor::new(hydro, mass, Fluid::AIR, 1.0 / 120.0)
    }

    /// Whatever is changed is named, and nothing else is.
    #[test]
    fn differences_are_named() {
        let leaf = leaf();
        assert!(leaf.check().is_ok() && leaf.check_same(&leaf).is_ok());
        type Change = fn(&mut PlannedFor);
        let changes: [(&str, Change); 11] = [
            ("mass", |p| p.mass.mass *= 1.1),
            ("distribution of the mass", |p| {
                p.mass.inertia[(0, 0)] *= 1.1
            }),
            ("center of mass", |p| p.mass.center.x += 1e-3),
            ("density of the fluid", |p| {
                p.fluid = Fluid::new(2.0, p.fluid.kinematic_viscosity()).unwrap();
            }),
            ("viscosity of the fluid", |p| {
                p.fluid = Fluid::new(p.fluid.density(), 1e-6).unwrap();
            }),
            ("time step", |p| p.dt *= 2.0),
            ("law", |p| {
                p.body.law = ViscousLaw::Thesis(ThesisLaw::default())
            }),
            ("gravity", |p| p.gravity.y = -1.62),
            ("wind", |p| p.wind.x = 1.0),
            ("tilt of the release", |p| {
                p.orientation = UnitQuaternion::from_scaled_axis(Vector3::x() * 0.3);
            }),
            ("spin of the release", |p| p.spin.z = 10.0),
        ];
        for (name, change) in changes {
            let mut other = leaf.clone();
            change(&mut other);
            let Err(Error::NotAsPlanned { differences }) = leaf.check_same(&other) else {
                panic!("{name} is not noticed");
            };
            assert!(differences.starts_with(name), "{name}: {differences}");
            assert!(!differences.contains(", "), "{name}: {differences}");
        }
        let mut other = leaf.clone();
        other.dt = f64::NAN;
        assert!(leaf.check_same(&other).is_err() && other.check().is_err());
    }

    /// A turn about the vertical, a thousandth of a radian and the first step's velocity are no other
    /// release; in wind the heading is.
    #[test]
    fn releases_are_compared_as_the_body_sees_them() {
        let mut leaf = leaf();
        leaf.orientation = UnitQuaternion::from_scaled_axis(Vector3::z() * 0.4);
        leaf.velocity = Vector3::new(1.0, 0.0, 0.0);
        let heading = UnitQuaternion::from_scaled_axis(Vector3::y() * 2.0);
        let mut other = leaf.clone();
        other.orientation = heading * leaf.orientation;
        other.velocity = heading * leaf.velocity + Vector3::y() * 0.05;
        assert!(leaf.check_same(&other).is_ok());
        let mut thrown = other.clone();
        thrown.velocity = Vector3::x();
        let text = leaf.check_same(&thrown).unwrap_err().to_string();
        assert!(text.contains("velocity of the release"), "{text}");
        leaf.wind = Vector3::x();
        other.wind = leaf.wind;
        let text = leaf.check_same(&other).unwrap_err().to_string();
        assert!(text.contains("heading"), "{text}");
    }
}
