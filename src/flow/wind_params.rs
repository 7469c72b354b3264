//! The parameters of a gust field: its spectrum, its box, the wind that carries it.

use super::{HeightLaw, lattice::Lattice, log_law::VON_KARMAN};
use crate::error::Error;
use crate::math;
use rapier3d::math::{Real, Vector};

/// How strong the gusts are at each wavelength: the one-dimensional power spectrum along the wind,
/// S_i(n) ∝ (n_c² + n²)^(−5/6), is −5/3 above the corner frequency n_c and flat below it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spectrum {
    /// Inertial range and variances of Kaimal et al. (1972): n S_i/u*² = (.309, .399, .377) f^(−2/3)
    /// for f = nz/U ≫ f_c, and σ_i/u* = (2.185, 1.638, 1.207) if the box resolved every wavelength,
    /// which puts the corner at f_c = (.0502, .175, .402). Against Kaimal's own curve it is 25 % stronger at
    /// the peak and 2.3 times weaker far below the corner. This is the default.
    #[default]
    Kaimal,
    /// Thesis (3.15)–(3.17): S_u = A_u n^(−5/3) without corner, A_u = u*(U/h)^(2/3), A_v = .88 A_u,
    /// A_w = .55 A_u. As an amplitude of a spectrum A_u should have u*² and C = .3; the numbers are
    /// taken as printed, in SI units.
    Thesis,
    /// Standard deviations as asked, exactly, over the modes that the box resolves.
    Given {
        /// Standard deviation along the wind, across it and up, m/s.
        deviation: [f64; 3],
        /// Wavelength of the corner, m; infinite for a pure power law.
        length_scale: f64,
    },
}

/// The parameters of [`SpectralWind::bake`](crate::flow::SpectralWind::bake).
///
/// ```
/// use rapier3d_immersed::flow::{SpectralWind, WindParams};
///
/// // A breeze over a meadow, as a horizontal slice of gusts that repeats after 50 m.
/// let params = WindParams {
///     mean_speed: 2.0,
///     roughness: 0.03,
///     nodes: [64, 64, 1],
///     size: [50.0; 3],
///     ..WindParams::default()
/// };
/// let wind = SpectralWind::bake(&params)?;
/// assert_eq!(wind.period(), [50.0; 3]);
/// assert!((wind.mean().speed(10.0) - 2.0).abs() < 1e-5);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct WindParams {
    /// Direction in which the mean wind blows, horizontal. Default +X.
    pub direction: Vector,
    /// Direction opposite to gravity. Default +Y.
    pub up: Vector,
    /// Mean wind at the reference height, m/s. Default 4 (thesis Fig. 3.12).
    pub mean_speed: f64,
    /// Height above ground of `mean_speed` and of the spectrum, m: the thesis's release height h₀. The
    /// default is 10.
    pub reference_height: f64,
    /// Roughness length z₀ of the ground, m. Default 0.3 (thesis).
    pub roughness: f64,
    /// Height of the ground along `up`, m. Default 0.
    pub ground: f64,
    /// Nodes along the wind, across it and up. One node up makes a horizontal slice that is used at
    /// every height. Default 100 × 100 × 1 (thesis).
    pub nodes: [usize; 3],
    /// Lengths after which the gusts repeat along the wind, across it and up, m. Default 100 each.
    pub size: [f64; 3],
    /// Strength of the gusts. Default [`Spectrum::Kaimal`].
    pub spectrum: Spectrum,
    /// Whether the gusts are made free of divergence: mass-conserving, with the transverse spectra
    /// 4/3 of the longitudinal one. A slice is free of divergence in its plane. All components then
    /// share the corner of the first, and the three standard deviations hold only in the mean over
    /// seeds; of those asked for by [`Spectrum::Given`] the sum of squares holds exactly. Default true.
    pub divergence_free: bool,
    /// Time after which the evolving field is what it was, s; `None` for a frozen one. Default 60.
    pub evolution_time: Option<f64>,
    /// How the gusts change with height. Default [`HeightLaw::SurfaceLayer`].
    pub height_law: HeightLaw,
    /// Seed of the random modes. Default 0.
    pub seed: u64,
}

