//! Baking: a stream past a body, its turbulence, and the particle that feels it (thesis Algorithm 1).
//!
//! Everything here is in units of the body's length L and falling speed U₀, so that the Reynolds number is
//! the only property of the fluid.

use super::grid::{Advection, Boundary, MacGrid, MacGridParams, Viscosity};
use super::{KEpsilon, KEpsilonGrid, TurbulenceField, TurbulenceState, TurbulenceTable};
use crate::error::Error;
use crate::flow::{Flow, Uniform};
use crate::math;
use rapier3d::math::Real;
use std::sync::Arc;

/// What shears the mean flow. The thesis does not say what did in its runs; a uniform stream in an empty
/// box has no shear, so that its turbulence only decays.
#[derive(Clone, Default)]
pub enum ShearSource {
    /// A round plate across the stream, L in diameter and one cell thick: a body falling broadside. This
    /// is the default.
    #[default]
    Plate,
    /// An ellipsoid with these semi-axes, in L, the first along the stream.
    Ellipsoid([f64; 3]),
    /// A gusty or sheared flow that enters (speeds in U₀, lengths in L); the box stays empty.
    Inflow(Arc<dyn Flow>),
    /// Nothing does: the turbulence decays homogeneously.
    Nothing,
}

/// The parameters of [`TurbulenceTable::bake`].
///
/// ```
/// use rapier3d_immersed::turbulence::{ShearSource, TurbulenceParams, TurbulenceTable};
///
/// // Nothing shears the stream: the turbulence that the particle feels decays as the k–ε model says.
/// let params = TurbulenceParams {
///     cells: [24, 8, 4],
///     shear: ShearSource::Nothing,
///     diffusion: false,
///     release: [0.0; 3],
///     spin_up: 0.0,
///     duration: 1.0,
///     ..TurbulenceParams::default()
/// };
/// let (table, report) = TurbulenceTable::bake(&params)?;
/// assert_eq!(report.unconverged_steps, 0);
/// let [first, last] = [0.0, 1.0].map(|time| table.history_at(time));
/// let (k, _) = params.model.advance(1.5, first.dissipation.into(), 0.0, 1.0);
/// assert!((f64::from(last.kinetic_energy) / k - 1.0).abs() < 0.01);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
pub struct TurbulenceParams {
    /// Re = U₀L/ν. Default 3.8e3 (thesis Fig. 4.2).
    pub reynolds: f64,
    /// Cells along the stream and across it. Default 32 × 32 × 16 (thesis Fig. 4.2; its timings are of
    /// 32 × 32 × 8).
    pub cells: [usize; 3],
    /// Edge of a cell in L. Default 1/8.
    pub cell_size: f64,
    /// Turbulence intensity I of k₀ = 3/2 (I U₀)². Default 1 (thesis (4.20)).
    pub intensity: f64,
    /// Eddy size l of ε₀ = C_μ^¾ k₀^(3/2)/l, in cells. Default 1 (thesis (4.20)).
    pub eddy_cells: f64,
    /// The model's constants.
    pub model: KEpsilon,
    /// Whether k and ε diffuse, thesis (4.15). Default true.
    pub diffusion: bool,
    /// Whether the mean flow is mixed by ν_T. Default true. Without it nothing ends the growth of k in fluid
    /// that is trapped in the wake: its shear feeds turbulence, but the turbulence does not smooth the shear.
    pub feedback: bool,
    /// How the mean flow is advected. Default MacCormack.
    pub advection: Advection,
    /// What shears the mean flow.
    pub shear: ShearSource,
    /// Time step, in L/U₀. Default 0.05.
    pub time_step: f64,
    /// How long the mean flow develops before the turbulence is set to (k₀, ε₀) and the particle
    /// is released, in L/U₀. Default 4.
    pub spin_up: f64,
    /// Length of the history, in L/U₀. Default 12.
    pub duration: f64,
    /// Where the particle is released, in L from the body (or the box's center without a body),
    /// along the stream first. Default (−0.9, 0.4, 0): it passes through the shear layer.
    pub release: [f64; 3],
    /// Number of instants of the space-time field, spread evenly over `duration`; 0 for none. Default 0.
    pub field_frames: usize,
}

