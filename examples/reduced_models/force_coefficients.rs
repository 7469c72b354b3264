//! Bodies whose fluid forces are separated: accelerations over the motion and over parameters, integrated.

use super::free_fall::{GRAVITY, Specimen};
use rapier3d_immersed::Error;
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::reduced::{
    Axis, CrossParams, CrossReport, Motions, SeparatedForces, TensorTrain, Tolerances, cross,
    integrate,
};

use std::f64::consts::FRAC_PI_2;

/// Long enough that the rounding of a step does not matter, short enough that its truncation
/// does not either, s.
const INSTANT: f64 = 1e-7;

/// The rates of a body's motion: fluid forces as a tensor train, weight and kinematics as they are.
pub struct SeparatedFall {
    /// du/dt and L dω/dt, body axes, times L.
    pub forces: SeparatedForces,
    /// Acceleration by weight less buoyancy along each body axis at unit gravity, over the parameters.
    weight: TensorTrain,
    length: f64,
}

impl SeparatedFall {
    /// Learns the accelerations of `specimen` over motions of `speeds` V, m/s, and `parameters`, which
    /// are those of [`Specimen::body`].
    pub fn bake(
        specimen: &Specimen,
        motions: Motions,
        speeds: (f64, f64),
        parameters: Vec<Axis>,
        params: &CrossParams,
    ) -> Result<(Self, CrossReport), Error> {
        let length = specimen.semi_axes.x;
        let mut axes = motions.axes(speeds.0, speeds.1)?;
        if motions == Motions::InPlane {
            // The default law stalls within .1 of sin α, earlier or later as the plate turns.
            axes[0] = Axis::elements(0.0, FRAC_PI_2, 16, 3)?;
            axes[1] = Axis::elements(-FRAC_PI_2, FRAC_PI_2, 32, 3)?;
        }
        let forces = |u: &Vector3<f64>, w: &Vector3<f64>, parameters: &[f64]| {
            let a = acceleration(specimen, parameters, *u, w / length, Vector3::zeros());
            let at = |k: usize| Vector3::new(a[k], a[k + 1], a[k + 2]);
            [at(0) * length, at(3) * (length * length)]
        };
        let (forces, report) =
            SeparatedForces::bake(motions, axes, parameters.clone(), params, forces)?;
        let at_rest = |point: &[f64], out: &mut [f64]| {
            let zero = Vector3::zeros();
            let a = acceleration(specimen, point, zero, zero, Vector3::repeat(1.0));
            out.copy_from_slice(&a[..3]);
        };
        let (weight, _) = cross(parameters, 3, at_rest, params)?;
        let separated = Self {
            forces,
            weight,
            length,
        };
        Ok((separated, report))
    }

    /// Horizontal positions at `times` of a body released from rest.
    pub fn positions(
        &self,
        parameters: &[f64],
        orientation: UnitQuaternion<f64>,
        times: &[f64],
        tolerances: Tolerances,
    ) -> Vec<[f64; 2]> {
        let weight = Vector3::from_column_slice(&self.weight.evaluate(parameters));
        // u, Lω in body axes, attitude, position.
        let rate = |_: f64, x: &[f64], out: &mut [f64]| {
            let (u, w) = (
                Vector3::from_column_slice(&x[..3]),
                Vector3::from_column_slice(&x[3..6]),
            );
            let q = Quaternion::new(x[6], x[7], x[8], x[9]);
            let attitude = UnitQuaternion::new_normalize(q);
            let [du, dw] = self.forces.evaluate(&u, &w, parameters);
            let pull = (attitude.inverse() * GRAVITY).component_mul(&weight);
            out[..3].copy_from_slice((du / self.length + pull).as_slice());
            out[3..6].copy_from_slice((dw / self.length).as_slice());
            let spin = w / self.length;
            let turning = q * Quaternion::from_imag(spin) * 0.5;
            out[6..10].copy_from_slice(&[turning.w, turning.i, turning.j, turning.k]);
            out[10..13].copy_from_slice((attitude * u).as_slice());
        };
        let mut state = [0.0; 13];
        let q = orientation.quaternion();
        state[6..10].copy_from_slice(&[q.w, q.i, q.j, q.k]);
        let mut now = 0.0;
        times
            .iter()
            .map(|time| {
                integrate(rate, now, *time, &mut state, tolerances);
                now = *time;
                [state[10], state[11]]
            })
            .collect()
    }
}

/// du/dt and dω/dt in body axes, from a step too short to matter; not finite where there is no such
/// body.
fn acceleration(
    specimen: &Specimen,
    parameters: &[f64],
    u: Vector3<f64>,
    spin: Vector3<f64>,
    gravity: Vector3<f64>,
) -> [f64; 6] {
    let Ok(mut body) = specimen.body(parameters) else {
        return [f64::NAN; 6];
    };
    body.set_velocity(u, spin);
    body.step(INSTANT, gravity);
    let back = body.orientation().inverse();
    let (du, dw) = (
        back * body.linear_velocity() - u,
        back * body.angular_velocity() - spin,
    );
    let (du, dw) = (du / INSTANT, dw / INSTANT);
    [du.x, du.y, du.z, dw.x, dw.y, dw.z]
}
