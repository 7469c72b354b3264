//! A boat from a mesh file: how it rights itself, and how it lives in a random sea.
//!
//! ```text
//! cargo run --release --example boat
//! cargo run --release --example boat -- --hull mine.obj --center 0.1 --wave-height 0.5 --wave-period 4
//! ```
//!
//! Writes `boat.svg` (righting levers and motions), `boat.html` (a page that plays its first 40 s at sea), `boat.glb` (the same for
//! 3-D tools), `boat.json` (numbers) and, with `--gif`, `boat.gif`.

#[path = "../support/draw.rs"]
#[allow(dead_code, reason = "shared with other examples")]
mod draw;
mod film;
mod righting;
mod seakeeping;
#[path = "../support/mod.rs"]
mod support;
#[allow(dead_code, reason = "shared with the tests")]
mod wigley;

use clap::Parser;
use draw::{Item, Panel};
use plotters::style::RGBColor;
use righting::{Vessel, vanishing};
use seakeeping::{Record, Voyage, response, significant};
use serde_json::json;
use std::path::PathBuf;
use support::film::{Film, FilmArgs};
use support::options::{Json, Out, Seconds, Seed, wrote};
use support::{cli, mesh};

/// A hull from a file: its righting curve, and its motions in a random sea.
#[derive(Parser, Debug)]
#[command(name = "boat", version, allow_negative_numbers = true)]
#[command(mut_arg("seconds", |seconds| seconds.default_value("600")))]
#[command(mut_arg("seed", |seed| seed.default_value("7")))]
struct Options {
    /// Closed hull, OBJ or STL in metres: x forward, y up from the waterline that it floats at, z to starboard
    /// [default: Wigley's, 4 m]
    #[arg(long, value_name = "FILE")]
    hull: Option<PathBuf>,
    /// Height of the center of mass over the waterline, m
    #[arg(long, value_name = "M", default_value = "0.05", value_parser = cli::finite)]
    center: f64,
    /// Significant height of the waves, m
    #[arg(long, value_name = "M", default_value = "0.3", value_parser = cli::not_negative)]
    wave_height: f64,
    /// Period of the sea's peak, s
    #[arg(long, value_name = "S", default_value = "3", value_parser = cli::positive)]
    wave_period: f64,
    /// Angle between the bow and the waves' way at first, degrees
    #[arg(long, value_name = "DEG", default_value = "60", value_parser = cli::finite)]
    heading: f64,
    #[command(flatten)]
    time: Seconds,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

const OURS: RGBColor = RGBColor(30, 90, 200);
const EXACT: RGBColor = RGBColor(40, 40, 40);
const SEA: RGBColor = RGBColor(120, 165, 175);
const ROLL: RGBColor = RGBColor(211, 47, 47);

/// Righting levers by heel, and those that they should be.
struct Levers {
    heels: Vec<f64>,
    ours: Vec<f64>,
    exact: Vec<f64>,
}

impl Levers {
    /// As lines over degrees.
    fn drawn(&self, title: &str) -> Panel {
        let mut panel = Panel::new(title, "heel, degrees", "righting lever GZ, m");
        let line = |levers: &[f64]| {
            let points = self.heels.iter().map(|heel| heel.to_degrees());
            points.zip(levers.iter().copied()).collect()
        };
        panel.items = vec![
            Item::Line(
                vec![
                    (0.0, 0.0),
                    (self.heels[self.heels.len() - 1].to_degrees(), 0.0),
                ],
                SEA,
                1,
            ),
            Item::Line(line(&self.ours), OURS, 4),
            Item::Dashed(line(&self.exact), EXACT),
        ];
        panel
    }

