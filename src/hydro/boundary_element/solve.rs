//! The solve, which takes the assembled integrals to the added mass.

use super::assemble::{Assembled, Elements, assemble};
use super::pair::NearField;
use super::panel::Panel;
use crate::geometry::{Sheet, Surface, VolumeIntegrals};
use crate::hydro::AddedMass;
use faer::linalg::solvers::{Lblt, Llt, Solve};
use faer::{Mat, MatRef, Side};
use rapier3d::na::{Matrix3, Matrix6, Vector3, Vector6};

/// A triangle mesh ready to be solved: centred, with its unknowns numbered.
pub(super) struct Problem {
    pub triangles: Vec<[u32; 3]>,
    pub panels: Vec<Panel>,
    pub unknowns: Vec<Option<u32>>,
    pub unknown_count: usize,
    /// One list of unknowns per closed component: adding a constant on it changes nothing.
    components: Vec<Vec<u32>>,
    positions: Vec<Vector3<f64>>,
    /// The volume that the mesh encloses; `None` for a sheet.
    inside: Option<VolumeIntegrals>,
    /// The point about which the added mass is computed.
    center: Vector3<f64>,
}

/// What one solve on one mesh gives.
pub(super) struct Solution {
    /// The added mass about [`Problem::center`].
    pub added_mass: AddedMass,
    /// Largest relative difference between two ways to compute the same entries.
    pub asymmetry: f64,
    pub scale: Scale,
    /// Potential (exterior, or jump for a sheet) of the six unit motions by vertex.
    pub potentials: Vec<[f64; 6]>,
    /// Whether the matrix was positive definite, as it is but for quadrature errors.
    pub definite: bool,
}

impl Problem {
    pub fn closed(surface: &Surface) -> Self {
        let inside = surface.volume_integrals();
        let pinned = vec![false; surface.vertices().len()];
        Self::new(
            surface.vertices(),
            surface.triangles(),
            &pinned,
            Some(inside),
            inside.centroid,
        )
    }

    /// The jump of the potential vanishes on the rim.
    pub fn sheet(sheet: &Sheet) -> Self {
        Self::new(
            sheet.vertices(),
            sheet.triangles(),
            sheet.on_rim(),
            None,
            sheet.centroid(),
        )
    }

    fn new(
        vertices: &[Vector3<f64>],
        triangles: &[[u32; 3]],
        pinned: &[bool],
        inside: Option<VolumeIntegrals>,
        center: Vector3<f64>,
    ) -> Self {
        let mut used = vec![false; vertices.len()];
        for v in triangles.iter().flatten() {
            used[*v as usize] = true;
        }
        let mut unknown_count = 0;
        let unknowns: Vec<Option<u32>> = used
            .iter()
            .zip(pinned)
            .map(|(used, pinned)| {
                (*used && !pinned).then(|| {
                    unknown_count += 1;
                    unknown_count as u32 - 1
                })
            })
            .collect();
        let positions: Vec<_> = vertices.iter().map(|v| v - center).collect();
        let panels = triangles
            .iter()
            .map(|t| Panel::new(t.map(|i| positions[i as usize])))
            .collect();
        let inside = inside.map(|i| VolumeIntegrals {
            centroid: i.centroid - center,
            ..i
        });
        let mut problem = Self {
            triangles: triangles.to_vec(),
            panels,
            unknowns,
            unknown_count,
            components: Vec::new(),
            positions,
            inside,
            center,
        };
        if inside.is_some() {
            problem.components = problem.find_components();
        }
        problem
    }

    pub fn center(&self) -> Vector3<f64> {
        self.center
    }

    /// Takes another point as the one that rotations are about.
    pub fn recenter(&mut self, center: Vector3<f64>) {
        let shift = self.center - center;
        for x in &mut self.positions {
            *x += shift;
        }
        self.panels = self
            .triangles
            .iter()
            .map(|t| Panel::new(t.map(|i| self.positions[i as usize])))
            .collect();
        if let Some(inside) = &mut self.inside {
            inside.centroid += shift;
        }
        self.center = center;
    }

