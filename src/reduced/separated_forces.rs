//! The force and torque of a fluid on a body over all of its motions, as a tensor train.

use super::axis::{Axis, Family};
use super::cross::{CrossParams, CrossReport, cross};
use super::tensor_train::TensorTrain;
use crate::error::Error;
use crate::math;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rapier3d::na::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Most coordinates, motion and parameters together: an evaluation keeps them on the stack.
const MOST_COORDINATES: usize = 16;
/// Largest rank, for the same reason.
const MOST_RANK: usize = 64;
/// Motions at which the symmetry is tried.
const SYMMETRY_POINTS: usize = 40;

/// Which motions forces are separated over, and which of them are mirror images of each other.
///
/// Half turns about the principal axes take every body with three planes of symmetry into itself; reflections do so
/// too unless the law makes a difference between left and right, as [`ThesisLaw`](crate::ThesisLaw)'s force along
/// (ω × u) × u does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum Motions {
    /// All of them, six coordinates; half turns about the axes are known to change nothing.
    Turned,
    /// All of them; half turns and reflections are.
    Mirrored,
    /// Those within the plane y–z, in which bodies stay that are symmetric to it: three coordinates.
    InPlane,
}

impl Motions {
    /// How many coordinates a motion has.
    pub fn coordinates(self) -> usize {
        match self {
            Self::Turned | Self::Mirrored => 6,
            Self::InPlane => 3,
        }
    }

    /// The coordinates of a motion, as [`SeparatedForces`] describes them, with meshes for laws of thin plates, for
    /// speeds between `slow` and `fast`.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] if the speeds are not positive and rising.
    pub fn axes(self, slow: f64, fast: f64) -> Result<Vec<Axis>, Error> {
        Error::check_positive("slowest speed of separated forces", slow)?;
        Error::check_positive("fastest speed over slowest, less 1", fast / slow - 1.0)?;
        let (slow, fast) = (math::ln(slow), math::ln(fast));
        // Lifts set in where Lω is but a fiftieth of u.
        let across = vec![0.0, 0.03, 0.15, 0.6, FRAC_PI_2];
        Ok(match self {
            Self::InPlane => vec![
                Axis::elements(0.0, FRAC_PI_2, 3, 7)?,
                Axis::elements(-FRAC_PI_2, FRAC_PI_2, 8, 6)?,
                Axis::elements(slow, fast, 4, 6)?,
            ],
            Self::Turned => vec![
                Axis::spectral(0.0, FRAC_PI_2, 10)?,
                Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 13)?,
                Axis::elements(-PI, PI, 2, 10)?,
                Axis::spectral(-FRAC_PI_2, FRAC_PI_2, 11)?,
                Axis::new(Family::Lobatto, across, 7)?,
                Axis::spectral(slow, fast, 5)?,
            ],
            Self::Mirrored => vec![
                Axis::elements(0.0, FRAC_PI_2, 6, 4)?,
                Axis::spectral(0.0, FRAC_PI_2, 7)?,
                Axis::elements(-PI, PI, 4, 4)?,
                Axis::elements(-FRAC_PI_2, FRAC_PI_2, 2, 4)?,
                Axis::new(Family::Lobatto, across, 4)?,
                Axis::spectral(slow, fast, 5)?,
            ],
        })
    }
}

/// û, ê_α, ê_φ of a direction.
fn frame(incidence: f64, azimuth: f64) -> [Vector3<f64>; 3] {
    let ((sa, ca), (sf, cf)) = (math::sin_cos(incidence), math::sin_cos(azimuth));
    [
        Vector3::new(ca * cf, ca * sf, sa),
        Vector3::new(-sa * cf, -sa * sf, ca),
        Vector3::new(-sf, cf, 0.0),
    ]
}

/// A velocity u and a spin w = Lω in body axes, in coordinates in which laws are short sums of products.
struct Motion {
    coordinates: [f64; 6],
    /// Signs of the axes that take the motion to the one that the coordinates are of.
    turn: Vector3<f64>,
    /// Their product: what a pseudovector is turned by besides.
    parity: f64,
    /// u² + w².
    speed2: f64,
}

