//! The panel: every setting as a slider or a choice, and what is known of the selected body.

use super::diagram;
use super::files::Files;
use super::keys;
use super::pointer::{Pointer, Tool};
use crate::bench::{Bench, Command, SPEEDS};
use crate::change::{Change, Setting};
use crate::kinds::Shape;
use crate::methods::Method;
use crate::phase::Phase;
use crate::settings::{Fluids, Law, ranges};
use crate::state::{Drive, GRAVITY};
use kiss3d::egui::{
    self, Align2, CollapsingHeader, Color32, ComboBox, Grid, ScrollArea, Slider, SliderClamping,
    Ui, vec2,
};
use rapier3d_immersed::DebugRender;
use std::ops::RangeInclusive;

/// Shows the panel and, if it is wanted, the phase diagram; returns what is asked for.
pub fn show(
    ctx: &egui::Context,
    bench: &mut Bench,
    pointer: &mut Pointer,
    files: &mut Files,
    phase: &Phase,
) -> Vec<Command> {
    let mut asked = Vec::new();
    if bench.view.panel {
        let height = ctx.content_rect().height() - 64.0;
        egui::Window::new("Workbench")
            .anchor(Align2::LEFT_TOP, vec2(8.0, 8.0))
            .resizable(false)
            .default_size([286.0, height])
            .show(ctx, |ui| {
                ui.spacing_mut().slider_width = 130.0;
                ScrollArea::vertical().max_height(height).show(ui, |ui| {
                    time(ui, bench, &mut asked);
                    let section = |title: &str, open: bool| {
                        CollapsingHeader::new(title.to_owned()).default_open(open)
                    };
                    section("bodies", true).show(ui, |ui| bodies(ui, bench, pointer, &mut asked));
                    section("fluid", true).show(ui, |ui| fluid(ui, bench, &mut asked));
                    section("forces by", true).show(ui, |ui| law(ui, bench, &mut asked));
                    section("show", true).show(ui, |ui| view(ui, bench));
                    section("files", false).show(ui, |ui| files.show(ui, bench, &mut asked));
                    section("keys", false).show(ui, help);
                });
            });
        egui::Window::new("selected body")
            .anchor(Align2::RIGHT_TOP, vec2(-8.0, 8.0))
            .resizable(false)
            .show(ctx, |ui| selected(ui, bench, phase));
    }
    if bench.view.phase {
        egui::Window::new("phase diagram")
            .anchor(Align2::RIGHT_BOTTOM, vec2(-8.0, -8.0))
            .resizable(false)
            .show(ctx, |ui| {
                let selected = bench.view.selected;
                let marker = selected.and_then(|body| phase.marker(bench.state(), body));
                diagram::show(ui, phase, marker.as_ref());
                ui.label("ring: where the selected body is expected; dot: now");
            });
    }
    asked
}

/// A slider; what it is moved to.
fn slider(ui: &mut Ui, text: &str, value: f64, range: RangeInclusive<f64>) -> Option<f64> {
    let mut value = value;
    // What is there stays as it is until it is moved.
    let slider = Slider::new(&mut value, range)
        .text(text)
        .max_decimals(3)
        .clamping(SliderClamping::Edits);
    ui.add(slider).changed().then_some(value)
}

/// A setting, if a slider of it is moved.
fn set(asked: &mut Vec<Command>, setting: Option<Setting>) {
    asked.extend(setting.map(|setting| Command::Change(Change::Set(setting))));
}

/// Sliders for some components of a vector; the vector, if one is moved.
fn vector(
    ui: &mut Ui,
    texts: &[(usize, &str)],
    vector: [f64; 3],
    range: &RangeInclusive<f64>,
) -> Option<[f64; 3]> {
    let mut moved = None;
    for (axis, text) in texts {
        if let Some(value) = slider(ui, text, vector[*axis], range.clone()) {
            let mut new = vector;
            new[*axis] = value;
            moved = Some(new);
        }
    }
    moved
}

fn time(ui: &mut Ui, bench: &Bench, asked: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let playing = bench.is_playing();
        if ui.button(if playing { "stop" } else { "play" }).clicked() {
            asked.push(Command::Play(!playing));
        }
        for (text, command) in [
            ("step", Command::Step(1)),
            ("− 1 s", Command::Rewind(1.0)),
            ("to the start", Command::Rewind(f64::MAX)),
            ("undo", Command::Undo),
        ] {
            if ui.button(text).clicked() {
                asked.push(command);
            }
        }
        ui.label(format!("{:.2} s", bench.state().time()));
    });
    let mut speed = bench.speed();
    let slider = Slider::new(&mut speed, SPEEDS)
        .logarithmic(true)
        .text("speed");
    if ui.add(slider).changed() {
        asked.push(Command::Speed(speed));
    }
    if !bench.message.is_empty() {
        ui.colored_label(Color32::from_rgb(255, 190, 90), &bench.message);
    }
}

