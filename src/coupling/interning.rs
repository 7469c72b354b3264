//! Values of which equal ones are stored once, found by a hash of their content.
//!
//! Floating-point numbers have no hash of their own, because NaN equals nothing and the two zeros equal
//! each other. Here they are hashed by their bits, with one zero; what is found is compared in full.

use crate::body::{DryMass, ImmersedBody};
use crate::motion::ControlSeries;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};

/// What [`Interned`] can find.
pub(super) trait Content {
    /// Feeds enough of the content to tell different values apart in all but rare cases.
    fn hash_content(&self, hasher: &mut DefaultHasher);

    /// The hash of the content, the same in every run.
    fn content_hash(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.hash_content(&mut hasher);
        hasher.finish()
    }
}

/// Where values are, by their hashes.
#[derive(Clone, Debug, Default)]
pub(super) struct HashIndex {
    places: HashMap<u64, Vec<u32>>,
}

impl HashIndex {
    /// The place of a value with this hash for which `is` holds.
    pub fn find(&self, hash: u64, is: impl Fn(u32) -> bool) -> Option<u32> {
        let places = self.places.get(&hash)?;
        places.iter().copied().find(|place| is(*place))
    }

    /// Adds a value's place.
    pub fn insert(&mut self, hash: u64, place: u32) {
        self.places.entry(hash).or_default().push(place);
    }

    /// Forgets all places.
    pub fn clear(&mut self) {
        self.places.clear();
    }
}

/// Distinct values in the order of their arrival.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        from = "Vec<T>",
        into = "Vec<T>",
        bound(
            serialize = "T: Clone + serde::Serialize",
            deserialize = "T: Content + serde::Deserialize<'de>"
        )
    )
)]
pub(super) struct Interned<T> {
    values: Vec<T>,
    index: HashIndex,
}

impl<T> Default for Interned<T> {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            index: HashIndex::default(),
        }
    }
}

impl<T: Content + PartialEq> Interned<T> {
    /// The index of a value, which is added if it is new.
    pub fn intern(&mut self, value: T) -> u32 {
        let hash = value.content_hash();
        let known = |place: u32| self.values[place as usize] == value;
        if let Some(place) = self.index.find(hash, known) {
            return place;
        }
        let place = self.values.len() as u32;
        self.index.insert(hash, place);
        self.values.push(value);
        place
    }
}

impl<T> Interned<T> {
    /// The value of an index that [`Interned::intern`] has returned.
    pub fn get(&self, index: u32) -> &T {
        &self.values[index as usize]
    }
}

impl<T: Content> From<Vec<T>> for Interned<T> {
    fn from(values: Vec<T>) -> Self {
        let mut index = HashIndex::default();
        for (place, value) in values.iter().enumerate() {
            index.insert(value.content_hash(), place as u32);
        }
        Self { values, index }
    }
}

impl<T> From<Interned<T>> for Vec<T> {
    fn from(interned: Interned<T>) -> Self {
        interned.values
    }
}

/// Feeds numbers by their bits.
pub(super) fn hash_numbers<'a>(
    hasher: &mut DefaultHasher,
    numbers: impl IntoIterator<Item = &'a f64>,
) {
    for number in numbers {
        // Adding zero makes one zero of the two.
        hasher.write_u64((number + 0.0).to_bits());
    }
}

impl Content for ImmersedBody {
    fn hash_content(&self, hasher: &mut DefaultHasher) {
        let hydro = &self.hydro;
        hash_numbers(hasher, [&hydro.volume, &hydro.planform.area]);
        hash_numbers(hasher, &hydro.centroid);
        hash_numbers(hasher, &hydro.reference);
        hash_numbers(hasher, &hydro.planform.half_extents);
        hash_numbers(hasher, &hydro.added_mass.linear);
        for (_, coefficient) in self.law.coefficients() {
            hash_numbers(hasher, [&coefficient]);
        }
    }
}

impl Content for DryMass {
    fn hash_content(&self, hasher: &mut DefaultHasher) {
        hash_numbers(hasher, [&self.mass]);
        hash_numbers(hasher, &self.center);
        hash_numbers(hasher, &self.inertia);
    }
}

impl Content for ControlSeries {
    fn hash_content(&self, hasher: &mut DefaultHasher) {
        hash_numbers(hasher, [&self.interval()]);
        for factors in self.controls() {
            for factor in <[f32; 3]>::from(*factors) {
                hasher.write_u32((factor + 0.0).to_bits());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values whose hashes all collide.
    #[derive(Clone, Debug, PartialEq)]
    struct Colliding(i32);

    impl Content for Colliding {
        fn hash_content(&self, _hasher: &mut DefaultHasher) {}
    }

    /// Equal values share an index, different ones do not, even where their hashes collide.
    #[test]
    fn equal_values_share_an_index() {
        let mut interned = Interned::default();
        let places = [5, 7, 5, 9, 7].map(|x| interned.intern(Colliding(x)));
        assert_eq!(places, [0, 1, 0, 2, 1]);
        assert_eq!(interned.get(2), &Colliding(9));
        let mut reloaded = Interned::from(Vec::from(interned));
        assert_eq!(reloaded.intern(Colliding(7)), 1);
        assert_eq!(reloaded.intern(Colliding(8)), 3);
    }

    /// A thousand different values are compared with each other about never: looking them up costs their
    /// number, not its square.
    #[test]
    fn different_values_are_not_compared() {
        use std::cell::Cell;
        thread_local!(static COMPARISONS: Cell<u32> = const { Cell::new(0) });

        #[derive(Clone)]
        struct Counted(f64);

        impl PartialEq for Counted {
            fn eq(&self, other: &Self) -> bool {
                COMPARISONS.set(COMPARISONS.get() + 1);
                self.0 == other.0
            }
        }

        impl Content for Counted {
            fn hash_content(&self, hasher: &mut DefaultHasher) {
                hash_numbers(hasher, [&self.0]);
            }
        }

        let mut interned = Interned::default();
        for round in 0..2 {
            for i in 0..1000 {
                assert_eq!(interned.intern(Counted(f64::from(i).sqrt())), i as u32);
            }
            assert!(
                COMPARISONS.get() <= 1000 * round + 2,
                "{}",
                COMPARISONS.get()
            );
        }
    }

    /// The two zeros are equal and must hash alike; the sign of anything else counts.
    #[test]
    fn zeros_hash_alike() {
        let hash = |x: f64| {
            let mut hasher = DefaultHasher::new();
            hash_numbers(&mut hasher, [&x]);
            hasher.finish()
        };
        assert_eq!(hash(0.0), hash(-0.0));
        assert_ne!(hash(1.0), hash(-1.0));
    }
}
