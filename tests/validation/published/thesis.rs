//! Figures 5.4 and 5.13 of H. Xie's thesis.

use super::draw::{self, Item, Panel, Point};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use super::{Vec3, previous};
use plotters::style::RGBColor;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::flow::FlowSample;
use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::motion::{DimensionlessNumbers, Moment, Trajectory};
use rapier3d_immersed::rapier3d::na::{Matrix3, Matrix6};
use rapier3d_immersed::training::{Experiment, thin_ellipsoid};
use rapier3d_immersed::turbulence::{
    NoiseStream, SeenFluctuation, TurbulenceState, kolmogorov_constant,
};
use rapier3d_immersed::{
    DryMass, Error, Fluid, FreeBody, HydroProperties, ImmersedBody, StochasticLaw, ThesisLaw,
    ViscousLaw,
};
use std::f64::consts::{FRAC_PI_2, TAU};

const BLUE: RGBColor = RGBColor(30, 90, 200);
const ORANGE: RGBColor = RGBColor(220, 120, 20);
const GREEN: RGBColor = RGBColor(46, 140, 60);
const RED: RGBColor = RGBColor(211, 47, 47);
const GRAVITY: f64 = 9.81;

pub fn compute(_: Effort, progress: Progress) -> Result<Computed, Failure> {
    let mut rows = Vec::new();
    let coefficients = coefficients(&mut rows)?;
    progress(0.3);
    let effects = effects(&mut rows)?;
    let pictures = vec![
        ("thesis_fig_5_4.svg".into(), coefficients),
        ("thesis_fig_5_13.svg".into(), effects),
    ];
    Ok((rows, pictures))
}

/// The card of Fig. 5.13: 4 × 2 × 0.04 cm. The thesis does not print its density: 800 kg/m³.
const SEMI_AXES: [f64; 3] = [0.02, 0.01, 0.0002];

fn card() -> Result<(HydroProperties, DryMass), Error> {
    thin_ellipsoid(SEMI_AXES, 800.0)
}

/// Drag and lift coefficient on the planform at an angle of attack, as the read-out has them: the card
/// moves at 1 m/s in air, across its long axis, turning slowly about it.
fn measured(law: ViscousLaw, alpha: f64) -> Result<[f64; 3], Error> {
    let (hydro, mass) = card()?;
    let scale = 0.5 * f64::from(Fluid::AIR.density()) * hydro.planform.area;
    let axes = hydro.planform.axes;
    let body = ImmersedBody::new(hydro).with_law(law)?;
    let mut body = FreeBody::new(&body, &mass, &Fluid::AIR)?;
    let (sin, cos) = alpha.sin_cos();
    body.set_velocity(axes * Vec3::new(0.0, cos, sin), axes * Vec3::x() * 1e-4);
    let forces = body.forces(Vec3::zeros());
    let parts = [
        forces.drag,
        forces.rotational_lift,
        forces.translational_lift,
    ];
    Ok(parts.map(|part| f64::from(part.force.length()) / scale))
}

