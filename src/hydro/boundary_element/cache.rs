//! A cache of solved shapes: a thousand equal leaves cost one solve.

use super::params::{
    BoundaryElementParams, BoundaryElementReport, BoundaryElementSolution, ProgressFn,
};
use crate::error::Error;
use crate::geometry::Surface;
use crate::hydro::AddedMass;
use rapier3d::math::Vector;
use rapier3d::na::Vector3;
use rapier3d::parry::shape::Shape;
use std::collections::BTreeMap;

/// Cells of the mesh by which a shape is recognised.
const KEY_CELLS: usize = 3;

/// Added mass by shape and by the parameters of its solve.
///
/// A shape is recognised by the digits of its mesh in its own frame, hashed to 128 bits: equal shapes
/// have equal keys in every program and on every machine, a shape that is turned or scaled has
/// another one. Two different shapes share a key with a probability of 10⁻³⁸.
///
/// ```
/// use rapier3d_immersed::boundary_element::{AddedMassCache, BoundaryElementParams};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// let params = BoundaryElementParams { tolerance: 0.1, ..Default::default() };
/// let mut cache = AddedMassCache::default();
/// for i in 0..100 {
///     let leaf = Cuboid::new(Vector::new(0.03, 0.0002, if i % 2 == 0 { 0.02 } else { 0.015 }));
///     cache.of_shape(&leaf, Vector::ZERO, &params, &|_| ())?;
/// }
/// assert_eq!(cache.len(), 2); // two kinds of leaves, two solves
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AddedMassCache {
    solved: BTreeMap<u128, SolvedShape>,
}

/// One entry of an [`AddedMassCache`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct SolvedShape {
    /// Per unit density, about [`SolvedShape::center`], in the shape's axes.
    pub added_mass: AddedMass,
    /// The point that the tensor is about, m, in the shape's frame.
    pub center: Vector3<f64>,
    /// How the solve went.
    pub report: BoundaryElementReport,
}

impl AddedMassCache {
    /// How many different shapes are known.
    pub fn len(&self) -> usize {
        self.solved.len()
    }

    /// Whether no shape is known yet.
    pub fn is_empty(&self) -> bool {
        self.solved.is_empty()
    }

    /// As [`AddedMass::of_shape`], solving only for shapes that are not known yet.
    ///
    /// # Errors
    /// Those of [`AddedMass::of_shape`].
    pub fn of_shape(
        &mut self,
        shape: &dyn Shape,
        reference_point: Vector,
        params: &BoundaryElementParams,
        progress: ProgressFn,
    ) -> Result<(AddedMass, &BoundaryElementReport), Error> {
        let key = key(&Surface::panelled(shape, KEY_CELLS)?, params);
        let solved = match self.solved.entry(key) {
            std::collections::btree_map::Entry::Occupied(known) => known.into_mut(),
            std::collections::btree_map::Entry::Vacant(new) => {
                let solution = BoundaryElementSolution::of_shape(shape, params, progress)?;
                new.insert(SolvedShape {
                    added_mass: solution.added_mass,
                    center: solution.center,
                    report: solution.report,
                })
            }
        };
        let offset = crate::math::to_f64(reference_point) - solved.center;
        Ok((solved.added_mass.about(offset), &solved.report))
    }
}

/// A hash (FNV-1a, 128 bits) of everything that the result depends on.
fn key(surface: &Surface, params: &BoundaryElementParams) -> u128 {
    let vertices = surface.vertices().iter().flat_map(|v| v.iter().copied());
    let scalars = [params.tolerance, params.far].into_iter().chain(vertices);
    let indices = surface.triangles().iter().flatten().map(|i| u64::from(*i));
    let counts = [
        params.max_panels as u64,
        params.touching_levels.into(),
        params.close_levels.into(),
        surface.vertices().len() as u64,
    ];
    // Adding zero turns −0 into 0.
    counts
        .into_iter()
        .chain(scalars.map(|x| (x + 0.0).to_bits()))
        .chain(indices)
        .flat_map(u64::to_le_bytes)
        .fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, |hash, byte| {
            (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
        })
}

#[cfg(feature = "serde-serialize")]
mod file {
    use super::{AddedMassCache, SolvedShape};
    use crate::error::Error;
    use crate::file::{FileKind, decode, encode};

    const FILE: FileKind = FileKind {
        name: "added-mass cache",
        magic: *b"R3DI-AMC",
        version: 1,
    };

    impl AddedMassCache {
        /// The bytes of a file with all known shapes.
        pub fn to_bytes(&self) -> Vec<u8> {
            let entries: Vec<_> = self.solved.iter().collect();
            encode(&FILE, &entries)
        }

        /// Reads what [`AddedMassCache::to_bytes`] wrote.
        ///
        /// # Errors
        /// Of the file: [`Error::WrongFileKind`], [`Error::UnsupportedFileVersion`],
        /// [`Error::WrongFileLength`], [`Error::AlteredFile`], [`Error::UndecodableFile`]; of its
        /// content: [`Error::UnphysicalAddedMass`].
        pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
            let entries: Vec<(u128, SolvedShape)> = decode(&FILE, bytes)?;
            for (_, solved) in &entries {
                if !(solved.added_mass.is_physical() && solved.center.iter().all(|x| x.is_finite()))
                {
                    return Err(Error::UnphysicalAddedMass);
                }
            }
            Ok(Self {
                solved: entries.into_iter().collect(),
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::parry::shape::SharedShape;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn filled(solves: &AtomicUsize) -> AddedMassCache {
        let params = BoundaryElementParams {
            tolerance: 0.1,
            ..BoundaryElementParams::default()
        };
        let mut cache = AddedMassCache::default();
        for i in 0..30 {
            // There are two kinds of leaves among thirty bodies.
            let shape = SharedShape::cuboid(0.03, 0.02, if i % 3 == 0 { 0.001 } else { 0.002 });
            let point = Vector::X * (i as f32 * 0.01);
            let count = |progress: super::super::BoundaryElementProgress| {
                if progress.level == 0 && progress.share == 1.0 {
                    solves.fetch_add(1, Ordering::Relaxed);
                }
            };
            let (found, _) = cache
                .of_shape(shape.as_ref(), point, &params, &count)
                .unwrap();
            let direct = AddedMass::of_shape(shape.as_ref(), point, 0.1);
            if i < 2 {
                let difference = found.to_matrix6() - direct.unwrap().0.to_matrix6();
                assert!(difference.norm() < 1e-9 * found.to_matrix6().norm());
            }
        }
        cache
    }

    #[test]
    fn equal_shapes_are_solved_once_and_files_are_checked() {
        let solves = AtomicUsize::new(0);
        let cache = filled(&solves);
        assert_eq!((cache.len(), solves.load(Ordering::Relaxed)), (2, 2));
        #[cfg(feature = "serde-serialize")]
        {
            let bytes = cache.to_bytes();
            assert_eq!(AddedMassCache::from_bytes(&bytes), Ok(cache));
            for cut in [0, 7, 20, bytes.len() - 1] {
                assert!(AddedMassCache::from_bytes(&bytes[..cut]).is_err());
            }
            for byte in 0..bytes.len() {
                let mut altered = bytes.clone();
                altered[byte] ^= 0x10;
                assert!(AddedMassCache::from_bytes(&altered).is_err(), "byte {byte}");
            }
        }
    }
}
