//! The hull that Wigley tested: its sides are parabolas both ways, y = ½B (1 − (2x/L)²)(1 − (z/T)²) under water, so that
//! volume, waterplane and metacenter are closed forms. Here with upright sides above the waterline, and a deck.

use crate::support::Vec3;
use std::fmt::Write;

/// A hull by its dimensions, m: x forward, y up from the waterline, z to starboard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wigley {
    /// Between the stems.
    pub length: f64,
    /// At the waterline amidships.
    pub beam: f64,
    /// Of the keel under the waterline.
    pub draft: f64,
    /// Of the deck over the waterline.
    pub freeboard: f64,
}

/// The dinghy of `wigley.obj`.
pub const DINGHY: Wigley = Wigley {
    length: 4.0,
    beam: 1.0,
    draft: 0.3,
    freeboard: 0.35,
};

/// Cells of its mesh along a side, and from the keel up to the waterline.
pub const CELLS: [usize; 2] = [14, 5];

impl Wigley {
    /// Volume under the waterline: ⁴⁄₉ L B T, m³.
    pub fn displacement(&self) -> f64 {
        4.0 / 9.0 * self.length * self.beam * self.draft
    }

    /// Area of the waterplane: ⅔ L B, m².
    pub fn waterplane(&self) -> f64 {
        2.0 / 3.0 * self.length * self.beam
    }

    /// Height of the metacenter over the waterline, m: BM = I/V = ³⁄₃₅ B²/T over the center of buoyancy, ⅜ T under it.
    pub fn metacenter(&self) -> f64 {
        3.0 / 35.0 * self.beam * self.beam / self.draft - 3.0 / 8.0 * self.draft
    }

    /// Vertices and triangles of a mesh of so many cells along a side and from keel to waterline.
    pub fn mesh(&self, [along, down]: [usize; 2]) -> (Vec<Vec3>, Vec<[usize; 3]>) {
        // Rows from the keel up, the last one being the deck's edge.
        let rows = down + 1;
        let mut vertices = Vec::new();
        let mut number = vec![vec![[0; 2]; along + 1]; rows + 1];
        for (row, numbers) in number.iter_mut().enumerate() {
            let depth = (down - row.min(down)) as f64 / down as f64;
            let y = if row > down {
                self.freeboard
            } else {
                -self.draft * depth
            };
            for (i, numbers) in numbers.iter_mut().enumerate() {
                let s = 2.0 * i as f64 / along as f64 - 1.0;
                let half = 0.5 * self.beam * (1.0 - s * s) * (1.0 - depth * depth);
                // Both sides share the keel and the stems.
                let sides: &[f64] = if half > 0.0 { &[-1.0, 1.0] } else { &[1.0] };
                for side in sides {
                    vertices.push(Vec3::new(0.5 * self.length * s, y, side * half));
                }
                let last = vertices.len() - 1;
                *numbers = [last + 1 - sides.len(), last];
            }
        }
        let mut triangles = Vec::new();
        let mut quad = |corners: [usize; 4], other: bool| {
            let [a, b, c, d] = corners;
            let halves = if other {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            let whole = |t: &[usize; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
            triangles.extend(halves.into_iter().filter(whole));
        };
        for i in 0..along {
            for row in 0..rows {
                let at = |i: usize, row: usize, side: usize| number[row][i][side];
                // Diagonals alternate, so that what they cut off and add cancels.
                let other = (i + row).is_multiple_of(2);
                let outline = |side| {
                    [
                        at(i, row, side),
                        at(i + 1, row, side),
                        at(i + 1, row + 1, side),
                        at(i, row + 1, side),
                    ]
                };
                quad(outline(1), other);
                let [a, b, c, d] = outline(0);
                quad([d, c, b, a], other);
            }
            let deck = |i: usize, side: usize| number[rows][i][side];
            quad(
                [deck(i, 0), deck(i, 1), deck(i + 1, 1), deck(i + 1, 0)],
                i % 2 == 0,
            );
        }
        (vertices, triangles)
    }

    /// The mesh as an OBJ file.
    pub fn obj(&self, cells: [usize; 2]) -> String {
        let (vertices, triangles) = self.mesh(cells);
        let mut text = format!(
            "# Wigley's hull, of a formula (examples/boat/wigley.rs): z = B/2 (1 - (2x/L)^2)(1 - (y/T)^2) under water,\n\
             # upright sides above. L {}, B {}, T {}, freeboard {} m; x forward, y up from the waterline.\n",
            self.length, self.beam, self.draft, self.freeboard
        );
        for v in &vertices {
            writeln!(text, "v {:.6} {:.6} {:.6}", v.x, v.y, v.z).expect("a string takes anything");
        }
        for t in &triangles {
            let [a, b, c] = t.map(|i| i + 1);
            writeln!(text, "f {a} {b} {c}").expect("a string takes anything");
        }
        text
    }
}
