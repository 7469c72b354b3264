//! What a user may change, as data: it is checked, held within its range, logged, saved and done again.

use crate::kinds::Shape;
use crate::methods::Method;
use crate::settings::{Fluids, Law, Settings, ranges};
use serde::{Deserialize, Serialize};
use std::mem::discriminant;
use std::ops::RangeInclusive;

/// A body to be placed, or thrown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Placement {
    /// What it is (default a leaf).
    pub shape: Shape,
    /// Times the lengths of the thing (default 1).
    pub size: f64,
    /// Its center of mass, m, y up from the ground (default 1.5 m over the middle).
    pub position: [f64; 3],
    /// From lying flat, degrees (default 20).
    pub tilt: f64,
    /// About the vertical, degrees (default 0).
    pub heading: f64,
    /// m/s (default 0).
    pub velocity: [f64; 3],
    /// rad/s (default 0).
    pub spin: [f64; 3],
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            shape: Shape::Leaf,
            size: 1.0,
            position: [0.0, 1.5, 0.0],
            tilt: 20.0,
            heading: 0.0,
            velocity: [0.0; 3],
            spin: [0.0; 3],
        }
    }
}

/// Many bodies at once, at random places and attitudes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rain {
    /// What falls (default leaves).
    pub shape: Shape,
    /// Times the lengths of the thing (default 1).
    pub size: f64,
    /// How many (default 30).
    pub count: f64,
    /// Of the places, heights and attitudes (default 1).
    pub seed: u64,
    /// Half the side of the square over which they begin, m (default 0.7).
    pub spread: f64,
    /// The least and the greatest height, m (default 0.8 and 2).
    pub heights: [f64; 2],
}

impl Default for Rain {
    fn default() -> Self {
        Self {
            shape: Shape::Leaf,
            size: 1.0,
            count: 30.0,
            seed: 1,
            spread: 0.7,
            heights: [0.8, 2.0],
        }
    }
}

/// One setting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setting {
    /// [`Settings::fluids`].
    Fluids(Fluids),
    /// [`Settings::level`].
    Level(f64),
    /// [`Settings::waves`].
    Waves(f64),
    /// [`Settings::wind`].
    Wind([f64; 3]),
    /// [`Settings::current`].
    Current([f64; 3]),
    /// [`Settings::turbulence`].
    Turbulence(f64),
    /// [`Settings::eddy`].
    Eddy(f64),
    /// [`Settings::law`].
    Law(Law),
    /// [`Settings::coefficients`].
    Coefficients([f64; 3]),
    /// [`Settings::factors`].
    Factors([f64; 3]),
    /// [`Settings::method`].
    Method(Method),
}

impl Setting {
    /// Sets it.
    pub fn put(self, settings: &mut Settings) {
        match self {
            Self::Fluids(x) => settings.fluids = x,
            Self::Level(x) => settings.level = x,
            Self::Waves(x) => settings.waves = x,
            Self::Wind(x) => settings.wind = x,
            Self::Current(x) => settings.current = x,
            Self::Turbulence(x) => settings.turbulence = x,
            Self::Eddy(x) => settings.eddy = x,
            Self::Law(x) => settings.law = x,
            Self::Coefficients(x) => settings.coefficients = x,
            Self::Factors(x) => settings.factors = x,
            Self::Method(x) => settings.method = x,
        }
    }
}

/// A change of the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Puts a body somewhere, at rest or thrown.
    Place(Placement),
    /// Puts many.
    Rain(Rain),
    /// A leaf that follows a line through these points, m, from the first to the last.
    Draw(Vec<[f64; 3]>),
    /// Sets something for all bodies.
    Set(Setting),
    /// Takes a body away.
    Remove(usize),
    /// Takes all bodies away.
    Clear,
}

/// Points of a drawn line.
const MOST_POINTS: usize = 2000;

impl Change {
    /// The change with every number within its range, and what was held there.
    ///
    /// # Errors
    /// Names what is no number.
    pub fn held(mut self) -> Result<(Self, Vec<String>), String> {
        let mut bounds = Bounds::default();
        match &mut self {
            Self::Place(body) => {
                bounds.hold("size", &mut body.size, &ranges::SIZE)?;
                bounds.place(&mut body.position)?;
                bounds.hold("tilt", &mut body.tilt, &(-360.0..=360.0))?;
                bounds.hold("heading", &mut body.heading, &(-360.0..=360.0))?;
                bounds.all("velocity", &mut body.velocity, &ranges::SPEED)?;
                bounds.all("spin", &mut body.spin, &ranges::SPIN)?;
            }
            Self::Rain(rain) => {
                bounds.hold("size", &mut rain.size, &ranges::SIZE)?;
                bounds.hold("number", &mut rain.count, &ranges::RAIN)?;
                bounds.hold("spread", &mut rain.spread, &(0.05..=4.0))?;
                bounds.all("height", &mut rain.heights, &ranges::HEIGHT)?;
                if rain.heights[0] > rain.heights[1] {
                    rain.heights.swap(0, 1);
                }
            }
            Self::Draw(points) => {
                if points.len() > MOST_POINTS {
                    return Err(format!("a line of more than {MOST_POINTS} points"));
                }
                for point in points {
                    bounds.place(point)?;
                }
            }
            Self::Set(setting) => bounds.setting(setting)?,
            Self::Remove(_) | Self::Clear => (),
        }
        Ok((self, bounds.notes))
    }

    /// Whether only the last of the two counts if both are made at the same time.
    pub fn replaces(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Set(a), Self::Set(b)) => discriminant(a) == discriminant(b),
            _ => false,
        }
    }
}

/// Holds numbers within ranges and notes which it held.
#[derive(Default)]
struct Bounds {
    notes: Vec<String>,
}

impl Bounds {
    fn hold(
        &mut self,
        what: &str,
        value: &mut f64,
        range: &RangeInclusive<f64>,
    ) -> Result<(), String> {
        if !value.is_finite() {
            return Err(format!("{what} is no number"));
        }
        let (low, high) = (*range.start(), *range.end());
        let held = value.clamp(low, high);
        if held != *value {
            self.notes
                .push(format!("{what} is held between {low} and {high}"));
            *value = held;
        }
        Ok(())
    }

    fn all(
        &mut self,
        what: &str,
        values: &mut [f64],
        range: &RangeInclusive<f64>,
    ) -> Result<(), String> {
        for value in values {
            self.hold(what, value, range)?;
        }
        Ok(())
    }

    fn place(&mut self, point: &mut [f64; 3]) -> Result<(), String> {
        let [x, y, z] = point;
        self.hold("place", x, &ranges::PLACE)?;
        self.hold("height", y, &ranges::HEIGHT)?;
        self.hold("place", z, &ranges::PLACE)
    }

    fn setting(&mut self, setting: &mut Setting) -> Result<(), String> {
        match setting {
            Setting::Level(x) => self.hold("level", x, &ranges::LEVEL),
            Setting::Waves(x) => self.hold("height of the waves", x, &ranges::WAVES),
            Setting::Wind(x) => self.all("wind", x, &ranges::WIND),
            Setting::Current(x) => self.all("current", x, &ranges::WIND),
            Setting::Turbulence(x) => self.hold("turbulence", x, &ranges::TURBULENCE),
            Setting::Eddy(x) => self.hold("size of the eddies", x, &ranges::EDDY),
            Setting::Coefficients(x) => self.all("coefficient", x, &ranges::COEFFICIENT),
            Setting::Factors(x) => self.all("factor", x, &ranges::FACTOR),
            Setting::Fluids(_) | Setting::Law(_) | Setting::Method(_) => Ok(()),
        }
    }
}
