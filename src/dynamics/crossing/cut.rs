//! What of a body is in which fluid.

use super::constants::{CrossingConstants, CutBody};
use super::portion::Portion;
use super::transfer::FluidMass;
use crate::hydro::{Submerged, Waterplane};
use crate::math::spatial::Blocks;
use crate::medium::Medium;
use rapier3d::na::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// Where a body is.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Center of mass in level axes, m.
    pub center: Vector3<f64>,
    /// Plate axes to level axes.
    pub turn: Matrix3<f64>,
}

impl Place {
    /// Of a body at a height, whose plate axes are mapped to the world's by an attitude, among level axes.
    pub fn new(
        center: Vector3<f64>,
        attitude: &UnitQuaternion<f64>,
        level: &Rotation3<f64>,
    ) -> Self {
        let attitude = attitude.to_rotation_matrix();
        Self {
            center,
            turn: level.inverse().matrix() * attitude.matrix(),
        }
    }
}

/// A medium at a moment, for bodies in some of its layers.
#[derive(Clone, Copy)]
pub(crate) struct Cut<'a> {
    pub medium: &'a Medium,
    pub time: f64,
    /// The first layer that the body may be in, and the number of layers.
    pub first: usize,
    pub count: usize,
}

/// A body as it is cut. Plate axes about the center of mass, SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wetted {
    /// Inertia of body and fluid.
    pub mass: FluidMass,
    /// Sum of density times volume, kg, and of density times the volume's first moment, kg·m.
    pub displaced_mass: f64,
    pub displaced_moment: Vector3<f64>,
    /// ∫ (density below less density above) × depth dV over what is under each boundary, less density × height of
    /// what is over all: the potential of buoyancy over the gravity, kg·m.
    pub potential: f64,
    /// The waterplanes with the jump of the density across them, level axes: kg/m.
    pub waterplane: Waterplane,
    /// How much more mass the body can displace on its way down, and how much less on its way up, kg.
    pub room: [f64; 2],
    /// Share of the volume under the free surface.
    pub submerged: f64,
}

impl CutBody {
    /// What of the hull is under a surface as a part of the body. A surface that jumps within a triangle, or is too steep
    /// for numbers, would leave more than there is, or elsewhere.
    fn possible(&self, found: Submerged, place: &Place) -> Submerged {
        let (volume, moment) = (found.volume * self.scale, found.moment * self.scale);
        let nothing = Submerged {
            volume: 0.0,
            moment: Vector3::zeros(),
            waterplane: Waterplane::default(),
        };
        if volume >= self.volume {
            let moment = place.turn * self.middle * self.volume;
            return Submerged {
                volume: self.volume,
                moment,
                ..nothing
            };
        }
        let waterplane = found.waterplane.scaled(self.scale);
        let [x, z] = waterplane.first;
        let [xx, xz, zz] = waterplane.second;
        let finite = (moment.sum() + waterplane.area + x + z + xx + xz + zz).is_finite();
        if !(volume > 0.0 && finite) {
            return nothing;
        }
        let farthest = volume * self.radius;
        Submerged {
            volume,
            moment: moment * (farthest / moment.norm().max(farthest)),
            waterplane,
        }
    }
}

