//! The stochastic method (thesis chapter 4) end to end: generalised Kirchhoff equations, constant
//! force coefficients, and Langevin turbulence from the k–ε table that the crate ships.
//!
//! ```text
//! cargo run --release --example stochastic -- --out out
//! ```
//!
//! * `paper.svg`: an elliptic piece of paper from two release angles, as Fig. 4.3: without turbulence, with the thesis's
//!   increments of the body's velocity, and in turbulence of the fluid. The increments halve the fall, and in a quarter
//!   of a second the release is forgotten,
//! * `endings.svg`: where 200 such falls are after 1.5 s, from above: without turbulence all at one point,
//! * `airplane_side.svg`, `airplane_above.svg`: the paper airplane of Fig. 4.4, thrown level with 0.2 m/s. Without turbulence
//!   it keeps its heading; with it, it pitches to the front and turns sideways, and often rolls over,
//! * `ellipsoid.svg`: a rubber ellipsoid in water, as Fig. 4.5: with Kirchhoff's equations alone, with its vortical loads,
//!   and with turbulence, without which it stays in the plane in which it was tilted,
//! * `paper.html`, `airplane.html`, `ellipsoid.html` (and `.glb`): the same flights side by side, to play in a browser,
//! * `stochastic.json`: what each run did, and the cost per step of the thesis's Table 4.2, all six rows, re-measured.
//!
//! Fig. 4.2, the history of the turbulence, is drawn by the example `wind`.

mod case;
mod cost;
mod figures;
#[path = "../support/mod.rs"]
mod support;

use case::{Case, Flight, Physics};
use clap::Parser;
use figures::{ALONG, FROM_ABOVE, FROM_THE_SIDE, Style, endings, strobe};
use serde_json::{Value, json};
use support::cli;
use support::film::{Film, FilmArgs};
use support::options::{Json, Out, Seed};
use support::picture::panels;
use support::recording::Recording;
use support::scene::{Kind, Scene};

/// The stochastic method's paper, airplane and ellipsoid, with and without turbulence.
#[derive(Parser, Debug)]
#[command(name = "stochastic", version)]
struct Options {
    #[command(flatten)]
    seed: Seed,
    /// Resistance of rotation, a share of that of the law's drag: 0 as the thesis prints it
    #[arg(long, value_name = "SHARE", default_value = "1", value_parser = cli::not_negative)]
    damping: f64,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

/// Runs under these physics, and what they did.
struct Runs<'a> {
    options: &'a Options,
    report: serde_json::Map<String, Value>,
}

impl Runs<'_> {
    fn case(&self, mut case: Case) -> Case {
        case.law.damping = self.options.damping;
        case
    }

    fn fly(&mut self, name: &str, case: &Case, physics: Physics) -> Flight {
        let flight = case.fly(physics, self.options.seed.value);
        let way = flight.way();
        let numbers = json!({
            "fall": -way.y,
            "drift": way.x.hypot(way.z),
            "turns": flight.turns(),
        });
        self.report
            .insert(format!("{name}, {}", physics.name()), numbers);
        flight
    }

    fn draw(&self, file: &str, title: &str, pictures: &[support::picture::Panel], layout: Layout) {
        let svg = panels(title, pictures, layout.0, layout.1).expect("lines can be drawn");
        self.options.out.write(file, svg);
    }
}

/// Flights of one case side by side as a page.
fn film(options: &Options, name: &str, title: &str, case: &Case, flights: &[(Physics, Flight)]) {
    let mut scene = Scene::new(Default::default());
    scene
        .kinds
        .push(Kind::seen(case.solid.clone(), case.dry.mass));
    scene.add_seen(0, [0.62, 0.24, 0.04]);
    let runs: Vec<(&str, Recording)> = flights
        .iter()
        .map(|(physics, flight)| (physics.name(), flight.recording()))
        .collect();
    let runs: Vec<(&str, &Recording)> = runs.iter().map(|(name, run)| (*name, run)).collect();
    let film = Film {
        name,
        title,
        scene: &scene,
        runs: &runs,
        camera: None,
        follow: true,
    };
    film.write(&options.out, &options.film);
}

/// Columns, and pixels of a panel.
type Layout = (usize, (u32, u32));

const THREE: [Physics; 3] = [Physics::Viscous, Physics::Increments, Physics::FluidSeen];

