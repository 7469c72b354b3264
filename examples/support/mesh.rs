//! A user's own mesh, from an OBJ or STL file.

use super::Vec3;
use rapier3d_immersed::Error;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::Matrix3;
use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

/// Largest mesh file that is read, bytes.
const LARGEST_FILE: u64 = 256 << 20;

/// Triangles as they stand in a file: open or closed, welded or not.
#[derive(Clone, Debug, PartialEq)]
pub struct RawMesh {
    /// Vertices, m.
    pub vertices: Vec<Vec3>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Reads an OBJ or STL (ASCII or binary) file; its unit is taken to be the metre.
///
/// # Errors
/// A line that names the file and what is wrong with it.
pub fn load(path: &Path) -> Result<RawMesh, String> {
    let problem = |what: String| format!("{}: {what}", path.display());
    let size = std::fs::metadata(path)
        .map_err(|error| problem(error.to_string()))?
        .len();
    if size > LARGEST_FILE {
        return Err(problem(format!(
            "{size} bytes are more than the {LARGEST_FILE} that are read"
        )));
    }
    let bytes = std::fs::read(path).map_err(|error| problem(error.to_string()))?;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
    let mesh = match extension.to_ascii_lowercase().as_str() {
        "obj" => read_obj(&bytes),
        "stl" => read_stl(&bytes),
        _ => Err("the name must end in .obj or .stl".into()),
    };
    mesh.and_then(RawMesh::checked).map_err(problem)
}

/// Longest mesh, m, that is taken as it is without a word on its unit.
const LARGEST_UNASKED: f64 = 10.0;

/// [`load`] with the file's unit: `scale` metres per unit. Without one the unit is the metre, and a mesh that
/// would then be as large as a house is taken for one in millimetres or inches, and refused.
///
/// # Errors
/// Those of [`load`], and a line that names the size.
pub fn load_scaled(path: &Path, scale: Option<f64>) -> Result<RawMesh, String> {
    let mut mesh = load(path)?;
    let extents = mesh.extents();
    if scale.is_none() && extents.max() > LARGEST_UNASKED {
        let [x, y, z] = <[f64; 3]>::from(extents).map(|x| format!("{:.3}", x).parse().unwrap_or(x));
        return Err(format!(
            "{}: {x} × {y} × {z} m, if its unit is the metre; if it is the millimetre, say --scale 0.001, \
             and if it is that large, --scale 1",
            path.display()
        ));
    }
    for vertex in &mut mesh.vertices {
        *vertex *= scale.unwrap_or(1.0);
    }
    Ok(mesh)
}

/// The text of an OBJ file in ASCII, UTF-8 (with a byte-order mark, too) or an older encoding: only comments
/// and names have letters beyond ASCII.
fn text(bytes: &[u8]) -> Result<String, String> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err("its text is in UTF-16: save it as ASCII or UTF-8".into());
    }
    let bytes = bytes.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(bytes);
    Ok(String::from_utf8_lossy(bytes).into_owned())
}

fn read_obj(bytes: &[u8]) -> Result<RawMesh, String> {
    let text = text(bytes)?;
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    // Materials are of no use here, wherever they are.
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(text), &options, no_materials)
        .map_err(|error| format!("not a readable OBJ file: {error}"))?;
    let mut mesh = RawMesh {
        vertices: Vec::new(),
        triangles: Vec::new(),
    };
    for model in models {
        let first = mesh.vertices.len() as u32;
        let positions = model.mesh.positions.chunks_exact(3);
        mesh.vertices
            .extend(positions.map(|p| Vec3::new(p[0].into(), p[1].into(), p[2].into())));
        let corners = model.mesh.indices.chunks_exact(3);
        mesh.triangles
            .extend(corners.map(|t| [t[0] + first, t[1] + first, t[2] + first]));
    }
    Ok(mesh)
}

