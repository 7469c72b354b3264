//! The fluid's forces on a body, separated: accelerations per squared speed over the direction of the
//! motion and over parameters.

use super::free_fall::{GRAVITY, Specimen};
use rapier3d_immersed::Error;
use rapier3d_immersed::rapier3d::na::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_immersed::reduced::TensorTrain;
use rapier3d_immersed::reduced::{Axis, Family};
use rapier3d_immersed::reduced::{CrossParams, CrossReport, cross};
use rapier3d_immersed::reduced::{Tolerances, integrate};
use std::f64::consts::{FRAC_PI_2, PI};

/// Long enough that the rounding of a step does not matter, short enough that its truncation
/// does not either, s.
const INSTANT: f64 = 1e-7;

/// Which motions the forces are learned for.
#[derive(Clone, Copy, PartialEq)]
pub enum Motions {
    /// All of them: six coordinates.
    Any,
    /// Those within the plane y–z, in which bodies stay that are symmetric to it: three coordinates.
    InPlane,
}

/// Velocity and Lω, body axes, in coordinates in which the laws are short sums of products.
///
/// In the speed V = √(u² + L²ω²) a force is V² times a function of directions alone but for
/// the Reynolds number. ω is taken apart along u and across it, because lifts depend on ω × u.
struct Motion {
    /// Any: incidence α ∈ [0, π/2] and azimuth φ ∈ [−π/2, π/2] of u, direction ψ of ω across u, angle δ
    /// to ω along u, γ to ω across u, ln V. In plane: α, γ of either sign, ln V.
    coordinates: [f64; 6],
    count: usize,
    /// Half turns about the principal axes take u there: signs of the axes.
    turn: Vector3<f64>,
    speed2: f64,
}

/// û, ê_α, ê_φ.
fn frame(incidence: f64, azimuth: f64) -> [Vector3<f64>; 3] {
    let ((sa, ca), (sf, cf)) = (incidence.sin_cos(), azimuth.sin_cos());
    [
        Vector3::new(ca * cf, ca * sf, sa),
        Vector3::new(-sa * cf, -sa * sf, ca),
        Vector3::new(-sf, cf, 0.0),
    ]
}

impl Motion {
    fn new(motions: Motions, u: Vector3<f64>, w: Vector3<f64>) -> Self {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let about_x = sign(u.z);
        let about_z = match motions {
            Motions::Any => sign(u.x),
            Motions::InPlane => sign(about_x * u.y),
        };
        let turn = Vector3::new(about_z, about_x * about_z, about_x);
        let (u, w) = (u.component_mul(&turn), w.component_mul(&turn));
        let speed = u.norm();
        let speed2 = speed * speed + w.norm_squared();
        let log_speed = 0.5 * speed2.max(1e-30).ln();
        let incidence = u.z.atan2(u.x.hypot(u.y));
        let (coordinates, count) = if motions == Motions::InPlane {
            let turning = (-w.x).atan2(speed);
            ([incidence, turning, log_speed, 0.0, 0.0, 0.0], 3)
        } else {
            let azimuth = u.y.atan2(u.x);
            let [e, across, aside] = frame(incidence, azimuth);
            let (along, a, b) = (w.dot(&e), w.dot(&across), w.dot(&aside));
            let turning = a.hypot(b);
            let angles = [
                incidence,
                azimuth,
                b.atan2(a),
                along.atan2(speed.hypot(turning)),
                turning.atan2(speed),
                log_speed,
            ];
            (angles, 6)
        };
        Self {
            coordinates,
            count,
            turn,
            speed2,
        }
    }

    /// u and Lω at the coordinates.
    fn velocities(motions: Motions, c: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let [azimuth, direction, along, across, log_speed] = match motions {
            Motions::Any => [c[1], c[2], c[3], c[4], c[5]],
            Motions::InPlane => [FRAC_PI_2, FRAC_PI_2, 0.0, c[1], c[2]],
        };
        let [e, up, aside] = frame(c[0], azimuth);
        let v = log_speed.exp();
        let ((sd, cd), (sg, cg)) = (along.sin_cos(), across.sin_cos());
        let w = e * sd + (up * direction.cos() + aside * direction.sin()) * (cd * sg);
        (e * (v * cd * cg), w * v)
    }

