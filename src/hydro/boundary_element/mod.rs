//! Added mass of any shape by boundary elements.
//!
//! [`HydroProperties::from_shape_with`](super::HydroProperties::from_shape_with) and
//! [`Accuracy::Mesh`](super::Accuracy) are all that most users need. Below that, [`AddedMass::of_shape`]
//! takes a collider's shape and a tolerance, [`AddedMass::solve`] a closed mesh, [`AddedMass::solve_sheet`]
//! an open one with a thickness; each gives the whole tensor, couplings included. An [`AddedMassCache`]
//! solves equal shapes once, and a [`BoundaryElementSolution`] also holds the potentials on the mesh.
//!
//! ```
//! use rapier3d_immersed::AddedMass;
//! use rapier3d_immersed::rapier3d::prelude::*;
//!
//! let (cube, report) = AddedMass::of_shape(&Cuboid::new(Vector::splat(0.5)), Vector::ZERO, 0.02)?;
//! assert!(report.converged);
//! // 0.639 of the displaced volume.
//! assert!((cube.linear[(0, 0)] - 0.639).abs() < 0.01);
//! # Ok::<(), rapier3d_immersed::Error>(())
//! ```
//!
//! The method is a Galerkin discretisation of the hypersingular operator with continuous, piecewise
//! linear potentials. Its integrals reduce to those of 1/|x − y| over pairs of triangles, done
//! exactly on one and adaptively on the other; the matrix is symmetric and positive, so that the
//! added mass converges from one side with twice the order of the potential; and nothing degenerates
//! when two faces approach: a leaf needs no more panels than a ball.
//!
//! # Thin bodies
//! A closed surface is solved as such however thin it is: an ellipsoid 10⁻⁵ as thick as long, on 1280
//! panels, is right to 0.2 % broadside. There is no thickness at which to switch to another formulation, and
//! none is switched to; [`Sheet`] is for bodies that are given by their mid-surface, whose added
//! mass is that of zero thickness. What thin
//! bodies do lose is the relative accuracy of entries that are tiny beside the others: the added mass
//! of a leaf in its own plane, 10⁻⁴ of the broadside one, is right in its order of magnitude only.
//!
//! # When the proxy ellipsoid will do
//! See the table at [`Accuracy`](super::Accuracy), by which
//! [`HydroProperties::from_shape_with`](super::HydroProperties::from_shape_with) solves.
//!
//! # Cost
//! There are half as many unknowns as panels. Processor time on one core (divide by the cores) for a ball of
//! 320, 1280, 5120 and 9680 panels: 0.010, 0.09, 1.4 and 4.9 s, growing as panels to the power 1.6,
//! 1.9, 2.0; a leaf takes about twice as long. It needs `4 × panels²` bytes, 100 MB for 5000 panels.
//!
//! The solve is direct. Even at 9680 panels the factorisation is an eighth of the work and the rest
//! is integration, so that an iterative solver would gain next to nothing; going further needs a
//! compressed matrix, and by then the error of the added mass is far below that of the shape.
//!
//! [`AddedMass::of_shape`]: super::AddedMass::of_shape
//! [`AddedMass::solve`]: super::AddedMass::solve
//! [`AddedMass::solve_sheet`]: super::AddedMass::solve_sheet
//! [`Sheet`]: crate::geometry::Sheet

mod assemble;
mod cache;
mod entry;
mod pair;
mod panel;
mod params;
mod properties;
mod refine;
mod shape;
mod solve;

pub use cache::{AddedMassCache, SolvedShape};
pub use params::{
    BoundaryElementParams, BoundaryElementProgress, BoundaryElementReport, BoundaryElementSolution,
    ProgressFn,
};
