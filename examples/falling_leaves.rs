//! A few hundred leaves and some confetti fall on a floor with obstacles: they flutter, tumble,
//! collide and come to rest. Or a paper airplane flies. Beside it the same scene in plain rapier.
//!
//! ```text
//! cargo run --release --example falling_leaves
//! cargo run --release --example falling_leaves -- --fluid water --leaves 100
//! cargo run --release --example falling_leaves -- --mesh my_leaf.obj --scale 0.001
//! cargo run --release --example falling_leaves -- --wind 2 --turbulence 0.3
//! cargo run --release --example falling_leaves -- --scene airplane
//! ```
//!
//! Writes `frames.svg` (moments of the run), `trajectories.svg` (both runs, from the side and from
//! above), `leaves.html` (plays in a browser; `--open` opens it), `leaves.glb` (the same for 3-D tools), `leaves.gif` and
//! `summary.json`.

mod support;

use clap::{Parser, ValueEnum};
use rand::{RngExt, SeedableRng};
use rapier3d_immersed::flow::LogLaw;
use rapier3d_immersed::rapier3d::math::{Pose, Rotation, Vector};
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{Immersion, Warning, preset};
use serde_json::{Value, json};
use std::path::PathBuf;
use support::airplane::Flight;
use support::cli::{self, FluidName, bad_value};
use support::leaf::{Blade, Outline};
use support::recording::{Plain, Recording, RunOptions, run};
use support::scene::{Kind, Scene};
use support::summary::{Summary, table};
use support::{Quat, Vec3, airplane, gallery, gif, glb, html, mesh};

/// Leaves and confetti fall on a floor with obstacles; the same scene in plain rapier beside it.
#[derive(Parser, Debug)]
#[command(name = "falling_leaves", version, allow_negative_numbers = true)]
struct Options {
    /// What falls
    #[arg(long, value_enum, default_value = "leaves")]
    scene: SceneName,
    /// Number of leaves [default: 300]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=20_000))]
    leaves: Option<u32>,
    /// Number of pieces of confetti [default: a third of --leaves]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=20_000))]
    confetti: Option<u32>,
    /// Simulated time, s [default: leaves 7 in air, 40 in water; airplane 4, 20]
    #[arg(long, value_name = "S", value_parser = cli::positive)]
    seconds: Option<f64>,
    /// Fluid to fall through
    #[arg(long, value_enum, default_value = "air")]
    fluid: FluidName,
    /// A leaf of your own, OBJ or STL in metres, instead of the built-in outlines: a closed solid, or
    /// an open sheet that gets a thickness of 0.3 mm
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Factor for the coordinates of --mesh: 0.001 for millimetres
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = cli::positive)]
    scale: f64,
    /// Density of the leaves [default: 350 in air, 1400 in water] or of the airplane [default: 800 in
    /// air, 2000 in water], kg/m³
    #[arg(long, value_name = "KG/M3", value_parser = cli::positive)]
    density: Option<f64>,
    /// Seed of the leaves' release: places, attitudes, colours [default: 7]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Wind along x, m/s at 2 m height, that grows with the logarithm of height
    #[arg(long, value_name = "M/S", default_value = "0", value_parser = cli::not_negative)]
    wind: f64,
    /// Turbulence: root mean square of the fluid's fluctuations over the wind speed, or over 1 m/s
    /// where the wind is less
    #[arg(long, value_name = "INTENSITY", default_value = "0", value_parser = cli::not_negative)]
    turbulence: f64,
    /// Time step, s [default: 1/240, the leaf-scale preset]
    #[arg(long, value_name = "S", value_parser = cli::positive)]
    dt: Option<f64>,
    /// Frames per second of the animation
    #[arg(long, value_name = "HZ", default_value = "30", value_parser = cli::positive)]
    frame_rate: f64,
    /// Skip the run in plain rapier
    #[arg(long)]
    no_compare: bool,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Show the animation in the browser
    #[arg(long)]
    open: bool,
    /// Print the summary as one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

