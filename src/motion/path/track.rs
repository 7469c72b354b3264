//! A fall as keyframes, evaluated at any time.

use crate::error::Error;
use crate::motion::Regime;
use rapier3d::math::{Real, Rotation, Vector};

/// Where a body is at one moment, in the fall's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Key {
    /// Center of mass, m.
    pub position: Vector,
    /// Its velocity, m/s.
    pub velocity: Vector,
    /// Rotation of the plate axes (x longest, z normal, as
    /// [`Planform::axes`](crate::Planform)) into the fall's frame.
    pub attitude: Rotation,
}

/// A fall from its release at the origin: keyframes at equal intervals, and which regime is when.
///
/// A [`Synthesizer`](super::Synthesizer) makes them; they can also be made of motion from elsewhere:
///
/// ```
/// use rapier3d_immersed::motion::Regime;
/// use rapier3d_immersed::motion::path::{Key, MotionPath};
/// use rapier3d_immersed::rapier3d::prelude::*;
///
/// // Half a second straight down, without a turn.
/// let keys = (0..=5).map(|i| Key {
///     position: Vector::Y * (-0.1 * i as f32),
///     velocity: -Vector::Y,
///     attitude: Rotation::IDENTITY,
/// });
/// let path = MotionPath::new(0.1, keys.collect(), vec![(0.0, Regime::SteadyDescent)])?;
/// assert!((path.duration() - 0.5).abs() < 1e-6);
/// assert!((path.at(0.25).position.y + 0.25).abs() < 1e-6);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize),
    serde(try_from = "RawPath")
)]
pub struct MotionPath {
    interval: Real,
    per_interval: Real,
    keys: Vec<Key>,
    regimes: Vec<(Real, Regime)>,
}

/// A path as it is read, not checked yet.
#[cfg(feature = "serde-serialize")]
#[derive(serde::Deserialize)]
struct RawPath {
    interval: Real,
    per_interval: Real,
    keys: Vec<Key>,
    regimes: Vec<(Real, Regime)>,
}

#[cfg(feature = "serde-serialize")]
impl TryFrom<RawPath> for MotionPath {
    type Error = Error;

    fn try_from(raw: RawPath) -> Result<Self, Error> {
        let path = Self {
            interval: raw.interval,
            per_interval: raw.per_interval,
            keys: raw.keys,
            regimes: raw.regimes,
        };
        path.check()?;
        Ok(path)
    }
}

#[cfg(feature = "serde-serialize")]
const FILE: crate::file::FileKind = crate::file::FileKind {
    name: "motion path",
    magic: *b"R3DI-PTH",
    version: 1,
};

impl MotionPath {
    /// A path of keys `interval` seconds apart; each regime lasts from its time to the next one's.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if there are less than two keys or no regime;
    /// [`Error::InvalidParameter`] or [`Error::NotFinite`] names an interval that is not positive, a
    /// number that is not finite, an attitude that is no rotation, or times that do not ascend from 0.
    pub fn new(
        interval: Real,
        mut keys: Vec<Key>,
        regimes: Vec<(Real, Regime)>,
    ) -> Result<Self, Error> {
        // Neighbouring quaternions must have the same sign to be interpolated.
        for i in 1..keys.len() {
            if keys[i].attitude.dot(keys[i - 1].attitude) < 0.0 {
                keys[i].attitude = -keys[i].attitude;
            }
        }
        let path = Self {
            interval,
            per_interval: 1.0 / interval,
            keys,
            regimes,
        };
        path.check()?;
        Ok(path)
    }

    fn check(&self) -> Result<(), Error> {
        Error::check_positive("interval", self.interval.into())?;
        Error::check_positive("1/interval", self.per_interval.into())?;
        let inverse = f64::from(self.interval) * f64::from(self.per_interval);
        Error::check_range("interval × 1/interval", inverse, 0.999, 1.001)?;
        for (what, least, count) in [
            ("keys of the path", 2, self.keys.len()),
            ("regimes of the path", 1, self.regimes.len()),
        ] {
            if count < least {
                return Err(Error::WrongLength {
                    what,
                    expected: least,
                    actual: count,
                });
            }
        }
        for key in &self.keys {
            let vectors = [key.position, key.velocity].map(|v| v.to_array().map(f64::from));
            Error::check_all_finite("key of the path", vectors.as_flattened())?;
            let norm = f64::from(key.attitude.length());
            let valid = (norm - 1.0).abs() < 1e-3;
            Error::check("norm of an attitude", norm, valid, "1")?;
        }
        for pair in self.keys.windows(2) {
            let cosine = f64::from(pair[0].attitude.dot(pair[1].attitude));
            let alike = cosine >= 0.0;
            Error::check(
                "product of neighbouring attitudes",
                cosine,
                alike,
                "zero or positive",
            )?;
        }
        let first = f64::from(self.regimes[0].0);
        Error::check("time of the first regime", first, first == 0.0, "0")?;
        for pair in self.regimes.windows(2) {
            let time = f64::from(pair[1].0);
            let later = pair[1].0 > pair[0].0;
            Error::check("time of a regime", time, later, "later than the one before")?;
        }
        Ok(())
    }

    /// Time between keys, s.
    pub fn interval(&self) -> Real {
        self.interval
    }

    /// The keys.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// When each regime begins, s.
    pub fn regimes(&self) -> &[(Real, Regime)] {
        &self.regimes
    }

    /// The regimes in their order: the motion class of the fall.
    pub fn sequence(&self) -> Vec<Regime> {
        self.regimes.iter().map(|(_, regime)| *regime).collect()
    }

    /// The regime at a time, s.
    pub fn regime_at(&self, time: Real) -> Regime {
        let after = self.regimes.partition_point(|(from, _)| *from <= time);
        self.regimes[after.saturating_sub(1)].1
    }