impl Default for WindParams {
    fn default() -> Self {
        Self {
            direction: Vector::X,
            up: Vector::Y,
            mean_speed: 4.0,
            reference_height: 10.0,
            roughness: 0.3,
            ground: 0.0,
            nodes: [100, 100, 1],
            size: [100.0; 3],
            spectrum: Spectrum::default(),
            divergence_free: true,
            evolution_time: Some(60.0),
            height_law: HeightLaw::default(),
            seed: 0,
        }
    }
}

impl WindParams {
    /// The wind of the thesis (§3.5, Fig. 3.12): its amplitudes, independent components, its height law.
    pub fn thesis() -> Self {
        Self {
            spectrum: Spectrum::Thesis,
            divergence_free: false,
            height_law: HeightLaw::Proportional,
            ..Self::default()
        }
    }
}

/// Spectrum of one component per wavenumber κ (cycles per meter): two-sided density along one line
/// ½ level (corner² + κ²)^(−5/6), m³/s².
#[derive(Clone, Copy)]
pub(super) struct Component {
    pub level: f64,
    pub corner: f64,
}

/// Kaimal's inertial-range constants, standard deviations over u*, and the corner that reconciles
/// the two: ∫₀^∞ (f_c² + f²)^(−5/6) df = 2.1033 f_c^(−2/3).
const KAIMAL_LEVEL: [f64; 3] = [0.309, 0.399, 0.377];
const KAIMAL_DEVIATION: [f64; 3] = [2.185, 1.638, 1.207];
const CORNER_INTEGRAL: f64 = 2.103_27;

/// Checks the parameters and returns the lattice of the nodes.
pub(super) fn check(params: &WindParams) -> Result<Lattice, Error> {
    Error::check_finite("mean_speed", params.mean_speed)?;
    Error::check_positive("reference_height", params.reference_height)?;
    Error::check_positive("roughness", params.roughness)?;
    Error::check_finite("ground", params.ground)?;
    if let Some(time) = params.evolution_time {
        Error::check_positive("evolution_time", time)?;
    }
    Error::check(
        "reference_height",
        params.reference_height,
        params.reference_height > params.roughness,
        "above the roughness length",
    )?;
    for (n, size) in params.nodes.into_iter().zip(params.size) {
        Error::check(
            "nodes",
            n as f64,
            n == 1 || (4..=1024).contains(&n),
            "1 or from 4 to 1024 along each axis",
        )?;
        Error::check_positive("size", size)?;
    }
    if let Spectrum::Given {
        deviation,
        length_scale,
    } = params.spectrum
    {
        for value in deviation {
            Error::check_not_negative("deviation", value)?;
        }
        Error::check(
            "length_scale",
            length_scale,
            length_scale > 0.0,
            "positive (infinite for a pure power law)",
        )?;
    }
    let spacing = core::array::from_fn(|i| (params.size[i] / params.nodes[i] as f64) as Real);
    Lattice::new(
        params.nodes,
        [true; 3],
        Vector::ZERO,
        Vector::from_array(spacing),
    )
}

/// The spectra of the three components.
pub(super) fn components(params: &WindParams) -> [Component; 3] {
    let height = params.reference_height;
    let friction =
        params.mean_speed.abs() * f64::from(VON_KARMAN) / math::ln(height / params.roughness);
    core::array::from_fn(|i| match params.spectrum {
        Spectrum::Kaimal => Component {
            level: KAIMAL_LEVEL[i] * friction.powi(2) * math::powf(height, -2.0 / 3.0),
            corner: math::powf(
                KAIMAL_LEVEL[i] * CORNER_INTEGRAL / KAIMAL_DEVIATION[i].powi(2),
                1.5,
            ) / height,
        },
        // In S_u = A_u n^(−5/3) with n = Uκ the powers of U cancel.
        Spectrum::Thesis => Component {
            level: friction * math::powf(height, -2.0 / 3.0) * [1.0, 0.88, 0.55][i],
            corner: 0.0,
        },
        Spectrum::Given { length_scale, .. } => Component {
            level: 1.0,
            corner: length_scale.recip(),
        },
    })
}
