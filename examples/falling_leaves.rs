//! A few hundred leaves and some confetti fall on a floor with obstacles: they flutter, tumble,
//! collide and come to rest. Or a paper airplane flies. Beside it the same scene in plain rapier.
//!
//! ```text
//! cargo run --release --example falling_leaves
//! cargo run --release --example falling_leaves -- --fluid water --count 100
//! cargo run --release --example falling_leaves -- --mesh my_leaf.obj --scale 0.001
//! cargo run --release --example falling_leaves -- --wind 2 --turbulence 0.3
//! cargo run --release --example falling_leaves -- --scene airplane
//! ```
//!
//! Writes `frames.svg` (moments of the run), `trajectories.svg` (both runs, from the side and from
//! above), `leaves.html` (plays in a browser; `--open` opens it), `leaves.glb` (the same for 3-D tools), `leaves.json` (numbers) and,
//! with `--gif`, `leaves.gif`.

mod support;

use clap::{Parser, ValueEnum};
use rand::{RngExt, SeedableRng};
use rapier3d_immersed::flow::LogLaw;
use rapier3d_immersed::rapier3d::math::{Pose, Rotation, Vector};
use rapier3d_immersed::rapier3d::prelude::PhysicsWorld;
use rapier3d_immersed::turbulence::{LangevinMode, Turbulence, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{Immersion, Warning, preset};
use serde_json::{Value, json};
use support::airplane::Flight;
use support::cli::{self, FluidArgs, FluidName, bad_value};
use support::film::{Film, FilmArgs, FrameRate};
use support::leaf::{Blade, Outline};
use support::options::{Count, Json, Material, Out, Seconds, Seed, TimeStep, Wind, wrote};
use support::recording::{Plain, Recording, RunOptions, run};
use support::scene::{Kind, Scene};
use support::shape::MeshArgs;
use support::summary::{Summary, table};
use support::{Quat, Vec3, airplane, gallery, mesh};

/// Leaves and confetti fall on a floor with obstacles; the same scene in plain rapier beside it.
///
/// Without --count there are 300 leaves. Without --seconds, leaves take 7 s in air and 40 s in water, the airplane 4 s and 20 s. Without --density, leaves have 350 kg/m³
/// in air and 1400 in water, the airplane 800 and 2000. Without --dt, a step is 1/240 s, as the leaf-scale preset has it. A --mesh
/// takes the place of the built-in leaves.
#[derive(Parser, Debug)]
#[command(name = "falling_leaves", version, allow_negative_numbers = true)]
#[command(mut_arg("seed", |seed| seed.default_value("7")))]
struct Options {
    /// What falls
    #[arg(long, value_enum, default_value = "leaves")]
    scene: SceneName,
    #[command(flatten)]
    count: Count,
    /// Number of pieces of confetti [default: a third of --count]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=20_000))]
    confetti: Option<u32>,
    #[command(flatten)]
    time: Seconds,
    #[command(flatten)]
    fluid: FluidArgs,
    #[command(flatten)]
    mesh: MeshArgs,
    #[command(flatten)]
    material: Material,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    wind: Wind,
    /// Turbulence: root mean square of the fluid's fluctuations over the wind speed, or over 1 m/s
    /// where the wind is less
    #[arg(long, value_name = "INTENSITY", default_value = "0", value_parser = cli::not_negative)]
    turbulence: f64,
    #[command(flatten)]
    step: TimeStep,
    /// Skip the run in plain rapier
    #[arg(long)]
    no_compare: bool,
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
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
        .time
        .seconds
        .unwrap_or(match (options.scene, options.fluid.fluid) {
            (SceneName::Leaves, FluidName::Air) => 7.0,
            (SceneName::Leaves, FluidName::Water) => 40.0,
            (SceneName::Airplane, FluidName::Air) => 4.0,
            (SceneName::Airplane, FluidName::Water) => 20.0,
        });
    let kinds = kinds(&options);
    let mut scene = build(&options, &kinds);
    if scene.pieces.is_empty() {
        bad_value("--count", "with --confetti 0 there has to be a leaf");
    }
    let dt = f64::from(scene.world.integration_parameters.dt);
    if seconds / dt > 1e6 {
        bad_value("--seconds", "more than a million steps");
    }
    let frames = seconds * options.frame_rate.hertz.min(1.0 / dt) * scene.pieces.len() as f64;
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
        frame_rate: options.frame_rate.hertz,
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
    let film = Film {
        name: told.animation,
        title: &told.title,
        scene: &scene,
        runs: &runs,
        camera: None,
        follow: false,
    };
    let out = &options.out;
    let mut files = film.write(out, &options.film);
    files.push(out.write("frames.svg", told.frames));
    files.push(out.write("trajectories.svg", told.trajectories));
    files.push(out.write(&format!("{}.json", told.animation), format!("{json:#}\n")));
    if options.json.on {
        println!("{json:#}");
    } else {
        let fluid = match options.fluid.fluid {
            FluidName::Air => "air",
            FluidName::Water => "water",
        };
        println!("{}, {seconds} s in {fluid}", told.title);
        print!("{}", told.table);
        println!("{}", wrote(&files));
    }
}

/// Sets the wind and the turbulence.
fn stir(immersion: &mut Immersion, options: &Options) {
    /// Where the wind has its speed, m, over a floor of this roughness, m.
    const HEIGHT: f32 = 2.0;
    const ROUGHNESS: f32 = 0.003;
    /// Size of the eddies, m: a room's.
    const EDDIES: f32 = 0.5;
    if options.wind.speed > 0.0 {
        let speed = options.wind.speed as f32;
        let wind = LogLaw::new(Vector::X, Vector::Y, speed, HEIGHT, ROUGHNESS);
        immersion.set_flow(wind.unwrap_or_else(|problem| bad_value("--wind", problem)));
    }
    if options.turbulence > 0.0 {
        let (speed, intensity) = (
            options.wind.speed.max(1.0) as f32,
            options.turbulence as f32,
        );
        let state = TurbulenceState::from_intensity(speed, intensity, EDDIES);
        immersion.set_turbulence(TurbulentLayer {
            source: Turbulence::Homogeneous(
                state.unwrap_or_else(|problem| bad_value("--turbulence", problem)),
            ),
            mode: LangevinMode::FluidSeen,
            seed: options.seed.value,
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
    options.count.check(0..=20_000);
    let only_leaves = [
        ("--count", options.count.count.is_some()),
        ("--confetti", options.confetti.is_some()),
        ("--mesh", options.mesh.mesh.is_some()),
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
    let (leaf, paper) = match options.fluid.fluid {
        FluidName::Air => (350.0, 800.0),
        // Soaked leaves sink by 1 to 2 cm/s; these are of plastic, for the patience of the viewer.
        FluidName::Water => (1400.0, 2000.0),
    };
    if options.scene == SceneName::Airplane {
        let kind = airplane::flying(options.material.density.unwrap_or(paper));
        return vec![kind.unwrap_or_else(|problem| bad_value("--density", problem))];
    }
    let leaf = options.material.density.unwrap_or(leaf);
    let mut kinds = match options.mesh.load() {
        Some(raw) => {
            let problem = |text: String| -> ! { bad_value("--mesh", text) };
            let raw = raw.unwrap_or_else(|text| problem(text));
            let solid = raw.solid(options.mesh.sheet_thickness());
            let solid = mesh::aligned(&solid.unwrap_or_else(|text| problem(text)));
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
    if let Some(dt) = options.step.dt {
        world.integration_parameters.dt = dt as f32;
    }
    if options.scene == SceneName::Airplane {
        return airplane::scene(world, kinds);
    }
    let mut scene = Scene::new(world);
    scene.kinds = kinds.to_vec();
    furnish(&mut scene);

    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(options.seed.value);
    let leaves = options.count.count.unwrap_or(300);
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
    let (width, lowest, highest) = match options.fluid.fluid {
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