/// Scenes by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SceneName {
    /// Leaves and confetti
    Leaves,
    /// The thesis's paper airplane of 8.3 × 8.3 × 0.01 cm with a paper clip on its nose, thrown with 2 m/s
    Airplane,
}

/// Linear RGB.
const AUTUMN: [[f32; 3]; 5] = [
    [0.55, 0.16, 0.02],
    [0.70, 0.33, 0.03],
    [0.42, 0.06, 0.03],
    [0.62, 0.48, 0.06],
    [0.26, 0.30, 0.06],
];
const CONFETTI: [[f32; 3]; 3] = [[0.05, 0.30, 0.65], [0.75, 0.08, 0.30], [0.85, 0.85, 0.85]];
const STONE: [f32; 3] = [0.42, 0.44, 0.47];

fn main() {
    let options: Options = cli::parse();
    check(&options);
    let seconds = options
        .seconds
        .unwrap_or(match (options.scene, options.fluid) {
            (SceneName::Leaves, FluidName::Air) => 7.0,
            (SceneName::Leaves, FluidName::Water) => 40.0,
            (SceneName::Airplane, FluidName::Air) => 4.0,
            (SceneName::Airplane, FluidName::Water) => 20.0,
        });
    let kinds = kinds(&options);
    let mut scene = build(&options, &kinds);
    if scene.pieces.is_empty() {
        bad_value("--leaves", "with --confetti 0 there has to be a leaf");
    }
    let dt = f64::from(scene.world.integration_parameters.dt);
    if seconds / dt > 1e6 {
        bad_value("--seconds", "more than a million steps");
    }
    let frames = seconds * options.frame_rate.min(1.0 / dt) * scene.pieces.len() as f64;
    if frames > 2e7 {
        bad_value("--frame-rate", "more than 20 million poses to record");
    }

    let fluid = options.fluid.fluid();
    let mut immersion = Immersion::new(fluid);
    for (index, kind) in scene.kinds.iter().enumerate() {
        let handles = scene
            .pieces
            .iter()
            .filter(|p| p.kind == index)
            .map(|p| p.handle);
        immersion.insert_all(handles, (*kind.body).clone());
    }
    stir(&mut immersion, &options);
    let run_options = RunOptions {
        seconds,
        frame_rate: options.frame_rate,
        // They take more memory than the poses.
        forces: frames < 1e6,
        message: "immersed",
    };
    let recording = run(&mut scene, &run_options, &mut immersion);
    report_warnings(immersion.warnings());

    let plain_run = (!options.no_compare).then(|| {
        let mut scene = build(&options, &kinds);
        let run_options = RunOptions {
            forces: false,
            message: "plain rapier",
            ..run_options
        };
        run(&mut scene, &run_options, &mut Plain)
    });
    let told = match options.scene {
        SceneName::Leaves => leaves_told(&scene, &recording, plain_run.as_ref()),
        SceneName::Airplane => airplane_told(&scene, &recording, plain_run.as_ref()),
    };

    let (immersed, plain) = told.numbers;
    let json = json!({
        "pieces": scene.pieces.len(),
        "immersed": immersed,
        "plain": plain,
    });
    let mut runs = vec![("immersed", &recording)];
    runs.extend(plain_run.iter().map(|plain| ("plain rapier", plain)));
    let takes: Vec<&Recording> = runs.iter().map(|(_, recording)| *recording).collect();
    let path = |name: &str| options.out.join(name);
    let moving = |kind: &str| path(&format!("{}.{kind}", told.animation));
    let page = moving("html");
    let mut files = vec![
        (path("frames.svg"), told.frames.into_bytes()),
        (path("trajectories.svg"), told.trajectories.into_bytes()),
        (page.clone(), html::page(&told.title, &scene, &runs).into()),
        (moving("glb"), glb::animation(&scene, &recording)),
        (path("summary.json"), format!("{json:#}\n").into_bytes()),
    ];
    // The airplane is too small to be seen in a picture of its whole flight.
    if options.scene == SceneName::Leaves {
        let path = moving("gif");
        let gif = gif::animation(&scene, &takes)
            .unwrap_or_else(|problem| cli::cannot_write(&path, problem));
        files.push((path, gif));
    }
    for (path, content) in &files {
        cli::write(path, content);
    }
    if options.json {
        println!("{json:#}");
    } else {
        let fluid = match options.fluid {
            FluidName::Air => "air",
            FluidName::Water => "water",
        };
        println!("{}, {seconds} s in {fluid}", told.title);
        print!("{}", told.table);
        let names: Vec<String> = files
            .iter()
            .map(|(path, _)| path.display().to_string())
            .collect();
        println!("wrote {}", names.join(", "));
    }
    if options.open {
        cli::open(&page);
    }
}

