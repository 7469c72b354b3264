//! What is drawn: bodies, ground, water, lines.

use super::pointer::Pointer;
use crate::bench::Bench;
use crate::forces;
use crate::kinds::{Shape, kind};
use crate::settings::Fluids;
use crate::state::{Drive, SAND, State};
use kiss3d::prelude::*;
use rapier3d_immersed::free_surface::{self, FreeSurface, Waves};
use rapier3d_immersed::rapier3d::math::Vector;
use std::collections::HashMap;

/// Side of the water that is seen, m, and its cells along each.
const POND: f64 = 16.0;
const CELLS: usize = 96;
/// Half the side of the ground's grid, m: its lines are 1 m apart.
const GRID: i32 = 8;
/// Side of the ground, m.
const GROUND: f32 = 40.0;
/// Of the light from above, on a scale of the renderer.
const SUN: f32 = 1.8;
const SKY: Color = Color::new(0.62, 0.72, 0.82, 1.0);
const UNDER_WATER: Color = Color::new(0.10, 0.28, 0.36, 1.0);
const WATER: Color = Color::new(0.02, 0.20, 0.34, 0.60);
const GRID_LINE: Color = Color::new(0.42, 0.39, 0.34, 1.0);
const TRAIL: Color = Color::new(0.95, 0.90, 0.55, 1.0);
const PATH: Color = Color::new(0.55, 0.15, 0.75, 1.0);
const SELECTED: Color = Color::new(1.0, 0.67, 0.16, 1.0);
/// Segments of the ring about the selected body.
const RING: usize = 48;

/// The nodes of the scene.
pub struct Drawing {
    /// What a renderer draws.
    pub scene: SceneNode3d,
    water: SceneNode3d,
    /// Significant height of the pond's waves, and these.
    waves: (f64, Option<Waves>),
    /// The bodies, by what they are: one mesh and many instances.
    bodies: HashMap<(Shape, u64), SceneNode3d>,
}

fn rgb([r, g, b]: [f32; 3]) -> Color {
    Color::new(r, g, b, 1.0)
}

impl Default for Drawing {
    fn default() -> Self {
        let mut scene = SceneNode3d::empty();
        let sun = Light::directional(Vec3::new(-0.45, -1.0, -0.35)).with_intensity(SUN);
        scene.add_light(sun);
        scene
            .add_cube(GROUND, 0.1, GROUND)
            .set_position(Vec3::new(0.0, -0.05, 0.0))
            .set_color(rgb(SAND))
            .set_roughness(1.0);
        let corner = [-0.5 * POND; 2];
        let surface = free_surface::mesh(&free_surface::Level, corner, [POND; 2], [CELLS; 2], 0.0);
        let (vertices, faces) = surface.unwrap_or_default();
        let mut water = scene.add_trimesh(vertices, faces, Vec3::ONE, false);
        water
            .set_color(WATER)
            .set_roughness(0.3)
            .set_reflectance(0.1)
            .set_casts_shadows(false)
            .enable_backface_culling(false);
        Self {
            scene,
            water,
            waves: (0.0, None),
            bodies: HashMap::new(),
        }
    }
}

impl Drawing {
    /// The state of the bench, on a window: nodes stay, lines are for the next frame.
    pub fn show(&mut self, window: &mut Window, bench: &Bench, pointer: &Pointer) {
        let state = bench.state();
        let under = state.settings.fluids == Fluids::Water;
        window.set_background_color(if under { UNDER_WATER } else { SKY });
        self.show_bodies(state);
        self.show_water(state);
        show_grid(window);
        for line in forces::lines(state, &bench.view) {
            window.draw_line(line.from, line.to, rgb(line.color), 2.0, false);
        }
        for [from, to] in pointer.lines() {
            window.draw_line(from, to, PATH, 3.0, false);
        }
        for (index, body) in state.bodies.iter().enumerate() {
            if bench.view.trails && state.is_seen(index) {
                let points = body.trail.iter().map(|p| Vec3::from(*p));
                show_line(window, points, TRAIL);
            }
            if let Drive::Path(path) = &body.drive {
                let line = path.sketch().points().iter().map(|(_, p)| *p);
                show_line(window, line.map(|p| crate::support::to_rapier(&p)), PATH);
            }
        }
        show_selected(window, bench);
    }

