//! Time goes on, stops, goes back, and is saved: bit by bit.

use immersed_workbench::{
    Bench, Change, Command, Fluids, Method, Placement, Rain, Saved, Setting, Shape,
};
use rapier3d_immersed::preset;

/// A scene in which much happens: a rain, gusts, water let in, a leaf on a path, one taken away.
fn eventful() -> Bench {
    let mut bench = Bench::default();
    let mut at = |steps: u64, change: Change| {
        bench.apply(Command::Step(steps)).unwrap();
        bench.apply(Command::Change(change)).unwrap();
    };
    let rain = Rain {
        count: 8.0,
        ..Rain::default()
    };
    at(0, Change::Rain(rain));
    at(10, Change::Set(Setting::Turbulence(0.4)));
    at(0, Change::Set(Setting::Turbulence(0.3)));
    at(
        15,
        Change::Draw(vec![[0.0, 1.6, 0.0], [0.2, 1.2, 0.0], [0.1, 0.6, 0.0]]),
    );
    at(20, Change::Set(Setting::Method(Method::Stochastic)));
    at(20, Change::Set(Setting::Fluids(Fluids::Pond)));
    let airplane = Placement {
        shape: Shape::Airplane,
        velocity: [2.0, 0.0, 0.0],
        ..Placement::default()
    };
    at(30, Change::Place(airplane));
    at(10, Change::Remove(2));
    bench.apply(Command::Step(70)).unwrap();
    bench
}

/// After going back, the world is as it was, and goes on as it did: across snapshots, changes and methods.
#[test]
fn going_back_gives_the_same_bits() {
    let mut bench = eventful();
    let end = bench.state().step;
    let last = bench.state().bits();
    let mut seen = Vec::new();
    // Steps right after a snapshot (60), between two, at changes (105), and the beginning.
    for step in [170, 105, 61, 60, 59, 25, 1, 0] {
        let back = (bench.state().step - step) as f64 / 240.0;
        bench.apply(Command::Rewind(back)).unwrap();
        assert_eq!(bench.state().step, step);
        seen.push((step, bench.state().bits(), bench.state().settings));
    }
    // Everything that was placed at the beginning is there.
    assert_eq!(bench.state().bodies.len(), 8);
    for (step, bits, settings) in seen.iter().rev() {
        let on = step - bench.state().step;
        bench.apply(Command::Step(on)).unwrap();
        assert_eq!(&bench.state().bits(), bits, "step {step}");
        assert_eq!(&bench.state().settings, settings);
    }
    bench
        .apply(Command::Step(end - bench.state().step))
        .unwrap();
    assert_eq!(bench.state().bits(), last);
}

/// Going back further than the beginning stops there; a new change forgets the future.
#[test]
fn a_change_in_the_past_forgets_the_future() {
    let mut bench = eventful();
    let changes = bench.changes().len();
    bench.apply(Command::Rewind(f64::MAX)).unwrap();
    assert_eq!(bench.state().step, 0);
    bench.apply(Command::Step(60)).unwrap();
    let wind = Change::Set(Setting::Wind([2.0, 0.0, 0.0]));
    bench.apply(Command::Change(wind)).unwrap();
    assert!(bench.changes().len() < changes);
    bench.apply(Command::Step(200)).unwrap();
    assert_eq!(
        bench.state().settings.fluids,
        Fluids::Air,
        "the pond was in the future"
    );
    // It is undone where it was made.
    bench.apply(Command::Undo).unwrap();
    assert_eq!(bench.state().settings.wind, [0.0; 3]);
    assert_eq!(bench.state().step, 260);
}

/// Undoing all is where one began.
#[test]
fn undoing_takes_changes_back_one_by_one() {
    let mut bench = Bench::default();
    for x in [0.0, 0.5] {
        let body = Placement {
            position: [x, 1.0, 0.0],
            ..Placement::default()
        };
        bench.apply(Command::Change(Change::Place(body))).unwrap();
        bench.apply(Command::Step(40)).unwrap();
    }
    bench.apply(Command::Undo).unwrap();
    assert_eq!((bench.state().bodies.len(), bench.state().step), (1, 80));
    // The first falls as it would have alone.
    let mut alone = Bench::default();
    let body = Placement {
        position: [0.0, 1.0, 0.0],
        ..Placement::default()
    };
    alone.apply(Command::Change(Change::Place(body))).unwrap();
    alone.apply(Command::Step(80)).unwrap();
    assert_eq!(bench.state().bits(), alone.state().bits());
    bench.apply(Command::Undo).unwrap();
    assert!(bench.state().bodies.is_empty());
    assert!(bench.apply(Command::Undo).is_err());
}