/// Sets the wind and the turbulence.
fn stir(immersion: &mut Immersion, options: &Options) {
    /// Where the wind has its speed, m, over a floor of this roughness, m.
    const HEIGHT: f32 = 2.0;
    const ROUGHNESS: f32 = 0.003;
    /// Size of the eddies, m: a room's.
    const EDDIES: f32 = 0.5;
    if options.wind > 0.0 {
        let speed = options.wind as f32;
        let wind = LogLaw::new(Vector::X, Vector::Y, speed, HEIGHT, ROUGHNESS);
        immersion.set_flow(wind.unwrap_or_else(|problem| bad_value("--wind", problem)));
    }
    if options.turbulence > 0.0 {
        let (speed, intensity) = (options.wind.max(1.0) as f32, options.turbulence as f32);
        let state = TurbulenceState::from_intensity(speed, intensity, EDDIES);
        immersion.set_turbulence(TurbulentLayer {
            source: Turbulence::Homogeneous(
                state.unwrap_or_else(|problem| bad_value("--turbulence", problem)),
            ),
            mode: LangevinMode::FluidSeen,
            seed: options.seed.unwrap_or(7),
        });
    }
}

/// A finished run in words, numbers and pictures.
struct Told {
    title: String,
    table: String,
    /// Immersed and in plain rapier.
    numbers: (Value, Option<Value>),
    frames: String,
    trajectories: String,
    /// Name of the animation's files, without their kind.
    animation: &'static str,
}

fn leaves_told(scene: &Scene, recording: &Recording, plain: Option<&Recording>) -> Told {
    let summary = Summary::of(scene, recording);
    let plain_summary = plain.map(|plain| Summary::of(scene, plain));
    Told {
        title: format!("{} leaves and pieces of confetti", scene.pieces.len()),
        table: table(&summary, plain_summary.as_ref()),
        numbers: (summary.json(), plain_summary.map(|plain| plain.json())),
        frames: gallery::frames(scene, recording, &summary),
        trajectories: gallery::trajectories(scene, recording, plain),
        animation: "leaves",
    }
}

fn airplane_told(scene: &Scene, recording: &Recording, plain: Option<&Recording>) -> Told {
    let flight = Flight::of(scene, recording);
    let plain_flight = plain.map(|plain| Flight::of(scene, plain));
    Told {
        title: "a paper airplane".into(),
        table: airplane::table(&flight, plain_flight.as_ref()),
        numbers: (flight.json(), plain_flight.map(|plain| plain.json())),
        frames: airplane::frames(scene, recording, &flight),
        trajectories: airplane::path(scene, recording, &flight, plain),
        animation: "airplane",
    }
}

/// Ends the program if an option is of no use in the scene.
fn check(options: &Options) {
    if options.scale != 1.0 && options.mesh.is_none() {
        bad_value("--scale", "is for the coordinates of a --mesh");
    }
    let only_leaves = [
        ("--leaves", options.leaves.is_some()),
        ("--confetti", options.confetti.is_some()),
        ("--mesh", options.mesh.is_some()),
        ("--seed", options.seed.is_some()),
    ];
    if options.scene == SceneName::Airplane
        && let Some((flag, _)) = only_leaves.iter().find(|(_, given)| *given)
    {
        bad_value(flag, "is for --scene leaves");
    }
}

