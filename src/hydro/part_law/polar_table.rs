//! Lift, drag and moment by the angle of attack, from a table.

use super::place::{PartPlace, at, velocity_at};
use crate::error::Error;
use crate::math;
use crate::math::spatial::{Blocks, Twist, cross, dot, product, skew};
use crate::math::{Scalar, scalar_struct};
use rapier3d::na::{Matrix3, Vector3};
use std::sync::Arc;

/// Angles of the table that a step reads: one per degree, both ends.
const ANGLES: usize = 361;
/// Degrees over which a table's end passes to the plate that continues it.
const BLEND: f64 = 15.0;

/// Coefficients at one angle of attack.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PolarRow {
    /// Angle of attack, degrees, from −180 to 180.
    pub angle: f64,
    /// C_L.
    pub lift: f64,
    /// C_D, not negative.
    pub drag: f64,
    /// C_M about the point that the table refers to, nose up.
    pub moment: f64,
}

/// Lift, drag and pitching moment of a wing section or a body by its angle of attack, and by Reynolds number if
/// there are several.
///
/// The section moves *forward* with its leading edge and has an *upper* side; α is positive where the flow meets the
/// lower side. Forces are `½ρA|v|² C` with the velocity v of the [reference point](PolarTable::with_axes) through the
/// fluid in the plane of the two, the moment is that times the chord. What moves along the span is not felt.
///
/// Between its angles a table is linear. One that does not reach ±180° is continued by a flat plate's
/// forces, `C_N = 1.98 sin|α|/(0.56 + 0.44 sin|α|)` along the normal (Hoerner, *Fluid-Dynamic Drag*, 3-16, in two dimensions), in the middle of the
/// chord, over 15° from its ends.
///
/// As text, one row per line: `angle, C_L, C_D[, C_M]`, in degrees, `#` before comments; `re = 100000` on a line of its own
/// begins the table of another Reynolds number.
///
/// ```
/// use rapier3d_immersed::PolarTable;
///
/// let section = PolarTable::from_csv("
///     # angle, C_L, C_D, C_M
///     -10, -0.9, 0.05, 0.0
///       0,  0.0, 0.01, 0.0
///      10,  0.9, 0.05, 0.0
///      14,  1.1, 0.11, -0.02
/// ")?;
/// assert!((section.at(5.0, 1e5).lift - 0.45).abs() < 1e-9);
/// // Continued as a plate: broadside on it has drag alone.
/// assert!((section.at(90.0, 1e5).drag - 2.0).abs() < 1e-9);
/// let gap = PolarTable::from_csv("0, 0, 0.01\n5, 0.5\n").unwrap_err();
/// assert!(gap.to_string().contains("row 2"), "{gap}");
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct PolarTable {
    /// Reynolds numbers (on the chord), rising, and the rows of each, one per degree from −180°.
    tables: Arc<Vec<(f64, Vec<Row>)>>,
    facing: Facing,
    /// The point that C_M refers to, in chords ahead of the planform's center.
    reference: f64,
}

/// Where the leading edge of a section is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
enum Facing {
    /// Along the shorter axis of the planform, the upper side along its normal.
    Planform,
    /// Forward and upper directions in the part's frame.
    Axes([Vector3<f64>; 2]),
    /// Wherever a body of revolution about this direction moves.
    Round(Vector3<f64>),
}

/// What a table is at one degree: C_L, C_D, C_M, and how much of C_L and C_D is the normal force of the plate that
/// continues the table, whose moment depends on the reference point.
type Row = [f64; 4];

impl PolarTable {
    /// A table for all Reynolds numbers. `rows` need not be sorted.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`], [`Error::OutOfRange`] or [`Error::NotFinite`] names what cannot be: fewer than two
    /// rows, an angle beyond ±180° or twice there, a gap of more than 90° between neighbours, a negative C_D.
    pub fn new(rows: &[PolarRow]) -> Result<Self, Error> {
        Self::by_reynolds_number(&[(1.0, rows)])
    }

