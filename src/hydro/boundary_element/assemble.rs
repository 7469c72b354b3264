//! The Galerkin matrix of the hypersingular operator, and the vortex potential of the rotations.

use super::pair::{Moments, NearField, THREE_POINTS, TIE};
use super::panel::Panel;
use rapier3d::na::{Matrix3, Vector3};
use rayon::prelude::*;
use std::collections::HashSet;
use std::f64::consts::PI;

/// Rows of panels that one task integrates, and rows that are kept before they are added up. Both
/// are fixed so that the order of every sum, and with it every digit, is independent of the number
/// of threads.
const ROWS_PER_TASK: usize = 8;
const ROWS_PER_BATCH: usize = 128;

/// What assembly needs of a mesh.
pub(super) struct Elements<'a> {
    pub triangles: &'a [[u32; 3]],
    pub panels: &'a [Panel],
    /// The unknown of each vertex; `None` on the free edge of a sheet, where the jump of the potential
    /// vanishes.
    pub unknowns: &'a [Option<u32>],
    pub unknown_count: usize,
}

/// The assembled integrals.
pub(super) struct Assembled {
    /// `∫∫ (n×∇v_i)(x) · (n×∇v_j)(y) / 4π|x−y|`, symmetric, row-major, m.
    pub matrix: Vec<f64>,
    /// Per panel P, the matrix that maps an angular velocity ω to `∫_P B`, with B the vector
    /// potential of [`super::solve`], m⁴.
    pub vector_potential: Vec<Matrix3<f64>>,
}

/// Contributions of one panel's row to vector potentials: `Σ first ⊗ n` and `Σ n · first`.
#[derive(Clone, Copy)]
struct Vortex {
    outer: Matrix3<f64>,
    inner: f64,
}

impl Vortex {
    const ZERO: Self = Self {
        outer: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        inner: 0.0,
    };

    /// Adds what panel Q of normal `n` contributes to panel P.
    fn add(&mut self, n: &Vector3<f64>, first_p: &Vector3<f64>, first_q: &Vector3<f64>) {
        self.outer += first_q * n.transpose();
        self.inner += n.dot(first_p);
    }
}

struct Row {
    /// Per vertex, `Σ_Q J_PQ (n×∇v)_Q` over the later panels Q and half of P itself.
    curls: Vec<Vector3<f64>>,
}

/// Coordinates of the quadrature points of all panels, one array per point and axis.
struct Points {
    at: [[Vec<f64>; 3]; 3],
}

impl Points {
    fn new(panels: &[Panel]) -> Self {
        let at = THREE_POINTS.map(|(l, _)| {
            [0, 1, 2].map(|axis| {
                panels
                    .iter()
                    .map(|p| (0..3).map(|k| l[k] * p.corners[k][axis]).sum())
                    .collect()
            })
        });
        Self { at }
    }

    fn point(&self, k: usize, panel: usize) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.at[k][axis][panel])
    }
}

/// Sums of 1/r between the three points of one panel and those of a run of others.
#[derive(Default)]
struct FarSums {
    /// The sums by points of the one panel.
    rows: [Vec<f64>; 3],
    /// The sums by points of the others.
    columns: [Vec<f64>; 3],
}

impl FarSums {
    fn fill(&mut self, points: &Points, p: usize) {
        let n = points.at[0][0].len() - p;
        for sums in self.rows.iter_mut().chain(&mut self.columns) {
            sums.clear();
            sums.resize(n, 0.0);
        }
        let x = [0, 1, 2].map(|a| points.point(a, p));
        for k in 0..3 {
            let [ys, yt, yu] = [0, 1, 2].map(|axis| &points.at[k][axis][p..]);
            let [r0, r1, r2] = &mut self.rows;
            let (r0, r1, r2) = (&mut r0[..n], &mut r1[..n], &mut r2[..n]);
            let column = &mut self.columns[k][..n];
            let (ys, yt, yu) = (&ys[..n], &yt[..n], &yu[..n]);
            for q in 0..n {
                let inverse = |x: &Vector3<f64>| {
                    let (d0, d1, d2) = (x.x - ys[q], x.y - yt[q], x.z - yu[q]);
                    1.0 / (d0 * d0 + d1 * d1 + d2 * d2).sqrt()
                };
                let (i0, i1, i2) = (inverse(&x[0]), inverse(&x[1]), inverse(&x[2]));
                r0[q] += i0;
                r1[q] += i1;
                r2[q] += i2;
                column[q] += i0 + i1 + i2;
            }
        }
    }
}

