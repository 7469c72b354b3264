//! The table of added masses, and what lies between its rows.
//!
//! What is interpolated are quotients by the proxy ellipsoid's, which hardly change from row to row: linear ones of the
//! added mass itself, angular ones of the added inertia over the ellipsoid's and .6 of the displaced one's, so that no
//! divisor vanishes where the ellipsoid is round.

use super::{Placed, Solid};
use crate::error::Error;
use crate::hydro::AddedMass;
use crate::math;
use rapier3d::na::{Matrix3, Vector3};
use std::sync::OnceLock;

/// Added mass over displaced mass, added over displaced inertia, and coupling over displaced mass times height.
type Row = [f64; 7];

/// Rows at equal steps of one or two logarithms of ratios of lengths.
#[derive(Debug, PartialEq)]
struct Grid {
    /// Smallest logarithm to base 2, of each ratio.
    first: [i32; 2],
    /// How many of each.
    count: [usize; 2],
    /// Whether it is that of boxes, whose edges may change places …
    cuboid: bool,
    /// … or of capsules, which begin with the ball: it has no added inertia, and what is nearly a ball next to none.
    capsule: bool,
    /// Quotients by the ellipsoid's, the second ratio's running fastest.
    rows: Vec<Row>,
}

/// The grids of the four solids.
#[derive(Debug, PartialEq)]
struct Table([Grid; 4]);

/// Added mass per unit density about the centroid, along the principal axes.
pub(super) fn added_mass(placed: &Placed) -> AddedMass {
    let solid = &placed.solid;
    let (kind, [x, y], order) = coordinates(solid);
    let row = Table::shipped().0[kind].at(x, y);
    let divisors = divisors(&in_order(solid, order));
    let mut found: Row = std::array::from_fn(|i| row[i] * divisors[i]);
    // Back from the order of lengths to the axes.
    for half in [0, 3] {
        let sorted: [f64; 3] = std::array::from_fn(|i| found[half + i]);
        (0..3).for_each(|i| found[half + order[i]] = sorted[i]);
    }
    let [x, y, z, about_x, about_y, about_z, coupling] = found;
    let mut added = AddedMass::diagonal(
        placed.along(Vector3::new(x, y, z)),
        placed.along(Vector3::new(about_x, about_y, about_z)),
    );
    let (j, k) = ((placed.axis + 1) % 3, (placed.axis + 2) % 3);
    added.coupling = Matrix3::zeros();
    added.coupling[(j, k)] = placed.sign * coupling;
    added.coupling[(k, j)] = -placed.sign * coupling;
    added
}

/// Which grid, where in it, and which of the solid's axes is the longest, the next, the shortest.
fn coordinates(solid: &Solid) -> (usize, [f64; 2], [usize; 3]) {
    match *solid {
        Solid::Cuboid { lengths } => {
            let mut order = [0, 1, 2];
            order.sort_by(|i, j| lengths[*j].total_cmp(&lengths[*i]));
            let [a, b, c] = order.map(|i| lengths[i]);
            (0, [math::log2(a / b), math::log2(b / c)], order)
        }
        Solid::Cylinder { radius, height } => (1, [slenderness(radius, height), 0.0], [0, 1, 2]),
        Solid::Cone { radius, height } => (2, [slenderness(radius, height), 0.0], [0, 1, 2]),
        Solid::Capsule { radius, length } => (3, [slenderness(radius, length), 0.0], [0, 1, 2]),
    }
}

/// Logarithm of height over diameter.
fn slenderness(radius: f64, height: f64) -> f64 {
    math::log2(0.5 * height / radius)
}

/// A box with its edges from the longest to the shortest, any other solid as it is.
fn in_order(solid: &Solid, order: [usize; 3]) -> Solid {
    match *solid {
        Solid::Cuboid { lengths } => Solid::Cuboid {
            lengths: Vector3::from_fn(|i, _| lengths[order[i]]),
        },
        other => other,
    }
}

/// What the seven quotients are multiplied by.
fn divisors(solid: &Solid) -> Row {
    let ellipsoid = solid.proxy().added_mass();
    let moments = solid.second_moment();
    let [about_x, about_y, about_z] = std::array::from_fn(|i| {
        let displaced = moments[(i + 1) % 3] + moments[(i + 2) % 3];
        ellipsoid.angular[(i, i)] + 0.6 * displaced
    });
    let linear = ellipsoid.linear.diagonal();
    let height = match *solid {
        Solid::Cuboid { lengths } => lengths.x,
        Solid::Cylinder { height, .. } | Solid::Cone { height, .. } => height,
        Solid::Capsule { length, .. } => length,
    };
    let coupling = solid.volume() * height;
    [
        linear.x, linear.y, linear.z, about_x, about_y, about_z, coupling,
    ]
}

