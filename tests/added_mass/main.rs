//! What the boundary elements must get right: bodies with exact or published added mass.
//!
//! Sizes are chosen so that the whole file stays within a minute in the development profile; the
//! same bodies converge further with more panels.

mod bodies;
mod coupled;
mod sheets;
mod solids;
mod symmetry;

use rapier3d_immersed::AddedMass;
use rapier3d_immersed::boundary_element::BoundaryElementParams;
use rapier3d_immersed::geometry::{Ellipsoid, Surface};
use rapier3d_immersed::rapier3d::na::Vector3;

/// The mesh as it is, without refinement.
pub fn as_is() -> BoundaryElementParams {
    BoundaryElementParams {
        tolerance: f64::INFINITY,
        ..BoundaryElementParams::default()
    }
}

pub fn ellipsoid(a: f64, b: f64, c: f64) -> Ellipsoid {
    Ellipsoid {
        semi_axes: Vector3::new(a, b, c),
    }
}

/// One solve on `20 cells²` panels.
pub fn solve_ellipsoid(body: &Ellipsoid, cells: usize) -> AddedMass {
    let surface = Surface::ellipsoid(body, cells).unwrap();
    AddedMass::solve(&surface, &as_is()).unwrap().0
}

#[track_caller]
pub fn assert_within(found: f64, expected: f64, relative: f64, what: &str) {
    let error = found / expected - 1.0;
    println!("{what}: {found:.5e} for {expected:.5e}, {error:+.2e}");
    assert!(
        error.abs() <= relative,
        "{what}: {found} for {expected}, {error:+.2e}"
    );
}
