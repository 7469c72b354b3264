//! Values of which equal ones are stored once, found by a hash of their content.
//!
//! Floating-point numbers have no hash of their own, because NaN equals nothing and the two zeros equal
//! each other. Here they are hashed by their bits, with one zero; what is found is compared in full.

use crate::body::{DryMass, ImmersedBody};
use crate::motion::ControlSeries;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};

/// What [`Interned`] can find.
pub(crate) trait Content {
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
pub(crate) struct HashIndex {
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
}

/// Distinct values, each at an index that stays. Values that nobody uses any more make room: they are
/// looked for when as many have been added as were used the last time, so that the table holds at most about
/// twice what is used and adding a value costs a constant time on average.
#[derive(Clone, Debug)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        from = "Vec<Option<T>>",
        into = "Vec<Option<T>>",
        bound(
            serialize = "T: Clone + serde::Serialize",
            deserialize = "T: Content + serde::Deserialize<'de>"
        )
    )
)]
pub(crate) struct Interned<T> {
    /// `None` where there is room for one.
    values: Vec<Option<T>>,
    free: Vec<u32>,
    index: HashIndex,
    /// Values that may be added before unused ones are looked for.
    before_sweep: u32,
}

/// Values that are kept without asking whether they are used.
const FEW: u32 = 16;

impl<T> Default for Interned<T> {
    fn default() -> Self {
        Self {
            values: Vec::new(),
            free: Vec::new(),
            index: HashIndex::default(),
            before_sweep: FEW,
        }
    }
}

impl<T> Interned<T> {
    /// The value at an index that [`Interned::add`] has returned and that has been used since.
    pub fn get(&self, index: u32) -> Option<&T> {
        self.values.get(index as usize)?.as_ref()
    }

    /// The values, in the order of their indices.
    #[cfg(feature = "serde-serialize")]
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.values.iter().flatten()
    }

    /// The index of the value with this hash for which `is` holds.
    pub fn find(&self, hash: u64, is: impl Fn(&T) -> bool) -> Option<u32> {
        self.index
            .find(hash, |place| self.get(place).is_some_and(&is))
    }
}

impl<T: Content> Interned<T> {
    /// Adds a value that is not there yet. `used` gives the indices of the values that are in use.
    pub fn add<U: IntoIterator<Item = u32>>(&mut self, value: T, used: impl FnOnce() -> U) -> u32 {
        if self.before_sweep == 0 {
            self.sweep(used());
        }
        self.before_sweep -= 1;
        let hash = value.content_hash();
        let place = match self.free.pop() {
            Some(place) => {
                self.values[place as usize] = Some(value);
                place
            }
            None => {
                self.values.push(Some(value));
                self.values.len() as u32 - 1
            }
        };
        self.index.insert(hash, place);
        place
    }

    /// Forgets the values that are not used.
    fn sweep(&mut self, used: impl IntoIterator<Item = u32>) {
        let mut is_used = vec![false; self.values.len()];
        for place in used {
            if let Some(is_used) = is_used.get_mut(place as usize) {
                *is_used = true;
            }
        }
        let values = std::mem::take(&mut self.values);
        let kept = values.into_iter().zip(is_used);
        let kept = kept.map(|(value, used)| value.filter(|_| used));
        *self = Self::from(kept.collect::<Vec<_>>());
    }
}

impl<T: Content + PartialEq> Interned<T> {
    /// The index of a value, which is added if it is new.
    pub fn intern<U: IntoIterator<Item = u32>>(
        &mut self,
        value: T,
        used: impl FnOnce() -> U,
    ) -> u32 {
        match self.find(value.content_hash(), |known| *known == value) {
            Some(place) => place,
            None => self.add(value, used),
        }
    }
}

impl<T: Content> From<Vec<Option<T>>> for Interned<T> {
    fn from(values: Vec<Option<T>>) -> Self {
        let mut index = HashIndex::default();
        let (mut free, mut kept) = (Vec::new(), 0);
        for (place, value) in values.iter().enumerate() {
            match value {
                Some(value) => {
                    index.insert(value.content_hash(), place as u32);
                    kept += 1;
                }
                None => free.push(place as u32),
            }
        }
        Self {
            values,
            free,
            index,
            before_sweep: kept.max(FEW),
        }
    }
}

impl<T> From<Interned<T>> for Vec<Option<T>> {
    fn from(interned: Interned<T>) -> Self {
        interned.values
    }
}

/// Feeds numbers by their bits.
pub(crate) fn hash_numbers<'a>(
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
        for part in &self.parts {
            hash_numbers(hasher, [&part.hydro.volume, &part.hydro.planform.area]);
            hash_numbers(hasher, &part.pose.translation.vector);
            hash_numbers(hasher, &part.pose.rotation.coords);
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
        let none = || [];
        let mut interned = Interned::default();
        let places = [5, 7, 5, 9, 7].map(|x| interned.intern(Colliding(x), none));
        assert_eq!(places, [0, 1, 0, 2, 1]);
        assert_eq!(interned.get(2), Some(&Colliding(9)));
        let mut reloaded = Interned::from(Vec::from(interned));
        assert_eq!(reloaded.intern(Colliding(7), none), 1);
        assert_eq!(reloaded.intern(Colliding(8), none), 3);
    }

    /// Forty-five thousand values of which eight are in use at a time leave no more than a few dozen behind,
    /// and the used ones keep their indices.
    #[test]
    fn unused_values_make_room() {
        let mut interned = Interned::default();
        let mut used = std::collections::VecDeque::new();
        for x in 0..45_000 {
            let place = interned.intern(Colliding(x), || used.iter().map(|(place, _)| *place));
            used.push_back((place, x));
            if used.len() > 8 {
                used.pop_front();
            }
            for (place, x) in &used {
                assert_eq!(interned.get(*place), Some(&Colliding(*x)));
            }
        }
        assert!(interned.values.len() <= 40, "{}", interned.values.len());
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
                let all = || 0..i as u32;
                assert_eq!(interned.intern(Counted(f64::from(i).sqrt()), all), i as u32);
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