impl Default for TurbulenceParams {
    fn default() -> Self {
        Self {
            reynolds: 3.8e3,
            cells: [32, 32, 16],
            cell_size: 0.125,
            intensity: 1.0,
            eddy_cells: 1.0,
            model: KEpsilon::default(),
            diffusion: true,
            feedback: true,
            advection: Advection::MacCormack,
            shear: ShearSource::default(),
            time_step: 0.05,
            spin_up: 4.0,
            duration: 12.0,
            release: [-0.9, 0.4, 0.0],
            field_frames: 0,
        }
    }
}

/// One entry of the followed particle's history, in units of L and U₀.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BakeSample {
    /// Time since the release.
    pub time: f64,
    /// Position in the box.
    pub position: [f64; 3],
    /// Turbulent kinetic energy k.
    pub kinetic_energy: f64,
    /// Dissipation rate ε.
    pub dissipation: f64,
    /// Rate of strain √(2 S:S) of the mean flow.
    pub strain: f64,
}

/// How a bake went.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeReport {
    /// The particle's history, as in the table.
    pub samples: Vec<BakeSample>,
    /// When the particle left the box, if it did: from then on its turbulence decays without shear.
    pub left_box_at: Option<f64>,
    /// Largest divergence that any step left, in units of the largest speed over the cell size.
    pub worst_divergence: f64,
    /// Steps whose pressure solver gave up before its tolerance.
    pub unconverged_steps: usize,
    /// Largest Courant number of a step.
    pub largest_courant: f64,
}

impl TurbulenceParams {
    /// What the thesis describes: semi-Lagrangian mean flow, k and ε reduced to (4.18)–(4.19) without
    /// diffusion, no effect of the turbulence on the mean flow. In the recirculation behind the body k then
    /// grows without bound; the followed particle passes outside of it.
    pub fn thesis() -> Self {
        Self {
            diffusion: false,
            feedback: false,
            advection: Advection::SemiLagrangian,
            ..Self::default()
        }
    }

    fn validate(&self) -> Result<(), Error> {
        Error::check_positive("reynolds", self.reynolds)?;
        Error::check_positive("cell_size", self.cell_size)?;
        Error::check_not_negative("intensity", self.intensity)?;
        Error::check_positive("eddy_cells", self.eddy_cells)?;
        Error::check_positive("time_step", self.time_step)?;
        Error::check_not_negative("spin_up", self.spin_up)?;
        Error::check_positive("duration", self.duration)?;
        let steps = (self.duration + self.spin_up) / self.time_step;
        Error::check(
            "(spin_up + duration)/time_step",
            steps,
            steps <= 1.0e6,
            "at most 1e6",
        )?;
        Error::check(
            "duration",
            self.duration,
            self.duration >= self.time_step,
            "at least one time step",
        )?;
        for x in self.release {
            Error::check_finite("release", x)?;
        }
        for n in self.cells {
            Error::check("cells", n as f64, n >= 4, "at least 4 along each axis")?;
        }
        Error::check(
            "field_frames",
            self.field_frames as f64,
            self.field_frames != 1 && self.field_frames <= 1 << 16,
            "0 or from 2 to 65536",
        )?;
        if let ShearSource::Ellipsoid(semi_axes) = self.shear {
            for x in semi_axes {
                Error::check_positive("semi_axes", x)?;
            }
        }
        Ok(())
    }

    /// Middle of the body: a third of the box from the inflow.
    fn body(&self) -> [f64; 3] {
        let size = self.cells.map(|n| n as f64 * self.cell_size);
        [size[0] / 3.0, size[1] / 2.0, size[2] / 2.0]
    }