    /// Tables at Reynolds numbers (on the chord), between which coefficients are linear in its logarithm.
    ///
    /// # Errors
    /// Those of [`PolarTable::new`], and [`Error::InvalidParameter`] for Reynolds numbers that do not rise.
    pub fn by_reynolds_number(tables: &[(f64, &[PolarRow])]) -> Result<Self, Error> {
        let enough = !tables.is_empty();
        Error::check(
            "number of polar tables",
            tables.len() as f64,
            enough,
            "at least 1",
        )?;
        let mut known: Vec<(f64, Vec<Row>)> = Vec::new();
        for (re, rows) in tables {
            Error::check_positive("Reynolds number of a polar table", *re)?;
            let rises = known.last().is_none_or(|(before, _)| before < re);
            Error::check(
                "Reynolds number of a polar table",
                *re,
                rises,
                "rising from table to table",
            )?;
            known.push((*re, whole_circle(rows)?));
        }
        Ok(Self {
            tables: Arc::new(known),
            facing: Facing::Planform,
            reference: 0.25,
        })
    }

    /// Reads a table from text: see [`PolarTable`].
    ///
    /// # Errors
    /// [`Error::UnreadableRow`] names a row that is none; those of [`PolarTable::by_reynolds_number`].
    pub fn from_csv(text: &str) -> Result<Self, Error> {
        let mut tables: Vec<(f64, Vec<PolarRow>)> = Vec::new();
        let mut row = 0;
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default().trim();
            if line.is_empty() {
                continue;
            }
            let unreadable = |row: usize| Error::UnreadableRow {
                row,
                text: line.to_owned(),
            };
            if let Some((name, value)) = line.split_once('=') {
                let re = value.trim().parse().map_err(|_| unreadable(row + 1))?;
                if !name.trim().eq_ignore_ascii_case("re") {
                    return Err(unreadable(row + 1));
                }
                tables.push((re, Vec::new()));
                continue;
            }
            row += 1;
            let numbers: Result<Vec<f64>, _> =
                line.split(',').map(|cell| cell.trim().parse()).collect();
            let (angle, lift, drag, moment) = match numbers.as_deref() {
                Ok([angle, lift, drag]) => (*angle, *lift, *drag, 0.0),
                Ok([angle, lift, drag, moment]) => (*angle, *lift, *drag, *moment),
                // The names of the columns.
                Err(_) if row == 1 && tables.is_empty() && line.contains(char::is_alphabetic) => {
                    row = 0;
                    continue;
                }
                _ => return Err(unreadable(row)),
            };
            if tables.is_empty() {
                tables.push((1.0, Vec::new()));
            }
            if let Some((_, rows)) = tables.last_mut() {
                rows.push(PolarRow {
                    angle,
                    lift,
                    drag,
                    moment,
                });
            }
        }
        let tables: Vec<(f64, &[PolarRow])> = tables
            .iter()
            .map(|(re, rows)| (*re, rows.as_slice()))
            .collect();
        Self::by_reynolds_number(&tables)
    }

    /// The same table for a section whose leading edge points `forward` and whose upper side `up`, in the
    /// part's frame; its moments refer to a point `reference` chords ahead of the planform's center (¼ by default: the
    /// quarter chord). Without this the section faces along the shorter axis of its planform, with the upper side along its normal.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::InvalidParameter`] if the two directions are not at right angles or of no length,
    /// [`Error::OutOfRange`] if the point is more than a chord away.
    pub fn with_axes(
        self,
        forward: Vector3<f64>,
        up: Vector3<f64>,
        reference: f64,
    ) -> Result<Self, Error> {
        Error::check_all_finite("forward direction of a polar", forward.as_slice())?;
        Error::check_all_finite("upper direction of a polar", up.as_slice())?;
        Error::check_positive("length of the forward direction of a polar", forward.norm())?;
        Error::check_positive("length of the upper direction of a polar", up.norm())?;
        let (forward, up) = (forward.normalize(), up.normalize());
        let cosine = forward.dot(&up);
        Error::check(
            "cosine between forward and upper direction of a polar",
            cosine,
            cosine.abs() < 1e-3,
            "zero",
        )?;
        Error::check_range("reference point of a polar", reference, -1.0, 1.0)?;
        let up = (up - forward * cosine).normalize();
        Ok(Self {
            facing: Facing::Axes([forward, up]),
            reference,
            ..self
        })
    }

    /// The same table for a body of revolution about `up`, in the part's frame: it faces wherever it moves, however
    /// it spins. Angles of attack are those from −90° to 90°; moments refer to the planform's center, and the chord is the
    /// diameter.
    ///
    /// ```
    /// use rapier3d_immersed::PolarTable;
    /// use rapier3d_immersed::rapier3d::na::Vector3;
    ///
    /// let disc = PolarTable::from_csv("-90, 0, 1.1\n0, 0, 0.02\n90, 0, 1.1")?;
    /// let disc = disc.with_revolution(Vector3::y())?;
    /// # drop(disc);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotFinite`], or [`Error::InvalidParameter`] if the direction is of no length.
    pub fn with_revolution(self, up: Vector3<f64>) -> Result<Self, Error> {
        Error::check_all_finite("upper direction of a polar", up.as_slice())?;
        Error::check_positive("length of the upper direction of a polar", up.norm())?;
        Ok(Self {
            facing: Facing::Round(up.normalize()),
            reference: 0.0,
            ..self
        })
    }

    /// The coefficients at an angle of attack, degrees, and a Reynolds number.
    pub fn at(&self, angle: f64, reynolds_number: f64) -> PolarRow {
        let [lift, drag, moment] = self.coefficients(angle, math::ln(reynolds_number.max(1e-9)));
        PolarRow {
            angle,
            lift,
            drag,
            moment,
        }
    }

    fn coefficients(&self, angle: f64, log_re: f64) -> [f64; 3] {
        let place = (angle.clamp(-180.0, 180.0) + 180.0).min(ANGLES as f64 - 1.000001);
        let (index, share) = (place as usize, place.fract());
        let of = |table: usize| {
            let rows = &self.tables[table].1;
            let (a, b) = (&rows[index], &rows[(index + 1).min(ANGLES - 1)]);
            let mix = |i: usize| a[i] + share * (b[i] - a[i]);
            // The plate's force is in its middle.
            [mix(0), mix(1), mix(2) - self.reference * mix(3)]
        };
        let above = self
            .tables
            .partition_point(|(re, _)| math::ln(*re) < log_re);
        if above == 0 || above == self.tables.len() {
            return of(above.min(self.tables.len() - 1));
        }
        let (low, high) = (
            math::ln(self.tables[above - 1].0),
            math::ln(self.tables[above].0),
        );
        let share = (log_re - low) / (high - low);
        let (low, high) = (of(above - 1), of(above));
        [0, 1, 2].map(|i| low[i] + share * (high[i] - low[i]))
    }
}

