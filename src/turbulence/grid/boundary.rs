//! What is at the ends of the box.

use super::array::Array3;
use super::separable::End;
use crate::error::Error;
use crate::flow::Flow;
use rapier3d::math::{Real, Vector};
use std::sync::Arc;

/// One end of one axis.
#[derive(Clone, Default)]
pub enum Boundary {
    /// The end is joined to the other one. This is the default.
    #[default]
    Periodic,
    /// Solid wall with no slip that moves in its own plane with this velocity, m/s (the component
    /// through the wall is ignored).
    Wall([f64; 3]),
    /// A wall without friction, or a plane of symmetry: nothing flows through it.
    FreeSlip,
    /// Fluid enters with the velocity of this flow, in the box's axes and the grid's time. A shear or a
    /// gusty wind here is what can keep turbulence alive without a body.
    Inflow(Arc<dyn Flow>),
    /// Fluid leaves (or enters) freely at zero pressure.
    Outflow,
}

/// All six ends.
#[derive(Clone)]
pub(crate) struct Sides {
    ends: [[Boundary; 2]; 3],
    active: [bool; 3],
}

impl Sides {
    pub fn new(ends: [[Boundary; 2]; 3], active: [bool; 3]) -> Result<Self, Error> {
        for i in 0..3 {
            let periodic = ends[i]
                .iter()
                .filter(|end| matches!(end, Boundary::Periodic))
                .count();
            Error::check(
                "number of periodic ends of an axis",
                periodic as f64,
                periodic != 1,
                "0 or 2",
            )?;
            let slipping = ends[i]
                .iter()
                .all(|end| matches!(end, Boundary::Periodic | Boundary::FreeSlip));
            Error::check(
                "cells of an axis with walls, inflow or outflow",
                1.0,
                active[i] || slipping,
                "at least 3",
            )?;
            for end in &ends[i] {
                if let Boundary::Wall(velocity) = end {
                    for x in velocity {
                        Error::check_finite("wall velocity", *x)?;
                    }
                }
            }
        }
        Ok(Self { ends, active })
    }

    pub fn is_periodic(&self, axis: usize) -> bool {
        matches!(self.ends[axis][0], Boundary::Periodic)
    }

    /// Whether the face at this end is an unknown of the flow.
    pub fn is_open(&self, axis: usize, upper: usize) -> bool {
        matches!(self.ends[axis][upper], Boundary::Outflow)
    }

    /// A position in cells, wrapped or clamped into the box.
    #[inline]
    pub fn confine(&self, x: [f64; 3], cells: [usize; 3]) -> [f64; 3] {
        core::array::from_fn(|i| {
            let n = cells[i] as f64;
            if !self.active[i] {
                0.5
            } else if self.is_periodic(i) {
                x[i].rem_euclid(n)
            } else {
                x[i].clamp(0.0, n)
            }
        })
    }

    /// What the pressure sees at the ends of an axis.
    pub fn pressure_ends(&self, axis: usize) -> [End; 2] {
        self.ends[axis].each_ref().map(|end| match end {
            Boundary::Periodic => End::Periodic,
            Boundary::Outflow => End::HalfValue,
            _ => End::Slope,
        })
    }

    /// What the change of component `c` sees at the ends of `axis` while it diffuses.
    pub fn velocity_ends(&self, c: usize, axis: usize) -> [End; 2] {
        self.ends[axis].each_ref().map(|end| match end {
            Boundary::Periodic => End::Periodic,
            Boundary::Outflow => End::Slope,
            Boundary::FreeSlip if c != axis => End::Slope,
            _ if c == axis => End::Value,
            _ => End::HalfValue,
        })
    }

    /// First unknown face of a component along its own axis, and how many there are.
    pub fn unknown_faces(&self, c: usize, cells: usize) -> (usize, usize) {
        if self.is_periodic(c) {
            return (0, cells);
        }
        let low = usize::from(!self.is_open(c, 0));
        let high = usize::from(!self.is_open(c, 1));
        (low, cells + 1 - low - high)
    }