    fn grid(&self) -> Result<MacGrid, Error> {
        let inflow: Arc<dyn Flow> = match &self.shear {
            ShearSource::Inflow(flow) => flow.clone(),
            _ => Arc::new(Uniform::new(1.0, 0.0, 0.0)),
        };
        let slip = || [Boundary::FreeSlip, Boundary::FreeSlip];
        let mut grid = MacGrid::new(&MacGridParams {
            cells: self.cells,
            cell_size: self.cell_size,
            viscosity: self.reynolds.recip(),
            boundaries: [
                [Boundary::Inflow(inflow), Boundary::Outflow],
                slip(),
                slip(),
            ],
            advection: self.advection,
            viscous_step: Viscosity::Implicit,
        })?;
        grid.set_velocity(|_| [1.0, 0.0, 0.0])?;
        let h = self.cell_size;
        let axes = match self.shear {
            // A little more than half a cell takes one layer of cells, wherever their centers are.
            ShearSource::Plate => Some([0.501 * h, 0.5, 0.5]),
            ShearSource::Ellipsoid(axes) => Some(axes),
            _ => None,
        };
        if let Some(axes) = axes {
            let body = self.body();
            let plate = matches!(self.shear, ShearSource::Plate);
            grid.set_obstacle(|x| {
                let d: [f64; 3] = core::array::from_fn(|i| (x[i] - body[i]) / axes[i]);
                if plate {
                    d[0].abs() <= 1.0 && d[1] * d[1] + d[2] * d[2] <= 1.0
                } else {
                    d.iter().map(|d| d * d).sum::<f64>() <= 1.0
                }
            })?;
        }
        Ok(grid)
    }
}

impl TurbulenceTable {
    /// Bakes the turbulence of a body that moves at U₀ (thesis Algorithm 1), on all cores.
    ///
    /// # Errors
    /// If a parameter is out of range, naming it.
    pub fn bake(params: &TurbulenceParams) -> Result<(Self, BakeReport), Error> {
        Self::bake_with_progress(params, &mut |_| {})
    }