impl Motion {
    fn new(motions: Motions, u: &Vector3<f64>, w: &Vector3<f64>) -> Self {
        let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        let about_x = sign(u.z);
        let turn = match motions {
            Motions::Turned => Vector3::new(sign(u.x), about_x * sign(u.x), about_x),
            Motions::Mirrored => Vector3::new(sign(u.x), sign(u.y), sign(u.z)),
            Motions::InPlane => {
                let about_z = sign(about_x * u.y);
                Vector3::new(about_z, about_x * about_z, about_x)
            }
        };
        let parity = turn.product();
        let (u, w) = (u.component_mul(&turn), w.component_mul(&turn) * parity);
        let speed = u.norm();
        let speed2 = speed * speed + w.norm_squared();
        let log_speed = 0.5 * math::ln(speed2.max(1e-30));
        let incidence = math::atan2(u.z, math::hypot(u.x, u.y));
        let coordinates = if motions == Motions::InPlane {
            [
                incidence,
                math::atan2(-w.x, speed),
                log_speed,
                0.0,
                0.0,
                0.0,
            ]
        } else {
            let azimuth = math::atan2(u.y, u.x);
            let [e, across, aside] = frame(incidence, azimuth);
            let (along, a, b) = (w.dot(&e), w.dot(&across), w.dot(&aside));
            let turning = math::hypot(a, b);
            [
                incidence,
                azimuth,
                math::atan2(b, a),
                math::atan2(along, math::hypot(speed, turning)),
                math::atan2(turning, speed),
                log_speed,
            ]
        };
        Self {
            coordinates,
            turn,
            parity,
            speed2,
        }
    }
}

/// u and w at coordinates, and the axes along and across u in the plane x–y, and z, that forces there are given in.
fn velocities(motions: Motions, c: &[f64]) -> [Vector3<f64>; 2] {
    let [azimuth, direction, along, across, log_speed] = match motions {
        Motions::Turned | Motions::Mirrored => [c[1], c[2], c[3], c[4], c[5]],
        Motions::InPlane => [FRAC_PI_2, FRAC_PI_2, 0.0, c[1], c[2]],
    };
    let [e, up, aside] = frame(c[0], azimuth);
    let v = math::exp(log_speed);
    let ((sd, cd), (sg, cg)) = (math::sin_cos(along), math::sin_cos(across));
    let w = e * sd + (up * math::cos(direction) + aside * math::sin(direction)) * (cd * sg);
    [e * (v * cd * cg), w * v]
}

/// The azimuth among the coordinates.
fn azimuth(motions: Motions, c: &[f64]) -> f64 {
    match motions {
        Motions::Turned | Motions::Mirrored => c[1],
        Motions::InPlane => FRAC_PI_2,
    }
}

/// From body axes to those along and across the azimuth, or back with the sine's other sign.
fn turned(v: &Vector3<f64>, (sine, cosine): (f64, f64)) -> Vector3<f64> {
    Vector3::new(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x, v.z)
}

/// Force and torque over the motions of a body with three planes of symmetry, and over parameters, as a tensor train.
///
/// A motion is the velocity u of the body's center and w = Lω, body axes, z along the plate's normal. With
/// V = √(u² + w²) force and torque are V² times a function of directions, and of V where it matters. Its
/// coordinates, in the order of the axes:
///
/// | | range | |
/// |---|---|---|
/// | incidence α | 0 to π/2 | of u to the plane x–y |
/// | azimuth φ | −π/2 to π/2 (0 to π/2 [`Mirrored`](Motions::Mirrored)) | of u in that plane |
/// | direction ψ | −π to π | of w across u: 0 toward the normal, π/2 toward growing φ |
/// | along δ | −π/2 to π/2 | from the plane of u and w across u to w along u |
/// | across γ | 0 to π/2 | from u to w across u |
/// | ln V | | |
///
/// In a plane they are α, γ of either sign (positive where −w_x is), and ln V. In these coordinates, and with their
/// vectors along and across the azimuth, laws are sums of few products: lifts depend on ω × u, and the
/// plate's shape on φ alone.
///
/// **Beyond its speeds** it goes on as laws do: as V above the fastest's coefficients stay, so that forces grow as
/// V²; below the slowest they grow as 1/V, so that forces fall as V, as those of creeping flow. All directions are within.
///
/// ```
/// use rapier3d_immersed::rapier3d::na::Vector3;
/// use rapier3d_immersed::reduced::{CrossParams, Motions, SeparatedForces};
///
/// // Drag −|u|u and a damping −|w|w, of a sphere.
/// let model = |u: &Vector3<f64>, w: &Vector3<f64>, _: &[f64]| [u * -u.norm(), w * -w.norm()];
/// let axes = Motions::InPlane.axes(0.1, 10.0)?;
/// let params = CrossParams { tolerance: 1e-4, rank_growth: 4, ..CrossParams::default() };
/// let (forces, _) = SeparatedForces::bake(Motions::InPlane, axes, Vec::new(), &params, model)?;
/// let (u, w) = (Vector3::new(0.0, -3.0, 4.0), Vector3::new(2.0, 0.0, 0.0));
/// let [force, torque] = forces.evaluate(&u, &w, &[]);
/// assert!((force - u * -5.0).norm() < 0.05 && (torque - w * -2.0).norm() < 0.05);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct SeparatedForces {
    pub(crate) motions: Motions,
    /// Force and torque over V², along and across the azimuth.
    pub(crate) train: TensorTrain,
}