impl Table {
    const SOLIDS: [&'static str; 4] = ["cuboid", "cylinder", "cone", "capsule"];
    const HEADER: &'static str =
        "solid,log2_ratio,log2_second_ratio,k_1,k_2,k_3,k_about_1,k_about_2,k_about_3,coupling";

    fn shipped() -> &'static Self {
        static SHIPPED: OnceLock<Table> = OnceLock::new();
        SHIPPED.get_or_init(|| {
            Self::from_csv(include_str!("added_mass.csv")).expect("the shipped table is whole")
        })
    }

    /// Reads the rows of all solids, in the order in which the grids have them.
    fn from_csv(text: &str) -> Result<Self, Error> {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let header = lines.next().unwrap_or_default() == Self::HEADER;
        Error::check("header of the table", 0.0, header, Self::HEADER)?;
        let mut places: [Vec<[i32; 2]>; 4] = Default::default();
        let mut rows: [Vec<Row>; 4] = Default::default();
        for line in lines {
            let mut fields = line.split(',');
            let name = fields.next().unwrap_or_default();
            let numbers: Vec<f64> = fields.map(|f| f.parse().unwrap_or(f64::NAN)).collect();
            Error::check_length("numbers of a row", 9, numbers.len())?;
            Error::check_all_finite("number of a row", &numbers)?;
            let kind = Self::SOLIDS.iter().position(|solid| *solid == name);
            let kind = kind.ok_or(Error::WrongLength {
                what: "solids of that name",
                expected: 1,
                actual: 0,
            })?;
            places[kind].push([numbers[0] as i32, numbers[1] as i32]);
            rows[kind].push(std::array::from_fn(|i| numbers[2 + i]));
        }
        let mut grids = Vec::new();
        for (kind, (places, rows)) in places.into_iter().zip(rows).enumerate() {
            grids.push(Grid::new(kind, &places, rows)?);
        }
        let grids = grids.try_into().expect("as many grids as solids");
        Ok(Self(grids))
    }
}

impl Grid {
    /// Of rows in order, as printed: ratios to the displaced mass.
    fn new(kind: usize, places: &[[i32; 2]], mut rows: Vec<Row>) -> Result<Self, Error> {
        let first = places.first().copied().unwrap_or_default();
        let last = places.last().copied().unwrap_or_default();
        let count = [0, 1].map(|i| (last[i] - first[i] + 1).max(0) as usize);
        Error::check_length("rows of a grid", count[0] * count[1], rows.len())?;
        for (i, (place, row)) in places.iter().zip(&mut rows).enumerate() {
            let expected = [
                (i / count[1]) as i32 + first[0],
                (i % count[1]) as i32 + first[1],
            ];
            Error::check("place of a row", i as f64, *place == expected, "in order")?;
            let solid = Solid::with_ratios(kind, place.map(|x| math::exp2(f64::from(x))));
            let (volume, moments) = (solid.volume(), solid.second_moment());
            let divisors = divisors(&solid);
            for (j, value) in row.iter_mut().enumerate() {
                let displaced = match j {
                    0..3 => volume,
                    3..6 => moments[(j + 1) % 3] + moments[(j + 2) % 3],
                    _ => divisors[6],
                };
                *value *= displaced / divisors[j];
            }
        }
        Ok(Self {
            first,
            count,
            cuboid: kind == 0,
            capsule: kind == 3,
            rows,
        })
    }

    /// The quotients at a place, those at the border beyond it.
    fn at(&self, x: f64, y: f64) -> Row {
        let place = [x, y];
        let (mut low, mut share) = ([0; 2], [0.0; 2]);
        for i in 0..2 {
            let at = (place[i] - f64::from(self.first[i])).clamp(0.0, (self.count[i] - 1) as f64);
            low[i] = (at as usize).min(self.count[i].saturating_sub(2));
            share[i] = at - low[i] as f64;
        }
        let row = |i: isize, j: isize| self.beyond(low[0] as isize + i, low[1] as isize + j);
        std::array::from_fn(|column| {
            let along = |i: isize| cubic([-1, 0, 1, 2].map(|j| row(i, j)[column]), share[1]);
            cubic([-1, 0, 1, 2].map(along), share[0])
        })
    }

