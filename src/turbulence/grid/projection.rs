//! The pressure that removes divergence.

use super::boundary::Sides;
use super::separable::Separable;

/// The pressure solver: direct in an empty box; around an obstacle, conjugate gradients that are
/// preconditioned by the empty box's direct solver.
pub(super) struct Projection {
    cells: [usize; 3],
    h: f64,
    box_solver: Separable,
    obstacle: Option<Obstacle>,
    grounded: bool,
}

/// The Laplacian of the fluid cells: for each, its fluid neighbors and its diagonal, times h².
struct Obstacle {
    neighbors: Vec<[Option<u32>; 6]>,
    diagonal: Vec<f64>,
}

/// Largest residual divergence relative to the initial one; and when to give up.
const TOLERANCE: f64 = 1.0e-8;
const MAX_ITERATIONS: usize = 300;

impl Projection {
    pub fn new(cells: [usize; 3], h: f64, sides: &Sides) -> Self {
        let ends = core::array::from_fn(|axis| sides.pressure_ends(axis));
        let open = |axis: usize| sides.is_open(axis, 0) || sides.is_open(axis, 1);
        Self {
            cells,
            h,
            box_solver: Separable::new(cells, h, ends),
            obstacle: None,
            grounded: (0..3).any(open),
        }
    }

    pub fn set_obstacle(&mut self, solid: &[bool], sides: &Sides) {
        if !solid.contains(&true) {
            self.obstacle = None;
            return;
        }
        let [nx, ny, _] = self.cells;
        let strides = [1, nx, nx * ny];
        let mut neighbors = vec![[None; 6]; solid.len()];
        let mut diagonal = vec![0.0; solid.len()];
        for cell in (0..solid.len()).filter(|cell| !solid[*cell]) {
            for axis in (0..3).filter(|axis| self.cells[*axis] > 1) {
                let (n, stride) = (self.cells[axis], strides[axis]);
                let i = cell / stride % n;
                for upper in 0..2 {
                    let edge = i == if upper == 1 { n - 1 } else { 0 };
                    let neighbor = match (edge, upper == 1) {
                        (false, true) => Some(cell + stride),
                        (false, false) => Some(cell - stride),
                        (true, true) if sides.is_periodic(axis) => Some(cell - (n - 1) * stride),
                        (true, false) if sides.is_periodic(axis) => Some(cell + (n - 1) * stride),
                        _ => None,
                    };
                    match neighbor {
                        Some(neighbor) if !solid[neighbor] => {
                            neighbors[cell][2 * axis + upper] = Some(neighbor as u32);
                            diagonal[cell] += 1.0;
                        }
                        // The pressure is zero half a cell outside.
                        None if sides.is_open(axis, upper) => diagonal[cell] += 2.0,
                        _ => {}
                    }
                }
            }
        }
        self.obstacle = Some(Obstacle {
            neighbors,
            diagonal,
        });
    }

    /// Turns the divergence into the pressure whose Laplacian it is (times −1). Returns the number
    /// of iterations and whether they sufficed.
    pub fn solve(&self, divergence: &mut Vec<f64>, solid: &[bool]) -> (usize, bool) {
        if !self.grounded {
            // Fluid cannot leave the box, so that only the part without mean can be removed. That is all of
            // it unless the prescribed inflow does not balance.
            let fluid = solid.iter().filter(|solid| !**solid).count() as f64;
            let mean = divergence.iter().sum::<f64>() / fluid;
            for (d, solid) in divergence.iter_mut().zip(solid) {
                if !*solid {
                    *d -= mean;
                }
            }
        }
        for d in divergence.iter_mut() {
            *d = -*d;
        }
        match &self.obstacle {
            None => {
                self.box_solver.solve(0.0, 1.0, divergence);
                (0, true)
            }
            Some(obstacle) => self.conjugate_gradients(obstacle, divergence, solid),
        }
    }

    fn conjugate_gradients(
        &self,
        obstacle: &Obstacle,
        f: &mut Vec<f64>,
        solid: &[bool],
    ) -> (usize, bool) {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let largest = |a: &[f64]| a.iter().fold(0.0f64, |max, x| max.max(x.abs()));
        let goal = TOLERANCE * largest(f);
        let mut x = vec![0.0; f.len()];
        let mut residual = core::mem::take(f);
        let mut direction = vec![0.0; x.len()];
        let mut image = vec![0.0; x.len()];
        let (mut rho, mut iterations) = (0.0, 0);
        while largest(&residual) > goal && iterations < MAX_ITERATIONS {
            let mut z = residual.clone();
            self.box_solver.solve(0.0, 1.0, &mut z);
            for (z, solid) in z.iter_mut().zip(solid) {
                if *solid {
                    *z = 0.0;
                }
            }
            let next = dot(&residual, &z);
            let beta = if iterations == 0 { 0.0 } else { next / rho };
            rho = next;
            for (d, z) in direction.iter_mut().zip(&z) {
                *d = z + beta * *d;
            }
            obstacle.apply(&direction, &mut image, self.h);
            let curvature = dot(&direction, &image);
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let alpha = rho / curvature;
            for i in 0..x.len() {
                x[i] += alpha * direction[i];
                residual[i] -= alpha * image[i];
            }
            iterations += 1;
        }
        *f = x;
        (iterations, largest(&residual) <= goal)
    }
}

impl Obstacle {
    fn apply(&self, x: &[f64], image: &mut [f64], h: f64) {
        let scale = 1.0 / (h * h);
        for (cell, image) in image.iter_mut().enumerate() {
            let sum: f64 = self.neighbors[cell]
                .iter()
                .flatten()
                .map(|neighbor| x[*neighbor as usize])
                .sum();
            *image = (self.diagonal[cell] * x[cell] - sum) * scale;
        }
    }
}
