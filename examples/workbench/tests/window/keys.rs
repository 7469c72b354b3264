//! Every key does what the help says.

use immersed_workbench::window::{App, HELP, Tool, pressed};
use immersed_workbench::{Bench, Change, Command, Method, Placement, Setting};
use kiss3d::event::Key;

fn press(app: &mut App, key: Key) {
    if let Some(command) = pressed(key, false, &mut app.bench, &mut app.pointer) {
        app.bench.apply(command).unwrap();
    }
}

fn with_leaf() -> App {
    let mut bench = Bench::default();
    let leaf = Change::Place(Placement::default());
    bench.apply(Command::Change(leaf)).unwrap();
    App::new(bench)
}

#[test]
fn one_key_for_each_method() {
    let mut app = App::new(Bench::default());
    for (key, method) in [
        (Key::Key1, Method::Stochastic),
        (Key::Key2, Method::Patterns),
        (Key::Key3, Method::Graph),
        (Key::Key4, Method::Reduced),
        (Key::Key5, Method::Plain),
        (Key::Key0, Method::Law),
    ] {
        press(&mut app, key);
        assert_eq!(app.bench.state().settings.method, method);
    }
    let asked = pressed(Key::Numpad3, false, &mut app.bench, &mut app.pointer);
    let graph = Command::Change(Change::Set(Setting::Method(Method::Graph)));
    assert_eq!(asked, Some(graph));
}

#[test]
fn time_goes_by_keys() {
    let mut app = with_leaf();
    assert!(app.bench.is_playing());
    press(&mut app, Key::Space);
    assert!(!app.bench.is_playing());
    for _ in 0..100 {
        press(&mut app, Key::Right);
    }
    assert_eq!(app.bench.state().step, 100);
    press(&mut app, Key::Left);
    assert_eq!(app.bench.state().step, 40);
    let shift = pressed(Key::Left, true, &mut app.bench, &mut app.pointer);
    assert_eq!(shift, Some(Command::Rewind(2.0)));
    press(&mut app, Key::Comma);
    assert!((app.bench.speed() - 0.8).abs() < 1e-9);
    press(&mut app, Key::Period);
    assert!((app.bench.speed() - 1.0).abs() < 1e-9);
}

#[test]
fn bodies_come_and_go_by_keys() {
    let mut app = with_leaf();
    press(&mut app, Key::O);
    assert_eq!(app.bench.state().bodies.len(), 31);
    app.bench.view.selected = Some(4);
    press(&mut app, Key::Delete);
    assert_eq!(app.bench.state().bodies.len(), 30);
    press(&mut app, Key::Z);
    assert_eq!(app.bench.state().bodies.len(), 31);
    press(&mut app, Key::C);
    assert!(app.bench.state().bodies.is_empty());
    // Two rains are not the same.
    let [first, second] = [(); 2].map(|()| {
        press(&mut app, Key::O);
        let bits = app.bench.state().bits();
        press(&mut app, Key::C);
        bits
    });
    assert_ne!(first, second);
}

#[test]
fn tools_and_views_have_keys() {
    let mut app = App::new(Bench::default());
    for (key, tool) in [
        (Key::B, Tool::Place),
        (Key::T, Tool::Throw),
        (Key::N, Tool::Draw),
        (Key::S, Tool::Select),
    ] {
        press(&mut app, key);
        assert_eq!(app.pointer.tool, tool);
    }
    let before = app.bench.view;
    for key in [Key::F, Key::L, Key::P, Key::X, Key::W, Key::D, Key::H] {
        let last = app.bench.view;
        press(&mut app, key);
        assert_ne!(app.bench.view, last, "{key:?}");
    }
    let now = app.bench.view;
    let shown = |view: immersed_workbench::View| {
        [
            view.forces,
            view.trails,
            view.planforms,
            view.proxies,
            view.flow,
            view.phase,
            view.panel,
        ]
    };
    assert_eq!(shown(now), shown(before).map(|on| !on));
    press(&mut app, Key::R);
    assert!(app.bench.film_length().is_some());
    press(&mut app, Key::R);
    assert!(app.bench.film_length().is_none());
}

#[test]
fn what_has_no_key_asks_for_nothing() {
    let mut app = with_leaf();
    let before = app.bench.view;
    for key in [Key::Q, Key::F5, Key::Escape, Key::Return] {
        assert_eq!(pressed(key, false, &mut app.bench, &mut app.pointer), None);
    }
    assert_eq!(app.bench.view, before);
    assert!(
        HELP.iter()
            .all(|(key, what)| !key.is_empty() && !what.is_empty())
    );
}