    /// A row of the grid, or one step beyond its border. Of a box that is one whose edges have another order; else it is
    /// what the parabola through the last three says.
    fn beyond(&self, i: isize, j: isize) -> Row {
        if self.cuboid && (i < 0 || j < 0) {
            return self.of_edges([i + j, j, 0]);
        }
        let counts = self.count.map(|count| count as isize);
        if counts[0] > 1 && !(0..counts[0]).contains(&i) {
            let step = if i < 0 { 1 } else { -1 };
            let [a, b, c] = [1, 2, 3].map(|n| self.beyond(i + n * step, j));
            let even = |k: usize| self.capsule && i < 0 && (3..6).contains(&k);
            return std::array::from_fn(|k| match even(k) {
                true => b[k],
                false => 3.0 * (a[k] - b[k]) + c[k],
            });
        }
        if counts[1] > 1 && !(0..counts[1]).contains(&j) {
            let step = if j < 0 { 1 } else { -1 };
            let [a, b, c] = [1, 2, 3].map(|n| self.beyond(i, j + n * step));
            return std::array::from_fn(|k| 3.0 * (a[k] - b[k]) + c[k]);
        }
        let (i, j) = (i.clamp(0, counts[0] - 1), j.clamp(0, counts[1] - 1));
        self.rows[(i * counts[1] + j) as usize]
    }

    /// The row of a box with edges of these logarithms, in any order.
    fn of_edges(&self, edges: [isize; 3]) -> Row {
        let mut order = [0, 1, 2];
        order.sort_by(|i, j| edges[*j].cmp(&edges[*i]));
        let [a, b, c] = order.map(|i| edges[i]);
        let sorted = self.beyond(a - b, b - c);
        let mut row = sorted;
        for (i, edge) in order.into_iter().enumerate() {
            (row[edge], row[3 + edge]) = (sorted[i], sorted[3 + i]);
        }
        row
    }
}

/// Catmull and Rom's cubic between the second and the third of four values.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (slope, next) = (0.5 * (c - a), 0.5 * (d - b));
    b + t * (slope + t * (3.0 * (c - b) - 2.0 * slope - next + t * (2.0 * (b - c) + slope + next)))
}

impl Solid {
    /// The solid of a grid with these ratios: of its first to the second edge and the second to the third; of height to
    /// diameter.
    fn with_ratios(kind: usize, [first, second]: [f64; 2]) -> Self {
        let (radius, height) = (0.5, first);
        match kind {
            0 => Self::Cuboid {
                lengths: Vector3::new(first * second, second, 1.0),
            },
            1 => Self::Cylinder { radius, height },
            2 => Self::Cone { radius, height },
            _ => Self::Capsule {
                radius,
                length: height,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table that lacks a row, has one twice, a word for a number, or a solid that there is not, is refused whole.
    #[test]
    fn broken_tables_are_refused() {
        let whole = include_str!("added_mass.csv");
        assert!(Table::from_csv(whole).is_ok());
        assert!(Table::from_csv("").is_err());
        let lines: Vec<&str> = whole.lines().collect();
        for i in (3..lines.len()).step_by(7) {
            let (before, after) = (lines[..i].join("\n"), lines[i + 1..].join("\n"));
            let with = |line: &str| Table::from_csv(&format!("{before}\n{line}\n{after}"));
            let row = lines[i];
            assert!(with(row).is_ok(), "{row}");
            assert!(with("").is_err(), "{row}");
            assert!(with(&format!("{row}\n{row}")).is_err(), "{row}");
            assert!(with(&row[..row.len() / 2]).is_err(), "{row}");
            assert!(with(&row.replacen(',', ",x", 1)).is_err(), "{row}");
            assert!(with(&row.replacen('c', "k", 1)).is_err(), "{row}");
        }
    }

    /// On its rows the table is what it says: of a cube, of a box that is given in another order, of a cylinder.
    #[test]
    fn rows_are_found_again() {
        let of = |solid| {
            added_mass(&Placed {
                solid,
                axis: 0,
                sign: 1.0,
            })
        };
        let cuboid = |x, y, z| Solid::Cuboid {
            lengths: Vector3::new(x, y, z),
        };
        let cube = of(cuboid(2.0, 2.0, 2.0));
        assert!((cube.linear[(1, 1)] / 8.0 - 6.38525e-1).abs() < 1e-9);
        // Edges of 1, 4 and 2: twice a ratio of 2.
        let row = [
            2.30837e-1, 5.30563e-1, 1.55874, 5.06189e-1, 9.01695e-1, 2.92215e-1,
        ];
        let solid = cuboid(1.0, 4.0, 2.0);
        let (found, moments) = (of(solid), solid.second_moment());
        for (axis, place) in [(1, 0), (2, 1), (0, 2)] {
            let displaced = moments[(axis + 1) % 3] + moments[(axis + 2) % 3];
            assert!((found.linear[(axis, axis)] / 8.0 / row[place] - 1.0).abs() < 1e-9);
            let about = found.angular[(axis, axis)] / displaced;
            assert!((about / row[3 + place] - 1.0).abs() < 1e-9);
        }
        let cylinder = of(Solid::Cylinder {
            radius: 0.5,
            height: 2.0,
        });
        let volume = std::f64::consts::FRAC_PI_2;
        assert!((cylinder.linear[(0, 0)] / volume - 3.06055e-1).abs() < 1e-9);
    }
}
