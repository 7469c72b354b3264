//! A body in an ideal fluid, left alone: energy, impulse and moment of impulse stay, and a pendulum of
//! potential flow swings with a period that is known.

use super::draw::{self, Item, Panel, Point};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use super::{Quat, Vec3};
use plotters::style::RGBColor;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::rapier3d::na::Matrix3;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::training::{BodyInWorld, BodyState};
use rapier3d_immersed::{
    DryMass, Error, Fluid, FreeBody, HydroProperties, ImmersedBody, ViscousLaw,
};

const SOURCE: &str = "Lamb, chapter VI: conserved exactly";
/// Period of the swing from φ₀ = 1 with M₁ = 1.2, M₂ = 3, J = ½, P = 2: 4 K(sin φ₀)/ω₀.
const PERIOD: f64 = 4.174_876_46;

/// A body in a rapier world without gravity, and a twin in f64 that evaluates the invariants at rapier's
/// state.
struct World {
    rapier: BodyInWorld,
    twin: FreeBody,
}

impl World {
    fn new(
        free: &FreeBody,
        body: &ImmersedBody,
        mass: &DryMass,
        fluid: Fluid,
        dt: f64,
    ) -> Result<Self, Error> {
        let release = BodyState::of(free);
        Ok(Self {
            rapier: BodyInWorld::new(body.clone(), mass, fluid, &release, dt, 0.0)?,
            twin: free.clone(),
        })
    }

    fn step(&mut self) -> &FreeBody {
        self.rapier.step();
        let state = self.rapier.state();
        self.twin.position = state.position;
        self.twin.set_orientation(state.orientation);
        self.twin.set_velocity(state.velocity, state.spin);
        &self.twin
    }
}

/// Relative deviations of energy, impulse and moment of impulse from where they began.
struct Invariants {
    energy: f64,
    impulse: Vec3,
    moment: Vec3,
}

impl Invariants {
    fn of(body: &FreeBody) -> Self {
        Self {
            energy: body.kinetic_energy(),
            impulse: body.impulse(),
            moment: body.impulse_moment(),
        }
    }

    fn deviation(&self, body: &FreeBody) -> [f64; 3] {
        let now = Self::of(body);
        // Far from the origin the moment is a small difference of large numbers.
        let scale = self.moment.norm() + body.position.norm() * self.impulse.norm();
        [
            (now.energy / self.energy - 1.0).abs(),
            (now.impulse - self.impulse).norm() / self.impulse.norm(),
            (now.moment - self.moment).norm() / scale,
        ]
    }
}

/// A box of 20 × 10 × 4 cm, twice as dense as the water around it.
fn block() -> Result<(ImmersedBody, DryMass), Error> {
    let size = [0.2, 0.1, 0.04];
    let half = size.map(|x| (0.5 * x) as f32);
    let shape = SharedShape::cuboid(half[0], half[1], half[2]);
    let hydro = HydroProperties::from_shape(shape.as_ref())?;
    let mass = 2000.0 * size.iter().product::<f64>();
    let [x, y, z] = size.map(|x| x * x / 12.0);
    let inertia = Matrix3::from_diagonal(&Vec3::new(y + z, z + x, x + y)) * mass;
    let dry = DryMass {
        mass,
        center: Vec3::zeros(),
        inertia,
    };
    let body = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid)?;
    Ok((body, dry))
}

/// The deviations over time in one run, and the largest of each.
fn history(seconds: f64, dt: f64, mut step: impl FnMut() -> [f64; 3]) -> ([f64; 3], Vec<Point>) {
    let (mut worst, mut curve) = ([0.0f64; 3], Vec::new());
    let steps = (seconds / dt).round() as usize;
    for i in 1..=steps {
        let deviation = step();
        worst = std::array::from_fn(|k| worst[k].max(deviation[k]));
        if i.is_multiple_of(steps.div_ceil(200)) {
            curve.push((i as f64 * dt, worst[0].max(1e-16)));
        }
    }
    (worst, curve)
}

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let (body, mass) = block()?;
    let seconds = effort.choose(10.0, 1.0);
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (i, spin) in [1.0, 6.0, 20.0].into_iter().enumerate() {
        let mut released = FreeBody::new(&body, &mass, &Fluid::WATER)?;
        released.set_orientation(Quat::from_euler_angles(0.4, 1.0, -0.3));
        let turning = Vec3::new(1.0, 2.0, -0.5).normalize() * spin;
        released.set_velocity(Vec3::new(0.3, 0.1, -0.2), turning);
        let start = Invariants::of(&released);
        let mut push = |how: &str, worst: [f64; 3], bar: Option<f64>| {
            for (what, error) in ["energy", "impulse", "moment of impulse"].iter().zip(worst) {
                let case = format!("{what}, {spin} rad/s, {seconds} s, {how}");
                rows.push(Row::at_most(case, error, bar, SOURCE));
            }
        };
        let mut converged = released.clone();
        converged.integrator.iterations = 8;
        let (worst, curve) = history(seconds, 1e-3, || {
            converged.step(1e-3, Vec3::zeros());
            start.deviation(&converged)
        });
        push("stand-alone, 1 ms, iterated", worst, Some(1e-9));
        curves.push((spin, RGBColor(46, 140, 60), curve));
        let mut default = released.clone();
        let dt = 1.0 / 240.0;
        let (worst, curve) = history(seconds, dt, || {
            default.step(dt, Vec3::zeros());
            start.deviation(&default)
        });
        push("stand-alone, 1/240 s, default", worst, None);
        curves.push((spin, RGBColor(30, 90, 200), curve));
        let mut world = World::new(&released, &body, &mass, Fluid::WATER, dt)?;
        let (worst, curve) = history(seconds, dt, || start.deviation(world.step()));
        push("rapier, 1/240 s", worst, Some(1e-4));
        curves.push((spin, RGBColor(211, 47, 47), curve));
        progress(0.3 * (i + 1) as f64);
    }
    pendulum(&mut rows)?;
    Ok((rows, vec![("kirchhoff.svg".into(), picture(curves)?)]))
}