fn bodies(ui: &mut Ui, bench: &Bench, pointer: &mut Pointer, asked: &mut Vec<Command>) {
    let now = pointer.body.shape;
    ComboBox::from_label("thing")
        .selected_text(now.name())
        .show_ui(ui, |ui| {
            for shape in Shape::ALL {
                if ui.selectable_label(shape == now, shape.name()).clicked() {
                    pointer.take(shape);
                }
            }
        });
    ui.horizontal_wrapped(|ui| {
        for tool in Tool::ALL {
            ui.selectable_value(&mut pointer.tool, tool, tool.name());
        }
    });
    ui.weak(pointer.tool.help());
    let body = &mut pointer.body;
    ui.add(
        Slider::new(&mut body.size, ranges::SIZE)
            .text("times its size")
            .max_decimals(2),
    );
    ui.add(
        Slider::new(&mut body.position[1], 0.1..=4.0)
            .text("height, m")
            .max_decimals(2),
    );
    ui.add(
        Slider::new(&mut body.tilt, -90.0..=90.0)
            .text("tilt, °")
            .max_decimals(0),
    );
    ui.add(
        Slider::new(&mut body.heading, 0.0..=360.0)
            .text("heading, °")
            .max_decimals(0),
    );
    ui.add(
        Slider::new(&mut pointer.rain, ranges::RAIN)
            .text("bodies in a rain")
            .integer(),
    );
    ui.horizontal(|ui| {
        if ui.button("rain").clicked() {
            asked.push(keys::rain(bench, pointer));
        }
        if ui.button("remove selected").clicked() {
            asked.extend(keys::remove(bench));
        }
        if ui.button("clear").clicked() {
            asked.push(Command::Change(Change::Clear));
        }
    });
}

fn fluid(ui: &mut Ui, bench: &Bench, asked: &mut Vec<Command>) {
    let settings = &bench.state().settings;
    ui.horizontal(|ui| {
        for (fluids, name) in [
            (Fluids::Air, "air"),
            (Fluids::Water, "water"),
            (Fluids::Pond, "air over a pond"),
        ] {
            let chosen = ui.selectable_label(settings.fluids == fluids, name);
            if chosen.clicked() {
                set(asked, Some(Setting::Fluids(fluids)));
            }
        }
    });
    let texts = match settings.fluids {
        Fluids::Water => ["current x, m/s", "current up, m/s", "current z, m/s"],
        Fluids::Air | Fluids::Pond => ["wind x, m/s", "wind up, m/s", "wind z, m/s"],
    };
    let texts = [(0, texts[0]), (1, texts[1]), (2, texts[2])];
    let moved = vector(ui, &texts, settings.wind, &ranges::WIND);
    set(asked, moved.map(Setting::Wind));
    let moved = slider(
        ui,
        "turbulence σ, m/s",
        settings.turbulence,
        ranges::TURBULENCE,
    );
    set(asked, moved.map(Setting::Turbulence));
    if settings.turbulence > 0.0 {
        let moved = slider(ui, "eddies, m", settings.eddy, ranges::EDDY);
        set(asked, moved.map(Setting::Eddy));
    }
    if settings.fluids == Fluids::Pond {
        let moved = slider(ui, "level, m", settings.level, ranges::LEVEL);
        set(asked, moved.map(Setting::Level));
        let moved = slider(ui, "waves, m", settings.waves, ranges::WAVES);
        set(asked, moved.map(Setting::Waves));
        let texts = [(0, "current x, m/s"), (2, "current z, m/s")];
        let moved = vector(ui, &texts, settings.current, &ranges::WIND);
        set(asked, moved.map(Setting::Current));
    }
}

