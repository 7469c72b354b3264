//! What happens to the window: keys that stay down, tools that change in mid drag, views from files.

use immersed_workbench::window::{App, Tool};
use immersed_workbench::{Bench, Change, Command, Placement, View};
use kiss3d::camera::Camera3d;
use kiss3d::event::{Action, Key, Modifiers, MouseButton, WindowEvent};
use kiss3d::glamx::{Vec2, Vec3};

const SIZE: Vec2 = Vec2::new(800.0, 600.0);

fn key(app: &mut App, key: Key, action: Action, modifiers: Modifiers) {
    app.event(&WindowEvent::Key(key, action, modifiers), SIZE);
}

fn moved(app: &mut App, x: f64, y: f64) {
    app.event(&WindowEvent::CursorPos(x, y, Modifiers::empty()), SIZE);
}

fn button(app: &mut App, action: Action) {
    let event = WindowEvent::MouseButton(MouseButton::Button1, action, Modifiers::empty());
    app.event(&event, SIZE);
}

fn bodies(app: &App) -> usize {
    app.bench.state().bodies.len()
}

/// A key that stays down asks once, but for those that move through time; with a modifier it is another program's.
#[test]
fn keys_ask_once() {
    let mut app = App::new(Bench::default());
    let none = Modifiers::empty();
    for _ in 0..5 {
        key(&mut app, Key::O, Action::Press, none);
    }
    assert_eq!(bodies(&app), 30);
    key(&mut app, Key::O, Action::Release, none);
    key(&mut app, Key::O, Action::Press, none);
    assert_eq!(bodies(&app), 60);
    for modifiers in [Modifiers::Control, Modifiers::Alt, Modifiers::Super] {
        key(&mut app, Key::C, Action::Press, modifiers);
        key(&mut app, Key::C, Action::Release, modifiers);
    }
    assert_eq!(bodies(&app), 60);
    for _ in 0..5 {
        key(&mut app, Key::Right, Action::Press, none);
    }
    assert_eq!(app.bench.state().step, 5);
    // Who looks elsewhere has let all keys go.
    app.event(&WindowEvent::Focus(false), SIZE);
    key(&mut app, Key::O, Action::Press, none);
    assert_eq!(bodies(&app), 90);
}

/// A drag belongs to the tool that it began with, and to the window.
#[test]
fn drags_end_with_their_tool() {
    let mut app = App::new(Bench::default());
    let drag = |app: &mut App, tool: Tool, between: &dyn Fn(&mut App)| {
        app.pointer.tool = tool;
        moved(app, 300.0, 300.0);
        button(app, Action::Press);
        moved(app, 340.0, 280.0);
        between(app);
        moved(app, 380.0, 260.0);
        button(app, Action::Release);
    };
    drag(&mut app, Tool::Throw, &|_| ());
    assert_eq!(bodies(&app), 1);
    let [x, y, _] = {
        let handle = app.bench.state().handle(0).unwrap();
        app.bench.state().world().bodies[handle].linvel().to_array()
    };
    assert!(x > 0.1 && y > 0.1, "to the right and up: {x}, {y}");
    drag(&mut app, Tool::Select, &|app| {
        app.pointer.tool = Tool::Throw
    });
    drag(&mut app, Tool::Place, &|app| app.pointer.tool = Tool::Draw);
    drag(&mut app, Tool::Throw, &|app| {
        app.event(&WindowEvent::Focus(false), SIZE);
    });
    assert_eq!(bodies(&app), 1);
}

/// A scene's own view is what is seen after it was read, and a turned view is what is saved.
#[test]
fn views_come_from_files_and_go_there() {
    let folder = std::env::temp_dir().join(format!("workbench-view-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("scene.json");
    let mut bench = Bench::default();
    bench.view.eye = [2.0, 1.0, 3.0];
    bench.view.target = [0.5, 0.7, -0.2];
    bench.apply(Command::Save(path.clone())).unwrap();
    let mut app = App::new(Bench::default());
    app.ask(Command::Load(path));
    let eye = app.camera().eye().to_array();
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near(eye, [2.0, 1.0, 3.0]), "{eye:?}");
    app.camera().set_dist(5.0);
    app.keep_view();
    let view = app.bench.view;
    assert!(!near(view.eye, [2.0, 1.0, 3.0]) && near(view.target, [0.5, 0.7, -0.2]));
    // And stays so.
    let eye = app.camera().eye().to_array();
    assert_eq!(eye, view.eye);
    // Who wanders off may do so, but a file has the last view that can be read.
    app.camera().set_at(Vec3::splat(1e3));
    app.keep_view();
    assert!(app.camera().at().x > 999.0);
    assert_eq!(app.bench.view, view);
    std::fs::remove_dir_all(folder).unwrap();
}

/// Another body does not inherit the attention that a removed one had.
#[test]
fn what_is_removed_is_not_selected() {
    let mut app = App::new(Bench::default());
    for x in [-0.5, 0.0, 0.5] {
        let position = [x, 1.0, 0.0];
        app.ask(Command::Change(Change::Place(Placement {
            position,
            ..Placement::default()
        })));
    }
    app.bench.view.selected = Some(1);
    app.ask(Command::Change(Change::Remove(2)));
    assert_eq!(app.bench.view.selected, Some(1));
    app.ask(Command::Change(Change::Remove(0)));
    assert_eq!(app.bench.view.selected, Some(0));
    key(&mut app, Key::Delete, Action::Press, Modifiers::empty());
    assert_eq!((bodies(&app), app.bench.view.selected), (0, None));
}

/// Views that no camera has are refused.
#[test]
fn views_are_checked() {
    let with = |eye, target| View {
        eye,
        target,
        ..View::default()
    };
    assert!(View::default().check().is_ok());
    for (eye, target) in [
        ([0.0, 0.0, 1e9], [0.0, 0.0, 2e9]),
        ([1e-30, 0.0, 0.0], [0.0; 3]),
        ([0.0; 3], [0.0; 3]),
        ([f32::NAN, 0.0, 0.0], [0.0; 3]),
        ([60.0, 0.0, 0.0], [0.0; 3]),
    ] {
        assert!(with(eye, target).check().is_err(), "{eye:?} {target:?}");
    }
}