    /// As [`TurbulenceTable::bake`]; `progress` is called with the share done, from 0 to 1, after every step.
    ///
    /// # Errors
    /// If a parameter is out of range, naming it.
    pub fn bake_with_progress(
        params: &TurbulenceParams,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(Self, BakeReport), Error> {
        params.validate()?;
        let dt = params.time_step;
        let mut grid = params.grid()?;
        let spin_up = (params.spin_up / dt).ceil() as usize;
        let steps = (params.duration / dt).ceil() as usize;
        let mut report = BakeReport {
            samples: Vec::with_capacity(steps + 1),
            left_box_at: None,
            worst_divergence: 0.0,
            unconverged_steps: 0,
            largest_courant: 0.0,
        };
        let mut flow_step = |grid: &mut MacGrid, report: &mut BakeReport, done: usize| {
            let step = grid.step(dt)?;
            report.worst_divergence = report.worst_divergence.max(step.divergence);
            report.largest_courant = report.largest_courant.max(step.courant);
            report.unconverged_steps += usize::from(!step.converged);
            progress(done as f64 / (spin_up + steps) as f64);
            Ok::<(), Error>(())
        };
        for step in 0..spin_up {
            flow_step(&mut grid, &mut report, step + 1)?;
        }
        let k0 = 1.5 * params.intensity.powi(2);
        let length = params.eddy_cells * params.cell_size;
        let epsilon0 = math::powf(params.model.c_mu, 0.75) * math::powf(k0, 1.5) / length;
        let viscosity = params.diffusion.then(|| params.reynolds.recip());
        let mut field = KEpsilonGrid::new(&grid, params.model, k0, epsilon0, viscosity)?;
        let mut particle = Particle::release(params, &grid, &field);
        let every = steps.div_ceil(params.field_frames.max(2) - 1);
        let mut frames = Vec::new();
        report.samples.push(particle.sample(&grid, 0.0));
        for step in 0..=steps {
            if params.field_frames > 0 && step % every == 0 {
                frames.extend(states(&grid, &field));
            }
            if step == steps {
                break;
            }
            let before = particle.position;
            flow_step(&mut grid, &mut report, spin_up + step + 1)?;
            field.step(&grid, dt)?;
            if params.feedback {
                grid.set_eddy_viscosity(field.eddy_viscosity())?;
            }
            let time = (step + 1) as f64 * dt;
            particle.advance(params, &grid, &field, before, dt);
            if particle.outside && report.left_box_at.is_none() {
                report.left_box_at = Some(time);
            }
            report.samples.push(particle.sample(&grid, time));
        }
        let history = report
            .samples
            .iter()
            .map(|sample| state(sample.kinetic_energy, sample.dissipation))
            .collect();
        let baked_field = if frames.is_empty() {
            None
        } else {
            let body = params.body();
            let h = params.cell_size;
            // The field's origin is the body.
            let origin = core::array::from_fn(|i| 0.5 * h - body[i]);
            Some(TurbulenceField::new(
                params.cells,
                origin,
                [h; 3],
                every as f64 * dt,
                frames,
            )?)
        };
        let table = Self::new(params.reynolds, dt, history, baked_field)?;
        Ok((table, report))
    }
}

fn state(k: f64, epsilon: f64) -> TurbulenceState {
    TurbulenceState {
        kinetic_energy: k as Real,
        dissipation: epsilon as Real,
    }
}

fn states(grid: &MacGrid, field: &KEpsilonGrid) -> Vec<TurbulenceState> {
    let [nx, ny, nz] = grid.cells();
    let mut states = Vec::with_capacity(nx * ny * nz);
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let (k, epsilon) = field.cell([i, j, k]);
                states.push(state(k, epsilon));
            }
        }
    }
    states
}

/// The passive particle that stands for the body (thesis §4.5).
struct Particle {
    position: [f64; 3],
    outside: bool,
    k: f64,
    epsilon: f64,
}

impl Particle {
    fn release(params: &TurbulenceParams, grid: &MacGrid, field: &KEpsilonGrid) -> Self {
        let body = params.body();
        let h = params.cell_size;
        let position = core::array::from_fn(|i| {
            let size = params.cells[i] as f64 * h;
            (body[i] + params.release[i]).clamp(0.5 * h, size - 0.5 * h)
        });
        let (k, epsilon) = field.at(grid, position);
        Self {
            position,
            outside: false,
            k,
            epsilon,
        }
    }

    fn advance(
        &mut self,
        params: &TurbulenceParams,
        grid: &MacGrid,
        field: &KEpsilonGrid,
        from: [f64; 3],
        dt: f64,
    ) {
        if !self.outside {
            let along = |x: [f64; 3], v: [f64; 3], dt: f64| -> [f64; 3] {
                core::array::from_fn(|i| x[i] + dt * v[i])
            };
            let middle = along(from, grid.velocity(from), 0.5 * dt);
            self.position = along(from, grid.velocity(middle), dt);
            let size = params.cells[0] as f64 * params.cell_size;
            self.outside = !(0.0..=size).contains(&self.position[0]);
        }
        (self.k, self.epsilon) = if self.outside {
            params.model.advance(self.k, self.epsilon, 0.0, dt)
        } else {
            field.at(grid, self.position)
        };
    }

    fn sample(&self, grid: &MacGrid, time: f64) -> BakeSample {
        let cells = grid.cells();
        let index = core::array::from_fn(|i| {
            ((self.position[i] / grid.cell_size()) as usize).min(cells[i] - 1)
        });
        BakeSample {
            time,
            position: self.position,
            kinetic_energy: self.k,
            dissipation: self.epsilon,
            strain: if self.outside {
                0.0
            } else {
                grid.strain2(index).sqrt()
            },
        }
    }
}
