//! Numbers of thesis chapter 3 that it takes from experiments without printing them, estimated from falls.

use super::pattern::Regime;
use crate::error::Error;
use std::sync::OnceLock;

/// Where a number is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EstimateSource {
    /// Falls of discs under this crate's default law.
    Own,
    /// Tracked falls of paper discs and hexagons (Howison et al. 2020).
    Tracks,
}

/// One estimated number.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// What it is; `estimates.csv` lists the names.
    pub quantity: String,
    /// Where it is from.
    pub source: EstimateSource,
    /// The regime of the fall as a whole that it is of.
    pub main: Option<Regime>,
    /// The regime of a half period, of a transition.
    pub from: Option<Regime>,
    /// The regime of the next one, of a transition; the first one, of a start.
    pub to: Option<Regime>,
    /// The number.
    pub value: f64,
    /// Its standard error, by the scatter between falls.
    pub error: f64,
    /// How many observations it is from.
    pub count: u64,
}

/// The estimates that this crate's defaults are taken from: the transition probabilities (3.13)
/// ([`MotionGraph::free_fall`](super::MotionGraph::free_fall)), B and C of (3.9)
/// ([`Deviation::of`](super::path::Deviation::of)) and the border of the spiral
/// ([`PhaseDiagram`](super::PhaseDiagram)).
///
/// `cargo run --release --features bake --example synthesis -- --estimate src/motion/estimates.csv` writes the
/// file that ships; its head says how.
///
/// ```
/// use rapier3d_immersed::motion::{EstimateSource, FallEstimates, Regime};
///
/// let shipped = FallEstimates::shipped();
/// // Tracked papers that tumble land 0.6 of their height away.
/// let tumbling = Some(Regime::PeriodicTumbling);
/// let mean = shipped.find("deviation_mean", EstimateSource::Tracks, [tumbling, None, None]);
/// assert!((mean.unwrap().value - 0.6).abs() < 0.05);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FallEstimates {
    rows: Vec<Estimate>,
}

impl FallEstimates {
    /// The columns of the file.
    pub const HEADER: &'static str = "quantity,source,main,from,to,value,error,count";