/// Fig. 5.4: C_D sin²α and the two lifts C_L1 |sin 2α|, C_L2 |cos 2α| for the three data sets that the
/// thesis fits; the measured points themselves are in its picture only.
fn coefficients(rows: &mut Vec<Row>) -> Result<String, Failure> {
    let sets = [
        ("data 1", ThesisLaw::FIG_5_4_DATA_1),
        ("data 2", ThesisLaw::FIG_5_4_DATA_2),
        ("data 3", ThesisLaw::FIG_5_4_DATA_3),
    ];
    let angles: Vec<f64> = (1..90).map(|i| f64::from(i).to_radians()).collect();
    let degrees = |values: &[f64]| -> Vec<Point> {
        let pairs = angles.iter().zip(values);
        pairs.map(|(a, c)| (a.to_degrees(), *c)).collect()
    };
    let mut panels = Vec::new();
    for (name, c) in sets {
        let mut found = [Vec::new(), Vec::new(), Vec::new()];
        let mut worst = [0.0f64; 3];
        for alpha in &angles {
            let exact = [
                c[0] * alpha.sin().powi(2),
                c[1] * (2.0 * alpha).sin().abs(),
                c[2] * (2.0 * alpha).cos().abs(),
            ];
            let law = ViscousLaw::Thesis(ThesisLaw::printed(c));
            let ours = measured(law, *alpha)?;
            for k in 0..3 {
                worst[k] = worst[k].max((ours[k] - exact[k]).abs() / c[0].max(c[1]));
                found[k].push(ours[k]);
            }
        }
        for (what, error) in ["drag", "rotational lift", "translational lift"]
            .iter()
            .zip(worst)
        {
            let case = format!("Fig. 5.4, {name}: {what} over the angle of attack");
            let source =
                "thesis (5.15)–(5.17), constants of the caption; of the largest coefficient";
            rows.push(Row::at_most(case, error, Some(1e-3), source));
        }
        let title = format!("{name}: C_D {}, C_L1 {}, C_L2 {}", c[0], c[1], c[2]);
        let mut panel = Panel::new(title, "angle of attack, degrees", "coefficient");
        panel.window = Some([(0.0, 90.0), (0.0, 3.2)]);
        let [drag, rotational, translational] = found;
        panel.items = vec![
            Item::Line(degrees(&drag), BLUE, 2),
            Item::Dashed(degrees(&rotational), ORANGE),
            Item::Dashed(degrees(&translational), GREEN),
        ];
        panels.push(panel);
    }
    let mut panel = Panel::new("the default law, Re ≈ 1300", "angle of attack, degrees", "");
    panel.window = Some([(0.0, 90.0), (0.0, 3.2)]);
    let mut found = [Vec::new(), Vec::new()];
    for alpha in &angles {
        let [drag, _, lift] = measured(ViscousLaw::default(), *alpha)?;
        found[0].push(drag);
        found[1].push(lift);
    }
    panel.items = vec![
        Item::Line(degrees(&found[0]), BLUE, 2),
        Item::Dashed(degrees(&found[1]), GREEN),
    ];
    for (i, (label, color)) in [
        ("drag", BLUE),
        ("rotational lift", ORANGE),
        ("translational lift", GREEN),
    ]
    .into_iter()
    .enumerate()
    {
        let at = (60.0, 3.0 - 0.2 * i as f64);
        panel.items.push(Item::Label(at, label.into(), color));
    }
    panels.push(panel);
    let title = "Thesis Fig. 5.4: drag (line) and lift (dashed) over the angle of attack";
    draw::svg(title, &panels, 4, (330, 420))
}

