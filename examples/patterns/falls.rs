//! Falls in pictures: thesis Figs. 5.5, 5.13, 5.14, 5.15 and 5.16.

use crate::Context;
use crate::draw::{Item, Panel, Point, color, isometric};
use plotters::style::RGBColor;
use rapier3d_immersed::flow::FlowSample;
use rapier3d_immersed::motion::{
    Classifier, DimensionlessNumbers, HelixFit, Moment, MotionGraph, Pattern, Regime, Sketch,
    Trajectory,
};
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::prelude::{ColliderBuilder, MassProperties, Vector};
use rapier3d_immersed::training::FollowParams;
use rapier3d_immersed::training::{
    Experiment, Plan, Planner, PlannerParams, Subspaces, thin_ellipsoid,
};
use rapier3d_immersed::turbulence::{
    NoiseStream, SeenFluctuation, TurbulenceState, kolmogorov_constant,
};
use rapier3d_immersed::{Error, Fluid, ImmersedBody, StochasticLaw, ViscousLaw};
use serde_json::{Value, json};

pub const GREY: RGBColor = RGBColor(120, 120, 120);
pub const BLUE: RGBColor = RGBColor(30, 90, 200);

/// Positions in cm.
fn centimeters(fall: &Trajectory) -> impl Iterator<Item = [f64; 3]> + '_ {
    fall.moments.iter().map(|m| (m.position * 100.0).into())
}

/// Seen along z, with strokes across the plate.
pub fn side(fall: &Trajectory, chord: f64, every: usize, color: RGBColor) -> Vec<Item> {
    let path = centimeters(fall).map(|[x, y, _]| (x, y)).collect();
    let mut items = vec![Item::Line(path, color, 1)];
    for moment in fall.moments.iter().step_by(every) {
        // The body edge-on: the direction across the line of sight and the normal.
        let across = moment.normal.cross(&Vector3::z()) * (50.0 * chord);
        let [x, y, _]: [f64; 3] = (moment.position * 100.0).into();
        let ends = vec![(x - across.x, y - across.y), (x + across.x, y + across.y)];
        items.push(Item::Line(ends, color, 2));
    }
    items
}

/// The path in space: world y is up.
fn in_space(fall: &Trajectory, color: RGBColor, width: u32) -> Item {
    let points = centimeters(fall).map(|[x, y, z]| isometric([x, z, y]));
    Item::Line(points.collect(), color, width)
}

fn from_above(fall: &Trajectory, color: RGBColor) -> Vec<Item> {
    let points: Vec<Point> = centimeters(fall).map(|[x, _, z]| (x, z)).collect();
    let start = points[0];
    vec![
        Item::Line(points, color, 1),
        Item::Dots(vec![start], RGBColor(0, 0, 0), 3),
    ]
}