fn law(ui: &mut Ui, bench: &Bench, asked: &mut Vec<Command>) {
    let settings = &bench.state().settings;
    ui.horizontal_wrapped(|ui| {
        for (key, method) in Method::ALL.into_iter().enumerate() {
            let text = format!("{key} {}", method.name());
            let chosen = ui.selectable_label(settings.method == method, text);
            if chosen.clicked() {
                set(asked, Some(Setting::Method(method)));
            }
        }
    });
    if settings.method != Method::Law {
        ui.weak("law and factors: for what is not flat");
    }
    let names = [
        (Law::Physical, "physical (default)"),
        (Law::Thesis, "the thesis's, with C̃"),
        (Law::Stochastic, "stochastic method's"),
        (Law::Inviscid, "an ideal fluid"),
    ];
    let now = names.iter().find(|(law, _)| *law == settings.law);
    ComboBox::from_label("law")
        .selected_text(now.map_or("", |(_, name)| *name))
        .show_ui(ui, |ui| {
            for (law, name) in names {
                if ui.selectable_label(settings.law == law, name).clicked() {
                    set(asked, Some(Setting::Law(law)));
                }
            }
        });
    if settings.law == Law::Thesis {
        let texts = [
            (0, "C̃ drag"),
            (1, "C̃ rotational lift"),
            (2, "C̃ translational lift"),
        ];
        let moved = vector(ui, &texts, settings.coefficients, &ranges::COEFFICIENT);
        set(asked, moved.map(Setting::Coefficients));
    }
    let texts = [
        (0, "× drag"),
        (1, "× rotational lift"),
        (2, "× translational lift"),
    ];
    let moved = vector(ui, &texts, settings.factors, &ranges::FACTOR);
    set(asked, moved.map(Setting::Factors));
}

fn view(ui: &mut Ui, bench: &mut Bench) {
    let view = &mut bench.view;
    ui.horizontal_wrapped(|ui| {
        for (shown, name) in [
            (&mut view.forces, "forces"),
            (&mut view.trails, "trails"),
            (&mut view.planforms, "planforms"),
            (&mut view.proxies, "proxies"),
            (&mut view.flow, "flow"),
            (&mut view.phase, "phase diagram"),
        ] {
            ui.checkbox(shown, name);
        }
    });
    if view.forces {
        ui.horizontal_wrapped(|ui| {
            for (name, color) in DebugRender::FORCES {
                let [r, g, b] = crate::forces::rgb(color).map(|x| (255.0 * x) as u8);
                ui.colored_label(Color32::from_rgb(r, g, b), name);
            }
        });
    }
}

fn selected(ui: &mut Ui, bench: &Bench, phase: &Phase) {
    let state = bench.state();
    let (Some((body, handle)), Some(index)) = (bench.selected(), bench.view.selected) else {
        ui.weak("none: click one");
        return;
    };
    let rapier = &state.world().bodies[handle];
    let forces = state.forces(index).unwrap_or_default();
    // Rapier's is that of body and fluid while something holds the body.
    let own = state.immersion.mass_of(handle).map(|own| own.mass);
    let mass = own.unwrap_or(rapier.mass().into());
    let weight = mass * GRAVITY;
    Grid::new("selected").num_columns(2).show(ui, |ui| {
        let mut row = |name: &str, value: String| {
            ui.label(name);
            ui.monospace(value);
            ui.end_row();
        };
        let all = state.bodies.len();
        row(
            "thing",
            format!("{}, {} of {all}", body.shape.name(), index + 1),
        );
        row("mass", format!("{:.3} g", 1e3 * mass));
        row("speed", format!("{:.2} m/s", rapier.linvel().length()));
        row("spin", format!("{:.1} rad/s", rapier.angvel().length()));
        row("mean descent", format!("{:.2} m/s", body.descent));
        let angle = forces.angle_of_attack.to_degrees();
        row("angle of attack", format!("{angle:.0}°"));
        for (name, force) in [
            ("drag", forces.drag),
            ("translational lift", forces.translational_lift),
            ("rotational lift", forces.rotational_lift),
            ("added mass", forces.added_mass),
            ("buoyancy", forces.buoyancy),
            ("turbulence", forces.turbulence),
        ] {
            let share = f64::from(force.force.length()) / weight;
            row(name, format!("{share:.2} weights"));
        }
        if let Some(marker) = phase.marker(state, index) {
            row("Re, expected", format!("{:.0}", marker.expected));
            row("Re, now", format!("{:.0}", marker.now));
            row("I*", format!("{:.4}", marker.i_star));
            row("regime", marker.regime.to_string());
        }
        if let Drive::Path(path) = &body.drive
            && let Some([mean, largest]) = path.distances()
        {
            let both = format!("{:.1}, {:.1} cm", 100.0 * mean, 100.0 * largest);
            row("from its line, mean, most", both);
        }
    });
}

fn help(ui: &mut Ui) {
    Grid::new("keys").num_columns(2).show(ui, |ui| {
        for (key, what) in keys::HELP {
            ui.monospace(key);
            ui.label(what);
            ui.end_row();
        }
    });
    ui.weak("right button turns, middle button moves, wheel zooms");
}