    fn find_components(&self) -> Vec<Vec<u32>> {
        let mut parent: Vec<u32> = (0..self.unknown_count as u32).collect();
        fn root(parent: &mut [u32], mut i: u32) -> u32 {
            while parent[i as usize] != i {
                parent[i as usize] = parent[parent[i as usize] as usize];
                i = parent[i as usize];
            }
            i
        }
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.unknowns[v as usize]);
            let Some(a) = a else { continue };
            for other in [b, c].into_iter().flatten() {
                let (i, j) = (root(&mut parent, a), root(&mut parent, other));
                parent[i.max(j) as usize] = i.min(j);
            }
        }
        let mut components: Vec<Vec<u32>> = vec![Vec::new(); self.unknown_count];
        for i in 0..self.unknown_count as u32 {
            components[root(&mut parent, i) as usize].push(i);
        }
        components.retain(|c| !c.is_empty());
        components
    }

    /// Solves for the six unit motions.
    ///
    /// The unknown is the double layer μ, the jump of the potential across the surface, with
    /// `W μ = −g`, W the hypersingular operator and g the normal velocity of the motion. W is
    /// symmetric and positive, and on continuous piecewise linear functions reads
    /// `⟨Wu, v⟩ = ∫∫ (n×∇u)·(n×∇v) / 4π|x−y|` (Nédélec 1982; Steinbach, *Numerical Approximation
    /// Methods for Elliptic Boundary Value Problems*, § 6.5). It does not degenerate when two faces
    /// approach, and serves closed and open surfaces alike.
    ///
    /// `−⟨μ, g⟩` is the kinetic energy of the fluid outside **and** of a fluid that fills the body.
    /// The latter is known for translations (`V`, and `V ω×centroid` for the coupling). For
    /// rotations it is not, and the outer potential itself is solved for:
    ///
    /// ```text
    /// W φ = −(½ + K')g,    (½ + K')g = g − n·curl B,    B = 2ω ∫_V G dV − ∫ G n×(ω×y) dS
    /// ```
    ///
    /// by the Helmholtz decomposition of the rigid motion inside. Integrated by parts against the
    /// basis, and with the Newton potential written as a surface integral, this too needs single
    /// layers only.
    pub fn solve(&self, near_field: &NearField, progress: &(dyn Fn(f64) + Sync)) -> Solution {
        let elements = Elements {
            triangles: &self.triangles,
            panels: &self.panels,
            unknowns: &self.unknowns,
            unknown_count: self.unknown_count,
        };
        let closed = self.inside.is_some();
        // Assembly is three quarters of the time at every size of interest.
        let assembled = assemble(&elements, near_field, closed, &|share| {
            progress(0.75 * share)
        });
        let fluxes = self.fluxes();
        let Assembled {
            mut matrix,
            vector_potential,
        } = assembled;
        self.pin_constants(&mut matrix);
        let n = self.unknown_count;
        let mut right = Mat::<f64>::from_fn(n, 9, |i, j| if j < 6 { fluxes[i][j] } else { 0.0 });
        if closed {
            self.add_outer_flux(&vector_potential, &mut right);
        }
        let view = MatRef::from_row_major_slice(&matrix, n, n);
        let (solved, definite) = match Llt::new(view, Side::Lower) {
            Ok(cholesky) => (cholesky.solve(&right), true),
            Err(_) => (Lblt::new(view, Side::Lower).solve(&right), false),
        };
        let product = right.transpose() * &solved;
        let (added_mass, asymmetry, scale) = self.added_mass(&product);
        progress(1.0);
        let potentials = self.potentials(&solved);
        Solution {
            added_mass,
            asymmetry,
            scale,
            potentials,
            definite,
        }
    }

    /// `∫ g_j v_i` by unknown i for the six unit motions j.
    fn fluxes(&self) -> Vec<[f64; 6]> {
        let mut fluxes = vec![[0.0; 6]; self.unknown_count];
        for (triangle, panel) in self.triangles.iter().zip(&self.panels) {
            let sum: Vector3<f64> = panel.corners.iter().sum();
            for (v, corner) in triangle.iter().zip(&panel.corners) {
                let Some(unknown) = self.unknowns[*v as usize] else {
                    continue;
                };
                let flux = &mut fluxes[unknown as usize];
                let moment = (sum + corner).cross(&panel.normal) * (panel.area / 12.0);
                for k in 0..3 {
                    flux[k] += panel.normal[k] * panel.area / 3.0;
                    flux[3 + k] += moment[k];
                }
            }
        }
        fluxes
    }

    /// Columns 6 to 8 become `∫ v_i (½ + K')g` of the three rotations.
    fn add_outer_flux(&self, vector_potential: &[Matrix3<f64>], right: &mut Mat<f64>) {
        for i in 0..self.unknown_count {
            for k in 0..3 {
                right[(i, 6 + k)] = right[(i, 3 + k)];
            }
        }
        for ((triangle, panel), b) in self
            .triangles
            .iter()
            .zip(&self.panels)
            .zip(vector_potential)
        {
            for (v, curl) in triangle.iter().zip(panel.curls()) {
                let Some(i) = self.unknowns[*v as usize] else {
                    continue;
                };
                let flux = b.tr_mul(&curl);
                for k in 0..3 {
                    right[(i as usize, 6 + k)] += flux[k];
                }
            }
        }
    }

    /// W cannot see a constant on a closed component. The fluxes have none, so that any positive
    /// weight on it makes the solution unique without changing it.
    fn pin_constants(&self, matrix: &mut [f64]) {
        let n = self.unknown_count;
        let mean = (0..n).map(|i| matrix[i * n + i]).sum::<f64>() / n.max(1) as f64;
        for component in &self.components {
            let weight = mean / component.len() as f64;
            for i in component {
                for j in component {
                    matrix[*i as usize * n + *j as usize] += weight;
                }
            }
        }
    }

    fn added_mass(&self, product: &Mat<f64>) -> (AddedMass, f64, Scale) {
        let mut m = Matrix6::from_fn(|i, j| product[(i, j)]);
        let Some(inside) = &self.inside else {
            // −⟨μ, g⟩ is symmetric up to rounding.
            let scale = Scale::new(&m, None);
            let asymmetry = scale.relative(&(m - m.transpose()));
            return (AddedMass::from_matrix6(&m), asymmetry, scale);
        };
        let volume = inside.volume;
        let coupling = -inside.centroid.cross_matrix() * volume;
        for i in 0..3 {
            m[(i, i)] -= volume;
            for j in 0..3 {
                m[(i, 3 + j)] -= coupling[(i, j)];
                m[(3 + i, j)] -= coupling[(j, i)];
                m[(3 + i, 3 + j)] = product[(3 + i, 6 + j)];
            }
        }
        // The coupling is computed again from the outer potential, and the rotation block transposed.
        let scale = Scale::new(&m, Some(inside));
        let mut difference = Matrix6::zeros();
        for i in 0..3 {
            for j in 0..3 {
                difference[(i, 3 + j)] = product[(i, 6 + j)] - m[(i, 3 + j)];
                difference[(3 + i, 3 + j)] = m[(3 + i, 3 + j)] - m[(3 + j, 3 + i)];
            }
        }
        let asymmetry = scale.relative(&difference);
        (AddedMass::from_matrix6(&m), asymmetry, scale)
    }

    fn potentials(&self, solved: &Mat<f64>) -> Vec<[f64; 6]> {
        self.unknowns
            .iter()
            .zip(&self.positions)
            .map(|(unknown, x)| {
                let Some(i) = unknown else { return [0.0; 6] };
                std::array::from_fn(|j| {
                    let row = *i as usize;
                    match (&self.inside, j) {
                        (None, _) => -solved[(row, j)],
                        (Some(_), 0..3) => x[j] - solved[(row, j)],
                        (Some(_), _) => -solved[(row, j + 3)],
                    }
                })
            })
            .collect()
    }
}

