//! Refinement of the mesh until the tolerance is met.

use super::pair::NearField;
use super::params::{
    BoundaryElementParams, BoundaryElementProgress, BoundaryElementReport, BoundaryElementSolution,
    ProgressFn,
};
use super::solve::{Problem, Solution};
use crate::error::Error;
use crate::geometry::{Sheet, Surface, bisect, quality};
use crate::hydro::AddedMass;
use rapier3d::na::Vector3;
use std::collections::HashMap;

/// A mesh with fewer panels than this is divided everywhere before it is solved for the first time:
/// the differences of the first levels would tell nothing.
const FIRST_PANELS: usize = 150;

/// The panels that are quartered hold this share of the sum of all indicators.
const MARKED_SHARE: f64 = 0.8;
/// The least share of the panels that is quartered.
const LEAST_MARKED: f64 = 0.25;

/// Ratio of successive differences that is assumed before it can be measured, and its bounds. Edges
/// of isotropic meshes give about ½ per doubling; a ratio close to 1 would extrapolate to anywhere.
const DEFAULT_RATIO: f64 = 0.5;
const RATIO_BOUNDS: (f64, f64) = (0.3, 0.7);

/// How often a matrix that is not positive definite, which only quadrature can be the cause of, is
/// integrated again with finer close panels.
const RETRIES: usize = 2;

/// What can be meshed.
#[derive(Clone, Debug)]
pub(super) enum Body {
    Closed(Surface),
    Sheet(Sheet),
}

impl Body {
    fn vertices(&self) -> &[Vector3<f64>] {
        match self {
            Self::Closed(surface) => surface.vertices(),
            Self::Sheet(sheet) => sheet.vertices(),
        }
    }

    fn triangles(&self) -> &[[u32; 3]] {
        match self {
            Self::Closed(surface) => surface.triangles(),
            Self::Sheet(sheet) => sheet.triangles(),
        }
    }

    fn check(&self) -> Result<(), Error> {
        quality::check_triangles(self.vertices(), self.triangles())?;
        if let Self::Closed(_) = self {
            quality::check_parts(self.vertices(), self.triangles())?;
        }
        quality::check_intersections(self.vertices(), self.triangles())
    }

    fn problem(&self) -> Problem {
        match self {
            Self::Closed(surface) => Problem::closed(surface),
            Self::Sheet(sheet) => Problem::sheet(sheet),
        }
    }

    fn quartered(&self, marked: &[bool]) -> Result<Self, Error> {
        Ok(match self {
            Self::Closed(surface) => {
                let mut vertices = surface.vertices().to_vec();
                let triangles = bisect::quarter(&mut vertices, surface.triangles(), marked);
                Self::Closed(Surface::new(&vertices, &triangles)?)
            }
            Self::Sheet(sheet) => Self::Sheet(sheet.quartered(marked)),
        })
    }
}

/// The meshes solved so far.
struct Levels<'a> {
    params: &'a BoundaryElementParams,
    progress: ProgressFn<'a>,
    last: Option<(Problem, Solution)>,
    history: Vec<(usize, f64)>,
    /// The last result, extrapolated if there were enough meshes.
    added_mass: AddedMass,
    error: Option<f64>,
    /// The center that all results are about: the first mesh's.
    center: Vector3<f64>,
}

impl<'a> Levels<'a> {
    fn new(params: &'a BoundaryElementParams, progress: ProgressFn<'a>) -> Self {
        Self {
            params,
            progress,
            last: None,
            history: Vec::new(),
            added_mass: AddedMass::zero(),
            error: None,
            center: Vector3::zeros(),
        }
    }

    fn solve(&mut self, body: &Body) {
        let mut problem = body.problem();
        let (level, panels) = (self.history.len(), problem.panels.len());
        let mut near_field = NearField {
            far: self.params.far,
            touching_levels: self.params.touching_levels,
            close_levels: self.params.close_levels,
        };
        if level == 0 {
            self.center = problem.center();
        } else {
            problem.recenter(self.center);
        }
        let report = |share| {
            (self.progress)(BoundaryElementProgress {
                level,
                panels,
                share,
            });
        };
        let mut solution = problem.solve(&near_field, &report);
        for _ in 0..RETRIES {
            if solution.definite {
                break;
            }
            near_field.touching_levels += 2;
            near_field.close_levels += 4;
            solution = problem.solve(&near_field, &report);
        }
        self.added_mass = solution.added_mass;
        let mut change = f64::INFINITY;
        if let Some((_, before)) = &self.last {
            let step = solution.added_mass.to_matrix6() - before.added_mass.to_matrix6();
            change = solution.scale.relative(&step);
            let ratio = match self.history.last() {
                Some((_, previous)) if previous.is_finite() && *previous > 0.0 => {
                    (change / previous).clamp(RATIO_BOUNDS.0, RATIO_BOUNDS.1)
                }
                _ => DEFAULT_RATIO,
            };
            // The differences are taken for a geometric series (Aitken). The error is estimated by what that
            // adds, or by the last difference if that is more.
            let missing = ratio / (1.0 - ratio);
            self.error = Some(change * missing.max(1.0));
            self.added_mass =
                AddedMass::from_matrix6(&(solution.added_mass.to_matrix6() + step * missing));
        }
        self.history.push((panels, change));
        self.last = Some((problem, solution));
    }