    fn axes(motions: Motions, speeds: (f64, f64)) -> Result<Vec<Axis>, Error> {
        let (slow, fast) = (speeds.0.ln(), speeds.1.ln());
        if motions == Motions::InPlane {
            return Ok(vec![
                Axis::elements(0.0, FRAC_PI_2, 3, 7)?,
                Axis::elements(-FRAC_PI_2, FRAC_PI_2, 8, 6)?,
                Axis::elements(slow, fast, 4, 6)?,
            ]);
        }
        // Lifts set in where Lω is but a fiftieth of u.
        let across = vec![0.0, 0.03, 0.15, 0.6, FRAC_PI_2];
        Ok(vec![
            Axis::spectral(0.0, FRAC_PI_2, 10)?,
            Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 13)?,
            Axis::elements(-PI, PI, 2, 10)?,
            Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 11)?,
            Axis::new(Family::Lobatto, across, 7)?,
            Axis::spectral(slow, fast, 5)?,
        ])
    }
}

/// The rates of a body's motion: fluid forces as a tensor train, weight and kinematics as they are.
pub struct SeparatedForces {
    motions: Motions,
    /// du/dt and L dω/dt, body axes, times L/V².
    pub forces: TensorTrain,
    /// Acceleration by weight less buoyancy along each body axis at unit gravity, over the parameters.
    weight: TensorTrain,
    length: f64,
}

impl SeparatedForces {
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
        let mut axes = Motion::axes(motions, speeds)?;
        let count = axes.len();
        axes.extend(parameters.iter().cloned());
        let forces = |point: &[f64], out: &mut [f64]| {
            let (u, w) = Motion::velocities(motions, point);
            let per = length / (u.norm_squared() + w.norm_squared());
            let a = acceleration(specimen, &point[count..], u, w / length, Vector3::zeros());
            for k in 0..3 {
                out[k] = a[k] * per;
                out[k + 3] = a[k + 3] * length * per;
            }
        };
        let (forces, report) = cross(axes, 6, forces, params)?;
        let at_rest = |point: &[f64], out: &mut [f64]| {
            let zero = Vector3::zeros();
            let a = acceleration(specimen, point, zero, zero, Vector3::repeat(1.0));
            out.copy_from_slice(&a[..3]);
        };
        let (weight, _) = cross(parameters, 3, at_rest, params)?;
        let forces = forces.rounded(0.1 * params.tolerance);
        let separated = Self {
            motions,
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
        let mut point = Vec::new();
        let (mut scratch, mut force) = (Vec::new(), [0.0; 6]);
        // u, Lω in body axes, attitude, position.
        let mut rate = |_: f64, x: &[f64], out: &mut [f64]| {
            let (u, w) = (
                Vector3::from_column_slice(&x[..3]),
                Vector3::from_column_slice(&x[3..6]),
            );
            let q = Quaternion::new(x[6], x[7], x[8], x[9]);
            let attitude = UnitQuaternion::new_normalize(q);
            let motion = Motion::new(self.motions, u, w);
            point.clear();
            point.extend_from_slice(&motion.coordinates[..motion.count]);
            point.extend_from_slice(parameters);
            self.forces.evaluate_into(&point, &mut force, &mut scratch);
            let pull = (attitude.inverse() * GRAVITY).component_mul(&weight);
            let scale = motion.speed2 / self.length;
            for k in 0..3 {
                out[k] = motion.turn[k] * force[k] * scale + pull[k];
                out[k + 3] = motion.turn[k] * force[k + 3] * scale;
            }
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
                integrate(&mut rate, now, *time, &mut state, tolerances);
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
