//! The one error type of this crate.

/// What can be wrong with an input, found when something is built, baked or loaded.
///
/// Every variant names the offending value. Nothing in the run-time step returns an error.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A scalar parameter is outside of what the physics allows.
    #[error("{parameter} must be {requirement}, but is {value}")]
    InvalidParameter {
        /// Name of the parameter, as in the public API.
        parameter: &'static str,
        /// What the parameter has to satisfy, e.g. `"positive and finite"`.
        requirement: &'static str,
        /// The value that was given.
        value: f64,
    },

    /// The shape encloses no volume, so that no fluid is displaced.
    #[error("a {shape} encloses no volume: it cannot be immersed")]
    ShapeWithoutVolume {
        /// Which kind of shape.
        shape: &'static str,
    },

    /// A mesh (or compound, or convex hull) without any triangle of non-zero size.
    #[error("the mesh has no triangles of non-zero size")]
    EmptyMesh,

    /// A vertex of a mesh is NaN or infinite.
    #[error("vertex {index} of the mesh is not finite")]
    NonFiniteVertex {
        /// Index of the first such vertex.
        index: usize,
    },

    /// A triangle refers to a vertex that does not exist.
    #[error("a triangle refers to vertex {index}, but the mesh has {vertices} vertices")]
    IndexOutOfRange {
        /// The index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },

    /// A mesh is not watertight, or its triangles are not oriented alike.
    #[error(
        "the mesh is not closed: {open_edges} edges lack a triangle on one side, \
         the first from {from:?} to {to:?}"
    )]
    OpenMesh {
        /// Number of such edges.
        open_edges: usize,
        /// One end of the first, m.
        from: [f64; 3],
        /// Its other end, m.
        to: [f64; 3],
    },

    /// A triangle is so thin that it has no normal.
    #[error("triangle {triangle} at {at:?} has no area to speak of")]
    DegenerateTriangle {
        /// Index of the first such triangle.
        triangle: usize,
        /// Its centroid, m.
        at: [f64; 3],
    },

    /// More than two triangles of a sheet meet at an edge.
    #[error("the sheet branches: more than two triangles meet from {from:?} to {to:?}")]
    BranchingMesh {
        /// One end of the first such edge, m.
        from: [f64; 3],
        /// Its other end, m.
        to: [f64; 3],
    },

    /// A sheet has one side only, like a Möbius strip.
    #[error("the sheet has one side only: its triangles cannot agree from {from:?} to {to:?}")]
    OneSidedSheet {
        /// One end of the edge where that shows, m.
        from: [f64; 3],
        /// Its other end, m.
        to: [f64; 3],
    },

    /// Two triangles of a mesh pass through each other.
    #[error("triangles {first} and {second} of the mesh intersect near {at:?}")]
    SelfIntersection {
        /// Index of one triangle.
        first: usize,
        /// Index of the other.
        second: usize,
        /// A point that both contain, m.
        at: [f64; 3],
    },

    /// One of several closed parts of a mesh is turned inside out.
    #[error("the part of the mesh around {center:?}, with triangle {triangle}, is inside out")]
    InsideOut {
        /// Index of a triangle of the part.
        triangle: usize,
        /// Center of its bounding box, m.
        center: [f64; 3],
    },

    /// A mesh is larger than the solver was allowed to take on.
    #[error("the mesh has {panels} triangles, more than max_panels = {max_panels}")]
    TooManyPanels {
        /// Triangles of the mesh.
        panels: usize,
        /// The limit.
        max_panels: usize,
    },

    /// A mesh is closed but flat, or its parts cancel.
    #[error("the mesh, {size} m across, encloses no volume")]
    NoVolume {
        /// Diagonal of its bounding box, m.
        size: f64,
    },

    /// An added-mass tensor is not finite, not symmetric, or gives some motion negative energy.
    #[error("the added-mass tensor is not symmetric, positive and finite")]
    UnphysicalAddedMass,

    /// A list has the wrong number of entries.
    #[error("{what}: {actual} given where {expected} are needed")]
    WrongLength {
        /// Which list.
        what: &'static str,
        /// How many entries it must have (the least, where more are allowed).
        expected: usize,
        /// How many it has.
        actual: usize,
    },

    /// A file does not start with the magic bytes of its kind.
    #[error("not a file of this kind: it starts with {found:02x?} instead of {expected:02x?}")]
    WrongMagic {
        /// How the file must start.
        expected: [u8; 8],
        /// How it starts (zeros where it is shorter).
        found: [u8; 8],
    },

    /// A file was written by another version of the format.
    #[error("file format version {found}, but this crate reads {expected}")]
    WrongVersion {
        /// The version this crate reads.
        expected: u32,
        /// The version of the file.
        found: u32,
    },

    /// The bytes of a file are not the ones that were written.
    #[error("the file was altered: checksum {found:016x}, but its header says {expected:016x}")]
    WrongChecksum {
        /// What the header says.
        expected: u64,
        /// What its content gives.
        found: u64,
    },

    /// The content of a file cannot be decoded, although its checksum is right.
    #[error("cannot decode {what} from {length} bytes")]
    Undecodable {
        /// What should be in the file.
        what: &'static str,
        /// Length of the content in bytes.
        length: usize,
    },
}

impl Error {
    /// `value` if it is positive and finite, otherwise the error that names it.
    pub(crate) fn check_positive(parameter: &'static str, value: f64) -> Result<f64, Self> {
        if value > 0.0 && value.is_finite() {
            Ok(value)
        } else {
            Err(Self::InvalidParameter {
                parameter,
                requirement: "positive and finite",
                value,
            })
        }
    }
}