impl SeparatedForces {
    /// Samples `model(u, w, parameters)`, which gives a force (a vector) and a torque (a pseudovector) in body axes, over
    /// the coordinates `axes` of motions (see [`Motions::axes`]) and over `parameters`. Forces are zero on many nodes: let ranks
    /// grow by four at least ([`CrossParams::rank_growth`]), and look at [`error`](Self::error).
    ///
    /// # Errors
    /// Those of [`cross()`]; [`Error::WrongLength`] for a wrong number of axes; [`Error::InvalidParameter`] for more than 16
    /// coordinates, ranks above 64, axes of directions that do not cover them, and forces without the symmetry of `motions`.
    pub fn bake(
        motions: Motions,
        axes: Vec<Axis>,
        parameters: Vec<Axis>,
        params: &CrossParams,
        mut model: impl FnMut(&Vector3<f64>, &Vector3<f64>, &[f64]) -> [Vector3<f64>; 2],
    ) -> Result<(Self, CrossReport), Error> {
        let count = motions.coordinates();
        Error::check_length("axes of a motion", count, axes.len())?;
        let all: Vec<Axis> = axes.into_iter().chain(parameters).collect();
        check_axes(motions, &all)?;
        check_symmetry(motions, &all, &mut model)?;
        let forces = |point: &[f64], out: &mut [f64]| {
            let (motion, parameters) = point.split_at(count);
            let [u, w] = velocities(motions, motion);
            let per = 1.0 / (u.norm_squared() + w.norm_squared());
            let turn = math::sin_cos(azimuth(motions, motion));
            let [force, torque] = model(&u, &w, parameters).map(|v| turned(&v, turn) * per);
            out[..3].copy_from_slice(force.as_slice());
            out[3..].copy_from_slice(torque.as_slice());
        };
        let (train, report) = cross(all, 6, forces, params)?;
        let train = train.rounded(0.1 * params.tolerance);
        let separated = Self { motions, train };
        separated.check()?;
        Ok((separated, report))
    }

    /// Force and torque in body axes at a velocity u of the center and a spin w = Lω.
    ///
    /// # Panics
    /// If the number of parameters differs.
    pub fn evaluate(
        &self,
        u: &Vector3<f64>,
        w: &Vector3<f64>,
        parameters: &[f64],
    ) -> [Vector3<f64>; 2] {
        let motion = Motion::new(self.motions, u, w);
        let count = self.motions.coordinates();
        let mut point = [0.0; MOST_COORDINATES];
        point[..count].copy_from_slice(&motion.coordinates[..count]);
        point[count..count + parameters.len()].copy_from_slice(parameters);
        let point = &point[..count + parameters.len()];
        let mut values = [0.0; 6];
        self.train
            .contract(point, &mut values, &mut [0.0; 2 * MOST_RANK]);
        let slow = math::exp(self.train.axes()[count - 1].start());
        let speed = motion.speed2.sqrt();
        let scale = motion.speed2.max(speed * slow);
        let (sine, cosine) = math::sin_cos(azimuth(self.motions, point));
        let [f, t] = [[0, 1, 2], [3, 4, 5]].map(|k| {
            let v = Vector3::new(values[k[0]], values[k[1]], values[k[2]]);
            turned(&v, (-sine, cosine)).component_mul(&motion.turn) * scale
        });
        [f, t * motion.parity]
    }

    /// The motions that it is of.
    pub fn motions(&self) -> Motions {
        self.motions
    }

    /// The tensor train: coordinates of the motion, then parameters, to force and torque over V².
    pub fn train(&self) -> &TensorTrain {
        &self.train
    }

