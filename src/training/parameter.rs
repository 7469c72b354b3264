//! What a sweep may vary besides the law's factors: release, distribution of the mass, wind (thesis § 5.7).

use super::experiment::Experiment;
use crate::error::Error;
use rapier3d::na::{Matrix3, Vector3};

/// A parameter of an [`Experiment`], for an axis of a [`Grid`](super::Grid).
///
/// ```
/// use rapier3d_immersed::ThesisLaw;
/// use rapier3d_immersed::training::{Experiment, Parameter};
///
/// let mut leaf = Experiment::thesis_leaf(ThesisLaw::default())?;
/// let mut control = [1.0; 3];
/// Parameter::CenterOfMass(0).set(0.005, &mut leaf, &mut control)?; // 5 mm along the long axis
/// Parameter::Wind(2).set(-3.0, &mut leaf, &mut control)?;
/// Parameter::Control(0).set(1.8, &mut leaf, &mut control)?;
/// assert_eq!((leaf.wind.z, control), (-3.0, [1.8, 1.0, 1.0]));
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// A factor c̃ on the law's forces: 0 drag, 1 rotational, 2 translational lift.
    Control(usize),
    /// Release angle, rad ([`Release::tilt`](super::Release)).
    Tilt,
    /// Axis that stays horizontal at the release, rad ([`Release::tilt_axis`](super::Release)).
    TiltAxis,
    /// Heading at the release, rad.
    Heading,
    /// Center of mass along an axis of the plate, from the center of the volume, m: 0 the long one, 1 the
    /// short one, 2 the normal. The inertia about the center of mass stays: a weight in the middle is moved.
    CenterOfMass(usize),
    /// Mass, kg; the inertia grows with it.
    Mass,
    /// Factor on the second moment of the mass along an axis of the plate (0 long, 1 short): above 1 the ends are
    /// heavier, below 1 the middle.
    MassSpread(usize),
    /// Component of the wind, m/s, world axes: 0 x, 1 y (up), 2 z.
    Wind(usize),
}

impl Parameter {
    /// Sets it.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] or [`Error::OutOfRange`] names an axis that there is not, a value that is not
    /// finite, or a mass or share that is not positive.
    pub fn set(
        self,
        value: f64,
        experiment: &mut Experiment,
        control: &mut [f64; 3],
    ) -> Result<(), Error> {
        Error::check_finite("parameter of the sweep", value)?;
        let axis = |axis: usize, count: usize| {
            let most = count as f64 - 1.0;
            Error::check_range("axis of the parameter", axis as f64, 0.0, most).map(|_| axis)
        };
        let plate = experiment.body.hydro.planform.axes;
        match self {
            Self::Control(k) => control[axis(k, 3)?] = value,
            Self::Tilt => experiment.release.tilt = value,
            Self::TiltAxis => experiment.release.tilt_axis = value,
            Self::Heading => experiment.release.heading = value,
            Self::CenterOfMass(k) => {
                let centroid = experiment.body.hydro.centroid;
                let mut from_it: Vector3<f64> =
                    plate.inverse() * (experiment.mass.center - centroid);
                from_it[axis(k, 3)?] = value;
                experiment.mass.center = centroid + plate * from_it;
            }
            Self::Mass => {
                Error::check_positive("mass", value)?;
                let factor = value / experiment.mass.mass;
                experiment.mass.mass = value;
                experiment.mass.inertia *= factor;
            }
            Self::MassSpread(k) => {
                Error::check_positive("spread of the mass", value)?;
                let k = axis(k, 2)?;
                let turn = *plate.matrix();
                // ∫xxᵀdm = ½ tr(I) − I.
                let inertia = turn.transpose() * experiment.mass.inertia * turn;
                let mut second = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
                let root = value.sqrt();
                for j in 0..3 {
                    second[(k, j)] *= root;
                    second[(j, k)] *= root;
                }
                let inertia = Matrix3::identity() * second.trace() - second;
                experiment.mass.inertia = turn * inertia * turn.transpose();
            }
            Self::Wind(k) => experiment.wind[axis(k, 3)?] = value,
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydro::viscous::ThesisLaw;
    use crate::training::thin_ellipsoid;

    fn card() -> Experiment {
        Experiment::thesis_card(ThesisLaw::default()).unwrap()
    }

    fn set(parameter: Parameter, value: f64) -> Result<(Experiment, [f64; 3]), Error> {
        let (mut card, mut control) = (card(), [1.0; 3]);
        parameter.set(value, &mut card, &mut control)?;
        Ok((card, control))
    }

    /// An ellipsoid whose long semi-axis is √2 as long has twice the second moment along it.
    #[test]
    fn mass_is_spread_as_that_of_a_longer_body() {
        let (longer, _) = set(Parameter::MassSpread(0), 2.0).unwrap();
        let (_, exact) = thin_ellipsoid([0.035 * 2f64.sqrt(), 0.02, 0.0001], 800.0).unwrap();
        let exact = exact.inertia * (card().mass.mass / exact.mass);
        let error = (longer.mass.inertia - exact).norm() / exact.norm();
        assert!(error < 1e-9, "{error}");
        assert!(longer.check().is_ok());
    }

    #[test]
    fn each_is_set_where_it_belongs() {
        let (card, _) = set(Parameter::CenterOfMass(0), 3e-3).unwrap();
        assert!((card.mass.center - Vector3::new(3e-3, 0.0, 0.0)).norm() < 1e-8);
        let (heavy, _) = set(Parameter::Mass, 2.0 * card.mass.mass).unwrap();
        let inertia = heavy.mass.inertia - card.mass.inertia * 2.0;
        assert!(inertia.norm() < 1e-18);
        let (tilted, _) = set(Parameter::Tilt, 0.7).unwrap();
        assert_eq!(tilted.release.tilt, 0.7);
        assert_eq!(set(Parameter::Control(2), 3.0).unwrap().1, [1.0, 1.0, 3.0]);
        assert_eq!(
            set(Parameter::Wind(0), 3.0).unwrap().0.wind,
            Vector3::x() * 3.0
        );
        for (bad, value) in [
            (Parameter::Control(3), 1.0),
            (Parameter::Wind(5), 1.0),
            (Parameter::CenterOfMass(3), 0.0),
            (Parameter::MassSpread(2), 1.0),
            (Parameter::MassSpread(0), 0.0),
            (Parameter::Mass, -1.0),
            (Parameter::Tilt, f64::NAN),
        ] {
            assert!(set(bad, value).is_err(), "{bad:?}");
        }
    }
}