/// One row per degree over the whole circle.
fn whole_circle(rows: &[PolarRow]) -> Result<Vec<Row>, Error> {
    let enough = rows.len() >= 2;
    Error::check(
        "number of rows of a polar table",
        rows.len() as f64,
        enough,
        "at least 2",
    )?;
    let mut sorted = rows.to_vec();
    for row in &sorted {
        Error::check_range("angle of a polar table", row.angle, -180.0, 180.0)?;
        Error::check_all_finite(
            "coefficients of a polar table",
            &[row.lift, row.drag, row.moment],
        )?;
        Error::check_not_negative("drag of a polar table", row.drag)?;
    }
    sorted.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    for pair in sorted.windows(2) {
        let gap = pair[1].angle - pair[0].angle;
        Error::check(
            "step between angles of a polar table",
            gap,
            gap > 0.0,
            "positive",
        )?;
        Error::check_range(
            "step between angles of a polar table, degrees",
            gap,
            0.0,
            90.0,
        )?;
    }
    let known = |row: &PolarRow| [row.lift, row.drag, row.moment, 0.0];
    let plate = |angle: f64| {
        let (sine, cosine) = math::sin_cos(angle.to_radians());
        let normal = 1.98 * sine / (0.56 + 0.44 * sine.abs());
        [normal * cosine, normal * sine + 0.02, 0.0, normal]
    };
    let row = |degree: i32| {
        let angle = f64::from(degree);
        let above = sorted
            .partition_point(|row| row.angle < angle)
            .clamp(1, sorted.len() - 1);
        let (a, b) = (&sorted[above - 1], &sorted[above]);
        let outside = (a.angle - angle).max(angle - b.angle);
        if outside > 0.0 {
            let end = if angle < a.angle { a } else { b };
            mixed(known(end), plate(angle), (outside / BLEND).min(1.0))
        } else {
            let share = (angle - a.angle) / (b.angle - a.angle);
            mixed(known(a), known(b), share)
        }
    };
    Ok((-180..=180).map(row).collect())
}

fn mixed(a: Row, b: Row, share: f64) -> Row {
    [0, 1, 2, 3].map(|i| a[i] + share * (b[i] - a[i]))
}