fn read_stl(bytes: &[u8]) -> Result<RawMesh, String> {
    // A binary file says how long it is; the ASCII format starts with "solid", and so do the
    // headers of some binary files.
    let declared = bytes
        .get(80..84)
        .map(|n| u64::from(u32::from_le_bytes([n[0], n[1], n[2], n[3]])));
    let is_binary = declared.is_some_and(|n| bytes.len() as u64 == 84 + 50 * n);
    if !is_binary && !bytes.trim_ascii_start().starts_with(b"solid") {
        return Err(match declared {
            Some(n) => format!(
                "not an STL file: as a binary one of {n} triangles it would have {} bytes, not {}",
                84 + 50 * n,
                bytes.len()
            ),
            None => "not an STL file: shorter than its header".into(),
        });
    }
    // The reading library goes by the first six bytes.
    let mut readable;
    if is_binary {
        readable = bytes.to_vec();
        readable[..80].fill(0);
    } else {
        readable = bytes.trim_ascii_start().to_vec();
        readable.insert(b"solid".len(), b' ');
    }
    let stl = stl_io::read_stl(&mut Cursor::new(readable))
        .map_err(|error| format!("not a readable STL file: {error}"))?;
    let index = |i: usize| u32::try_from(i).map_err(|_| "too many vertices".to_string());
    let mut triangles = Vec::with_capacity(stl.faces.len());
    for face in &stl.faces {
        let [a, b, c] = face.vertices;
        triangles.push([index(a)?, index(b)?, index(c)?]);
    }
    let vertices = stl.vertices.iter();
    Ok(RawMesh {
        vertices: vertices
            .map(|v| Vec3::new(v[0].into(), v[1].into(), v[2].into()))
            .collect(),
        triangles,
    })
}

impl RawMesh {
    /// Extents of the bounding box, m.
    pub fn extents(&self) -> Vec3 {
        let start = Vec3::repeat(f64::INFINITY);
        let fold = |(low, high): (Vec3, Vec3), v: &Vec3| (low.inf(v), high.sup(v));
        let (low, high) = self.vertices.iter().fold((start, -start), fold);
        high - low
    }

    fn checked(self) -> Result<Self, String> {
        if let Some(index) = self
            .vertices
            .iter()
            .position(|v| !v.iter().all(|x| x.is_finite()))
        {
            return Err(Error::NonFiniteVertex { index }.to_string());
        }
        if self.triangles.is_empty() {
            return Err(Error::EmptyMesh.to_string());
        }
        let vertices = self.vertices.len();
        if let Some(index) = self
            .triangles
            .iter()
            .flatten()
            .find(|i| **i as usize >= vertices)
        {
            let index = *index;
            return Err(Error::IndexOutOfRange { index, vertices }.to_string());
        }
        Ok(self)
    }

    /// The mesh as a solid: as it is if it is closed; an open sheet, as most leaf models are, gets
    /// `thickness` (m) along its mean normal.
    ///
    /// # Errors
    /// What is wrong with the mesh.
    pub fn solid(&self, thickness: f64) -> Result<Surface, String> {
        match Surface::new(&self.vertices, &self.triangles) {
            Err(error @ Error::OpenMesh { .. }) if self.has_border() => {
                self.thickened(thickness, &error)
            }
            other => other.map_err(|error| error.to_string()),
        }
    }

