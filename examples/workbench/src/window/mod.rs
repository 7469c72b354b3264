//! The window: what is seen of a bench, and what the mouse and the keys ask of it.

mod diagram;
mod drawing;
mod files;
mod keys;
mod panel;
mod pointer;

pub use files::Files;
pub use keys::{HELP, pressed};
pub use pointer::{Pointer, Sight, Tool};

use crate::bench::{Bench, Command};
use crate::phase::Phase;
use crate::view::{DISTANCE, View};
use drawing::Drawing;
use kiss3d::prelude::*;
use rapier3d_immersed::rapier3d::math::Vector;
use std::path::Path;
use std::time::{Duration, Instant};

/// Of the window, pixels.
const SIZE: [u32; 2] = [1280, 800];
/// Between two looks at a window that is not seen.
const UNSEEN: Duration = Duration::from_millis(16);

/// A bench, with the tool that a user has and what is seen.
pub struct App {
    /// The bench.
    pub bench: Bench,
    /// The tool.
    pub pointer: Pointer,
    /// Names of files.
    pub files: Files,
    phase: Phase,
    /// Where it is looked from, and where the bench's view was when the two were last the same.
    camera: OrbitCamera3d,
    seen: View,
    cursor: Vec2,
    down: Vec<Key>,
    /// What is asked for but has to be prepared, and whether a picture has said so.
    waiting: Option<(Command, bool)>,
}

impl App {
    /// For a bench.
    pub fn new(bench: Bench) -> Self {
        Self {
            camera: camera(&bench.view),
            seen: bench.view,
            bench,
            pointer: Pointer::default(),
            files: Files::default(),
            phase: Phase::default(),
            cursor: Vec2::ZERO,
            down: Vec::new(),
            waiting: None,
        }
    }

    /// Carries a command out; one that takes a second or more, after the next picture, which says so.
    pub fn ask(&mut self, command: Command) {
        if let Some((earlier, _)) = self.waiting.take() {
            self.apply(earlier);
        }
        if self.bench.must_prepare(&command) {
            self.bench.message = "the method is trained for this thing …".into();
            self.waiting = Some((command, false));
        } else {
            self.apply(command);
        }
    }

    fn apply(&mut self, command: Command) {
        if matches!(command, Command::Load(_)) {
            self.pointer.let_go();
        }
        // What is wrong is in the bench's message.
        self.bench.apply(command).ok();
    }

    /// Lets the time between two pictures pass, s.
    pub fn advance(&mut self, seconds: f64) {
        match self.waiting.take() {
            Some((command, true)) => self.apply(command),
            Some((command, false)) => self.waiting = Some((command, true)),
            None => self.bench.advance(seconds),
        }
    }

    /// The panel, and what it asks for.
    pub fn panel(&mut self, ctx: &kiss3d::egui::Context) {
        let (pointer, files) = (&mut self.pointer, &mut self.files);
        for command in panel::show(ctx, &mut self.bench, pointer, files, &self.phase) {
            self.ask(command);
        }
    }

    /// The camera for the next picture: a file that was read brings its own view.
    pub fn camera(&mut self) -> &mut OrbitCamera3d {
        let (view, seen) = (&self.bench.view, &self.seen);
        if (view.eye, view.target) != (seen.eye, seen.target) {
            self.camera.look_at(view.eye.into(), view.target.into());
        }
        &mut self.camera
    }

    /// After a picture: the view is where the camera has been turned to, or was last where a file may have it.
    pub fn keep_view(&mut self) {
        let turned = View {
            eye: self.camera.eye().to_array(),
            target: self.camera.at().to_array(),
            ..self.bench.view
        };
        if turned.check().is_ok() {
            self.bench.view = turned;
        }
        self.seen = self.bench.view;
    }

    /// What happens to a window of a size in pixels, and is not the panel's.
    pub fn event(&mut self, event: &WindowEvent, size: Vec2) {
        if let WindowEvent::CursorPos(x, y, _) = *event {
            self.cursor = Vec2::new(x as f32, y as f32);
        }
        let (origin, direction) = self.camera.unproject(self.cursor, size);
        let sight = Sight { origin, direction };
        match *event {
            WindowEvent::Key(key, Action::Press, modifiers) => {
                // A key that stays down is pressed over and over.
                let again = self.down.contains(&key);
                if !again {
                    self.down.push(key);
                }
                let others = Modifiers::Control | Modifiers::Alt | Modifiers::Super;
                if modifiers.intersects(others) || again && !keys::repeats(key) {
                    return;
                }
                let shift = modifiers.contains(Modifiers::Shift);
                let asked = keys::pressed(key, shift, &mut self.bench, &mut self.pointer);
                if let Some(command) = asked {
                    self.ask(command);
                }
            }
            WindowEvent::Key(key, Action::Release, _) => self.down.retain(|down| *down != key),
            WindowEvent::MouseButton(MouseButton::Button1, Action::Press, _) => {
                self.pointer.press(&sight, &self.bench.view);
            }
            WindowEvent::MouseButton(MouseButton::Button1, Action::Release, _) => {
                if let Some(command) = self.pointer.release(&sight, &mut self.bench) {
                    self.ask(command);
                }
            }
            WindowEvent::CursorPos(..) => self.pointer.drag(&sight, &self.bench.view),
            WindowEvent::Focus(false) => {
                self.down.clear();
                self.pointer.let_go();
            }
            _ => {}
        }
    }
}

