//! Whether what a shape's properties say can be true: they are plain data, which a user may have changed or
//! a file may have held.

use super::HydroProperties;
use crate::error::Error;

/// How far the volume of a hull may be from the displaced one, as a share of it.
const HULL_ROUNDING: f64 = 1e-3;

impl HydroProperties {
    /// Checks every number.
    ///
    /// ```
    /// use rapier3d_immersed::HydroProperties;
    /// use rapier3d_immersed::rapier3d::prelude::*;
    ///
    /// let mut ball = HydroProperties::from_shape(&Ball::new(0.1))?;
    /// assert!(ball.check().is_ok());
    /// ball.volume = -1.0;
    /// assert!(ball.check().unwrap_err().to_string().contains("displaced volume"));
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidParameter`], [`Error::OutOfRange`], [`Error::NotFinite`] or
    /// [`Error::UnphysicalAddedMass`] names the first that cannot be; those of [`Hull::check`](crate::Hull::check).
    pub fn check(&self) -> Result<(), Error> {
        self.check_numbers()?;
        self.check_hulls()
    }

    /// Checks the hull, and those of the parts: that takes a while where it has many triangles.
    pub(crate) fn check_hulls(&self) -> Result<(), Error> {
        self.hull.check()?;
        let enclosed = self.hull.volume() / self.volume;
        Error::check(
            "volume that the hull encloses over the displaced volume",
            enclosed,
            (enclosed - 1.0).abs() <= HULL_ROUNDING,
            "1 within 1e-3",
        )?;
        self.parts.iter().try_for_each(Self::check_hulls)
    }

    /// Checks all but the hulls.
    pub(crate) fn check_numbers(&self) -> Result<(), Error> {
        Error::check_positive("displaced volume", self.volume)?;
        Error::check_all_finite("center of buoyancy", self.centroid.as_slice())?;
        Error::check_all_finite("reference point", self.reference.as_slice())?;
        if !self.added_mass.is_physical() {
            return Err(Error::UnphysicalAddedMass);
        }
        let plate = &self.planform;
        let axes = plate.axes.matrix();
        Error::check_all_finite("planform axes", axes.as_slice())?;
        let skewness = (axes * axes.transpose()).map_with_location(|i, j, x| {
            let identity = if i == j { 1.0 } else { 0.0 };
            (x - identity).abs()
        });
        let rotation = skewness.max() < 1e-6 && axes.determinant() > 0.0;
        Error::check("planform axes", skewness.max(), rotation, "a rotation")?;
        Error::check_all_finite("planform center", plate.center.as_slice())?;
        Error::check_positive("planform area", plate.area)?;
        for extent in plate.half_extents.iter() {
            Error::check_positive("planform half extent", *extent)?;
        }
        Error::check_not_negative("planform thickness", plate.thickness)?;
        for moment in plate.second_moment.iter().chain(&plate.third_moment) {
            Error::check_not_negative("planform moment", *moment)?;
        }
        let whole = plate.fraction > 0.0 && plate.fraction <= 1.0 + 1e-9;
        Error::check(
            "fraction of a planform",
            plate.fraction,
            whole,
            "positive and at most 1",
        )?;
        let semi_axes = &self.proxy.semi_axes;
        for semi_axis in semi_axes.iter() {
            Error::check_not_negative("proxy semi-axis", *semi_axis)?;
        }
        // An elliptic disc has one semi-axis of zero; what has two shows no shadow at all.
        let positive = semi_axes.iter().filter(|semi_axis| **semi_axis > 0.0);
        let count = positive.count();
        let enough = count >= 2;
        Error::check(
            "proxy semi-axes above zero",
            count as f64,
            enough,
            "at least two",
        )?;
        if let Some(bluff) = &self.bluff {
            bluff.check()?;
        }
        for part in &self.parts {
            let nested = part.parts.len() as f64;
            Error::check("parts of a part", nested, nested == 0.0, "none")?;
            part.check_numbers()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::parry::shape::Cuboid;

    type Field = fn(&mut HydroProperties) -> &mut f64;

    /// Each field in turn is made what it cannot be, by every value that cannot be.
    #[test]
    fn each_field_is_checked() {
        let half = rapier3d::math::Vector::new(0.04, 0.001, 0.02);
        let good = HydroProperties::from_shape(&Cuboid::new(half)).unwrap();
        good.check().unwrap();
        let fields: [(&str, Field, &[f64]); 14] = [
            ("fraction", |h| &mut h.planform.fraction, &[0.0, -1.0, 1.1]),
            ("volume", |h| &mut h.volume, &[0.0, -1.0]),
            ("centroid", |h| &mut h.centroid.x, &[]),
            ("reference", |h| &mut h.reference.y, &[]),
            ("added mass", |h| &mut h.added_mass.linear[(0, 0)], &[-1.0]),
            ("center", |h| &mut h.planform.center.z, &[]),
            (
                "axes",
                |h| &mut h.planform.axes.matrix_mut_unchecked()[(1, 2)],
                &[3.0],
            ),
            ("area", |h| &mut h.planform.area, &[0.0, -1.0]),
            (
                "half extent",
                |h| &mut h.planform.half_extents.y,
                &[0.0, -1.0],
            ),
            ("thickness", |h| &mut h.planform.thickness, &[-1.0]),
            (
                "second moment",
                |h| &mut h.planform.second_moment.x,
                &[-1.0],
            ),
            ("third moment", |h| &mut h.planform.third_moment.y, &[-1.0]),
            ("x", |h| &mut h.proxy.semi_axes.x, &[-1.0]),
            ("z", |h| &mut h.proxy.semi_axes.z, &[-1.0]),
        ];
        for (name, field, values) in fields {
            for value in values.iter().chain(&[f64::NAN, f64::INFINITY]) {
                let mut bad = good.clone();
                *field(&mut bad) = *value;
                assert!(bad.check().is_err(), "{name} {value}");
            }
        }
        // A hull that encloses another volume, a hole, a corner that is no number, and one that is not there.
        type Change = fn(&mut Vec<rapier3d::na::Vector3<f64>>, &mut Vec<[u32; 3]>);
        let changes: [(Change, &str); 4] = [
            (
                |v, _| v.iter_mut().for_each(|v| v.x *= 1.01),
                "the hull encloses",
            ),
            (|_, t| t.truncate(11), "edge"),
            (|v, _| v[1].y = f64::NAN, "vertex 1"),
            (|_, t| t[0][1] = 99, "99"),
        ];
        for (change, named) in changes {
            let mut bad = good.clone();
            let super::super::Hull::Polyhedron {
                vertices,
                triangles,
            } = &mut bad.hull
            else {
                panic!("a box is a polyhedron");
            };
            change(vertices, triangles);
            let problem = bad.check().unwrap_err().to_string();
            assert!(problem.contains(named), "{problem}");
        }
        let mut point = good.clone();
        point.proxy.semi_axes *= 0.0;
        assert!(point.check().is_err());
        // Longer, shorter, and mirrored.
        for factor in [2.0, 0.9, -1.0] {
            let mut skewed = good.clone();
            let axes = skewed.planform.axes.matrix() * factor;
            skewed.planform.axes = rapier3d::na::Rotation3::from_matrix_unchecked(axes);
            assert!(skewed.check().is_err(), "{factor}");
        }
    }
}