/// Energy, relative to that of the broadest motion, that is left to one that moves no fluid: above
/// rounding, so that the tensor stays positive in all later arithmetic.
const LEAST_ENERGY: f64 = 1e-12;

/// The magnitudes that errors of the blocks are relative to; they do not depend on the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    linear: f64,
    angular: f64,
}

impl Scale {
    /// The norms of the blocks, but not less than the displaced fluid's own inertia for the
    /// rotations: a sphere has no added moment of inertia to be relative to.
    fn new(m: &Matrix6<f64>, inside: Option<&VolumeIntegrals>) -> Self {
        let norm = |at: usize| m.fixed_view::<3, 3>(at, at).norm();
        let floor = inside.map_or(0.0, |i| i.unit_inertia().norm());
        Self {
            linear: norm(0).max(f64::MIN_POSITIVE),
            angular: norm(3).max(floor).max(f64::MIN_POSITIVE),
        }
    }

    /// The magnitude of the energy of one of the six unit motions.
    pub fn of_motion(&self, motion: usize) -> f64 {
        if motion < 3 {
            self.linear
        } else {
            self.angular
        }
    }

    /// The nearest tensor without negative energies. Motions that hardly move fluid, such as the spin
    /// of a disc, come out as zero plus or minus the error, and run time must not see negative ones.
    pub fn positive(&self, added_mass: &AddedMass) -> AddedMass {
        let unit = Vector6::from_fn(|i, _| self.of_motion(i).sqrt());
        let scaled = added_mass
            .to_matrix6()
            .map_with_location(|i, j, x| x / (unit[i] * unit[j]));
        let mut eigen = scaled.symmetric_eigen();
        if eigen.eigenvalues.min() >= LEAST_ENERGY {
            return *added_mass;
        }
        eigen
            .eigenvalues
            .apply(|energy| *energy = energy.max(LEAST_ENERGY));
        let positive = eigen.recompose();
        AddedMass::from_matrix6(&positive.map_with_location(|i, j, x| x * unit[i] * unit[j]))
    }

    /// The largest norm of a block of a difference, relative to the block's scale.
    pub fn relative(&self, difference: &Matrix6<f64>) -> f64 {
        let norm = |i: usize, j: usize| difference.fixed_view::<3, 3>(i, j).norm();
        (norm(0, 0) / self.linear)
            .max(norm(0, 3) / (self.linear * self.angular).sqrt())
            .max(norm(3, 3) / self.angular)
    }
}