scalar_struct! {
    /// What a step needs of a [`PolarTable`] besides its rows; part axes, the place's position is the reference
    /// point.
    pub(crate) struct PolarConstants<T> {
        forward: Vector3<T>,
        up: Vector3<T>,
        /// ½ρA over the mass scale, 1/m.
        dynamic_area: T,
        /// Chord, L.
        chord: T,
        /// Speed × this = Re.
        reynolds_scale: T,
    }
}

/// What a part has that a table is applied to.
pub(super) struct Section {
    /// Planform area, m², and its chord, m.
    pub area: f64,
    pub chord: f64,
    pub density: f64,
    pub kinematic_viscosity: f64,
}

impl PolarConstants<f64> {
    /// Directions in the axes of the planform, whose own they are unless the table has others in the part's frame, which
    /// `to_plate` turns.
    pub(super) fn new(
        table: &PolarTable,
        section: &Section,
        to_plate: &Matrix3<f64>,
        mass: f64,
        length: f64,
    ) -> Self {
        let [forward, up] = match table.facing {
            Facing::Planform => [Vector3::y(), Vector3::z()],
            Facing::Axes(axes) => axes.map(|a| to_plate * a),
            // Forward is known when it moves.
            Facing::Round(up) => [Vector3::zeros(), to_plate * up],
        };
        Self {
            forward,
            up,
            dynamic_area: 0.5 * section.density * section.area / mass,
            chord: section.chord / length,
            reynolds_scale: section.chord / section.kinematic_viscosity,
        }
    }

    /// Where the reference point is from the planform's center, m, in its axes.
    pub(super) fn reference(
        table: &PolarTable,
        forward: &Vector3<f64>,
        chord: f64,
    ) -> Vector3<f64> {
        forward * (table.reference * chord)
    }
}

impl<T: Scalar> PolarConstants<T> {
    #[inline(always)]
    pub fn matrix(
        &self,
        table: &PolarTable,
        place: &PartPlace<T>,
        v: &Twist<T>,
        factors: [T; 2],
    ) -> Blocks<T> {
        let up = place.out(&self.up);
        let u = velocity_at(v, &place.position);
        let rising = dot(&u, &up);
        let round = matches!(table.facing, Facing::Round(_));
        let forward = if round {
            let along = u - up * rising;
            let speed = dot(&along, &along).sqrt();
            along * (speed.constant(1.0) / speed.max(speed.constant(1e-6)))
        } else {
            place.out(&self.forward)
        };
        let ahead = dot(&u, &forward);
        let speed2 = ahead * ahead + rising * rising;
        let speed = speed2.sqrt();
        let [lift, drag, moment] = T::by_lane([ahead, rising, speed * self.reynolds_scale], |v| {
            let angle = math::atan2(-v[1], v[0]).to_degrees();
            table.coefficients(angle, math::ln(v[2].max(1e-9)))
        });
        let by_speed = self.dynamic_area * speed;
        // Drag on both directions of the plane, lift that turns from forward to up.
        let resistance = by_speed * drag * factors[0];
        let zero = speed.constant(0.0);
        let entry = |i: usize, j: usize| {
            if !round {
                -(forward[i] * forward[j] + up[i] * up[j]) * resistance
            } else if i == j {
                // A body of revolution also resists what turns its motion aside within the step.
                -resistance
            } else {
                zero
            }
        };
        let (xy, xz, yz) = (entry(0, 1), entry(0, 2), entry(1, 2));
        let drag = Matrix3::new(
            entry(0, 0),
            xy,
            xz,
            xy,
            entry(1, 1),
            yz,
            xz,
            yz,
            entry(2, 2),
        );
        let span = cross(&forward, &up);
        let g = drag + skew(&(span * (by_speed * lift * factors[1])));
        let n = at(&g, &place.position);
        // The moment over the speed; the motion along which it acts is braked by as much power as it gives.
        let torque = span * (by_speed * self.chord * moment * factors[1]);
        let per = speed.constant(1.0) / speed.max(speed.constant(1e-6));
        let along = (forward * ahead + up * rising) * per;
        let e = |i: usize, j: usize| along[i] * torque[j];
        let braked = Matrix3::new(
            e(0, 0),
            e(0, 1),
            e(0, 2),
            e(1, 0),
            e(1, 1),
            e(1, 2),
            e(2, 0),
            e(2, 1),
            e(2, 2),
        );
        let turned = braked.transpose();
        let r = skew(&place.position);
        Blocks {
            m11: n.m11,
            m12: n.m12 - braked,
            m21: n.m21 + turned,
            m22: n.m22 - product(&r, &braked) - product(&turned, &r),
        }
    }
}