/// An ellipsoid of the card's size from meridians and parallels.
fn mesh() -> Result<Surface, Error> {
    const AROUND: u32 = 24;
    const RINGS: u32 = 11;
    let point = |polar: f64, around: f64| {
        let unit = Vec3::new(
            polar.sin() * around.cos(),
            polar.sin() * around.sin(),
            polar.cos(),
        );
        unit.component_mul(&Vec3::from(SEMI_AXES))
    };
    let mut vertices = vec![point(0.0, 0.0)];
    for ring in 1..=RINGS {
        let polar = 2.0 * FRAC_PI_2 * f64::from(ring) / f64::from(RINGS + 1);
        vertices.extend((0..AROUND).map(|i| point(polar, TAU * f64::from(i) / f64::from(AROUND))));
    }
    let south = vertices.len() as u32;
    vertices.push(point(2.0 * FRAC_PI_2, 0.0));
    let at = |ring: u32, i: u32| 1 + (ring - 1) * AROUND + i % AROUND;
    let mut triangles = Vec::new();
    for i in 0..AROUND {
        triangles.push([0, at(1, i), at(1, i + 1)]);
        triangles.push([south, at(RINGS, i + 1), at(RINGS, i)]);
        for ring in 1..RINGS {
            let [a, b] = [at(ring, i), at(ring, i + 1)];
            let [c, d] = [at(ring + 1, i), at(ring + 1, i + 1)];
            triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    Surface::new(&vertices, &triangles)
}

/// The nearest matrix without negative energies: a naive quadrature's need not be one.
fn positive(matrix: &Matrix6<f64>) -> (AddedMass, bool) {
    let clip = |block: Matrix3<f64>| {
        let eigen = (0.5 * (block + block.transpose())).symmetric_eigen();
        let kept = eigen.eigenvalues.map(|x| x.max(0.0));
        let turn = eigen.eigenvectors;
        let clipped = turn * Matrix3::from_diagonal(&kept) * turn.transpose();
        (clipped, eigen.eigenvalues.min() < 0.0)
    };
    let block = |i: usize| matrix.fixed_view::<3, 3>(i, i).into_owned();
    let (linear, a) = clip(block(0));
    let (angular, b) = clip(block(3));
    // The card has three planes of symmetry: no coupling.
    let added = AddedMass {
        linear,
        coupling: Matrix3::zeros(),
        angular,
    };
    (added, a || b)
}

/// Fig. 5.13: one effect after the other.
fn effects(rows: &mut Vec<Row>) -> Result<String, Failure> {
    let (hydro, mass) = card()?;
    let exact = hydro.added_mass.to_matrix6();
    let naive = previous::added_mass(&mesh()?).ok_or("the naive quadrature is singular")?;
    let (coarse, negative) = positive(&naive);
    let error = (naive - exact).norm() / exact.norm();
    let source = if negative {
        "‖K − K_a‖/‖K_a‖, as thesis Fig. 5.2 (90 % at 0.03 cm); negative energies are cut off for (b)"
    } else {
        "‖K − K_a‖/‖K_a‖, as thesis Fig. 5.2 (90 % at 0.03 cm)"
    };
    rows.push(Row::at_most(
        "Fig. 5.13 (b): error of the previous method's added mass",
        error,
        None,
        source,
    ));

    let numbers = DimensionlessNumbers::of(&hydro, &mass, &Fluid::AIR, GRAVITY)?;
    let body = ImmersedBody::new(hydro.clone());
    let release = |body: ImmersedBody, fluid: Fluid| {
        let mut experiment = Experiment::new(body, mass, fluid);
        experiment.release.tilt = 30f64.to_radians();
        // An end of the long axis dips, in the plane of the picture.
        experiment.release.tilt_axis = 0.0;
        experiment.seconds = 1.2;
        experiment.dt = 1.0 / 240.0;
        experiment
    };
    let inviscid = body.clone().with_law(ViscousLaw::Inviscid)?;
    let before =
        ImmersedBody::new(hydro.with_added_mass(coarse)?).with_law(ViscousLaw::Inviscid)?;
    let constant = ViscousLaw::Stochastic(StochasticLaw::default());
    let constant = body.clone().with_law(constant)?;
    // Table 5.2 lists the card as a zigzag.
    let zigzag = ViscousLaw::Thesis(ThesisLaw::printed(ThesisLaw::ZIGZAG));
    let zigzag = body.clone().with_law(zigzag)?;
    let vacuum = Fluid::new(1e-6, 1.0)?;
    let cases = [
        ("(a) no fluid", release(inviscid.clone(), vacuum)),
        (
            "(b) added mass, previous method",
            release(before, Fluid::AIR),
        ),
        ("(c) added mass", release(inviscid, Fluid::AIR)),
        ("(d) constant drag and lift", release(constant, Fluid::AIR)),
        ("(e) thesis's law, as printed", release(zigzag, Fluid::AIR)),
        ("(g) the default law", release(body, Fluid::AIR)),
    ];
    let mut falls = Vec::new();
    for (name, experiment) in &cases {
        falls.push((*name, experiment.run()?));
    }
    let gusty = in_turbulence(&cases[4].1, &numbers)?;
    falls.insert(5, ("(f) (e) and turbulence", gusty));
    let depth = |fall: &Trajectory| -fall.moments[fall.moments.len() - 1].position.y;
    let free = 0.5 * GRAVITY * 1.2f64.powi(2);
    let pair = [free, depth(&falls[0].1)];
    rows.push(Row::number(
        "Fig. 5.13 (a): depth after 1.2 s",
        pair,
        "m",
        Some(1e-3),
        "½gt²",
    ));
    rows.push(energy_of_the_ideal_fall(&cases[2].1)?);
    for (name, fall) in &falls[1..] {
        let text = format!(
            "{:.2} m down, {:.2} m aside, rises by {:.1} mm at most",
            depth(fall),
            aside(fall),
            1e3 * rise(fall)
        );
        let case = format!("Fig. 5.13 {name}: after 1.2 s");
        rows.push(
            Row::fact(
                case,
                text,
                true,
                "the thesis shows pictures only, and no density",
            )
            .shown(),
        );
    }
    let panels: Vec<Panel> = falls.iter().map(|(name, fall)| panel(name, fall)).collect();
    let title =
        "Thesis Fig. 5.13: effects one by one; card of 4 × 2 × 0.04 cm, 30°, 1.2 s (scales differ)";
    draw::svg(title, &panels, 7, (250, 560))
}

/// Kinetic energy of card and fluid gained in case (c), over the work of weight and buoyancy.
fn energy_of_the_ideal_fall(experiment: &Experiment) -> Result<Row, Error> {
    let mut body = experiment.released()?;
    let weight =
        experiment.mass.mass - f64::from(experiment.fluid.density()) * experiment.body.hydro.volume;
    let mut worst = 0.0f64;
    for _ in 0..experiment.steps() {
        body.step(experiment.dt, experiment.gravity_vector());
        let work = -weight * GRAVITY * body.position.y;
        worst = worst.max((body.kinetic_energy() / work - 1.0).abs());
    }
    let case = "Fig. 5.13 (c): kinetic energy over the work of gravity";
    Ok(Row::at_most(case, worst, Some(0.01), "ideal fluid: equal"))
}

/// Largest rise of the center of mass after any moment.
fn rise(fall: &Trajectory) -> f64 {
    let (mut low, mut most) = (f64::INFINITY, 0.0f64);
    for moment in &fall.moments {
        low = low.min(moment.position.y);
        most = most.max(moment.position.y - low);
    }
    most
}

fn aside(fall: &Trajectory) -> f64 {
    let last = fall.moments[fall.moments.len() - 1].position;
    last.x.hypot(last.z)
}

/// The experiment in a fluid whose velocity fluctuates by 30 % of U0.
fn in_turbulence(
    experiment: &Experiment,
    numbers: &DimensionlessNumbers,
) -> Result<Trajectory, Error> {
    let state = TurbulenceState::from_intensity(numbers.u0 as f32, 0.3, numbers.length as f32)?;
    let viscosity = numbers.kinematic_viscosity as f32;
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(viscosity));
    let noise = NoiseStream::new(1, 0);
    let mut seen = SeenFluctuation::default();
    let mut body = experiment.released()?;
    let mut moments = vec![Moment::of(&body)];
    for step in 0..experiment.steps() {
        let speed = body.linear_velocity().norm() as f32;
        let random = noise.vector(step as u64, 0);
        let flow = FlowSample {
            velocity: seen.advance(&state, c0, speed, experiment.dt as f32, random),
            ..FlowSample::default()
        };
        body.step_in(experiment.dt, experiment.gravity_vector(), &flow);
        moments.push(Moment::of(&body));
    }
    Ok(Trajectory {
        interval: experiment.dt,
        moments,
    })
}

fn panel(name: &str, fall: &Trajectory) -> Panel {
    let mut panel = Panel::new(name, "cm", "cm");
    let flat = |p: &Vec3| (100.0 * p.x, 100.0 * p.y);
    let path = fall.moments.iter().map(|m| flat(&m.position)).collect();
    panel.items.push(Item::Line(path, RED, 1));
    for moment in fall.moments.iter().step_by(9) {
        let across = moment.normal.cross(&Vec3::z()) * SEMI_AXES[0];
        let ends = [moment.position - across, moment.position + across];
        panel
            .items
            .push(Item::Line(ends.iter().map(flat).collect(), BLUE, 2));
    }
    panel
}
