//! Options that examples share: they are parsed alike, and their help says what they do.

use crate::support::cli::FluidArgs;
use crate::support::film::{FilmArgs, FrameRate};
use crate::support::options::{Count, Json, Material, Out, Seconds, Seed, TimeStep, Wind, key};
use crate::support::shape::{ShapeArgs, ShapeName};
use crate::support::track::TrackArgs;
use clap::{CommandFactory, Parser, ValueEnum};

/// A command with all of them, and with defaults of its own.
#[derive(Parser)]
#[command(name = "all")]
#[command(mut_arg("seed", |seed| seed.default_value("7")))]
#[command(mut_arg("out", |out| out.default_value("out/all")))]
#[command(mut_arg("wind", |wind| wind.default_value("0.6")))]
#[command(mut_arg("frame_rate", |rate| rate.default_value("15")))]
#[command(mut_arg("count", |count| count.default_value("12")))]
#[command(mut_arg("seconds", |seconds| seconds.default_value("40")))]
#[command(mut_arg("dt", |dt| dt.default_value("0.004")))]
struct All {
    #[command(flatten)]
    body: ShapeArgs,
    #[command(flatten)]
    material: Material,
    #[command(flatten)]
    fluid: FluidArgs,
    #[command(flatten)]
    wind: Wind,
    #[command(flatten)]
    count: Count,
    #[command(flatten)]
    time: Seconds,
    #[command(flatten)]
    step: TimeStep,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    track: TrackArgs,
    #[command(flatten)]
    frame_rate: FrameRate,
    #[command(flatten)]
    film: FilmArgs,
    #[command(flatten)]
    out: Out,
    #[command(flatten)]
    json: Json,
}

fn parse(line: &str) -> Result<All, String> {
    let words = ["all"].into_iter().chain(line.split_whitespace());
    All::try_parse_from(words).map_err(|error| error.to_string())
}

#[test]
fn they_go_together_and_take_other_defaults() {
    All::command().debug_assert();
    let usual = parse("").unwrap();
    assert_eq!(usual.seed.value, 7);
    assert_eq!(
        usual.out.path("a.svg"),
        std::path::Path::new("out/all/a.svg")
    );
    assert_eq!((usual.wind.speed, usual.frame_rate.hertz), (0.6, 15.0));
    assert_eq!((usual.count.within(1..=20), usual.time.given()), (12, 40.0));
    assert_eq!(usual.step.given(), 0.004);
    assert!(!usual.json.on && !usual.film.gif && !usual.film.open);
    let told =
        parse("--seed 3 --count 5 --seconds 2 --wind 1 --json --gif --density 400 --fluid water")
            .unwrap();
    assert_eq!(
        (told.seed.value, told.count.count, told.time.given()),
        (3, Some(5), 2.0)
    );
    assert!(told.json.on && told.film.gif && told.material.density == Some(400.0));
    assert!((told.fluid.fluid().density() - 997.0).abs() < 1.0);
    assert!(told.track.track.is_none());
    // As they were called once.
    for old in ["--leaves", "--flakes", "--bodies"] {
        assert_eq!(parse(&format!("{old} 4")).unwrap().count.count, Some(4));
    }
}

/// Every shape is on the command line, and the help has its lengths and their defaults.
#[test]
fn the_help_has_every_shape_and_size() {
    let help = All::command().render_long_help().to_string();
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    for shape in ShapeName::value_variants() {
        let word = shape.word();
        let told = if *shape == ShapeName::Mesh {
            parse("--shape mesh --mesh a.obj")
        } else {
            parse(&format!("--shape {word}"))
        };
        assert_eq!(told.unwrap().body.shape, Some(*shape));
        let (names, usual) = shape.sizes();
        let lengths: Vec<String> = usual.iter().map(f64::to_string).collect();
        assert!(help.contains(names), "{word}: {names}");
        assert!(help.contains(&lengths.join(",")), "{word}: {lengths:?}");
    }
}

#[test]
fn bad_values_are_named() {
    let wrong = |line: &str| parse(line).err().unwrap();
    assert!(wrong("--size 0").contains("'0' for '--size <A[,B[,C]]>': must be above zero"));
    assert!(wrong("--shape cube").contains("'cube' for '--shape <SHAPE>'"));
    assert!(wrong("--seconds -1").contains("--seconds") || wrong("--seconds -1").contains("-1"));
    assert!(wrong("--wind x").contains("'x' for '--wind <M/S>': must be a number"));
    // A mesh's options need a mesh.
    assert!(wrong("--scale 2").contains("--mesh"));
    assert!(wrong("--thickness 0.001").contains("--mesh"));
}

#[test]
fn names_end_in_units() {
    assert_eq!(key("descent", "m/s"), "descent_mps");
    assert_eq!(key("density", "kg/m³"), "density_kgpm3");
    assert_eq!(key("turns", ""), "turns");
}