    /// Length, s.
    pub fn duration(&self) -> Real {
        self.interval * (self.keys.len() - 1) as Real
    }

    /// Index of the key before a time, at most the last but one, and the share of the interval since.
    #[inline]
    fn locate(&self, time: Real) -> (usize, Real) {
        let place = (time * self.per_interval).clamp(0.0, (self.keys.len() - 1) as Real);
        let index = (place as usize).min(self.keys.len() - 2);
        (index, place - index as Real)
    }

    /// The keys between which a time lies, s.
    #[inline]
    pub(crate) fn keys_around(&self, time: Real) -> [&Key; 2] {
        let (index, _) = self.locate(time);
        [&self.keys[index], &self.keys[index + 1]]
    }

    /// The moment at a time, s, clamped to the path: cubic between positions, so that the velocity is
    /// their derivative, and linear (normalised) between attitudes.
    #[inline]
    pub fn at(&self, time: Real) -> Key {
        let (index, s) = self.locate(time);
        let (a, b) = (&self.keys[index], &self.keys[index + 1]);
        let h = self.interval;
        let step = b.position - a.position;
        let (u, v) = (a.velocity * h, b.velocity * h);
        let (c2, c3) = (step * 3.0 - u * 2.0 - v, u + v - step * 2.0);
        Key {
            position: a.position + (u + (c2 + c3 * s) * s) * s,
            velocity: (u + (c2 * 2.0 + c3 * (3.0 * s)) * s) * self.per_interval,
            attitude: (a.attitude * (1.0 - s) + b.attitude * s).normalize(),
        }
    }

    /// The bytes of a file that holds this path.
    #[cfg(feature = "serde-serialize")]
    pub fn to_bytes(&self) -> Vec<u8> {
        crate::file::encode(&FILE, self)
    }

    /// Reads what `to_bytes` wrote.
    ///
    /// # Errors
    /// If the bytes are of another kind or version, truncated, altered, or describe what
    /// [`MotionPath::new`] refuses.
    #[cfg(feature = "serde-serialize")]
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let raw: RawPath = crate::file::decode(&FILE, bytes)?;
        raw.try_into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic(t: Real) -> (Vector, Vector) {
        let position = Vector::new(t * t * t, -t, 2.0 * t * t);
        (position, Vector::new(3.0 * t * t, -1.0, 4.0 * t))
    }

    fn path() -> MotionPath {
        let keys = (0..=8).map(|i| {
            let t = 0.25 * i as Real;
            let (position, velocity) = cubic(t);
            Key {
                position,
                velocity,
                // Beyond half a turn the quaternion changes its sign.
                attitude: Rotation::from_axis_angle(Vector::Z, 2.0 * t),
            }
        });
        let regimes = vec![(0.0, Regime::SteadyDescent), (1.0, Regime::PeriodicSpiral)];
        MotionPath::new(0.25, keys.collect(), regimes).unwrap()
    }

    /// Hermite interpolation is exact for a cubic, its derivative too; in f32.
    #[test]
    fn cubics_are_reproduced() {
        let path = path();
        for i in 0..=200 {
            let t = 0.01 * i as Real;
            let (position, velocity) = cubic(t);
            let key = path.at(t);
            assert!((key.position - position).length() < 1e-5);
            assert!((key.velocity - velocity).length() < 1e-4);
            // At its quarters, a chord between quaternions 0.5 rad apart is at most 1e-3 rad off.
            let angle = key
                .attitude
                .angle_between(Rotation::from_axis_angle(Vector::Z, 2.0 * t));
            assert!(angle < 2e-3, "{t} {angle}");
        }
        assert_eq!(path.at(-1.0).position, path.at(0.0).position);
        assert_eq!(path.at(99.0).position, path.keys()[8].position);
        assert_eq!(path.regime_at(0.99), Regime::SteadyDescent);
        assert_eq!(path.regime_at(1.0), Regime::PeriodicSpiral);
    }

    #[test]
    fn bad_paths_are_refused() {
        let good = path();
        let new = |interval, keys: &[Key], regimes: &[(Real, Regime)]| {
            MotionPath::new(interval, keys.to_vec(), regimes.to_vec())
        };
        assert!(new(0.25, &good.keys, &good.regimes).is_ok());
        assert!(new(0.0, &good.keys, &good.regimes).is_err());
        assert!(new(Real::NAN, &good.keys, &good.regimes).is_err());
        assert!(new(0.25, &good.keys[..1], &good.regimes).is_err());
        assert!(new(0.25, &good.keys, &[]).is_err());
        assert!(new(0.25, &good.keys, &good.regimes[1..]).is_err());
        let mut keys = good.keys.clone();
        keys[3].velocity.y = Real::INFINITY;
        assert!(new(0.25, &keys, &good.regimes).is_err());
        keys[3] = Key {
            attitude: good.keys[3].attitude * 2.0,
            ..good.keys[3]
        };
        assert!(new(0.25, &keys, &good.regimes).is_err());
    }

    #[cfg(feature = "serde-serialize")]
    #[test]
    fn what_is_saved_is_loaded() {
        let path = path();
        let bytes = path.to_bytes();
        assert_eq!(MotionPath::from_bytes(&bytes).as_ref(), Ok(&path));
        for at in 0..bytes.len() {
            let mut altered = bytes.clone();
            altered[at] ^= 0x10;
            assert!(MotionPath::from_bytes(&altered).is_err(), "byte {at}");
        }
        let mut bad = path;
        bad.keys[2].position.x = Real::NAN;
        assert!(MotionPath::from_bytes(&bad.to_bytes()).is_err());
    }
}
