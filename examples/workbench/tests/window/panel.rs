//! The panel, clicked by what it says: as a screen reader sees it.

use immersed_workbench::window::App;
use immersed_workbench::{Bench, Change, Command, Fluids, Law, Placement, Setting};
use kiss3d::egui::accesskit::{Node, NodeId, Role};
use kiss3d::egui::{Context, Event, Modifiers, PointerButton, Pos2, RawInput, Rect, pos2, vec2};
use std::collections::HashMap;

/// A panel of a screen of 1280 × 1600 points, which is high enough for all of it.
struct Screen {
    app: App,
    ctx: Context,
    nodes: HashMap<NodeId, Node>,
    frame: u32,
}

impl Screen {
    fn new(bench: Bench) -> Self {
        let ctx = Context::default();
        ctx.enable_accesskit();
        let mut screen = Self {
            app: App::new(bench),
            ctx,
            nodes: HashMap::new(),
            frame: 0,
        };
        screen.rest();
        screen
    }

    fn frame(&mut self, events: Vec<Event>) {
        self.frame += 1;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(1280.0, 1600.0))),
            time: Some(f64::from(self.frame) / 10.0),
            events,
            ..RawInput::default()
        };
        let (ctx, app) = (&self.ctx, &mut self.app);
        let mut output = ctx.run_ui(input, |ui| app.panel(ui.ctx()));
        // Nobody paints here.
        output.textures_delta.clear();
        let update = output.platform_output.accesskit_update;
        self.nodes = update.unwrap().nodes.into_iter().collect();
    }

    /// Until all that opens has opened.
    fn rest(&mut self) {
        for _ in 0..8 {
            self.frame(Vec::new());
        }
    }

    /// Where something of this kind is that says this.
    fn find(&self, role: Role, text: &str) -> Option<Rect> {
        let mut named = self.nodes.values().filter(|node| {
            let says = node.label().or(node.value());
            node.role() == role && says == Some(text)
        });
        let bounds = named.next()?.bounds()?;
        let corner = |x: f64, y: f64| pos2(x as f32, y as f32);
        Some(Rect::from_min_max(
            corner(bounds.x0, bounds.y0),
            corner(bounds.x1, bounds.y1),
        ))
    }

    fn press(&mut self, at: Pos2) {
        self.press_once(at);
        self.rest();
    }

    fn press_once(&mut self, at: Pos2) {
        self.frame(vec![Event::PointerMoved(at)]);
        for pressed in [true, false] {
            self.frame(vec![Event::PointerButton {
                pos: at,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            }]);
        }
    }

    fn click(&mut self, text: &str) {
        self.click_once(text);
        self.rest();
    }

    fn click_once(&mut self, text: &str) {
        let roles = [Role::Button, Role::CheckBox, Role::RadioButton];
        let found = roles.iter().find_map(|role| self.find(*role, text));
        let Some(at) = found else {
            let all = self.nodes.values();
            let all: Vec<_> = all.map(|n| (n.role(), n.label(), n.value())).collect();
            panic!("nothing says {text:?} among {all:?}");
        };
        self.press_once(at.center());
    }

    /// Moves a slider to a share of its way.
    fn slide(&mut self, text: &str, share: f32) {
        let slider = self.find(Role::Slider, text);
        let Some(rail) = slider else {
            panic!("no slider says {text:?}");
        };
        self.press(pos2(rail.left() + share * rail.width(), rail.center().y));
    }
}

#[test]
fn time_is_under_buttons() {
    let mut screen = Screen::new(Bench::default());
    screen.click("stop");
    assert!(!screen.app.bench.is_playing());
    screen.click("step");
    assert_eq!(screen.app.bench.state().step, 1);
    screen.click("play");
    assert!(screen.app.bench.is_playing());
}

#[test]
fn it_rains_at_a_click() {
    let mut screen = Screen::new(Bench::default());
    screen.click("rain");
    assert_eq!(screen.app.bench.state().bodies.len(), 30);
    screen.click("undo");
    assert!(screen.app.bench.state().bodies.is_empty());
    screen.click("throw");
    assert_eq!(
        screen.app.pointer.tool,
        immersed_workbench::window::Tool::Throw
    );
}

