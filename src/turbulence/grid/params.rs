//! What a grid is made with, and what its steps report.

use super::boundary::Boundary;

/// The parameters of [`MacGrid::new`](super::MacGrid::new).
#[derive(Clone)]
pub struct MacGridParams {
    /// Cells along x, y and z. One cell makes the flow uniform along that axis: 64 × 64 × 1 is a
    /// two-dimensional grid. Default 32 × 32 × 16 (thesis).
    pub cells: [usize; 3],
    /// Edge of a cell, m. Default 1/32.
    pub cell_size: f64,
    /// Kinematic viscosity ν, m²/s. Default 0.
    pub viscosity: f64,
    /// What is at the lower and upper end of each axis. Default periodic.
    pub boundaries: [[Boundary; 2]; 3],
    /// How velocity is advected. Default MacCormack.
    pub advection: Advection,
    /// How velocity diffuses. Default implicit.
    pub viscous_step: Viscosity,
}

impl Default for MacGridParams {
    fn default() -> Self {
        Self {
            cells: [32, 32, 16],
            cell_size: 1.0 / 32.0,
            viscosity: 0.0,
            boundaries: Default::default(),
            advection: Advection::default(),
            viscous_step: Viscosity::default(),
        }
    }
}

/// What one step achieved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Largest divergence left in a fluid cell, in units of the largest speed over the cell size.
    pub divergence: f64,
    /// Iterations of the pressure solver: 0 without an obstacle, when it is direct.
    pub iterations: usize,
    /// Whether the pressure solver reached its tolerance.
    pub converged: bool,
    /// Largest number of cells that the fluid crossed along an axis in this step.
    pub courant: f64,
}

/// How a quantity is carried along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Advection {
    /// Looks up where the fluid came from (Stam 1999; thesis). It is stable for any step, of first order, and
    /// as dissipative as a viscosity of about h²/(8 dt).
    SemiLagrangian,
    /// Goes there and back by the semi-Lagrangian way and subtracts half of the error (Selle et al. 2008),
    /// limited to the values it came from. It is of second order, and the default.
    #[default]
    MacCormack,
    /// Compensates the error of going back and forth (Dupont & Liu 2003; Kim et al. 2005), limited likewise.
    Bfecc,
}

/// How velocity diffuses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Viscosity {
    /// Forward Euler, which is cheap, but stable only for ν dt Σ 1/h² ≤ ½.
    Explicit,
    /// Backward Euler, which is stable for any step and of first order in time. This is the default.
    #[default]
    Implicit,
    /// The trapezoidal rule, which is stable and of second order in time.
    CrankNicolson,
}
