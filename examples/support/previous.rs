//! The method that the thesis compares with (its § 5.3.1): constant panels, the boundary integral
//! equation (5.6) with its sign corrected, and every integral by the value at the panel's centroid.

use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{DMatrix, Matrix6, Vector3};
use std::f64::consts::PI;

/// The 6×6 added mass about the origin; `None` if the equations are singular.
pub fn added_mass(surface: &Surface) -> Option<Matrix6<f64>> {
    let panels: Vec<_> = surface
        .corners()
        .map(|[a, b, c]| {
            let cross = (b - a).cross(&(c - a));
            ((a + b + c) / 3.0, cross.normalize(), cross.norm() / 2.0)
        })
        .collect();
    let n = panels.len();
    let normal_velocity = |i: usize, j: usize| {
        let (x, normal, _): (Vector3<f64>, Vector3<f64>, f64) = panels[i];
        if j < 3 {
            normal[j]
        } else {
            x.cross(&normal)[j - 3]
        }
    };
    let kernel = |i: usize, j: usize| {
        let (d, r) = (
            panels[i].0 - panels[j].0,
            (panels[i].0 - panels[j].0).norm(),
        );
        panels[j].2 * d.dot(&panels[j].1) / (4.0 * PI * r.powi(3))
    };
    let matrix = DMatrix::from_fn(n, n, |i, j| if i == j { 0.5 } else { -kernel(i, j) });
    let right = DMatrix::from_fn(n, 6, |i, k| {
        (0..n)
            .map(|j| {
                let potential = if i == j {
                    // A disc of the same area, at its center.
                    (panels[j].2 / PI).sqrt() / 2.0
                } else {
                    panels[j].2 / (4.0 * PI * (panels[i].0 - panels[j].0).norm())
                };
                -potential * normal_velocity(j, k)
            })
            .sum()
    });
    let potential = matrix.lu().solve(&right)?;
    let m = Matrix6::from_fn(|j, k| {
        -(0..n)
            .map(|i| potential[(i, j)] * normal_velocity(i, k) * panels[i].2)
            .sum::<f64>()
    });
    Some((m + m.transpose()) / 2.0)
}