#[test]
fn fluid_and_law_are_set() {
    let mut screen = Screen::new(Bench::default());
    assert!(screen.find(Role::Slider, "waves, m").is_none());
    screen.click("air over a pond");
    assert_eq!(screen.app.bench.state().settings.fluids, Fluids::Pond);
    screen.slide("waves, m", 0.5);
    let waves = screen.app.bench.state().settings.waves;
    assert!((waves - 0.075).abs() < 0.01, "{waves}");
    screen.slide("wind x, m/s", 0.75);
    let wind = screen.app.bench.state().settings.wind;
    assert!(
        (wind[0] - 5.0).abs() < 0.6 && wind[1..] == [0.0; 2],
        "{wind:?}"
    );
    screen.click("1 stochastic");
    let method = screen.app.bench.state().settings.method;
    assert_eq!(method, immersed_workbench::Method::Stochastic);
    assert!(screen.find(Role::Slider, "C̃ drag").is_none());
    let law = immersed_workbench::Setting::Law(Law::Thesis);
    let bench = &mut screen.app.bench;
    bench.apply(Command::Change(Change::Set(law))).unwrap();
    screen.rest();
    screen.slide("C̃ drag", 1.0);
    let coefficients = screen.app.bench.state().settings.coefficients;
    assert!(coefficients[0] > 4.8, "{coefficients:?}");
}

/// A method that is trained first says so for a frame, and is then there.
#[test]
fn training_is_announced() {
    let mut bench = Bench::default();
    let leaf = Change::Place(Placement::default());
    bench.apply(Command::Change(leaf)).unwrap();
    let mut screen = Screen::new(bench);
    screen.click_once("4 reduced (PGD)");
    let method = |screen: &Screen| screen.app.bench.state().settings.method;
    assert_eq!(method(&screen), immersed_workbench::Method::Law);
    // The picture in which it was clicked is over; the next one says so, the one after that has it.
    screen.app.advance(0.01);
    screen.frame(Vec::new());
    let said = "the method is trained for this thing …";
    assert!(screen.find(Role::Label, said).is_some());
    assert_eq!(method(&screen), immersed_workbench::Method::Law);
    screen.app.advance(0.01);
    assert_eq!(method(&screen), immersed_workbench::Method::Reduced);
}

#[test]
fn what_is_shown_is_chosen() {
    let mut screen = Screen::new(Bench::default());
    let legend = |screen: &Screen| screen.find(Role::Label, "buoyancy").is_some();
    assert!(legend(&screen));
    screen.click("forces");
    assert!(!screen.app.bench.view.forces && !legend(&screen));
    screen.click("phase diagram");
    assert!(screen.app.bench.view.phase);
    screen.rest();
    let caption = "ring: where the selected body is expected; dot: now";
    assert!(screen.find(Role::Label, caption).is_some());
}

/// What the panel says of a body is what the bench knows.
#[test]
fn the_selected_body_is_described() {
    let mut bench = Bench::default();
    let leaf = Change::Place(Placement::default());
    bench.apply(Command::Change(leaf)).unwrap();
    bench.apply(Command::Step(240)).unwrap();
    let mut screen = Screen::new(bench);
    let says = |screen: &Screen, text: &str| screen.find(Role::Label, text).is_some();
    assert!(says(&screen, "leaf, 1 of 1"));
    let body = &screen.app.bench.state().bodies[0];
    let descent = format!("{:.2} m/s", body.descent);
    assert!(says(&screen, &descent), "{descent}");
    screen.app.bench.view.selected = Some(7);
    screen.rest();
    assert!(says(&screen, "none: click one"));
}

/// Being shown changes nothing: not even numbers that no slider would make.
#[test]
fn what_is_shown_stays() {
    let mut bench = Bench::default();
    let set = |bench: &mut Bench, setting| {
        bench.apply(Command::Change(Change::Set(setting))).unwrap();
    };
    set(&mut bench, Setting::Wind([1.0 / 3.0, 0.0, -0.77777]));
    set(&mut bench, Setting::Turbulence(0.0123456));
    set(&mut bench, Setting::Eddy(0.0625123));
    set(&mut bench, Setting::Factors([1.23456, 0.98765, 1.0]));
    let before = bench.changes().to_vec();
    let mut screen = Screen::new(bench);
    screen.rest();
    assert_eq!(screen.app.bench.changes(), before);
}