    fn done(&self) -> bool {
        self.params.tolerance.is_infinite()
            || self.error.is_some_and(|e| e <= self.params.tolerance)
    }

    fn finish(self, body: &Body) -> Result<BoundaryElementSolution, Error> {
        let converged = self.done();
        let Some((problem, solution)) = self.last else {
            return Err(Error::EmptyMesh);
        };
        Ok(BoundaryElementSolution {
            added_mass: solution.scale.positive(&self.added_mass),
            center: self.center,
            report: BoundaryElementReport {
                panels: problem.panels.len(),
                unknowns: problem.unknown_count,
                estimated_error: self.error,
                converged,
                asymmetry: solution.asymmetry,
                definite: solution.definite,
                history: self.history,
            },
            vertices: body.vertices().to_vec(),
            triangles: body.triangles().to_vec(),
            potentials: solution.potentials,
        })
    }
}

fn check_size(body: &Body, params: &BoundaryElementParams) -> Result<(), Error> {
    let panels = body.triangles().len();
    if panels > params.max_panels {
        return Err(Error::TooManyPanels {
            panels,
            max_panels: params.max_panels,
        });
    }
    Ok(())
}

/// Refines a mesh where its potentials have kinks.
pub(super) fn adaptively(
    mut body: Body,
    params: &BoundaryElementParams,
    progress: ProgressFn,
) -> Result<BoundaryElementSolution, Error> {
    check_size(&body, params)?;
    body.check()?;
    let refine = params.tolerance.is_finite();
    while refine && body.triangles().len() < FIRST_PANELS.min(params.max_panels / 4) {
        body = body.quartered(&vec![true; body.triangles().len()])?;
    }
    let mut levels = Levels::new(params, progress);
    loop {
        levels.solve(&body);
        if levels.done() {
            break;
        }
        let Some((problem, solution)) = &levels.last else {
            break;
        };
        let finer = body.quartered(&mark(&indicators(problem, solution)))?;
        if finer.triangles().len() > params.max_panels {
            break;
        }
        body = finer;
    }
    levels.finish(&body)
}

/// Solves for ever finer meshes of one shape.
pub(super) fn by_family(
    params: &BoundaryElementParams,
    progress: ProgressFn,
    mut mesh: impl FnMut(usize) -> Result<Body, Error>,
) -> Result<BoundaryElementSolution, Error> {
    let mut body = mesh(0)?;
    check_size(&body, params)?;
    body.check()?;
    let mut levels = Levels::new(params, progress);
    loop {
        levels.solve(&body);
        if levels.done() {
            break;
        }
        let finer = mesh(levels.history.len())?;
        if finer.triangles().len() > params.max_panels {
            break;
        }
        body = finer;
    }
    levels.finish(&body)
}

/// Squared error indicators by panel: the jumps of the potential's slope across its edges, weighted
/// to approximate the energy that the error holds. On a surface that is unfolded along an edge, a smooth
/// potential has no jump; at a free edge the jump is the slope itself, which is infinite.
fn indicators(problem: &Problem, solution: &Solution) -> Vec<f64> {
    let mut slopes: HashMap<(u32, u32), [f64; 6]> = HashMap::new();
    let mut edges = Vec::with_capacity(problem.panels.len() * 3);
    for (triangle, panel) in problem.triangles.iter().zip(&problem.panels) {
        let curls = panel.curls();
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            let edge = panel.corners[(i + 1) % 3] - panel.corners[i];
            let along = edge.normalize();
            // n × ∇φ along the edge is ∇φ across it.
            let across: [f64; 6] = std::array::from_fn(|j| {
                (0..3)
                    .map(|k| curls[k].dot(&along) * solution.potentials[triangle[k] as usize][j])
                    .sum()
            });
            let key = (a.min(b), a.max(b));
            let sum = slopes.entry(key).or_insert([0.0; 6]);
            for (sum, slope) in sum.iter_mut().zip(across) {
                *sum += slope;
            }
            edges.push((key, edge.norm()));
        }
    }
    problem
        .panels
        .iter()
        .zip(edges.chunks(3))
        .map(|(panel, edges)| {
            edges
                .iter()
                .map(|(key, length)| {
                    let jump: f64 = slopes[key]
                        .iter()
                        .enumerate()
                        .map(|(j, slope)| slope * slope / solution.scale.of_motion(j))
                        .sum();
                    jump * length * panel.area
                })
                .sum()
        })
        .collect()
}

/// The panels with the largest indicators.
fn mark(indicators: &[f64]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..indicators.len()).collect();
    order.sort_by(|i, j| indicators[*j].total_cmp(&indicators[*i]).then(i.cmp(j)));
    let goal = MARKED_SHARE * indicators.iter().sum::<f64>();
    let least = (LEAST_MARKED * indicators.len() as f64).ceil() as usize;
    let mut marked = vec![false; indicators.len()];
    let mut sum = 0.0;
    for (place, panel) in order.into_iter().enumerate() {
        if sum >= goal && place >= least {
            break;
        }
        sum += indicators[panel];
        marked[panel] = true;
    }
    marked
}