/// Fig. 5.5: the card that autorotates along a helix. The thesis prints a = 2.5, b = 1.5 and c = 0.01 cm;
/// they are read as semi-axes here, although its Table 5.2 lists whole axes for other bodies.
pub fn helix(context: &Context) -> Result<Value, Error> {
    let (hydro, mass) = thin_ellipsoid([0.025, 0.015, 0.000_1], 1200.0)?;
    let mut experiment = Experiment::new(hydro, mass, Fluid::AIR);
    experiment.seconds = 6.0;
    let classifier = Classifier::default();
    let drop = |tilt: f64, tilt_axis: f64| {
        let mut experiment = experiment.clone();
        experiment.release.tilt = tilt.to_radians();
        experiment.release.tilt_axis = tilt_axis.to_radians();
        experiment.run()
    };
    let fit = |fall: &Trajectory| HelixFit::of(classifier.after_transient(fall));
    let fall = drop(45.0, 3.0)?;
    // How often it does so: most releases lead to autorotation along a path that bends now this way, now that.
    let (mut tumbling, mut helices, mut releases) = (0, 0, 0);
    for tilt in [43.0, 44.0, 45.0, 46.0, 47.0] {
        for tilt_axis in [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 8.0, 12.0] {
            let other = drop(tilt, tilt_axis)?;
            releases += 1;
            tumbling += u32::from(classifier.classify(&other).regime == Regime::PeriodicTumbling);
            helices += u32::from(fit(&other).is_some_and(|fit| fit.is_helix()));
        }
    }
    let seen = classifier.classify(&fall);
    let found = fit(&fall);
    let mut space = Panel::bare("in space");
    space
        .items
        .push(in_space(&fall, color(Pattern::Autorotation), 1));
    let mut above = Panel::new("from above", "x, cm", "z, cm").equal();
    above.items = from_above(&fall, color(Pattern::Autorotation));
    let title = "Fig. 5.5: card of semi-axes 2.5 × 1.5 × 0.01 cm, 1200 kg/m³, released at 45°, default law, 6 s";
    context.write("fig_5_5_helix.svg", title, &[space, above], 2, (470, 620));
    Ok(json!({
        "regime": seen.regime.abbreviation(),
        "half_turns": seen.flips,
        "radius_cm": found.map(|f| 100.0 * f.radius),
        "pitch_cm": found.map(|f| 100.0 * f.pitch),
        "turns": found.map(|f| f.turns),
        "residual_of_radius": found.map(|f| f.residual),
        "azimuth_per_half_turn_degrees": found.map(|f| f.azimuth_per_half_turn.to_degrees()),
        "helix": found.is_some_and(|f| f.is_helix()),
        "releases": releases,
        "releases_tumbling": tumbling,
        "releases_helix": helices,
    }))
}

/// Fig. 5.13: a card of 4 × 2 × 0.04 cm released at 30°, effects switched on one by one.
pub fn effects(context: &Context, seed: u64) -> Result<Value, Error> {
    let (hydro, mass) = thin_ellipsoid([0.02, 0.01, 0.0002], 800.0)?;
    let numbers = DimensionlessNumbers::of(&hydro, &mass, &Fluid::AIR, 9.81)?;
    let body = ImmersedBody::new(hydro);
    let release = |body: ImmersedBody, fluid: Fluid| {
        let mut experiment = Experiment::new(body, mass, fluid);
        experiment.release.tilt = 30f64.to_radians();
        experiment.release.tilt_axis = 85f64.to_radians();
        experiment.seconds = 1.2;
        experiment
    };
    let inviscid = body.clone().with_law(ViscousLaw::Inviscid)?;
    let vacuum = release(inviscid.clone(), Fluid::new(1e-6, 1.0)?);
    // The boundary elements that the thesis compares with are close to 90 % off at 0.03 cm (Fig. 5.2).
    let mut coarse = inviscid.clone();
    let a = &mut coarse.hydro.added_mass;
    (a.linear, a.coupling, a.angular) = (a.linear * 0.1, a.coupling * 0.1, a.angular * 0.1);
    let constant = body
        .clone()
        .with_law(ViscousLaw::Stochastic(StochasticLaw::default()))?;
    let cases = [
        ("(a) no fluid", vacuum),
        ("(b) a tenth of the added mass", release(coarse, Fluid::AIR)),
        ("(c) added mass", release(inviscid, Fluid::AIR)),
        ("(d) constant drag and lift", release(constant, Fluid::AIR)),
        ("(e) default law", release(body.clone(), Fluid::AIR)),
    ];
    let mut falls = Vec::new();
    for (name, experiment) in &cases {
        falls.push((*name, experiment.run()?));
    }
    let gusty = in_turbulence(&cases[4].1, &numbers, seed)?;
    falls.push(("(f) (e) in turbulence of 30 %", gusty));
    let mut panels = Vec::new();
    let mut rows = Vec::new();
    for (name, fall) in &falls {
        let mut panel = Panel::new(*name, "x, cm", "y, cm");
        // Across the drift, which is along z for a body that turns about its long axis.
        let turned = turned_to_drift(fall);
        panel.items = side(&turned, 0.02, 6, BLUE);
        panels.push(panel);
        let end = fall.moments[fall.moments.len() - 1].position;
        let rise = fall
            .moments
            .windows(2)
            .map(|m| m[1].position.y - m[0].position.y);
        let (rise, _) = rise.fold((0.0f64, 0.0f64), |(most, now), step| {
            let now = (now + step).max(0.0);
            (most.max(now), now)
        });
        rows.push(json!({
            "case": name,
            "end_cm": [100.0 * end.x, 100.0 * end.y, 100.0 * end.z],
            "largest_rise_mm": 1e3 * rise,
        }));
    }
    let title = "Fig. 5.13: effects switched on one by one; card of 4 × 2 × 0.04 cm, 30°, 1.2 s (scales differ)";
    context.write("fig_5_13_effects.svg", title, &panels, 6, (250, 560));
    Ok(json!(rows))
}