    /// Root mean square of the error of force and torque at `count` random motions and parameters off the nodes, over that
    /// of the model's, and the largest error over the same.
    pub fn error(
        &self,
        count: usize,
        seed: u64,
        mut model: impl FnMut(&Vector3<f64>, &Vector3<f64>, &[f64]) -> [Vector3<f64>; 2],
    ) -> [f64; 2] {
        let mut random = Pcg64::seed_from_u64(seed);
        let (mut squares, mut norm, mut worst) = (0.0, 0.0, 0.0_f64);
        for _ in 0..count {
            let point = random_point(self.train.axes(), &mut random);
            let (motion, parameters) = point.split_at(self.motions.coordinates());
            let [u, w] = velocities(self.motions, motion);
            let per = 1.0 / (u.norm_squared() + w.norm_squared());
            let exact = model(&u, &w, parameters);
            let found = self.evaluate(&u, &w, parameters);
            let size = |v: &[Vector3<f64>; 2]| v[0].norm_squared() + v[1].norm_squared();
            let off = size(&[found[0] - exact[0], found[1] - exact[1]]) * per * per;
            squares += off;
            norm += size(&exact) * per * per;
            worst = worst.max(off);
        }
        let norm = norm.max(f64::MIN_POSITIVE);
        [
            (squares / norm).sqrt(),
            (worst * count as f64 / norm).sqrt(),
        ]
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        self.train.check()?;
        Error::check_length("outputs of separated forces", 6, self.train.outputs())?;
        check_axes(self.motions, self.train.axes())?;
        let widest = self.train.ranks().into_iter().max().unwrap_or(1);
        let fits = widest <= MOST_RANK;
        Error::check(
            "rank of separated forces",
            widest as f64,
            fits,
            "at most 64",
        )
        .map(drop)
    }
}

fn random_point(axes: &[Axis], random: &mut Pcg64) -> Vec<f64> {
    axes.iter()
        .map(|axis| random.random_range(axis.start()..axis.end()))
        .collect()
}

/// The axes of directions must cover them: there is nothing to continue them by.
fn check_axes(motions: Motions, axes: &[Axis]) -> Result<(), Error> {
    let count = motions.coordinates();
    if axes.len() < count {
        return Err(Error::WrongLength {
            what: "axes of separated forces",
            expected: count,
            actual: axes.len(),
        });
    }
    let fits = axes.len() <= MOST_COORDINATES;
    let coordinates = axes.len() as f64;
    Error::check(
        "coordinates of separated forces",
        coordinates,
        fits,
        "at most 16",
    )?;
    let quarter = FRAC_PI_2;
    let ranges: &[[f64; 2]] = match motions {
        Motions::InPlane => &[[0.0, quarter], [-quarter, quarter]],
        Motions::Turned => &[
            [0.0, quarter],
            [-quarter, quarter],
            [-PI, PI],
            [-quarter, quarter],
            [0.0, quarter],
        ],
        Motions::Mirrored => &[
            [0.0, quarter],
            [0.0, quarter],
            [-PI, PI],
            [-quarter, quarter],
            [0.0, quarter],
        ],
    };
    for (axis, [start, end]) in axes.iter().zip(ranges) {
        for (value, expected) in [(axis.start(), start), (axis.end(), end)] {
            let ends = (value - expected).abs() < 1e-9;
            Error::check(
                "end of an axis of directions",
                value,
                ends,
                "that of the range",
            )?;
        }
    }
    Ok(())
}

