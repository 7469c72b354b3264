//! The window: what is seen of a bench, and what the mouse and the keys ask of it.

mod diagram;
mod files;
mod hand;
mod keys;
mod panel;
mod stage;

pub use files::Files;
pub use hand::{Hand, Sight, Tool};
pub use keys::{HELP, pressed};

use crate::bench::{Bench, Command};
use crate::phase::Phase;
use crate::view::View;
use kiss3d::prelude::*;
use rapier3d_immersed::rapier3d::math::Vector;
use stage::Stage;
use std::path::Path;
use std::time::Instant;

/// Of the window, pixels.
const SIZE: [u32; 2] = [1280, 800];

/// A bench, with what a user has in the hand.
pub struct App {
    /// The bench.
    pub bench: Bench,
    /// The tool.
    pub hand: Hand,
    /// Names of files.
    pub files: Files,
    phase: Phase,
    /// What is asked for but has to be prepared: it is said first, then done.
    waiting: Option<Command>,
}

impl App {
    /// For a bench.
    pub fn new(bench: Bench) -> Self {
        Self {
            bench,
            hand: Hand::default(),
            files: Files::default(),
            phase: Phase::default(),
            waiting: None,
        }
    }

    /// Carries a command out; one that takes a second or more, at the beginning of the next frame.
    pub fn ask(&mut self, command: Command) {
        if self.bench.must_prepare(&command) {
            self.bench.message = "the method is trained for this thing …".into();
            self.waiting = Some(command);
        } else {
            // What is wrong is in the bench's message.
            self.bench.apply(command).ok();
        }
    }

    /// Lets the time of a frame pass, s.
    pub fn advance(&mut self, seconds: f64) {
        match self.waiting.take() {
            Some(command) => {
                self.bench.apply(command).ok();
            }
            None => self.bench.advance(seconds),
        }
    }

    /// The panel, and what it asks for.
    pub fn panel(&mut self, ctx: &kiss3d::egui::Context) {
        let (hand, files) = (&mut self.hand, &mut self.files);
        for command in panel::show(ctx, &mut self.bench, hand, files, &self.phase) {
            self.ask(command);
        }
    }

    fn event(&mut self, event: &WindowEvent, camera: &OrbitCamera3d, size: Vec2, at: Vec2) {
        let (origin, direction) = camera.unproject(at, size);
        let sight = Sight { origin, direction };
        match *event {
            WindowEvent::Key(key, Action::Press, modifiers) => {
                let shift = modifiers.contains(Modifiers::Shift);
                let asked = keys::pressed(key, shift, &mut self.bench, &mut self.hand);
                if let Some(command) = asked {
                    self.ask(command);
                }
            }
            WindowEvent::MouseButton(MouseButton::Button1, Action::Press, _) => {
                self.hand.press(&sight, &self.bench.view);
            }
            WindowEvent::MouseButton(MouseButton::Button1, Action::Release, _) => {
                if let Some(command) = self.hand.release(&sight, &mut self.bench) {
                    self.ask(command);
                }
            }
            WindowEvent::CursorPos(..) => self.hand.drag(&sight, &self.bench.view),
            _ => {}
        }
    }
}

fn camera(view: &View) -> OrbitCamera3d {
    let (eye, target) = (Vector::from(view.eye), Vector::from(view.target));
    let mut camera = OrbitCamera3d::new_with_frustum(0.8, 0.02, 100.0, eye, target);
    // Return is for the fields of the panel.
    camera.rebind_reset_key(None);
    camera.set_min_dist(0.1);
    camera.set_max_dist(40.0);
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
    let mut stage = Stage::default();
    let mut camera = camera(&app.bench.view);
    let mut seen = app.bench.view;
    let mut last = Instant::now();
    let mut cursor = Vec2::ZERO;
    loop {
        // A file that was read brings its own view.
        if (app.bench.view.eye, app.bench.view.target) != (seen.eye, seen.target) {
            camera.look_at(app.bench.view.eye.into(), app.bench.view.target.into());
        }
        // The left button belongs to the tool, except to select; the right one always turns.
        let turns = match app.hand.tool {
            Tool::Select => MouseButton::Button1,
            _ => MouseButton::Button2,
        };
        camera.rebind_rotate_button(Some(turns));
        camera.rebind_drag_button(Some(MouseButton::Button3));
        stage.show(&mut window, &app.bench, &app.hand);
        window.draw_ui(|ctx| app.panel(ctx));
        if !window.render_3d(&mut stage.scene, &mut camera).await {
            break;
        }
        app.bench.view.eye = camera.eye().to_array();
        app.bench.view.target = camera.at().to_array();
        seen = app.bench.view;
        let size = window.size().as_vec2();
        for event in window.events().iter() {
            if let WindowEvent::CursorPos(x, y, _) = event.value {
                cursor = Vec2::new(x as f32, y as f32);
            }
            let of_panel = if event.value.is_keyboard_event() {
                window.is_egui_capturing_keyboard()
            } else {
                window.is_egui_capturing_mouse()
            };
            let ends = matches!(event.value, WindowEvent::MouseButton(_, Action::Release, _));
            if !of_panel || ends {
                app.event(&event.value, &camera, size, cursor);
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
}

impl Pictures {
    /// For pictures of so many pixels in each direction. Panics without a graphics driver: see [`can_draw`].
    pub async fn new([width, height]: [u32; 2]) -> Self {
        let mut surface = OffscreenSurface::new(width, height).await;
        surface.set_samples(NumSamples::Four);
        lit(surface.window_mut());
        Self { surface }
    }

    /// What the window would show.
    pub async fn picture(&mut self, app: &mut App) -> image::RgbImage {
        let mut stage = Stage::default();
        let mut camera = camera(&app.bench.view);
        let resized = WindowEvent::FramebufferSize(self.surface.width(), self.surface.height());
        camera.handle_event(self.surface.window().canvas(), &resized);
        // The panel knows its size after its first frame.
        for _ in 0..3 {
            stage.show(self.surface.window_mut(), &app.bench, &app.hand);
            self.surface.draw_ui(|ctx| app.panel(ctx));
            self.surface.render_3d(&mut stage.scene, &mut camera).await;
        }
        self.surface.snap_image()
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