/// The same fall with its principal horizontal direction along x.
fn turned_to_drift(fall: &Trajectory) -> Trajectory {
    let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
    for m in &fall.moments {
        let p = m.position;
        (xx, xz, zz) = (xx + p.x * p.x, xz + p.x * p.z, zz + p.z * p.z);
    }
    let angle = 0.5 * (2.0f64 * xz).atan2(xx - zz);
    let turn =
        rapier3d_immersed::rapier3d::na::Rotation3::from_axis_angle(&Vector3::y_axis(), angle);
    let mut turned = fall.clone();
    for m in &mut turned.moments {
        m.position = turn * m.position;
        m.normal = turn * m.normal;
        m.long_axis = turn * m.long_axis;
    }
    turned
}

/// The experiment in a fluid whose velocity fluctuates by 30 % of U0.
fn in_turbulence(
    experiment: &Experiment,
    numbers: &DimensionlessNumbers,
    seed: u64,
) -> Result<Trajectory, Error> {
    let state = TurbulenceState::from_intensity(numbers.u0 as f32, 0.3, numbers.length as f32)?;
    let c0 = kolmogorov_constant(state.taylor_reynolds_squared(numbers.kinematic_viscosity as f32));
    let noise = NoiseStream::new(seed, 0);
    let mut seen = SeenFluctuation::default();
    let mut body = experiment.released()?;
    let mut fall = Trajectory {
        interval: experiment.dt,
        moments: vec![Moment::of(&body)],
    };
    for step in 0..experiment.steps() {
        let speed = body.linear_velocity().norm() as f32;
        let random = noise.vector(step as u64, 0);
        let velocity = seen.advance(&state, c0, speed, experiment.dt as f32, random);
        let flow = FlowSample {
            velocity,
            ..FlowSample::default()
        };
        body.step_in(experiment.dt, experiment.gravity_vector(), &flow);
        fall.moments.push(Moment::of(&body));
    }
    Ok(fall)
}

/// A planner for a trained leaf.
pub fn planner(experiment: &Experiment, subspaces: &Subspaces) -> Result<Planner, Error> {
    let params = PlannerParams::default();
    Planner::new(
        experiment.clone(),
        subspaces.clone(),
        &MotionGraph::thesis(),
        params,
    )
}

/// The stretches of a plan's fall by pattern.
fn stretches(plan: &Plan) -> impl Iterator<Item = (Pattern, Trajectory)> + '_ {
    plan.series
        .dwell_times()
        .into_iter()
        .map(|(pattern, from, to)| {
            let interval = plan.fall.interval;
            let moments = plan.fall.between(from, to + interval).to_vec();
            (pattern, Trajectory { interval, moments })
        })
}

