//! Chapter 4: the stochastic method.

use super::entry::Ours::{Printed, Timed};
use super::entry::{Chapter, Entry, Number, api};

pub const CHAPTER: Chapter = Chapter {
    title: "Chapter 4: the stochastic method",
    entries: &[
        Entry {
            remark: "A drawing, and a list of symbols.",
            ..Entry::new("Fig. 4.1, Table 4.1", "overview, notation")
        },
        Entry {
            api: api![
                turbulence::TurbulenceParams,
                turbulence::TurbulenceTable,
                turbulence::KEpsilon
            ],
            example: Some("wind"),
            pictures: &["history.svg", "stream.svg"],
            numbers: &[Number::new(
                "k–ε model on 32 × 32 × 8 cells, 320 steps, ms",
                "182",
                Timed("k–ε, 32 × 32 × 8"),
            )],
            remark: "How many steps the thesis times is not printed; 182 ms are 24 of ours.",
            ..Entry::new("Fig. 4.2, Algorithm 1", "χ and ε over time")
        },
        Entry {
            api: api![
                StochasticLaw,
                turbulence::Turbulence,
                turbulence::LangevinMode
            ],
            example: Some("stochastic"),
            pictures: &["paper.svg", "endings.svg"],
            numbers: &[
                Number::new(
                    "75°: fall in 1.5 s without turbulence, m",
                    "",
                    Printed("/runs/paper, 75°, no turbulence/fall"),
                ),
                Number::new(
                    "75°: fall in 1.5 s with increments, m",
                    "",
                    Printed("/runs/paper, 75°, Langevin, the body's velocity (thesis)/fall"),
                ),
            ],
            remark: "That paper is “helical” from 75° and goes from side to side from 30° is not reproduced: the increments \
                     forget the release within a quarter of a second.",
            ..Entry::new("Fig. 4.3, Algorithm 2", "paper from 75° and 30°")
        },
        Entry {
            api: api![StochasticLaw, turbulence::LangevinMode],
            example: Some("stochastic"),
            pictures: &["airplane_side.svg", "airplane_above.svg"],
            remark: "Both of its turns, to the front and sideways, are there with turbulence, in 100 of 100 seeds with the \
                     thesis's increments, and not without. So is, now and then, a flight on its back. The video is not published.",
            ..Entry::new("Fig. 4.4", "a paper airplane")
        },
        Entry {
            api: api![ViscousLaw, turbulence::LangevinMode],
            example: Some("stochastic"),
            pictures: &["ellipsoid.svg"],
            remark: "By Kirchhoff's equations alone it stays in its plane, with turbulence it leaves it: as the thesis says.",
            ..Entry::new("Fig. 4.5", "a rubber ellipsoid in water")
        },
        Entry {
            api: api![Immersion],
            example: Some("stochastic"),
            numbers: &[
                Number::new(
                    "ellipsoid 1, 320 triangles, 1 ms: step, ms",
                    "1.59",
                    Printed("/cost/0/step_ms"),
                ),
                Number::new("ellipsoid 1, 5 ms", "1.63", Printed("/cost/1/step_ms")),
                Number::new("ellipsoid 1, 10 ms", "1.65", Printed("/cost/2/step_ms")),
                Number::new(
                    "ellipsoid 2, 1280 triangles, 5 ms",
                    "1.71",
                    Printed("/cost/3/step_ms"),
                ),
                Number::new(
                    "paper, 1024 triangles, 5 ms",
                    "1.73",
                    Printed("/cost/4/step_ms"),
                ),
                Number::new(
                    "airplane, 288 triangles, 5 ms",
                    "1.86",
                    Printed("/cost/5/step_ms"),
                ),
                Number::new(
                    "added mass, 1280 triangles, ms",
                    "53",
                    Timed("boundary elements, 1280 triangles"),
                ),
            ],
            remark: "Ours are whole steps of a rapier world with that body in it.",
            ..Entry::new("Table 4.2, § 4.6", "times of the method")
        },
    ],
};