/// Compares the forces at random motions with those at their images.
fn check_symmetry(
    motions: Motions,
    axes: &[Axis],
    model: &mut impl FnMut(&Vector3<f64>, &Vector3<f64>, &[f64]) -> [Vector3<f64>; 2],
) -> Result<(), Error> {
    let images: &[[f64; 3]] = match motions {
        Motions::Mirrored => &[[-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]],
        Motions::Turned | Motions::InPlane => &[[-1.0, -1.0, 1.0], [1.0, -1.0, -1.0]],
    };
    let mut random = Pcg64::seed_from_u64(3);
    for _ in 0..SYMMETRY_POINTS {
        let point = random_point(axes, &mut random);
        let (motion, parameters) = point.split_at(motions.coordinates());
        let [u, w] = velocities(motions, motion);
        let [force, torque] = model(&u, &w, parameters);
        let size = force.norm() + torque.norm();
        for image in images {
            let turn = Vector3::from(*image);
            let as_spin = turn * turn.product();
            let [f, t] = model(
                &u.component_mul(&turn),
                &w.component_mul(&as_spin),
                parameters,
            );
            let off = (f.component_mul(&turn) - force).norm()
                + (t.component_mul(&as_spin) - torque).norm();
            // Models may be differences, good to some digits; a wrong sign is wrong by the size.
            let same = off <= 1e-3 * size;
            Error::check(
                "asymmetry of the forces, relative",
                off / size,
                same || !size.is_finite(),
                "zero: half turns (and reflections) of the motion must turn the forces",
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coordinates and back: every motion is found again, at its image.
    #[test]
    fn coordinates_are_those_of_the_motion() {
        let mut random = Pcg64::seed_from_u64(4);
        for motions in [Motions::Turned, Motions::Mirrored, Motions::InPlane] {
            for _ in 0..200 {
                let mut vector = || Vector3::from_fn(|_, _| random.random_range(-2.0..2.0));
                let (mut u, mut w) = (vector(), vector());
                if motions == Motions::InPlane {
                    (u.x, w.y, w.z) = (0.0, 0.0, 0.0);
                }
                let motion = Motion::new(motions, &u, &w);
                let [a, b] = velocities(motions, &motion.coordinates);
                let back = motion.turn * motion.parity;
                assert!((a.component_mul(&motion.turn) - u).norm() < 1e-12);
                assert!(
                    (b.component_mul(&back) - w).norm() < 1e-12,
                    "{motions:?} {w} {b}"
                );
            }
        }
    }

    /// A polar and an axial law with all six components, learned in every symmetry; and its continuation beyond
    /// the speeds: as V² above, as V below.
    #[test]
    fn a_law_is_learned_and_continued() {
        // Anisotropic drag, Magnus lift, and a torque of both kinds of symmetry.
        let model = |u: &Vector3<f64>, w: &Vector3<f64>, p: &[f64]| {
            let drag = Vector3::new(0.2, 0.3, 1.0).component_mul(u) * -u.norm();
            let munk = Vector3::new(u.y * u.z, -u.x * u.z, 0.1 * u.x * u.y);
            [drag * p[0] + w.cross(u) * 0.4, munk - w * w.norm()]
        };
        let parameter = vec![Axis::spectral(0.5, 1.5, 2).unwrap()];
        let params = CrossParams {
            tolerance: 1e-3,
            rank_growth: 4,
            ..CrossParams::default()
        };
        let axes = Motions::Mirrored.axes(0.5, 2.0).unwrap();
        let baked = SeparatedForces::bake(Motions::Mirrored, axes, parameter, &params, model);
        let (forces, _) = baked.unwrap();
        let [rms, worst] = forces.error(500, 8, model);
        println!("{rms:.1e}, {worst:.1e}, ranks {:?}", forces.train().ranks());
        assert!(rms < 5e-3, "{rms:e}");
        let (u, w) = (Vector3::new(-0.3, 0.5, -0.2), Vector3::new(0.4, -0.1, 0.3));
        let at = |scale: f64| forces.evaluate(&(u * scale), &(w * scale), &[1.0]);
        let (fast, faster) = (at(10.0), at(20.0));
        let (slow, slower) = (at(0.1), at(0.01));
        for k in 0..2 {
            assert!((faster[k] - fast[k] * 4.0).norm() < 1e-9 * faster[k].norm());
            assert!((slow[k] - slower[k] * 10.0).norm() < 1e-9 * slow[k].norm());
        }
        assert_eq!(
            forces.evaluate(&Vector3::zeros(), &Vector3::zeros(), &[1.0]),
            [Vector3::zeros(); 2]
        );
    }

    /// What cannot be is named.
    #[test]
    fn bad_forces_are_errors() {
        let axes = || Motions::Mirrored.axes(0.5, 2.0).unwrap();
        let bake = |motions, axes, model: fn(&Vector3<f64>, &Vector3<f64>) -> [Vector3<f64>; 2]| {
            SeparatedForces::bake(
                motions,
                axes,
                Vec::new(),
                &CrossParams::default(),
                |u, w, _| model(u, w),
            )
            .unwrap_err()
            .to_string()
        };
        let drag = |u: &Vector3<f64>, _: &Vector3<f64>| [-u, Vector3::zeros()];
        // A force along a pseudovector tells left from right.
        let handed = |u: &Vector3<f64>, w: &Vector3<f64>| [w * u.norm(), Vector3::zeros()];
        assert!(bake(Motions::Mirrored, axes(), handed).contains("asymmetry"));
        assert!(bake(Motions::Mirrored, axes()[..5].to_vec(), drag).contains("axes of a motion"));
        let short = vec![Axis::spectral(0.0, 1.0, 3).unwrap(); 6];
        assert!(bake(Motions::Mirrored, short, drag).contains("axis of directions"));
        let nothing = |_: &Vector3<f64>, _: &Vector3<f64>| [Vector3::repeat(f64::NAN); 2];
        assert!(!bake(Motions::Mirrored, axes(), nothing).is_empty());
        assert!(Motions::InPlane.axes(1.0, 1.0).is_err());
        assert!(Motions::InPlane.axes(0.0, 1.0).is_err());
    }
}