/// Figs. 5.14 and 5.15: a leaf that descends steadily, then autorotates, and its coefficients.
pub fn leaf(context: &Context, planner: &Planner, seed: u64) -> Result<(Value, Value), Error> {
    let sequence = [Pattern::SteadyDescent, Pattern::Autorotation];
    let plan = planner.plan_sequence(&sequence, seed)?;
    let mut path = Panel::new("the fall (scales differ)", "x, cm", "y, cm");
    let turned = Plan {
        fall: turned_to_drift(&plan.fall),
        ..plan.clone()
    };
    for (pattern, part) in stretches(&turned) {
        path.items.extend(side(&part, 0.042, 6, color(pattern)));
    }
    let mut controls = Panel::new("control parameters c̃", "time, s", "");
    let mut coefficients = serde_json::Map::new();
    let mut forces = Panel::new("coefficients C_d, C_l1, C_l2 (Fig. 5.15)", "time, s", "");
    let names = ["drag", "rotational lift", "translational lift"];
    let colors = [GREY, BLUE, RGBColor(220, 120, 20)];
    for k in 0..3 {
        let series = &plan.series;
        let mut steps = Vec::new();
        for (i, control) in series.controls().iter().enumerate() {
            let c = f64::from(<[f32; 3]>::from(*control)[k]);
            let t = i as f64 * series.interval();
            steps.extend([(t, c), (t + series.interval(), c)]);
        }
        let top = steps.iter().fold(0.0f64, |m, p| m.max(p.1));
        controls.items.push(Item::Line(steps, colors[k], 2));
        let at = (0.3 * series.duration(), 4.5 - 0.25 * k as f64);
        controls.items.push(Item::Label(
            at,
            format!("{} (≤ {top:.2})", names[k]),
            colors[k],
        ));
        // The shape of each coefficient over the angle of attack, thesis (5.17).
        let instant = plan.fall.moments.windows(2).enumerate().map(|(i, pair)| {
            let v = pair[1].position - pair[0].position;
            let sine = (v.dot(&pair[0].normal).abs() / v.norm().max(1e-12)).min(1.0);
            let alpha = sine.asin();
            let t = i as f64 * plan.fall.interval;
            let shape = [sine * sine, (2.0 * alpha).sin(), (2.0 * alpha).cos()][k];
            (t, f64::from(<[f32; 3]>::from(series.at(t))[k]) * shape)
        });
        let instant: Vec<Point> = instant.collect();
        let size = instant.len() as f64;
        let mean = instant.iter().map(|p| p.1).sum::<f64>() / size;
        let square = instant.iter().map(|p| (p.1 - mean).powi(2)).sum::<f64>() / size;
        let numbers = json!({ "mean": mean, "standard_deviation": square.sqrt() });
        coefficients.insert(names[k].replace(' ', "_"), numbers);
        forces.items.push(Item::Line(instant, colors[k], 1));
    }
    controls.window = Some([(0.0, plan.series.duration()), (0.0, 4.8)]);
    let title = "A leaf of 7.3 × 4.2 × 0.03 cm: steady descent (red), then autorotation (magenta), Figs. 5.14, 5.15";
    context.write(
        "fig_5_14_leaf.svg",
        title,
        &[path, controls, forces],
        3,
        (470, 560),
    );
    let observed: Vec<&str> = plan
        .dwells
        .iter()
        .map(|d| d.observed.abbreviation())
        .collect();
    let planned = json!({ "observed": observed, "seconds": plan.series.duration() });
    Ok((planned, Value::Object(coefficients)))
}

/// Fig. 5.16: leaves from a tree, equal starts, different styles.
pub fn tree(context: &Context, planner: &Planner, seed: u64, leaves: u64) -> Result<Value, Error> {
    let mut panel = Panel::bare("");
    let mut rows = Vec::new();
    let mut above = Panel::new("from above", "x, cm", "z, cm").equal();
    for leaf in 0..leaves {
        let plan = planner.plan(seed.wrapping_mul(1000).wrapping_add(leaf))?;
        for (pattern, part) in stretches(&plan) {
            panel.items.push(in_space(&part, color(pattern), 2));
            let points = centimeters(&part).map(|[x, _, z]| (x, z)).collect();
            above.items.push(Item::Line(points, color(pattern), 1));
        }
        let names = plan.series.sequence();
        let names: Vec<&str> = names.iter().map(|p| p.abbreviation()).collect();
        rows.push(json!({
            "sequence": names,
            "shown": plan.dwells.iter().all(|d| d.observed == d.planned),
        }));
    }
    let title = format!(
        "Fig. 5.16: {leaves} equal leaves, equal releases, styles drawn from the motion graph \
         (red SD, magenta AR, blue AZ, green ZZ)"
    );
    context.write("fig_5_16_tree.svg", &title, &[panel, above], 2, (640, 820));
    Ok(json!(rows))
}