    /// Whether there is an edge with a triangle on one side only. What is open without one is wound both ways.
    fn has_border(&self) -> bool {
        let mut uses: HashMap<(u32, u32), u32> = HashMap::new();
        for [a, b, c] in self.welded().triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *uses.entry((from.min(to), from.max(to))).or_default() += 1;
            }
        }
        uses.values().any(|count| *count == 1)
    }

    fn thickened(&self, thickness: f64, why_no_solid: &Error) -> Result<Surface, String> {
        let sheet = self.welded();
        let corner = |i: u32| sheet.vertices[i as usize];
        let mean: Vec3 = sheet
            .triangles
            .iter()
            .map(|t| (corner(t[1]) - corner(t[0])).cross(&(corner(t[2]) - corner(t[0]))))
            .sum();
        let area: f64 = sheet
            .triangles
            .iter()
            .map(|t| {
                (corner(t[1]) - corner(t[0]))
                    .cross(&(corner(t[2]) - corner(t[0])))
                    .norm()
            })
            .sum();
        // A sheet that is folded onto itself has no side to thicken toward.
        if mean.norm() < 0.1 * area {
            return Err(format!(
                "neither a solid ({why_no_solid}) nor a sheet (its triangles face all ways)"
            ));
        }
        let offset = mean.normalize() * (0.5 * thickness);
        sheet.between(&vec![offset; sheet.vertices.len()])
    }

    /// An open sheet as a solid of this thickness (m) across each of its faces, mitred at the folds.
    ///
    /// # Errors
    /// What is wrong with the mesh.
    pub fn mitred(&self, thickness: f64) -> Result<Surface, String> {
        // The offset d of a vertex has d·n = thickness/2 for the normals n of all faces around it.
        let mut normals = vec![(Matrix3::zeros(), Vec3::zeros()); self.vertices.len()];
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| self.vertices[i as usize]);
            // A triangle whose corners lie on a line has no normal of its own.
            let Some(n) = (b - a).cross(&(c - a)).try_normalize(0.0) else {
                continue;
            };
            for i in t {
                let (squares, sum) = &mut normals[*i as usize];
                *squares += n * n.transpose();
                *sum += n * (0.5 * thickness);
            }
        }
        let offsets: Result<Vec<Vec3>, String> = normals
            .iter()
            .map(|(squares, sum)| Ok(squares.pseudo_inverse(1e-6)? * sum))
            .collect();
        self.between(&offsets?)
    }

    /// The solid between the sheet moved by the offsets of its vertices (m), and by their opposites.
    fn between(&self, offsets: &[Vec3]) -> Result<Surface, String> {
        let count = self.vertices.len() as u32;
        let pairs = || self.vertices.iter().zip(offsets);
        let upper = pairs().map(|(v, offset)| v + offset);
        let lower = pairs().map(|(v, offset)| v - offset);
        let vertices: Vec<Vec3> = upper.chain(lower).collect();
        let mut triangles = self.triangles.clone();
        triangles.extend(
            self.triangles
                .iter()
                .map(|t| [t[2], t[1], t[0]].map(|i| i + count)),
        );
        let edges = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let mut uses: HashMap<(u32, u32), u32> = HashMap::new();
        for edge in self.triangles.iter().flat_map(edges) {
            *uses.entry(edge).or_default() += 1;
        }
        for (a, b) in self.triangles.iter().flat_map(edges) {
            if !uses.contains_key(&(b, a)) {
                triangles.push([b, a, a + count]);
                triangles.push([b, a + count, b + count]);
            }
        }
        Surface::new(&vertices, &triangles)
            .map_err(|error| format!("an open sheet that cannot be thickened: {error}"))
    }

    /// Vertices at exactly the same place merged, collapsed triangles dropped.
    fn welded(&self) -> Self {
        let mut places: HashMap<[u64; 3], u32> = HashMap::new();
        let mut vertices = Vec::new();
        let merged: Vec<u32> = self
            .vertices
            .iter()
            .map(|v| {
                // Adding 0.0 turns −0.0 into 0.0.
                let place = [v.x, v.y, v.z].map(|x| (x + 0.0).to_bits());
                *places.entry(place).or_insert_with(|| {
                    vertices.push(*v);
                    vertices.len() as u32 - 1
                })
            })
            .collect();
        let triangles = self.triangles.iter().map(|t| t.map(|i| merged[i as usize]));
        Self {
            triangles: triangles
                .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                .collect(),
            vertices,
        }
    }
}

/// The solid moved to its centroid and turned to its principal axes: x the longest, z the shortest.
/// Its inertia is then diagonal.
pub fn aligned(solid: &Surface) -> Surface {
    let integrals = solid.volume_integrals();
    let eigen = integrals.second_moment.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
    let axis = |i: usize| eigen.eigenvectors.column(order[i]).into_owned();
    let (x, z) = (axis(0), axis(2));
    let turn = Matrix3::from_columns(&[x, z.cross(&x), z]).transpose();
    solid.map(|v| turn * (v - integrals.centroid))
}