fn main() {
    let options: Options = cli::parse();
    let mut runs = Runs {
        options: &options,
        report: serde_json::Map::new(),
    };

    let mut pictures = [Vec::new(), Vec::new()];
    let style = Style {
        every: 0.04,
        view: FROM_THE_SIDE,
        window: [(-0.25, 0.25), (-1.5, 0.05)],
    };
    for (angle, name) in [(75.0, "paper, 75°"), (30.0, "paper, 30°")] {
        let case = runs.case(Case::paper(angle));
        let flights = THREE.map(|physics| (physics, runs.fly(name, &case, physics)));
        for (physics, flight) in &flights {
            pictures[0].push(strobe(physics.name(), &case, flight, style));
            pictures[1].push(endings(&case, *physics, 200));
        }
        if angle == 75.0 {
            film(
                &options,
                "paper",
                "Paper in air, let go at 75°",
                &case,
                &flights,
            );
        }
    }
    let title = "Paper of 8 × 2 × 0.01 cm in air, every 40 ms; released at 75° (top) and 30°";
    runs.draw("paper.svg", title, &pictures[0], (3, (330, 700)));
    let title =
        "Where 200 pieces of this paper are after 1.5 s, from above; released at 75° (top) and 30°";
    runs.draw("endings.svg", title, &pictures[1], (3, (470, 480)));

    let airplane = runs.case(Case::airplane(0.0));
    let flights = THREE.map(|physics| (physics, runs.fly("airplane", &airplane, physics)));
    film(
        &options,
        "airplane",
        "Paper airplane, thrown level with 0.2 m/s",
        &airplane,
        &flights,
    );
    let from_the_side = Style {
        every: 0.1,
        view: FROM_THE_SIDE,
        window: [(-0.25, 0.35), (-1.7, 0.1)],
    };
    let from_above = Style {
        every: 0.3,
        view: FROM_ABOVE,
        window: [(-0.1, 0.25), (-0.25, 0.1)],
    };
    for (file, style, size) in [
        ("airplane_side.svg", from_the_side, (400, 760)),
        ("airplane_above.svg", from_above, (400, 430)),
    ] {
        let panel = |(physics, flight): &(Physics, Flight)| {
            strobe(physics.name(), &airplane, flight, style)
        };
        let pictures: Vec<_> = flights.iter().map(panel).collect();
        let every = style.every;
        let title = format!("Paper airplane, thrown level with 0.2 m/s, every {every} s");
        runs.draw(file, &title, &pictures, (3, size));
    }

    let ellipsoid = runs.case(Case::ellipsoid(0.0));
    let four = [Physics::Kirchhoff, THREE[0], THREE[1], THREE[2]];
    let flights = four.map(|physics| (physics, runs.fly("ellipsoid", &ellipsoid, physics)));
    let title = "Rubber ellipsoid sinking in water";
    film(&options, "ellipsoid", title, &ellipsoid, &flights);
    let mut pictures = Vec::new();
    for view in [FROM_THE_SIDE, ALONG] {
        let style = Style {
            every: 0.05,
            view,
            window: [(-0.09, 0.11), (-0.47, 0.05)],
        };
        for (physics, flight) in &flights {
            pictures.push(strobe(physics.name(), &ellipsoid, flight, style));
        }
    }
    let title = "Rubber ellipsoid (semi-axes 1, 2, 4 cm) sinking in water, every 50 ms; from the side (top) and from the front";
    runs.draw("ellipsoid.svg", title, &pictures, (4, (310, 640)));

    let costs = cost::table();
    let text = json!({ "runs": runs.report, "cost": costs });
    let content = format!("{text:#}\n");
    options.out.write("stochastic.json", &content);
    if options.json.on {
        print!("{content}");
        return;
    }
    println!(
        "{:<55} {:>8} {:>8} {:>7}",
        "run", "fall, m", "drift, m", "turns"
    );
    for (name, run) in &runs.report {
        let number = |key: &str| run[key].as_f64().unwrap_or(f64::NAN);
        let (fall, drift, turns) = (number("fall"), number("drift"), number("turns"));
        println!("{name:<55} {fall:>8.2} {drift:>8.2} {turns:>7.1}");
    }
    cost::print(&costs);
    let out = options.out.folder.display();
    println!(
        "wrote paper, endings, airplane_side, airplane_above, ellipsoid (.svg), paper, airplane, ellipsoid (.html, .glb) and \
         stochastic.json to {out}"
    );
}
