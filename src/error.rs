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

    /// A scalar parameter is outside of its range.
    #[error("{parameter} must lie between {low} and {high}, but is {value}")]
    OutOfRange {
        /// Name of the parameter, as in the public API.
        parameter: &'static str,
        /// Smallest value allowed.
        low: f64,
        /// Largest value allowed.
        high: f64,
        /// The value that was given.
        value: f64,
    },

    /// The shape encloses no volume, so that no fluid is displaced.
    #[error("a {shape} encloses no volume: it cannot be immersed")]
    ShapeWithoutVolume {
        /// Which kind of shape.
        shape: &'static str,
    },

    /// A custom shape of the user's: what it looks like is not known.
    #[error(
        "the surface of a custom shape is not known: describe it with geometry::Surface::new and \
         HydroProperties::from_surface"
    )]
    UnknownShape,

    /// An added-mass tensor is not finite, not symmetric, or gives some motion negative energy.
    #[error("the added-mass tensor is not symmetric, positive and finite")]
    UnphysicalAddedMass,

    /// A body is so small, large, light or heavy that the constants of its motion overflow.
    #[error(
        "the motion of a body of {mass} kg (added mass included) and {length} m is beyond single precision"
    )]
    BeyondSinglePrecision {
        /// Mass of body and added mass, kg.
        mass: f64,
        /// Half of its longest extent, m.
        length: f64,
    },

    /// A rigid body handle is stale.
    #[error("there is no such rigid body")]
    NoBody,

    /// A rigid body has no enabled collider that is not a sensor.
    #[error("the rigid body has no solid collider, so that it displaces no fluid")]
    NoCollider,

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

    /// A row of a table in text is none.
    #[error("row {row} of the table cannot be read: {text:?}")]
    UnreadableRow {
        /// Number of the row, comments and empty lines aside, from 1.
        row: usize,
        /// What stands there.
        text: String,
    },

    /// A mesh is not watertight, or its triangles are not oriented alike.
    #[error(
        "the mesh is not closed: {open_edges} edges lack a triangle on one side, or have two that face \
         opposite ways, the first from {from:?} to {to:?}"
    )]
    OpenMesh {
        /// Number of such edges.
        open_edges: usize,
        /// One end of the first, m.
        from: [f64; 3],
        /// Its other end, m.
        to: [f64; 3],
    },

    /// A mesh is closed but flat, or its parts cancel. A convex hull of points that are less than about a thousandth of
    /// its width apart (paper) is flattened when parry makes it; one made of its faces is not.
    #[error(
        "the mesh, {size} m across, encloses no volume (of a thin plate make `convex_mesh` from its faces: `convex_hull` flattens it)"
    )]
    NoVolume {
        /// Diagonal of its bounding box, m.
        size: f64,
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

    /// An entry of a list is not a finite number.
    #[error("{what}: entry {index} is {value}")]
    NotFinite {
        /// Which list.
        what: &'static str,
        /// Position of the entry, from 0.
        index: usize,
        /// The entry.
        value: f64,
    },

    /// The samples to cluster take fewer than four different values.
    #[error("the samples cannot be divided into four clusters: they take too few values")]
    TooFewClusters,

    /// A body was asked for a motion pattern that none of its control parameters gives.
    #[error("the body never shows the pattern {pattern}")]
    PatternNotShown {
        /// The pattern, by its two letters.
        pattern: &'static str,
    },

    /// A viscous law has no coefficient of this name.
    #[error("there is no coefficient '{name}'; this law has {}", known.join(", "))]
    UnknownCoefficient {
        /// The name that was given.
        name: String,
        /// The names that there are.
        known: Vec<&'static str>,
    },

    /// The bytes do not start like a file of the expected kind.
    #[error("not a {file} file")]
    WrongFileKind {
        /// Kind of file that was expected, e.g. `"turbulence table"`.
        file: &'static str,
    },

    /// The file was written by a version of this crate that this one cannot read.
    #[error("{file} file has version {found}, but only version {supported} can be read")]
    UnsupportedFileVersion {
        /// Kind of file.
        file: &'static str,
        /// The version that the file declares.
        found: u32,
        /// The version that this crate reads and writes.
        supported: u32,
    },

    /// The file is shorter or longer than its header declares.
    #[error("{file} file should have {expected} bytes, but has {found}")]
    WrongFileLength {
        /// Kind of file.
        file: &'static str,
        /// Bytes that the header asks for (at least a whole header).
        expected: u64,
        /// Bytes that there are.
        found: u64,
    },

    /// The file was altered or damaged after it was written.
    #[error("{file} file has checksum {found:016x}, but declares {declared:016x}")]
    AlteredFile {
        /// Kind of file.
        file: &'static str,
        /// Checksum in the file.
        declared: u64,
        /// Checksum of what the file contains.
        found: u64,
    },

    /// What is to be played was planned for something else.
    #[error("not what was planned for: {differences}")]
    NotAsPlanned {
        /// What differs, with both values where it is a number.
        differences: String,
    },
    /// The content of a file cannot be decoded, although its checksum is right.
    #[error("{file} file: its {length} bytes of content cannot be decoded")]
    UndecodableFile {
        /// Kind of file.
        file: &'static str,
        /// Length of the content in bytes.
        length: usize,
    },
}

impl Error {
    /// `value` if it is positive and finite, otherwise the error that names it.
    pub(crate) fn check_positive(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(
            parameter,
            value,
            value > 0.0 && value.is_finite(),
            "positive and finite",
        )
    }

    /// `value` if it is zero or positive, and finite, otherwise the error that names it.
    pub(crate) fn check_not_negative(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(
            parameter,
            value,
            value >= 0.0 && value.is_finite(),
            "zero or positive, and finite",
        )
    }

    /// `value` if it is finite, otherwise the error that names it.
    pub(crate) fn check_finite(parameter: &'static str, value: f64) -> Result<f64, Self> {
        Self::check(parameter, value, value.is_finite(), "finite")
    }

    /// `value` if it is `valid`, otherwise the error that names it and says what it has to be.
    pub(crate) fn check(
        parameter: &'static str,
        value: f64,
        valid: bool,
        requirement: &'static str,
    ) -> Result<f64, Self> {
        if valid {
            Ok(value)
        } else {
            Err(Self::InvalidParameter {
                parameter,
                requirement,
                value,
            })
        }
    }

    /// `value` if it lies in `[low, high]`, otherwise the error that names it.
    pub(crate) fn check_range(
        parameter: &'static str,
        value: f64,
        low: f64,
        high: f64,
    ) -> Result<f64, Self> {
        if (low..=high).contains(&value) {
            Ok(value)
        } else {
            Err(Self::OutOfRange {
                parameter,
                low,
                high,
                value,
            })
        }
    }

    /// An error if the list has a length other than `expected`.
    pub(crate) fn check_length(
        what: &'static str,
        expected: usize,
        actual: usize,
    ) -> Result<(), Self> {
        if expected == actual {
            Ok(())
        } else {
            Err(Self::WrongLength {
                what,
                expected,
                actual,
            })
        }
    }

    /// An error that names the first entry whose size is beyond `limit`, or that is NaN.
    pub(crate) fn check_all_within(
        what: &'static str,
        values: &[f64],
        limit: f64,
    ) -> Result<(), Self> {
        for value in values {
            Self::check_range(what, *value, -limit, limit)?;
        }
        Ok(())
    }

    /// An error that names the first entry that is not finite.
    pub(crate) fn check_all_finite(what: &'static str, values: &[f64]) -> Result<(), Self> {
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Self::NotFinite {
                what,
                index,
                value: values[index],
            }),
        }
    }
}