/// The reference swing: a body of M₁ = 1.2 kg along, M₂ = 3 kg across and J = ½ kg m² with the fluid.
fn pendulum(rows: &mut Vec<Row>) -> Result<(), Failure> {
    let shape = SharedShape::cuboid(0.5, 0.3, 0.05);
    let added = AddedMass::diagonal(Vec3::new(0.2, 0.5, 2.0), Vec3::new(0.1, 0.25, 0.1));
    let hydro = HydroProperties::from_shape(shape.as_ref())?.with_added_mass(added)?;
    let body = ImmersedBody::new(hydro).with_law(ViscousLaw::Inviscid)?;
    let mass = DryMass {
        mass: 1.0,
        center: Vec3::zeros(),
        inertia: Matrix3::identity() * 0.25,
    };
    let fluid = Fluid::new(1.0, 1e-6)?;
    let mut released = FreeBody::new(&body, &mass, &fluid)?;
    released.set_orientation(Quat::from_axis_angle(&Vec3::y_axis(), 1.0));
    let (sin, cos) = 1f64.sin_cos();
    let along = Vec3::new(-2.0 * sin / 1.2, 0.0, 2.0 * cos / 3.0);
    released.set_velocity(released.orientation() * along, Vec3::zeros());

    let mut free = released.clone();
    let dt = 1e-4;
    let alone = period(dt, || {
        free.step(dt, Vec3::zeros());
        free.normal()
    });
    let source = "4 K(sin φ₀)/ω₀";
    let pair = [PERIOD, alone];
    let case = "period of the swing, stand-alone, 0.1 ms";
    rows.push(Row::number(case, pair, "s", Some(1e-6), source));
    for steps in [240.0, 60.0] {
        let dt = 1.0 / steps;
        let mut world = World::new(&released, &body, &mass, fluid, dt)?;
        let rapier = period(dt, || world.step().normal());
        let case = format!("period of the swing, rapier, 1/{steps} s");
        let bar = (steps == 240.0).then_some(1e-4);
        rows.push(Row::number(case, [PERIOD, rapier], "s", bar, source));
    }
    Ok(())
}

/// Mean over five periods of the angle of the normal in the x–z plane.
fn period(dt: f64, mut normal: impl FnMut() -> Vec3) -> f64 {
    const SWINGS: usize = 5;
    let (mut last, mut time, mut crossings) = (1.0f64, 0.0, Vec::new());
    while crossings.len() <= 2 * SWINGS && time < 100.0 {
        let n = normal();
        time += dt;
        let angle = n.x.atan2(n.z);
        if angle * last < 0.0 {
            crossings.push(time - dt * angle / (angle - last));
        }
        last = angle;
    }
    match crossings[..] {
        [first, .., end] if crossings.len() > 2 * SWINGS => (end - first) / SWINGS as f64,
        _ => f64::NAN,
    }
}

fn picture(curves: Vec<(f64, RGBColor, Vec<Point>)>) -> Result<String, Failure> {
    let mut panels = Vec::new();
    for spin in [1.0, 6.0, 20.0] {
        let title = format!("{spin} rad/s");
        let mut panel = Panel::new(title, "time, s", "largest error of the energy so far");
        panel.logarithmic = true;
        panel.window = Some([(0.05, 10.0), (1e-15, 1e-2)]);
        for (of, color, curve) in &curves {
            if *of == spin {
                panel.items.push(Item::Line(curve.clone(), *color, 2));
            }
        }
        for (i, (label, color)) in [
            ("rapier, 1/240 s", RGBColor(211, 47, 47)),
            ("stand-alone, 1/240 s", RGBColor(30, 90, 200)),
            ("stand-alone, 1 ms, iterated", RGBColor(46, 140, 60)),
        ]
        .into_iter()
        .enumerate()
        {
            let at = (0.3, 3e-3 / 8f64.powi(i as i32));
            panel.items.push(Item::Label(at, label.into(), color));
        }
        panels.push(panel);
    }
    let title = "A block of 20 × 10 × 4 cm in water without viscosity: energy that should stay";
    draw::svg(title, &panels, 3, (430, 420))
}