/// One line for all pieces whose inertia rapier alone would have wrong, one each for anything else.
fn report_warnings(warnings: &[Warning]) {
    let is_inertia = |warning: &&Warning| matches!(warning, Warning::WrongInertia { .. });
    let corrected = warnings.iter().filter(is_inertia).count();
    if corrected > 0 {
        eprintln!(
            "note: rapier's own inertia of {corrected} pieces is wrong; corrected while immersed"
        );
    }
    for warning in warnings.iter().filter(|warning| !is_inertia(warning)) {
        eprintln!("warning: {warning}");
    }
}

/// Leaves first, confetti last; or the airplane.
fn kinds(options: &Options) -> Vec<Kind> {
    let (leaf, paper) = match options.fluid {
        FluidName::Air => (350.0, 800.0),
        // Soaked leaves sink by 1 to 2 cm/s; these are of plastic, for the patience of the viewer.
        FluidName::Water => (1400.0, 2000.0),
    };
    if options.scene == SceneName::Airplane {
        let kind = airplane::flying(options.density.unwrap_or(paper));
        return vec![kind.unwrap_or_else(|problem| bad_value("--density", problem))];
    }
    let leaf = options.density.unwrap_or(leaf);
    let mut kinds = match &options.mesh {
        Some(path) => {
            let problem = |text: String| -> ! {
                bad_value("--mesh", format!("{}: {text}", path.display()));
            };
            let mut raw = mesh::load(path).unwrap_or_else(|text| bad_value("--mesh", text));
            for vertex in &mut raw.vertices {
                *vertex *= options.scale;
            }
            let solid = raw.solid(0.0003).unwrap_or_else(|text| problem(text));
            let solid = mesh::aligned(&solid);
            let size = solid.size();
            if !(1e-3..=1.0).contains(&size) {
                problem(format!(
                    "{size:.3e} m across; this scene is for leaves of 1 mm to 1 m (see --scale)"
                ));
            }
            vec![Kind::new(&solid, leaf, None).unwrap_or_else(|text| problem(text))]
        }
        None => {
            let blade = |outline, length, width, camber| Blade {
                outline,
                length,
                width,
                thickness: 0.0003,
                camber,
            };
            [
                blade(Outline::Elliptic, 0.073, 0.042, [0.001, 0.0015]),
                blade(Outline::Ovate, 0.064, 0.044, [0.0015, 0.001]),
                blade(Outline::Lanceolate, 0.080, 0.022, [0.002, 0.0]),
                blade(Outline::Maple, 0.068, 0.070, [0.001, 0.001]),
            ]
            .map(|blade| built_in(&blade, leaf))
            .into()
        }
    };
    let confetti = Blade {
        outline: Outline::Rectangle,
        length: 0.028,
        width: 0.014,
        thickness: 0.0001,
        camber: [0.0, 0.0],
    };
    kinds.push(built_in(&confetti, paper));
    kinds
}

fn built_in(blade: &Blade, density: f64) -> Kind {
    let outline = blade.outline.points(blade.length, blade.width, 20);
    let picture: Vec<Vec3> = outline.iter().map(|p| Vec3::new(p[0], 0.0, p[1])).collect();
    let solid = blade.solid().expect("a blade is a closed solid");
    Kind::new(&solid, density, Some(&picture))
        .unwrap_or_else(|problem| bad_value("--density", problem))
}