/// A path of five points, drawn by a user, and how the leaf follows it in rapier.
pub fn sketches(context: &Context, experiment: &Experiment, seed: u64) -> Result<Value, Error> {
    let v = Vector3::new;
    let swing = [
        (0.0, v(0.0, 2.0, 0.0)),
        (0.5, v(0.15, 1.6, 0.0)),
        (1.0, v(0.0, 1.2, 0.0)),
        (1.5, v(0.15, 0.8, 0.0)),
        (2.0, v(0.0, 0.4, 0.0)),
    ];
    let glide = [
        (0.0, v(0.0, 2.0, 0.0)),
        (0.5, v(0.2, 1.6, 0.0)),
        (1.0, v(0.5, 1.2, 0.0)),
        (1.5, v(0.8, 0.8, 0.0)),
        (2.0, v(1.0, 0.4, 0.0)),
    ];
    let landing = Sketch::landing(
        experiment,
        v(0.0, 2.0, 0.0),
        &[v(0.35, 1.0, 0.0)],
        v(0.1, 0.0, 0.0),
    )?;
    let named = [
        ("a swing of five points", Sketch::new(swing.to_vec())?),
        ("a glide", Sketch::new(glide.to_vec())?),
        ("pass there, land here", landing),
    ];
    let extents = experiment.body.hydro.planform.half_extents.cast::<f32>();
    let density = experiment.mass.mass / experiment.body.hydro.volume;
    let ball = ColliderBuilder::ball(1e-4);
    let inertia = experiment.mass.inertia.diagonal().cast::<f32>();
    let collider = ball.mass_properties(MassProperties::new(
        Vector::ZERO,
        experiment.mass.mass as f32,
        Vector::new(inertia.x, inertia.y, inertia.z),
    ));
    let params = FollowParams {
        seed,
        ..FollowParams::default()
    };
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (name, sketch) in named {
        let found = sketch.follow(experiment, collider.clone(), &params)?;
        let title = format!(
            "{name}: {:.1} cm off on average",
            100.0 * found.mean_distance
        );
        let mut panel = Panel::new(title, "x, cm", "y, cm").equal();
        let count = (sketch.duration() / experiment.dt) as usize;
        let drawn = (0..=count).map(|i| sketch.at(i as f64 * experiment.dt));
        let flat = |p: Vector3<f64>| (100.0 * p.x, 100.0 * p.y);
        panel
            .items
            .push(Item::Dashed(drawn.map(flat).collect(), GREY));
        let path = found.path.iter().copied().map(flat).collect();
        panel.items.push(Item::Line(path, BLUE, 2));
        let points = sketch.points().iter().map(|(_, p)| flat(*p)).collect();
        panel
            .items
            .push(Item::Dots(points, RGBColor(211, 47, 47), 5));
        panels.push(panel);
        rows.push(json!({
            "name": name,
            "mean_cm": 100.0 * found.mean_distance,
            "largest_cm": 100.0 * found.largest_distance,
            "at_points_cm": found.at_points.iter().map(|d| 100.0 * d).collect::<Vec<_>>(),
        }));
        context.say(format!(
            "{name}: {:.1} cm off on average, {:.1} cm at most; the leaf is {:.1} cm long ({density:.0} kg/m³)",
            100.0 * found.mean_distance,
            100.0 * found.largest_distance,
            200.0 * extents.x
        ));
    }
    let title =
        "Sketched paths (dashed, through the red points) and the leaf that follows them in rapier";
    context.write("sketches.svg", title, &panels, 3, (430, 620));
    Ok(json!(rows))
}