    fn show_bodies(&mut self, state: &State) {
        let mut instances: HashMap<_, Vec<_>> = HashMap::new();
        for (index, body) in state.bodies.iter().enumerate() {
            let handle = state.handle(index).filter(|_| state.is_seen(index));
            let Some(handle) = handle else {
                continue;
            };
            let pose = state.world().bodies[handle].position();
            let key = (body.shape, body.size.to_bits());
            instances.entry(key).or_default().push(InstanceData3d {
                position: pose.translation,
                deformation: Mat3::from_quat(pose.rotation),
                color: rgb(body.shape.color(body.id as usize)),
                ..InstanceData3d::default()
            });
        }
        for (key, node) in &mut self.bodies {
            node.set_visible(instances.contains_key(key));
        }
        for (key, instances) in instances {
            let scene = &mut self.scene;
            let node = self.bodies.entry(key).or_insert_with(|| {
                let mut node = body(key.0, f64::from_bits(key.1));
                node.set_roughness(0.8).enable_backface_culling(false);
                scene.add_child(node.clone());
                node
            });
            node.set_instances(&instances);
        }
    }

    fn show_water(&mut self, state: &State) {
        let pond = state.settings.fluids == Fluids::Pond;
        self.water.set_visible(pond);
        if !pond {
            return;
        }
        // What is set now: the fluid has it with the next step.
        let settings = &state.settings;
        if self.waves.0 != settings.waves {
            // Waves that cannot be are reported by the step.
            self.waves = (settings.waves, settings.surface().unwrap_or_default());
        }
        let level = settings.level as f32;
        self.water.set_position(Vec3::Y * level);
        let time = state.immersion.time();
        let waves = self.waves.1.as_ref();
        self.water.modify_vertices(&mut |vertices| {
            for vertex in vertices {
                let (x, z) = (vertex.x.into(), vertex.z.into());
                let height = waves.map_or(0.0, |waves| waves.elevation(x, z, time).height);
                vertex.y = height as f32;
            }
        });
        self.water.recompute_normals();
    }
}

/// The mesh of a thing; a small cube in place of one that cannot be made, which no body is.
fn body(shape: Shape, size: f64) -> SceneNode3d {
    let Ok(kind) = kind(shape, size) else {
        return SceneNode3d::cube(0.01, 0.01, 0.01);
    };
    let vertices = kind.solid.vertices().iter();
    let vertices = vertices.map(crate::support::to_rapier).collect();
    let faces = kind.solid.triangles().to_vec();
    SceneNode3d::trimesh(vertices, faces, Vec3::ONE, true)
}

fn show_grid(window: &mut Window) {
    let (end, above) = (GRID as f32, 1e-3);
    for i in -GRID..=GRID {
        let i = i as f32;
        for (from, to) in [
            (Vec3::new(i, above, -end), Vec3::new(i, above, end)),
            (Vec3::new(-end, above, i), Vec3::new(end, above, i)),
        ] {
            window.draw_line(from, to, GRID_LINE, 1.0, false);
        }
    }
}

fn show_line(window: &mut Window, mut points: impl Iterator<Item = Vector>, color: Color) {
    let Some(mut last) = points.next() else {
        return;
    };
    for point in points {
        window.draw_line(last, point, color, 2.0, false);
        last = point;
    }
}

fn show_selected(window: &mut Window, bench: &Bench) {
    let state = bench.state();
    let Some((of, handle)) = bench.selected() else {
        return;
    };
    let at = state.world().bodies[handle].center_of_mass();
    let radius = 1.2 * of.reach();
    let ring = (0..=RING).map(|i| {
        let (z, x) = (std::f32::consts::TAU * i as f32 / RING as f32).sin_cos();
        at + Vector::new(x, 0.0, z) * radius
    });
    show_line(window, ring, SELECTED);
}
