//! A card that flies by the crate's own dynamics under the thesis's law, thrown in any way.

use super::free_fall::Specimen;
use rapier3d_immersed::rapier3d::na::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// One row of a track: center, m, long axis and normal.
pub const COLUMNS: [&str; 9] = [
    "x", "y", "z", "long x", "long y", "long z", "n x", "n y", "n z",
];
/// Coefficients C̃; velocities in m/s and rad/s, orientation as a rotation vector in rad and
/// position in m at the first frame, all in world axes with z up.
pub const PARAMETERS: [&str; 15] = [
    "C_D", "C_L1", "C_L2", "u0", "v0", "w0", "omega_x0", "omega_y0", "omega_z0", "turn_x0",
    "turn_y0", "turn_z0", "x0", "y0", "z0",
];
/// A card thrown up and aside, nearly flat.
pub const TRUTH: [f64; 15] = [
    0.31, 0.91, 0.61, 0.8, 0.3, 0.5, 3.0, 9.0, 4.0, 0.2, 0.3, -0.4, 0.1, -0.1, 0.2,
];

/// The row of a center and the orientation of a body with its long axis along x, its normal along z.
pub fn measured(position: [f64; 3], orientation: &UnitQuaternion<f64>) -> [f64; 9] {
    let (a, n) = (orientation * Vector3::x(), orientation * Vector3::z());
    let [x, y, z] = position;
    [x, y, z, a.x, a.y, a.z, n.x, n.y, n.z]
}

/// The rows at `times`, as many as `out` holds; not finite where there is no such card.
pub fn simulate(
    card: &Specimen,
    density_ratio: f64,
    parameters: &[f64],
    times: &[f64],
    out: &mut [f64],
) {
    let three = |k: usize| Vector3::from_column_slice(&parameters[k..k + 3]);
    let coefficients = [parameters[0], parameters[1], parameters[2], density_ratio];
    let Ok(mut body) = card.body(&coefficients) else {
        out.fill(f64::NAN);
        return;
    };
    body.set_orientation(UnitQuaternion::from_scaled_axis(three(9)));
    body.set_velocity(three(3), three(6));
    body.position = three(12);
    let mut rows = out.chunks_exact_mut(COLUMNS.len());
    let count = rows.len();
    card.follow(&mut body, &times[..count], |body| {
        if let Some(out) = rows.next() {
            let position = body.position.into();
            out.copy_from_slice(&measured(position, &body.orientation()));
        }
    });
}

/// Where to look, given the first row of a track.
pub fn ranges(first: &[f64]) -> Vec<(f64, f64)> {
    let (a, n) = (
        Vector3::from_column_slice(&first[3..6]),
        Vector3::from_column_slice(&first[6..9]),
    );
    let axes = Matrix3::from_columns(&[a, n.cross(&a), n]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&axes)).scaled_axis();
    let mut ranges = vec![(0.1, 1.0), (0.2, 2.0), (0.1, 2.0)];
    ranges.extend([(-3.0, 3.0); 3]);
    ranges.extend([(-15.0, 15.0); 3]);
    ranges.extend(turn.iter().map(|x| (x - 0.2, x + 0.2)));
    ranges.extend(first[..3].iter().map(|x| (x - 0.1, x + 0.1)));
    ranges
}