    /// What ships.
    pub fn shipped() -> &'static Self {
        static SHIPPED: OnceLock<FallEstimates> = OnceLock::new();
        SHIPPED.get_or_init(|| {
            Self::from_csv(include_str!("estimates.csv")).expect("the shipped file is a good one")
        })
    }

    /// Reads a table; lines that begin with # are comments.
    ///
    /// # Errors
    /// [`Error::WrongLength`] if the header or the columns of a row are others, [`Error::NotFinite`] or
    /// [`Error::InvalidParameter`] if a field cannot be read.
    pub fn from_csv(text: &str) -> Result<Self, Error> {
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let columns = Self::HEADER.split(',').count();
        let header = lines.next().unwrap_or_default();
        let found = header.split(',').count() as f64;
        Error::check(
            "header of estimates",
            found,
            header == Self::HEADER,
            Self::HEADER,
        )?;
        let row = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            Error::check_length("columns of an estimate", columns, fields.len())?;
            let number = |field: &str| {
                let value = field.parse().unwrap_or(f64::NAN);
                Error::check_finite("number of an estimate", value)
            };
            Ok(Estimate {
                quantity: fields[0].to_string(),
                source: match fields[1] {
                    "tracks" => EstimateSource::Tracks,
                    _ => EstimateSource::Own,
                },
                main: regime(fields[2])?,
                from: regime(fields[3])?,
                to: regime(fields[4])?,
                value: number(fields[5])?,
                error: Error::check_not_negative("error of an estimate", number(fields[6])?)?,
                count: Error::check_not_negative("count of an estimate", number(fields[7])?)?
                    as u64,
            })
        };
        let rows = lines.map(row).collect::<Result<_, Error>>()?;
        Ok(Self { rows })
    }

    /// All of them.
    pub fn rows(&self) -> &[Estimate] {
        &self.rows
    }

    /// The estimate of a quantity of a fall's main regime, from a regime, to one.
    pub fn find(
        &self,
        quantity: &str,
        source: EstimateSource,
        [main, from, to]: [Option<Regime>; 3],
    ) -> Option<&Estimate> {
        self.rows.iter().find(|row| {
            row.quantity == quantity
                && row.source == source
                && [row.main, row.from, row.to] == [main, from, to]
        })
    }

    /// How often falls of a main regime went from one regime to another within a half period (or stayed),
    /// backward transitions too.
    pub fn transitions(&self, main: Regime) -> [[u64; 6]; 6] {
        let mut counts = [[0; 6]; 6];
        for row in self.rows.iter().filter(|row| row.main == Some(main)) {
            if let ("transition", Some(from), Some(to)) = (&*row.quantity, row.from, row.to) {
                counts[from as usize][to as usize] += row.count;
            }
        }
        counts
    }

    /// In which regime falls of a main regime began.
    pub fn starts(&self, main: Regime) -> [u64; 6] {
        let mut counts = [0; 6];
        for row in self.rows.iter().filter(|row| row.main == Some(main)) {
            if let ("start", Some(to)) = (&*row.quantity, row.to) {
                counts[to as usize] += row.count;
            }
        }
        counts
    }

    /// B or C of (3.9): from tracks where they show the regime, from own falls elsewhere; of the helix,
    /// which neither shows, that of the spiral.
    pub(crate) fn deviation(&self, quantity: &str, regime: Regime) -> f64 {
        let regime = match regime {
            Regime::TransitionalHelix => Regime::PeriodicSpiral,
            other => other,
        };
        let of = |source| self.find(quantity, source, [Some(regime), None, None]);
        let found = of(EstimateSource::Tracks).or_else(|| of(EstimateSource::Own));
        found.map_or(0.0, |row| row.value)
    }

    /// I* below which own falls circle.
    pub(crate) fn spiral_below(&self) -> f64 {
        let border = self.find("spiral_below", EstimateSource::Own, [None; 3]);
        border.map_or(0.0, |row| row.value)
    }
}

fn regime(field: &str) -> Result<Option<Regime>, Error> {
    if field.is_empty() {
        return Ok(None);
    }
    let named = |regime: &Regime| regime.abbreviation() == field;
    let found = Regime::ALL.into_iter().find(named);
    Error::check(
        "regime of an estimate",
        f64::NAN,
        found.is_some(),
        "SD, PF, TC, PT, TH or PS",
    )?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shipped_file_is_complete() {
        let shipped = FallEstimates::shipped();
        let mut falls = 0;
        for main in Regime::ALL {
            let row = shipped.find("falls", EstimateSource::Own, [Some(main), None, None]);
            let count = row.unwrap().count;
            assert_eq!(shipped.starts(main).iter().sum::<u64>(), count);
            falls += count;
            assert!(shipped.deviation("deviation_mean", main) > 0.0, "{main}");
            assert!(shipped.deviation("deviation_width", main) > 0.0, "{main}");
        }
        assert!(falls >= 10_000);
        assert!((1e-3..1e-2).contains(&shipped.spiral_below()));
    }

    #[test]
    fn bad_tables_are_refused() {
        let table =
            |row: &str| FallEstimates::from_csv(&format!("{}\n{row}\n", FallEstimates::HEADER));
        assert!(table("start,own,PF,,SD,0.1,0.01,20").is_ok());
        assert!(table("start,own,XX,,SD,0.1,0.01,20").is_err());
        assert!(table("start,own,PF,,SD,nan,0.01,20").is_err());
        assert!(table("start,own,PF,,SD,0.1,-1,20").is_err());
        assert!(table("start,own,PF,,SD,0.1,0.01").is_err());
        assert!(FallEstimates::from_csv("").is_err());
    }
}