/// A scene from a file is where the saved one was, and falls on the same way.
#[test]
fn a_saved_scene_goes_on_the_same_way() {
    let folder = std::env::temp_dir().join(format!("workbench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("scene.json");
    let mut bench = eventful();
    bench.view.trails = true;
    bench.apply(Command::Save(path.clone())).unwrap();
    let mut read = Bench::default();
    read.apply(Command::Load(path.clone())).unwrap();
    assert_eq!(read.state().bits(), bench.state().bits());
    assert_eq!(read.state().settings, bench.state().settings);
    assert!(read.view.trails);
    for bench in [&mut bench, &mut read] {
        bench.apply(Command::Step(150)).unwrap();
    }
    assert_eq!(read.state().bits(), bench.state().bits());
    // Films are of the formats that their names say.
    read.apply(Command::Record(true)).unwrap();
    read.apply(Command::Step(40)).unwrap();
    for (name, begin) in [
        ("film.html", &b"<!doctype html"[..]),
        ("film.gif", &b"GIF89a"[..]),
        ("film.glb", &b"glTF"[..]),
    ] {
        let film = folder.join(name);
        read.apply(Command::Film(film.clone())).unwrap();
        let bytes = std::fs::read(film).unwrap();
        let first = bytes[..begin.len()].to_ascii_lowercase();
        assert_eq!(first, begin.to_ascii_lowercase(), "{name}");
        read.apply(Command::Record(true)).unwrap();
        read.apply(Command::Step(24)).unwrap();
    }
    assert!(read.apply(Command::Film(folder.join("film.txt"))).is_err());
    std::fs::remove_dir_all(folder).unwrap();
}

/// Files that cannot be are refused with what is wrong, and leave the bench as it was.
#[test]
fn broken_files_are_refused() {
    let good = Saved::new(0, Bench::default().view, Vec::new());
    let text = good.to_text().unwrap();
    assert_eq!(Saved::from_text(&text).unwrap(), good);
    for (from, to, why) in [
        ("\"version\": 1", "\"version\": 9", "version"),
        ("\"step\": 0", "\"step\": 999999999", "step"),
        ("\"changes\": []", "\"changes\": [{\"step\": 0}]", "change"),
        ("\"forces\"", "\"farces\"", "farces"),
    ] {
        assert!(text.contains(from), "{text}");
        let problem = Saved::from_text(&text.replace(from, to)).unwrap_err();
        assert!(problem.contains(why), "{problem}");
    }
}

/// Slow motion makes fewer steps of the same length; a pause makes none.
#[test]
fn time_goes_as_fast_as_is_set() {
    let mut bench = Bench::default();
    bench.advance(0.04);
    assert_eq!(bench.state().step, 9, "0.04 s of 240 steps in a second");
    bench.apply(Command::Speed(0.25)).unwrap();
    (0..10).for_each(|_| bench.advance(0.02));
    // 0.2 s at a quarter of the speed are 12 steps; 0.6 were left over from before.
    assert_eq!(bench.state().step, 9 + 12);
    bench.apply(Command::Play(false)).unwrap();
    bench.advance(1.0);
    assert_eq!(bench.state().step, 21);
    // A machine that is too slow for real time makes what it can, and owes nothing.
    bench.apply(Command::Speed(1.0)).unwrap();
    bench.apply(Command::Play(true)).unwrap();
    bench.advance(60.0);
    assert_eq!(bench.state().step, 33);
    bench.advance(0.0);
    assert_eq!(bench.state().step, 33);
}

/// The scenes beside the package can be read, and show what they are there for.
#[test]
fn scenes_can_be_read() {
    for (name, text, bodies) in [
        ("leaves", include_str!("../../scenes/leaves.json"), 13),
        ("phase", include_str!("../../scenes/phase.json"), 3),
        ("path", include_str!("../../scenes/path.json"), 1),
        ("water", include_str!("../../scenes/water.json"), 18),
    ] {
        let saved = Saved::from_text(text).unwrap_or_else(|problem| panic!("{name}: {problem}"));
        let step = saved.step;
        let bench = Bench::load(saved).unwrap_or_else(|problem| panic!("{name}: {problem}"));
        assert_eq!(bench.state().step, step, "{name}");
        assert_eq!(bench.state().bodies.len(), bodies, "{name}");
    }
}

/// What a slider has set in one go is taken back in one go.
#[test]
fn a_slider_is_undone_at_once() {
    let mut bench = Bench::default();
    let leaf = Change::Place(Placement::default());
    bench.apply(Command::Change(leaf)).unwrap();
    bench.apply(Command::Step(10)).unwrap();
    let wind = |bench: &mut Bench, x: f64| {
        let wind = Change::Set(Setting::Wind([x, 0.0, 0.0]));
        bench.apply(Command::Change(wind)).unwrap();
    };
    wind(&mut bench, 0.5);
    bench.apply(Command::Step(60)).unwrap();
    for i in 0..20 {
        wind(&mut bench, 1.0 + 0.1 * f64::from(i));
        bench.apply(Command::Step(4)).unwrap();
    }
    let step = bench.state().step;
    bench.apply(Command::Undo).unwrap();
    assert_eq!(bench.state().settings.wind[0], 0.5);
    assert_eq!((bench.state().step, bench.changes().len()), (step, 2));
    bench.apply(Command::Undo).unwrap();
    assert_eq!(bench.state().settings.wind, [0.0; 3]);
    assert_eq!(bench.state().bodies.len(), 1);
}

/// A film shows what happened, not what was undone.
#[test]
fn a_film_forgets_what_is_undone() {
    let folder = std::env::temp_dir().join(format!("workbench-film-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let film = |undone: bool| {
        let mut bench = Bench::default();
        let leaf = Change::Place(Placement::default());
        bench.apply(Command::Change(leaf)).unwrap();
        bench.apply(Command::Record(true)).unwrap();
        bench.apply(Command::Step(40)).unwrap();
        if undone {
            let wind = Change::Set(Setting::Wind([3.0, 0.0, 0.0]));
            bench.apply(Command::Change(wind)).unwrap();
        }
        bench.apply(Command::Step(80)).unwrap();
        if undone {
            bench.apply(Command::Undo).unwrap();
        }
        bench.apply(Command::Step(16)).unwrap();
        let length = 136.0 * f64::from(preset::LEAF_DT);
        assert!((bench.film_length().unwrap() - length).abs() < 1e-9);
        let path = folder.join("film.glb");
        bench.apply(Command::Film(path.clone())).unwrap();
        std::fs::read(path).unwrap()
    };
    assert!(film(true) == film(false));
    std::fs::remove_dir_all(&folder).unwrap();
}