impl Cut<'_> {
    /// What of a body is under the boundary over a layer: level axes about the center of mass.
    pub fn under(&self, layer: usize, body: &CutBody, place: &Place) -> Submerged {
        let (at, medium) = (&place.center, self.medium);
        let surface = medium.surface();
        let top = -medium.top(layer) - at.y;
        let found = if layer != 1 || surface.is_still() {
            body.hull.under_plane(&place.turn, top, [0.0; 2])
        } else if medium.is_plane_over(body.length) {
            let here = medium.elevation(at, self.time);
            body.hull
                .under_plane(&place.turn, here.height - at.y, here.slope)
        } else {
            let depth = |r: &Vector3<f64>| {
                let point = at + r;
                medium.elevation(&point, self.time).height - point.y
            };
            body.hull.under(&place.turn, depth)
        };
        body.possible(found, place)
    }

    /// Calls `each` with the layer's number from the first one on, and with volume and first moment of what of a body
    /// is in it; with what is under each boundary `boundary`, and the number of the layer below it.
    fn divide(
        &self,
        body: &CutBody,
        place: &Place,
        mut each: impl FnMut(usize, f64, Vector3<f64>),
        mut boundary: impl FnMut(usize, &Submerged),
    ) {
        let (mut volume, mut moment) = (body.volume, place.turn * body.middle * body.volume);
        for number in 0..self.count {
            if number + 1 == self.count {
                each(number, volume, moment);
                break;
            }
            let mut under = self.under(self.first + number + 1, body, place);
            under.volume = under.volume.clamp(0.0, volume);
            boundary(number + 1, &under);
            each(number, volume - under.volume, moment - under.moment);
            (volume, moment) = (under.volume, under.moment);
        }
    }

    /// Cuts a body; `portions` gets those of each part in each layer, layer by layer.
    pub fn cut(
        &self,
        constants: &CrossingConstants,
        place: &Place,
        portions: &mut Vec<Portion>,
    ) -> Wetted {
        let whole = &constants.whole;
        let back = place.turn.transpose();
        let portion = |body: &CutBody, volume: f64, moment: Vector3<f64>| {
            let share = volume / body.volume;
            let shift = if share > 1e-9 {
                back * (moment / volume) - body.middle
            } else {
                Vector3::zeros()
            };
            Portion { share, shift }
        };
        let fluids = &constants.fluids[self.first..];
        let parts = constants.part_count();
        portions.clear();
        portions.resize(self.count * parts, Portion::default());
        let dry = FluidMass::dry(constants.dry_mass, constants.dry_inertia);
        let mut wetted = Wetted::nothing(dry);
        let (mut waterplane, mut potential, mut room) = (wetted.waterplane, 0.0, [0.0; 2]);
        let first = self.first;
        let mut submerged = if first == 0 { 0.0 } else { 1.0 };
        let each = |number: usize, volume: f64, moment: Vector3<f64>| {
            let Some(fluid) = fluids.get(number) else {
                return;
            };
            let density = fluid.density;
            let found = portion(whole, volume, moment);
            wetted.displaced_mass += density * volume;
            wetted.displaced_moment += back * moment * density;
            let middle = whole.middle + found.shift;
            wetted
                .mass
                .add(&constants.added_mass, density * found.share, middle);
            if parts == 1 {
                portions[number] = found;
            }
        };
        let boundary = |number: usize, under: &Submerged| {
            let density = |number: usize| fluids.get(number).map_or(0.0, |fluid| fluid.density);
            let jump = density(number) - density(number - 1);
            let top = -self.medium.top(first + number);
            // Depth under the mean level of what is under: for waves the potential is not that of a still fluid.
            let depth = (top - place.center.y) * under.volume - under.moment.y;
            potential += jump * depth;
            if jump > 0.0 {
                waterplane.add(&under.waterplane.scaled(jump));
                room[0] += jump * (whole.volume - under.volume);
                room[1] += jump * under.volume;
            }
            if first + number == 1 {
                submerged = under.volume / whole.volume;
            }
        };
        self.divide(whole, place, each, boundary);
        let uppermost = fluids.first().map_or(0.0, |fluid| fluid.density);
        let middle_height = place.center.y + (place.turn * whole.middle).y;
        wetted.potential = potential - uppermost * whole.volume * middle_height;
        (wetted.waterplane, wetted.room, wetted.submerged) = (waterplane, room, submerged);
        for (i, part) in constants.parts.iter().enumerate() {
            if parts > 1 {
                let each = |number: usize, volume: f64, moment: Vector3<f64>| {
                    portions[number * parts + i] = portion(part, volume, moment);
                };
                self.divide(part, place, each, |_, _| {});
            }
        }
        wetted
    }
}

impl Wetted {
    /// A body in no fluid.
    pub fn nothing(mass: FluidMass) -> Self {
        Self {
            mass,
            displaced_mass: 0.0,
            displaced_moment: Vector3::zeros(),
            potential: 0.0,
            waterplane: Waterplane::default(),
            room: [0.0; 2],
            submerged: 0.0,
        }
    }

    /// The hydrostatic stiffness `g Σ Δρ ∫ w wᵀ dA` with w = (n, r × n), n being up: plate axes, N/m, N, N·m.
    pub fn stiffness(&self, place: &Place, gravity: f64) -> Blocks<f64> {
        let plane = self.waterplane.scaled(gravity);
        let ([x, z], [xx, xz, zz]) = (plane.first, plane.second);
        // w = (0, 1, 0, −z, 0, x) in level axes.
        let m11 = Matrix3::from_diagonal(&Vector3::new(0.0, plane.area, 0.0));
        let m12 = Matrix3::new(0.0, 0.0, 0.0, -z, 0.0, x, 0.0, 0.0, 0.0);
        let m22 = Matrix3::new(zz, 0.0, -xz, 0.0, 0.0, 0.0, -xz, 0.0, xx);
        let back = place.turn.transpose();
        let turned = |m: Matrix3<f64>| back * m * place.turn;
        let m12 = turned(m12);
        Blocks {
            m11: turned(m11),
            m12,
            m21: m12.transpose(),
            m22: turned(m22),
        }
    }
}

impl Waterplane {
    /// All of it times a factor.
    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self {
            area: self.area * factor,
            first: self.first.map(|x| x * factor),
            second: self.second.map(|x| x * factor),
        }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.area += other.area;
        for (own, other) in self.first.iter_mut().zip(other.first) {
            *own += other;
        }
        for (own, other) in self.second.iter_mut().zip(other.second) {
            *own += other;
        }
    }
}