/// Integrates all pairs of panels. `progress` is called with the share that is done.
pub(super) fn assemble(
    elements: &Elements,
    near_field: &NearField,
    vortex: bool,
    progress: &(dyn Fn(f64) + Sync),
) -> Assembled {
    let (n, panels) = (elements.unknown_count, elements.panels);
    let points = Points::new(panels);
    let curls: Vec<_> = panels.iter().map(Panel::curls).collect();
    let mut matrix = vec![0.0; n * n];
    let mut vortices = vec![Vortex::ZERO; if vortex { panels.len() } else { 0 }];
    // For each unknown, these are the panels around it, ascending, and which of their corners it is.
    let mut around = vec![Vec::new(); n];
    for (p, triangle) in elements.triangles.iter().enumerate() {
        for (corner, v) in triangle.iter().enumerate() {
            if let Some(unknown) = elements.unknowns[*v as usize] {
                around[unknown as usize].push((p, corner));
            }
        }
    }
    let mut first = 0;
    while first < panels.len() {
        let last = (first + ROWS_PER_BATCH).min(panels.len());
        let starts: Vec<_> = (first..last).step_by(ROWS_PER_TASK).collect();
        let tasks: Vec<(Vec<Row>, Vec<Vortex>)> = starts
            .into_par_iter()
            .map(|start| {
                let mut felt = vec![Vortex::ZERO; vortices.len()];
                let mut sums = FarSums::default();
                let rows = (start..(start + ROWS_PER_TASK).min(last))
                    .map(|p| {
                        row(
                            elements, &points, &curls, near_field, p, &mut sums, &mut felt,
                        )
                    })
                    .collect();
                (rows, felt)
            })
            .collect();
        let mut rows = Vec::with_capacity(last - first);
        for (task, felt) in tasks {
            rows.extend(task);
            for (sum, part) in vortices.iter_mut().zip(&felt) {
                sum.outer += part.outer;
                sum.inner += part.inner;
            }
        }
        matrix
            .par_chunks_mut(n.max(1))
            .zip(&around)
            .for_each(|(line, around)| {
                for (p, corner) in around.iter().filter(|(p, _)| (first..last).contains(p)) {
                    let curl = curls[*p][*corner];
                    for (entry, other) in line.iter_mut().zip(&rows[p - first].curls) {
                        *entry += curl.dot(other);
                    }
                }
            });
        first = last;
        let left = (panels.len() - last) as f64 / panels.len() as f64;
        progress(1.0 - left * left);
    }
    // Only pairs with P ≤ Q were added, and half of P = Q, so that the transpose is the other half.
    for i in 0..n {
        for j in 0..i {
            let sum = (matrix[i * n + j] + matrix[j * n + i]) / (4.0 * PI);
            matrix[i * n + j] = sum;
            matrix[j * n + i] = sum;
        }
        matrix[i * n + i] *= 2.0 / (4.0 * PI);
    }
    let vector_potential = vortices
        .iter()
        .map(|v| (v.outer - Matrix3::from_diagonal_element(v.inner)) / (4.0 * PI))
        .collect();
    Assembled {
        matrix,
        vector_potential,
    }
}

fn row(
    elements: &Elements,
    points: &Points,
    curls: &[[Vector3<f64>; 3]],
    near_field: &NearField,
    p: usize,
    sums: &mut FarSums,
    felt: &mut [Vortex],
) -> Row {
    let panels = elements.panels;
    let panel = &panels[p];
    sums.fill(points, p);
    let x = [0, 1, 2].map(|a| points.point(a, p));
    let mut row = Row {
        curls: vec![Vector3::zeros(); elements.unknown_count],
    };
    let corners: HashSet<u32> = elements.triangles[p].into();
    for (offset, other) in panels[p..].iter().enumerate() {
        let q = p + offset;
        let reach = TIE * near_field.far * (panel.radius + other.radius);
        let moments = if q == p {
            near_field.self_moments(panel)
        } else if (panel.centroid - other.centroid).norm_squared() < reach * reach {
            let touching = elements.triangles[q].iter().any(|v| corners.contains(v));
            near_field.moments(panel, other, touching)
        } else {
            let w = panel.area * other.area / 9.0;
            let [r, c] = [&sums.rows, &sums.columns].map(|s| [0, 1, 2].map(|k| s[k][offset] * w));
            let mut far = Moments {
                uniform: r[0] + r[1] + r[2],
                ..Moments::default()
            };
            if !felt.is_empty() {
                far.first_p = x[0] * r[0] + x[1] * r[1] + x[2] * r[2];
                for (k, sum) in c.iter().enumerate() {
                    far.first_q += points.point(k, q) * *sum;
                }
            }
            far
        };
        let share = if q == p { 0.5 } else { 1.0 };
        for (corner, v) in elements.triangles[q].iter().enumerate() {
            if let Some(unknown) = elements.unknowns[*v as usize] {
                row.curls[unknown as usize] += curls[q][corner] * (moments.uniform * share);
            }
        }
        if !felt.is_empty() {
            felt[p].add(&other.normal, &moments.first_p, &moments.first_q);
            if q != p {
                felt[q].add(&panel.normal, &moments.first_q, &moments.first_p);
            }
        }
    }
    row
}
