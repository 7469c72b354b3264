//! The shape of a path seen from above (thesis Fig. 3.8).

use crate::motion::trajectory::principal_variances;
use rapier3d::na::{Matrix2, Vector2, Vector3};

/// Measures of the horizontal projection of a path.
///
/// ```
/// use rapier3d_immersed::motion::path::{HorizontalShape, UnifiedCurve};
///
/// let helix = UnifiedCurve::helix(0.1, 0.3, 2.0, 1.0);
/// let turn = std::f64::consts::PI;
/// let points: Vec<_> = (0..240).map(|i| helix.position(turn * f64::from(i) / 240.0)).collect();
/// let shape = HorizontalShape::of(&points);
/// assert_eq!(shape.petals, 4);
/// assert!((shape.extent - 0.13).abs() < 1e-3); // A (1 + ε)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HorizontalShape {
    /// Largest distance of a point from the mean, m. The other numbers mean nothing if it is zero.
    pub extent: f64,
    /// 1 − √(λ₂/λ₁) with the variances λ₁ ≥ λ₂ along the principal axes: 1 for a straight line.
    pub linearity: f64,
    /// 4π area/perimeter² of the closed polygon of the points, at most 1, which a circle has. It means
    /// something for one turn about the mean.
    pub circularity: f64,
    /// Maxima of the distance from the mean that rise above the minima beside them by 5 % of the extent,
    /// for one turn.
    pub petals: usize,
}

impl HorizontalShape {
    /// Measures points at equal intervals; the last is followed by the first.
    pub fn of(points: &[Vector3<f64>]) -> Self {
        let count = points.len().max(1) as f64;
        let flat: Vec<Vector2<f64>> = points.iter().map(|p| Vector2::new(p.x, p.z)).collect();
        let mean = flat.iter().sum::<Vector2<f64>>() / count;
        let mut variance = Matrix2::zeros();
        let (mut area, mut perimeter) = (0.0, 0.0);
        for (i, point) in flat.iter().enumerate() {
            let next = flat[(i + 1) % flat.len()] - mean;
            let point = point - mean;
            variance += point * point.transpose() / count;
            area += 0.5 * (point.x * next.y - point.y * next.x);
            perimeter += (next - point).norm();
        }
        let [large, small] = principal_variances(&variance);
        let radii: Vec<f64> = flat.iter().map(|p| (p - mean).norm()).collect();
        let extent = radii.iter().copied().fold(0.0, f64::max);
        let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
        Self {
            extent,
            linearity: 1.0 - ratio(small, large).sqrt(),
            circularity: ratio(
                4.0 * std::f64::consts::PI * area.abs(),
                perimeter * perimeter,
            ),
            petals: maxima(&radii, 0.05 * extent),
        }
    }
}

/// Maxima of a closed series that stand out by `height`, from the lowest entry around.
fn maxima(values: &[f64], height: f64) -> usize {
    let lowest = (0..values.len()).min_by(|a, b| values[*a].total_cmp(&values[*b]));
    let Some(start) = lowest.filter(|_| height > 0.0) else {
        return 0;
    };
    let (mut count, mut rising) = (0, true);
    let (mut low, mut high) = (values[start], values[start]);
    for i in 0..=values.len() {
        let value = values[(start + i) % values.len()];
        if rising {
            high = high.max(value);
            if high - low > height && value < high - height {
                count += 1;
                (rising, low) = (false, value);
            }
        } else {
            low = low.min(value);
            if value > low + height {
                (rising, high) = (true, value);
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square has 4π/16 and four corners; a line is a line.
    #[test]
    fn known_shapes() {
        let mut square = Vec::new();
        for i in 0..400 {
            let (side, s) = (i / 100, f64::from(i % 100) / 50.0 - 1.0);
            let (x, z) = [(s, -1.0), (1.0, s), (-s, 1.0), (-1.0, -s)][side as usize];
            square.push(Vector3::new(x, 0.0, z));
        }
        let shape = HorizontalShape::of(&square);
        assert!((shape.circularity - std::f64::consts::PI / 4.0).abs() < 1e-12);
        assert_eq!(shape.petals, 4);
        assert!(shape.linearity < 1e-6);
        let line: Vec<_> = (0..50)
            .map(|i| Vector3::new(f64::from(i), 7.0, 2.0 * f64::from(i)))
            .collect();
        let shape = HorizontalShape::of(&line);
        assert!((shape.linearity - 1.0).abs() < 1e-6 && shape.circularity < 1e-12);
    }
}