fn camera(view: &View) -> OrbitCamera3d {
    let (eye, target) = (Vector::from(view.eye), Vector::from(view.target));
    let mut camera = OrbitCamera3d::new_with_frustum(0.8, 0.02, 100.0, eye, target);
    // Return is for the fields of the panel.
    camera.rebind_reset_key(None);
    let (least, most) = DISTANCE.into_inner();
    camera.set_min_dist(least);
    camera.set_max_dist(most);
    camera.rebind_drag_button(Some(MouseButton::Button3));
    camera
}

fn lit(window: &mut Window) {
    window.set_ambient(0.35);
    window.set_shadow_distance(14.0);
    window.set_first_cascade_far_bound(4.0);
}

/// Opens a window on a bench, until it is closed.
pub async fn open(bench: Bench) {
    let mut window = Window::new_with_size("Workbench", SIZE[0], SIZE[1]).await;
    window.rebind_close_key(None);
    lit(&mut window);
    let mut app = App::new(bench);
    let mut drawing = Drawing::default();
    let mut last = Instant::now();
    let mut panels = None;
    loop {
        // The left button belongs to the tool, except to select; the right one always turns.
        let right = window.get_mouse_button(MouseButton::Button2) == Action::Press;
        let turns = match app.pointer.tool {
            Tool::Select if !right => MouseButton::Button1,
            _ => MouseButton::Button2,
        };
        app.camera.rebind_rotate_button(Some(turns));
        drawing.show(&mut window, &app.bench, &app.pointer);
        // A window that is not seen is not drawn, and its panel, which was not either, would be added to.
        let shown = window.egui_context().cumulative_pass_nr();
        if panels == Some(shown) {
            std::thread::sleep(UNSEEN);
        } else {
            panels = Some(shown);
            window.draw_ui(|ctx| app.panel(ctx));
        }
        if !window.render_3d(&mut drawing.scene, app.camera()).await {
            break;
        }
        app.keep_view();
        let size = window.size().as_vec2();
        for event in window.events().iter() {
            let event = event.value;
            let of_panel = if event.is_keyboard_event() {
                window.is_egui_capturing_keyboard()
            } else {
                event.is_mouse_event() && window.is_egui_capturing_mouse()
            };
            let ends = matches!(
                event,
                WindowEvent::MouseButton(_, Action::Release, _)
                    | WindowEvent::Key(_, Action::Release, _)
            );
            if !of_panel || ends {
                app.event(&event, size);
            }
        }
        let now = Instant::now();
        app.advance((now - last).as_secs_f64());
        last = now;
    }
}

/// Draws without a window. There can be one of it in a program, on its main thread: the renderer's context is global.
pub struct Pictures {
    surface: OffscreenSurface,
    drawing: Drawing,
}

impl Pictures {
    /// For pictures of so many pixels in each direction. Panics without a graphics driver: see [`can_draw`].
    pub async fn new([width, height]: [u32; 2]) -> Self {
        let mut surface = OffscreenSurface::new(width, height).await;
        surface.set_samples(NumSamples::Four);
        lit(surface.window_mut());
        let drawing = Drawing::default();
        Self { surface, drawing }
    }

    /// What the window would show.
    pub async fn picture(&mut self, app: &mut App) -> image::RgbImage {
        let (surface, drawing) = (&mut self.surface, &mut self.drawing);
        let resized = WindowEvent::FramebufferSize(surface.width(), surface.height());
        app.camera()
            .handle_event(surface.window().canvas(), &resized);
        // The panel knows its size after its first frame.
        for _ in 0..3 {
            drawing.show(surface.window_mut(), &app.bench, &app.pointer);
            surface.draw_ui(|ctx| app.panel(ctx));
            surface.render_3d(&mut drawing.scene, app.camera()).await;
        }
        surface.snap_image()
    }
}

/// Whether there is something to draw with: a graphics processor, or a driver that does it in software.
pub async fn can_draw() -> bool {
    let instance = wgpu::Instance::default();
    let options = wgpu::RequestAdapterOptions::default();
    instance.request_adapter(&options).await.is_ok()
}

/// Writes a picture of a bench as a PNG file.
///
/// # Errors
/// If there is nothing to draw with, or the file cannot be written.
pub async fn write_picture(bench: Bench, path: &Path) -> Result<(), String> {
    if !can_draw().await {
        return Err("there is no graphics driver: mesa-vulkan-drivers draws in software".into());
    }
    let mut pictures = Pictures::new(SIZE).await;
    let picture = pictures.picture(&mut App::new(bench)).await;
    picture
        .save(path)
        .map_err(|error| format!("{}: {error}", path.display()))
}