/// Floor, obstacles, and all pieces above them. Equal options give equal scenes.
fn build(options: &Options, kinds: &[Kind]) -> Scene {
    let mut world = PhysicsWorld::new();
    preset::leaf_scale(&mut world.integration_parameters);
    if let Some(dt) = options.dt {
        world.integration_parameters.dt = dt as f32;
    }
    if options.scene == SceneName::Airplane {
        return airplane::scene(world, kinds);
    }
    let mut scene = Scene::new(world);
    scene.kinds = kinds.to_vec();
    furnish(&mut scene);

    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(options.seed.unwrap_or(7));
    let leaves = options.leaves.unwrap_or(300);
    let confetti = options.confetti.unwrap_or(leaves / 3);
    let count = leaves + confetti;
    let mut order: Vec<bool> = (0..count).map(|i| i < leaves).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.random_range(0..=i));
    }
    // A grid wide enough for any attitude, every piece somewhere in its cell.
    let size = kinds
        .iter()
        .map(|kind| kind.solid.size())
        .fold(0.0, f64::max);
    let cell = (1.3 * size).max(0.11);
    let (width, lowest, highest) = match options.fluid {
        FluidName::Air => (0.7, 0.9, 2.6),
        FluidName::Water => (1.4, 0.45, 0.8),
    };
    let across = ((width / cell) as u32).max(3);
    let layers = count.div_ceil(across * across).max(1);
    let rise = cell.max((highest - lowest) / f64::from(layers));
    for (i, is_leaf) in order.into_iter().enumerate() {
        let i = i as u32;
        let place = [i % across, (i / across) % across, i / (across * across)];
        let mut shift = |room: f64| {
            let free = 0.5 * (room - size).max(0.0);
            random.random_range(-free..=free)
        };
        let middle = 0.5 * f64::from(across - 1);
        let position = Vec3::new(
            (f64::from(place[0]) - middle) * cell + shift(cell),
            lowest + (f64::from(place[2]) + 0.5) * rise + shift(rise),
            (f64::from(place[1]) - middle) * cell + shift(cell),
        );
        let mut angle = || random.random_range(-1.0..1.0_f64);
        // Near level, as from a twig, in any direction.
        let heading = Quat::from_axis_angle(&Vec3::y_axis(), std::f64::consts::PI * angle());
        let tilt = Quat::from_scaled_axis(Vec3::new(angle(), 0.0, angle()) * 0.9);
        let spin = Vec3::new(angle(), angle(), angle()) * 2.0;
        let leaf_kinds = kinds.len() - 1;
        let (kind, color) = if is_leaf {
            (
                random.random_range(0..leaf_kinds),
                AUTUMN[random.random_range(0..AUTUMN.len())],
            )
        } else {
            (leaf_kinds, CONFETTI[random.random_range(0..CONFETTI.len())])
        };
        // From the frame of the piece, whichever way its normal points, to lying flat.
        let axes = &kinds[kind].body.hydro.planform.axes;
        let normal = axes * Vec3::z();
        let level = Quat::rotation_between(&normal, &Vec3::y()).unwrap_or_else(Quat::identity);
        scene.add_piece(
            kind,
            color,
            (position, heading * tilt * level),
            spin,
            preset::leaf_body,
        );
    }
    scene
}

/// Floor, two blocks, a ramp and a ball.
fn furnish(scene: &mut Scene) {
    let at = |x: f32, y: f32, z: f32| Pose::from_translation(Vector::new(x, y, z));
    scene.add_box(at(0.0, -0.05, 0.0), [14.0, 0.1, 14.0], [0.62, 0.58, 0.50]);
    scene.add_box(at(-0.55, 0.15, -0.25), [0.35, 0.3, 0.4], STONE);
    scene.add_box(at(-0.25, 0.06, 0.45), [0.5, 0.12, 0.2], STONE);
    scene.add_ball(at(0.35, 0.2, 0.35), 0.2, [0.18, 0.30, 0.38]);
    let ramp = Pose::from_parts(
        Vector::new(0.45, 0.17, -0.35),
        Rotation::from_rotation_z(-0.6),
    );
    scene.add_box(ramp, [0.7, 0.03, 0.6], [0.35, 0.24, 0.14]);
}