    /// Largest difference, m.
    fn worst(&self) -> f64 {
        let pairs = self.ours.iter().zip(&self.exact);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

/// A box of 4 × 1 × .8 m, its center of mass in the waterline, up to where its deck's edge goes under: there
/// GZ = sin θ (GM + ½ BM tan² θ).
fn barge() -> Levers {
    let [beam, draft] = [1.0, 0.3];
    let barge = Vessel::barge([4.0, beam, 0.8], draft, 0.0);
    let most = (2.0 * draft / beam).atan();
    let heels: Vec<f64> = (0..=30).map(|i| most * f64::from(i) / 30.0).collect();
    let bm = beam * beam / (12.0 * draft);
    let gm = bm - 0.5 * draft;
    let exact = |heel: &f64| heel.sin() * (gm + 0.5 * bm * heel.tan().powi(2));
    Levers {
        ours: barge.levers(&heels),
        exact: heels.iter().map(exact).collect(),
        heels,
    }
}

fn main() {
    let options: Options = cli::parse();
    macro_rules! say {
        ($($words:tt)*) => {
            if !options.json.on {
                println!($($words)*);
            }
        };
    }
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/boat/wigley.obj");
    let path = options.hull.clone().unwrap_or(own.into());
    let hull = mesh::load(&path).and_then(|raw| raw.solid(0.0));
    let hull = hull.unwrap_or_else(|problem| cli::bad_value("--hull", problem));
    if hull.vertices().iter().all(|v| v.y >= 0.0) || hull.vertices().iter().all(|v| v.y <= 0.0) {
        cli::bad_value("--hull", "the waterline y = 0 does not cut it");
    }
    let vessel = Vessel::new(hull, options.center);

    let heels: Vec<f64> = (0..=90).map(|i| f64::from(2 * i).to_radians()).collect();
    let levers = Levers {
        ours: vessel.levers(&heels),
        exact: vessel.sounded_levers(&heels),
        heels,
    };
    let barge = barge();
    let most = levers.ours.iter().copied().fold(0.0, f64::max);
    let turns = [&levers.ours, &levers.exact]
        .map(|curve| vanishing(&levers.heels, curve).map(f64::to_degrees));
    say!(
        "{}: {:.0} kg, {} triangles",
        path.display(),
        vessel.dry.mass,
        vessel.hull.triangles().len()
    );
    if options.hull.is_none() {
        let (found, exact) = (vessel.dry.mass / 997.0, wigley::DINGHY.displacement());
        say!("volume under water {found:.4} m³, {exact:.4} of the hull without facets");
    }
    say!(
        "righting lever: {most:.4} m at most, {:.1e} m off soundings at most",
        levers.worst()
    );
    say!(
        "  vanishes at {:.2}° of heel, by soundings {:.2}°",
        turns[0].unwrap_or(f64::NAN),
        turns[1].unwrap_or(f64::NAN)
    );
    say!(
        "a barge: {:.1e} m off sin θ (GM + ½ BM tan² θ) at most",
        barge.worst()
    );

    let voyage = Voyage {
        height: options.wave_height,
        period: options.wave_period,
        seed: options.seed.value,
        heading: options.heading.to_radians(),
        seconds: options.time.given(),
    };
    let record = voyage.record(&vessel);
    let record =
        record.unwrap_or_else(|problem| cli::bad_value("--wave-height/--wave-period", problem));
    let [elevation, heave] = [&record.elevation, &record.heave].map(|series| significant(series));
    let [roll, pitch] =
        [&record.roll, &record.pitch].map(|series| significant(series).to_degrees());
    let follows = response(&record.elevation, &record.heave);
    say!(
        "{} s in waves of {} m and {} s:",
        voyage.seconds,
        options.wave_height,
        options.wave_period
    );
    say!(
        "  significant: sea at the boat {elevation:.3} m, heave {heave:.3} m, roll {roll:.1}°, pitch {pitch:.1}°"
    );
    say!(
        "  own periods: heave {:.2} s, roll {:.2} s",
        record.periods[0],
        record.periods[1]
    );
    say!("  heave over the sea's height, by frequency:");
    for (frequency, share) in follows.iter().step_by(2) {
        say!("    {frequency:.3} Hz {share:.2}");
    }
    say!(
        "  under water {:.0} to {:.0} % of the volume; {:.0} µs a step",
        100.0 * record.submerged[1],
        100.0 * record.submerged[0],
        record.step
    );

    let panels = [
        attitudes(&vessel),
        levers.drawn("the boat: ours (blue), by soundings (dashed)"),
        barge.drawn("a barge: ours (blue), sin θ (GM + ½ BM tan² θ) (dashed)"),
        heaving(&record),
        rolling(&record),
        following(&follows),
    ];
    let picture = draw::svg(
        "A boat: what rights it, and what the sea does to it",
        &panels,
        3,
        (520, 380),
    );
    let picture = picture.unwrap_or_else(|problem| cli::cannot_write("boat.svg".as_ref(), problem));
    let summary = json!({
        "mass_kg": vessel.dry.mass,
        "largest_lever_m": most,
        "lever_error_m": levers.worst(),
        "vanishing_heel_deg": turns,
        "barge_lever_error_m": barge.worst(),
        "significant": {"sea_m": elevation, "heave_m": heave, "roll_deg": roll, "pitch_deg": pitch},
        "periods": {"heave_s": record.periods[0], "roll_s": record.periods[1]},
        "heave_response_by_frequency_hz": follows,
        "step_us": record.step,
    });
    let (scene, recording) = film::animation(&vessel, &record, &voyage)
        .unwrap_or_else(|problem| cli::cannot_write("boat.glb".as_ref(), problem));
    let film = Film {
        name: "boat",
        title: "A boat in a sea",
        scene: &scene,
        runs: &[("boat", &recording)],
        camera: None,
        follow: false,
    };
    let mut files = film.write(&options.out, &options.film);
    files.push(options.out.write("boat.svg", picture));
    files.push(options.out.write("boat.json", format!("{summary:#}\n")));
    if options.json.on {
        println!("{summary:#}");
    } else {
        println!("{}", wrote(&files));
    }
}

/// The boat from ahead at four heels, as it floats then.
fn attitudes(vessel: &Vessel) -> Panel {
    let mut panel = Panel::bare("from ahead at a heel of 0, 30, 60 and 90°");
    for i in 0..4 {
        let heel = f64::from(30 * i).to_radians();
        let aside = 1.4 * f64::from(i);
        let outline = film::seen_from_ahead(vessel, heel);
        let corners: Vec<_> = outline.iter().map(|[z, y]| (z + aside, *y)).collect();
        let closed = corners.iter().chain(&corners[..1]).copied().collect();
        panel.items.push(Item::Line(closed, EXACT, 2));
        panel.items.push(Item::Line(
            vec![(aside - 0.65, 0.0), (aside + 0.65, 0.0)],
            OURS,
            2,
        ));
    }
    panel
}

/// The first minute.
fn shown(record: &Record, series: &[f64], factor: f64) -> Vec<(f64, f64)> {
    let start = record.times.first().copied().unwrap_or(0.0);
    let points = record
        .times
        .iter()
        .zip(series)
        .map(|(t, x)| (t - start, factor * x));
    points.take_while(|(t, _)| *t < 60.0).collect()
}

fn heaving(record: &Record) -> Panel {
    let mut panel = Panel::new("heave (blue) on the sea's height there", "s", "m");
    panel.items = vec![
        Item::Line(shown(record, &record.elevation, 1.0), SEA, 3),
        Item::Line(shown(record, &record.heave, 1.0), OURS, 1),
    ];
    panel
}

fn rolling(record: &Record) -> Panel {
    let degrees = 1f64.to_degrees();
    let mut panel = Panel::new("roll (red) and pitch (blue)", "s", "degrees");
    panel.items = vec![
        Item::Line(shown(record, &record.pitch, degrees), OURS, 1),
        Item::Line(shown(record, &record.roll, degrees), ROLL, 1),
    ];
    panel
}

fn following(follows: &[(f64, f64)]) -> Panel {
    let mut panel = Panel::new("heave over the sea's height", "frequency, Hz", "");
    let last = follows.last().map_or(1.0, |(frequency, _)| *frequency);
    panel.window = Some([(0.0, last), (0.0, 1.6)]);
    panel.items = vec![
        Item::Line(vec![(0.0, 1.0), (last, 1.0)], SEA, 1),
        Item::Line(
            follows
                .iter()
                .map(|(f, share)| (*f, share.min(1.6)))
                .collect(),
            OURS,
            2,
        ),
    ];
    panel
}