    /// Velocity component `c` that this end imposes at `point` (m).
    fn imposed(&self, axis: usize, upper: usize, c: usize, point: [f64; 3], time: f64) -> f64 {
        match &self.ends[axis][upper] {
            Boundary::Wall(velocity) if c != axis => velocity[c],
            Boundary::Inflow(flow) => {
                let point = Vector::from_array(point.map(|x| x as Real));
                let value = f64::from(flow.velocity(point, time).to_array()[c]);
                // A user's flow may misbehave; the grid must not.
                if value.is_finite() { value } else { 0.0 }
            }
            _ => 0.0,
        }
    }

    /// Sets the velocities of the faces on which they are prescribed.
    pub fn set_faces(&self, c: usize, faces: &mut Array3, h: f64, time: f64) {
        if !self.active[c] {
            return;
        }
        let last = faces.dims[c] - 1;
        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
        for m in 0..faces.dims[a] {
            for n in 0..faces.dims[b] {
                let mut index = [0; 3];
                (index[a], index[b]) = (m, n);
                if self.is_periodic(c) {
                    let value = faces.get(index);
                    index[c] = last;
                    faces.set(index, value);
                    continue;
                }
                for upper in 0..2 {
                    index[c] = upper * last;
                    if !self.is_open(c, upper) {
                        let mut point = index.map(|i| (i as f64 + 0.5) * h);
                        point[c] = index[c] as f64 * h;
                        faces.set(index, self.imposed(c, upper, c, point, time));
                    }
                }
            }
        }
    }

    /// Sets the ghosts of component `c`, axis by axis.
    pub fn set_ghosts(&self, c: usize, faces: &mut Array3, h: f64, time: f64) {
        for axis in (0..3).filter(|axis| self.active[*axis]) {
            let n = faces.dims[axis];
            for upper in 0..2 {
                let end = if upper == 1 { n - 1 } else { 0 };
                let (from, factor) = match (&self.ends[axis][upper], axis == c) {
                    // Along its own axis face n is face 0 again.
                    (Boundary::Periodic, true) => (if upper == 1 { 1 } else { n - 2 }, 1.0),
                    (Boundary::Periodic, false) => (n - 1 - end, 1.0),
                    (Boundary::Wall(_) | Boundary::Inflow(_), false) => (end, -1.0),
                    // Through a wall the flow is odd, so that its second difference vanishes there.
                    (Boundary::Wall(_) | Boundary::FreeSlip, true) => {
                        (if upper == 1 { n - 2 } else { 1 }, -1.0)
                    }
                    _ => (end, 1.0),
                };
                let twice = if factor < 0.0 && axis != c { 2.0 } else { 0.0 };
                faces.fill_ghosts(axis, upper == 1, from, factor, |index| {
                    if twice == 0.0 {
                        return 0.0;
                    }
                    let mut point = index.map(|i| (i as f64 + 0.5) * h);
                    point[c] -= 0.5 * h;
                    point[axis] = if upper == 1 { n as f64 * h } else { 0.0 };
                    twice * self.imposed(axis, upper, c, point, time)
                });
            }
        }
    }

    /// Ghosts of a quantity in the cell centers: `inflow` enters, elsewhere the slope is zero.
    pub fn set_center_ghosts(&self, centers: &mut Array3, inflow: f64) {
        for axis in (0..3).filter(|axis| self.active[*axis]) {
            let n = centers.dims[axis];
            for upper in 0..2 {
                let end = if upper == 1 { n - 1 } else { 0 };
                match &self.ends[axis][upper] {
                    Boundary::Periodic => {
                        centers.fill_ghosts(axis, upper == 1, n - 1 - end, 1.0, |_| 0.0);
                    }
                    Boundary::Inflow(_) => {
                        centers.fill_ghosts(axis, upper == 1, end, 0.0, |_| inflow);
                    }
                    _ => centers.fill_ghosts(axis, upper == 1, end, 1.0, |_| 0.0),
                }
            }
        }
    }
}
