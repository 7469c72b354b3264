//! From the first frames of a track to the rest of it: the state, and coefficients, that fit them.

use super::measured::{Fall, Paper, STATE, Seen, divergence};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::reduced::{Fit, FitParams, fit};
use rapier3d_immersed::{Error, PhysicalLaw, ThesisLaw, ViscousLaw};

/// Frames from which a state is estimated: 0.2 s, more than a half turn of a small paper that tumbles.
pub const KNOWN: usize = 20;

/// Frames to which coefficients are fitted: 0.41 s.
pub const FITTED: usize = 40;

/// A law with some of its coefficients free.
pub struct Family {
    pub name: &'static str,
    pub coefficients: &'static [&'static str],
    /// Where to look for them.
    pub ranges: &'static [(f64, f64)],
    pub law: fn(&[f64]) -> ViscousLaw,
}

/// The default law as it is.
pub const DEFAULT: Family = Family {
    name: "default",
    coefficients: &[],
    ranges: &[],
    law: |_| ViscousLaw::default(),
};

/// The default law, four of whose coefficients for narrow plates, as discs are, are free.
pub const PHYSICAL: Family = Family {
    name: "four free",
    coefficients: &["C_s", "chi_s", "epsilon", "k_2"],
    ranges: &[(0.3, 2.0), (0.0, 0.15), (0.0, 1.0), (0.0, 1.0)],
    law: |c| {
        ViscousLaw::Physical(PhysicalLaw {
            stalled_lift_narrow: c[0],
            stalled_travel_narrow: c[1],
            rotational_stall_narrow: c[2],
            rotation_damping_narrow: c[3],
            ..PhysicalLaw::default()
        })
    },
};

/// What the default law has for them.
pub fn defaults() -> [f64; 4] {
    let law = PhysicalLaw::default();
    [
        law.stalled_lift_narrow,
        law.stalled_travel_narrow,
        law.rotational_stall_narrow,
        law.rotation_damping_narrow,
    ]
}

/// The thesis's law, whose C̃ (5.15)–(5.17) is free.
pub const THESIS: Family = Family {
    name: "thesis",
    coefficients: &["C_D", "C_L1", "C_L2"],
    ranges: &[(0.1, 4.0), (-4.0, 4.0), (-4.0, 8.0)],
    law: |c| ViscousLaw::Thesis(ThesisLaw::new([c[0], c[1], c[2]])),
};

/// The coefficients of `family` (unless they are `fixed`), then the [`STATE`](super::measured::STATE), then a
/// scale of each camera's areas, that come closest to the first [`KNOWN`] frames, or to [`FITTED`] where
/// coefficients are free. They are looked for everywhere, or near `start`.
///
/// # Errors
/// Those of [`fit`].
pub fn identify(
    paper: &Paper,
    fall: &Fall,
    family: &Family,
    fixed: Option<&[f64]>,
    start: Option<&[f64]>,
) -> Result<Fit, Error> {
    let free = if fixed.is_some() { &[] } else { family.ranges };
    let frames = if free.is_empty() { KNOWN } else { FITTED };
    let count = free.len();
    let scales = count + STATE.len();
    let ranges = [free, &paper.ranges(fall), &[(0.3, 15.0); 2]].concat();
    let model = |p: &[f64], out: &mut [f64]| {
        let law = (family.law)(fixed.unwrap_or(&p[..count]));
        let Ok(seen) = paper.fall(law, &p[count..scales], out.len() / 5) else {
            out.fill(f64::NAN);
            return;
        };
        for (i, out) in out.chunks_exact_mut(5).enumerate() {
            out[..3].copy_from_slice(seen.positions[i].as_slice());
            for k in [0, 1] {
                out[3 + k] = p[scales + k] * seen.views[k][i];
            }
        }
    };
    let (data, deviations) = fall.data(frames);
    // There are several minima, of which the least is wanted.
    let searches = if start.is_some() { 1 } else { 2 };
    let mut least: Option<Fit> = None;
    for seed in 1..=searches {
        let params = FitParams {
            start: start.map(<[f64]>::to_vec),
            // At first what is known, but all at once near a start.
            stages: if start.is_none() && frames > KNOWN {
                vec![KNOWN as f64 / frames as f64, 1.0]
            } else {
                vec![1.0]
            },
            random_starts: 2000,
            descents: 8,
            row: 5,
            max_iterations: 50,
            difference: 1e-4,
            tolerance: 1e-5,
            seed,
        };
        let found = fit(&model, &data, &deviations, &ranges, &params)?;
        if least
            .as_ref()
            .is_none_or(|l| found.reduced_residual < l.reduced_residual)
        {
            least = Some(found);
        }
    }
    Ok(least.expect("at least one search"))
}

/// A fall whose state was estimated from its first [`KNOWN`] frames, and that goes on by itself.
pub struct Forecast {
    pub seen: Seen,
    /// Distance from the track, frame by frame, m.
    pub errors: Vec<f64>,
    /// From the first frame until it is more than a diameter; `None` if it never is.
    pub divergence: Option<f64>,
}

impl Forecast {
    /// From a state that was estimated under `law`.
    ///
    /// # Errors
    /// Those of [`Paper::fall`].
    pub fn new(paper: &Paper, fall: &Fall, law: ViscousLaw, state: &[f64]) -> Result<Self, Error> {
        let seen = paper.fall(law, state, fall.positions.len())?;
        let pairs = seen.positions.iter().zip(&fall.positions);
        Ok(Self {
            errors: pairs.map(|(a, b)| (a - b).norm()).collect(),
            divergence: divergence(&seen.positions, &fall.positions, fall.diameter()),
            seen,
        })
    }

    /// Root of the mean squared distance in the frames that the state was estimated from, m.
    pub fn residual(&self) -> f64 {
        let squares = self.errors[..KNOWN].iter().map(|e| e * e).sum::<f64>();
        (squares / KNOWN as f64).sqrt()
    }

    /// Correlation of what both cameras saw of the paper with what they would have seen of this one, in the
    /// frames from `from` to `to`. (Not more can be said of attitudes: blobs were up to twice as large as
    /// the paper's picture.)
    pub fn view_correlation(&self, fall: &Fall, from: usize, to: usize) -> f64 {
        let both = self.seen.views.iter().zip(&fall.areas);
        let each = both.map(|(ours, theirs)| correlation(&ours[from..to], &theirs[from..to]));
        0.5 * each.sum::<f64>()
    }
}

/// What a paper does that goes on with its mean velocity over the known frames.
pub fn straight_on(fall: &Fall) -> Vec<Vector3<f64>> {
    let last = KNOWN - 1;
    let frame = (fall.positions[last] - fall.positions[0]) / last as f64;
    let known = fall.positions[..KNOWN].iter().copied();
    let count = fall.positions.len() - KNOWN;
    known
        .chain((1..=count).map(|i| fall.positions[last] + frame * i as f64))
        .collect()
}

/// A repeat, moved to the same first position.
pub fn moved(fall: &Fall, repeat: &Fall) -> Vec<Vector3<f64>> {
    let offset = fall.positions[0] - repeat.positions[0];
    repeat.positions.iter().map(|p| p + offset).collect()
}

fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let (ma, mb) = (mean(a), mean(b));
    let moment = |x: &[f64], y: &[f64], mx: f64, my: f64| -> f64 {
        x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum()
    };
    moment(a, b, ma, mb) / (moment(a, a, ma, ma) * moment(b, b, mb, mb)).sqrt()
}
