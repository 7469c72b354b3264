//! Leaves on a twig that sways in gusts.

use crate::Failure;
use crate::draw::{Item, Panel};
use crate::film::{BLUE, GREEN, GREY, RED, Shown, View, drawn, greatest};
use crate::stage::{advance, immerse, kinetic_energy, sprung, untouched, world};
use plotters::style::RGBColor;
use rapier3d_immersed::flow::Flow;
use rapier3d_immersed::rapier3d::prelude::*;
use rapier3d_immersed::{Fluid, Immersion};
use std::f32::consts::TAU;

/// From the side and a little along the twig.
const VIEW: View = View(Vector::new(0.6, 0.0, 0.8), Vector::new(-0.16, 0.96, 0.12));
const BROWN: RGBColor = RGBColor(121, 85, 61);
/// Leaves: how many, length, width and thickness, m, density, kg/m³; the stalk of each, m.
pub const LEAVES: usize = 12;
const LEAF: [f32; 3] = [0.073, 0.000_3, 0.042];
const DENSITY: f32 = 350.0;
const STALK: f32 = 0.03;
/// The twig: length and radius, m, density, kg/m³; how stiff its base is, N·m/rad, and how much that is damped, N·m·s/rad.
const TWIG: f32 = 0.6;
const RADIUS: f32 = 0.004;
const WOOD: f32 = 600.0;
const STIFF: f32 = 4.0;
const DAMPED: f32 = 0.05;
/// The stalks: N·m/rad and N·m·s/rad.
const BENDING: f32 = 5e-5;
const SLOW: f32 = 2e-6;

/// A wind along x that rises and falls, so much and so often, in gusts that come from the side.
#[derive(Clone, Copy, Debug)]
pub struct Gusts {
    /// Mean, and how far it goes up and down, m/s.
    pub mean: f32,
    pub swing: f32,
}

/// Of one gust, s.
const PERIOD: f32 = 1.7;

impl Flow for Gusts {
    fn velocity(&self, point: Vector, time: f64) -> Vector {
        let phase = TAU * (time as f32 - point.z / 3.0) / PERIOD;
        Vector::X * (self.mean + self.swing * phase.sin())
            + Vector::Z * (0.3 * self.swing * (2.3 * phase).sin())
    }
}

pub struct Twig {
    pub world: PhysicsWorld,
    pub immersion: Immersion,
    pub twig: RigidBodyHandle,
    pub leaves: Vec<RigidBodyHandle>,
}

impl Twig {
    /// # Errors
    /// Those of the description, which these sizes do not give.
    pub fn new(wind: Gusts, hz: f32) -> Result<Self, Failure> {
        let (mut world, mut immersion) = world(Fluid::AIR, hz);
        immersion.set_flow(wind);
        let branch = world.insert_body(RigidBodyBuilder::fixed());
        // The twig's frame: from its base, along z.
        let half = Pose::translation(0.0, 0.0, 0.5 * TWIG);
        let wood = untouched(SharedShape::capsule_z(0.5 * TWIG, RADIUS), half).density(WOOD);
        let (twig, _) = world.insert(RigidBodyBuilder::dynamic().can_sleep(false), wood);
        // It does not turn about itself.
        let fixed = JointAxesMask::LIN_AXES | JointAxesMask::ANG_Z;
        let base = sprung(GenericJointBuilder::new(fixed), STIFF, DAMPED);
        world.insert_impulse_joint(branch, twig, base);
        immerse(&world, &mut immersion, twig, None)?;
        let mut leaves = Vec::new();
        for i in 0..LEAVES {
            // Two and two, to the left and the right, each pair turned against the one before.
            let along = TWIG * (1.0 + (i / 2) as f32) / (LEAVES / 2) as f32;
            let side = if i % 2 == 0 { 0.5 } else { -0.5 };
            let turn = Rotation::from_rotation_z(-TAU / 4.0 + side)
                * Rotation::from_rotation_x(TAU * 0.13 * i as f32);
            let [length, thickness, width] = LEAF;
            let blade = SharedShape::cuboid(0.5 * length, 0.5 * thickness, 0.5 * width);
            let out = Pose::translation(STALK + 0.5 * length, 0.0, 0.0);
            let node = Pose::from_parts(Vector::Z * along, turn);
            let body = RigidBodyBuilder::dynamic().pose(node).can_sleep(false);
            let (leaf, _) = world.insert(body, untouched(blade, out).density(DENSITY));
            let stalk = GenericJointBuilder::new(JointAxesMask::LIN_AXES).local_frame1(node);
            world.insert_impulse_joint(twig, leaf, sprung(stalk, BENDING, SLOW));
            immerse(&world, &mut immersion, leaf, None)?;
            leaves.push(leaf);
        }
        Ok(Self {
            world,
            immersion,
            twig,
            leaves,
        })
    }

    pub fn run(&mut self, seconds: f32) {
        advance(&mut self.world, &mut self.immersion, seconds);
    }

    /// Mean angle between the leaves and a direction, degrees: of their normals, and of their long axes.
    pub fn angles(&self, direction: Vector) -> [f64; 2] {
        let mean = |axis: Vector, both: bool| {
            let each = self.leaves.iter().map(|leaf| {
                let cosine = (*self.world.bodies[*leaf].rotation() * axis).dot(direction);
                let cosine = if both { cosine.abs() } else { cosine };
                f64::from(cosine.clamp(-1.0, 1.0).acos().to_degrees())
            });
            each.sum::<f64>() / LEAVES as f64
        };
        [mean(Vector::Y, true), mean(Vector::X, false)]
    }
}

pub fn show() -> Result<Shown, Failure> {
    let (mut lines, mut panels) = (Vec::new(), Vec::new());
    let mut curves = Panel::new("long axes to the wind, mean", "time, s", "degrees");
    let mut energies = Panel::new("kinetic energy", "time, s", "mJ");
    for (mean, swing, color) in [(0.0, 0.0, GREY), (2.0, 1.0, BLUE), (5.0, 2.5, RED)] {
        let mut twig = Twig::new(Gusts { mean, swing }, 240.0)?;
        let (mut angle, mut energy) = (Vec::new(), Vec::new());
        for i in 1..=400 {
            let time = 0.05 * f64::from(i);
            twig.run(0.05);
            angle.push((time, twig.angles(Vector::X)[1]));
            energy.push((time, 1e3 * kinetic_energy(&twig.world)));
        }
        let title = format!("{mean} ± {swing} m/s, after 20 s");
        let mut view = Panel::new(title, "m", "m").equal();
        view.window = Some([(-0.1, 0.7), (-0.4, 0.4)]);
        let wood = drawn(&twig.world, &[twig.twig], VIEW, BROWN);
        view.items = drawn(&twig.world, &twig.leaves, VIEW, GREEN);
        view.items.extend(wood);
        panels.push(view);
        let most = greatest(&energy);
        lines.push(format!("{mean} ± {swing} m/s: at most {most:.1} mJ"));
        curves.items.push(Item::Line(angle, color, 1));
        energies.items.push(Item::Line(energy, color, 1));
    }
    panels.extend([curves, energies]);
    let title = "Leaves on a twig; below: still air (grey), 2 m/s (blue), 5 m/s (red)";
    Ok(Shown::new(title, panels, lines))
}
