//! Training in pictures: thesis Figs. 5.7 to 5.10.

use crate::draw::{Item, Panel, color, cube, depth, isometric};
use crate::{Context, bar};
use rapier3d_immersed::Error;
use rapier3d_immersed::motion::{Classifier, DimensionlessNumbers, Pattern};
use rapier3d_immersed::training::{
    Axis, Clusters, Experiment, Features, Grid, Parameter, Sample, Subspaces, Sweep,
};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::time::Instant;

/// A sweep of the coefficients of a body, and its clusters.
pub struct Trained {
    pub name: String,
    pub limit: f64,
    pub sweep: Sweep,
    pub clusters: Clusters,
    /// Clusters by how the bodies turn.
    pub turning: Clusters,
    /// The same with the flips that the direct classifier counts.
    pub flips: Clusters,
    pub seconds: f64,
}

impl Trained {
    pub fn new(
        name: &str,
        experiment: &Experiment,
        count: usize,
        limit: f64,
        seed: u64,
    ) -> Result<Self, Error> {
        let start = Instant::now();
        let mut sweep = Sweep::new(Grid::of_coefficients(count, limit)?);
        run(&mut sweep, experiment)?;
        let seconds = start.elapsed().as_secs_f64();
        let samples: Vec<Sample> = sweep.samples().iter().flatten().copied().collect();
        let body = &experiment.body.hydro;
        let length =
            DimensionlessNumbers::of(body, &experiment.mass, &experiment.fluid, 9.81)?.length;
        let find = |features| Clusters::find_by(features, &samples, length, seed);
        let clusters = find(Features::Path)?;
        let (turning, flips) = (find(Features::Turning)?, find(Features::Flips)?);
        Ok(Self {
            name: name.into(),
            limit,
            sweep,
            clusters,
            turning,
            flips,
            seconds,
        })
    }

    pub fn samples(&self) -> impl Iterator<Item = &Sample> {
        self.sweep.samples().iter().flatten()
    }

    fn agreement(&self) -> f64 {
        self.clusters.agreement(self.samples())
    }

    /// (d, e) of every sample, coloured by either classifier.
    fn scatter(&self, direct: bool) -> Panel {
        let who = if direct { "direct" } else { "k-means" };
        let mut panel = Panel::new(format!("{}: {who}", self.name), "log₁₀ d, cm", "e");
        for pattern in Pattern::ALL {
            let points = self.samples().filter(|s| self.label(s, direct) == pattern);
            let points = points.map(|s| ((100.0 * s.distance).max(0.05).log10(), s.eccentricity));
            panel
                .items
                .push(Item::Dots(points.collect(), color(pattern), 2));
        }
        panel.window = Some([(-1.3, 4.0), (0.0, 1.05)]);
        panel
    }

    fn label(&self, sample: &Sample, direct: bool) -> Pattern {
        if direct {
            sample.pattern()
        } else {
            self.clusters.label(sample)
        }
    }

    /// The parameter space as a cloud of dots, far ones first.
    fn cloud(&self, direct: bool) -> Panel {
        let who = if direct { "direct" } else { "k-means" };
        let title = format!("{}, {} samples: {who}", self.name, self.sweep.grid().len());
        let mut panel = Panel::bare(title);
        panel.items = cube(self.limit, ["C_D", "C_L1", "C_L2"]);
        let grid = self.sweep.grid();
        let mut dots: Vec<([f64; 3], Pattern)> = self
            .samples()
            .enumerate()
            .map(|(node, sample)| {
                let p = grid.point(node);
                ([p[0], p[1], p[2]], self.label(sample, direct))
            })
            .collect();
        dots.sort_by(|a, b| depth(b.0).total_cmp(&depth(a.0)));
        for (at, pattern) in dots {
            panel
                .items
                .push(Item::Dots(vec![isometric(at)], color(pattern), 3));
        }
        panel
    }

    /// How many falls show each pattern, in the order of [`Pattern::ALL`].
    fn count(&self, direct: bool) -> [usize; 4] {
        Pattern::ALL.map(|pattern| {
            let shown = self.samples().filter(|s| self.label(s, direct) == pattern);
            shown.count()
        })
    }

    /// Fig. 5.8 in numbers.
    pub fn counts(&self) -> Value {
        json!({
            "name": self.name,
            "order": Pattern::ALL.map(Pattern::abbreviation),
            "direct": self.count(true),
            "k_means": self.count(false),
        })
    }

    pub fn json(&self) -> Value {
        json!({
            "name": self.name,
            "samples": self.sweep.grid().len(),
            "seconds": self.seconds,
            "direct": self.count(true),
            "clusters": self.count(false),
            "agreement": self.agreement(),
            "kappa": {
                "path": self.clusters.kappa(self.samples()),
                "turning": self.turning.kappa(self.samples()),
                "flips": self.flips.kappa(self.samples()),
            },
            "confusion": self.clusters.confusion(self.samples()),
            "steady_regions": regions(&self.sweep, |s| s.pattern()),
            "steady_regions_clusters": regions(&self.sweep, |s| self.clusters.label(s)),
        })
    }
}

/// Sizes of the regions of steady descent that hold more than one per cent of the nodes.
fn regions(sweep: &Sweep, label: impl Fn(&Sample) -> Pattern) -> Vec<usize> {
    let labels = sweep.samples().iter().flatten().map(label).collect();
    let Ok(subspaces) = Subspaces::new(sweep.grid().clone(), labels) else {
        return Vec::new();
    };
    let sizes = subspaces.regions(Pattern::SteadyDescent).into_iter();
    let sizes = sizes.map(|region| region.len());
    sizes
        .filter(|size| size * 100 > sweep.grid().len())
        .collect()
}

pub fn run(sweep: &mut Sweep, experiment: &Experiment) -> Result<(), Error> {
    let progress = bar(sweep.remaining() as u64, "falls");
    sweep.run_coefficients(experiment, &Classifier::default(), |done, _| {
        progress.set_position(done as u64);
        ControlFlow::Continue(())
    })?;
    progress.finish_and_clear();
    Ok(())
}

/// Figs. 5.7 and 5.8: four bodies and laws, and how the two classifiers see them.
pub fn clusters(context: &Context, trained: &[Trained]) -> Value {
    let mut panels = Vec::new();
    for direct in [false, true] {
        panels.extend(trained.iter().map(|t| t.scatter(direct)));
    }
    let title = "Distance and eccentricity of every fall (Fig. 5.7); red SD, magenta AR, blue AZ, \
                 green ZZ";
    context.write(
        "fig_5_7_clusters.svg",
        title,
        &panels,
        trained.len(),
        (400, 330),
    );
    let mut panels = Vec::new();
    for direct in [false, true] {
        panels.extend(trained.iter().map(|t| t.cloud(direct)));
    }
    let title =
        "Patterns over the control parameters (Fig. 5.8); red SD, magenta AR, blue AZ, green ZZ";
    context.write(
        "fig_5_8_samples.svg",
        title,
        &panels,
        trained.len(),
        (400, 400),
    );
    let list: Vec<Value> = trained.iter().map(Trained::json).collect();
    for t in trained {
        context.say(format!(
            "{}: {} falls in {:.2} s; k-means of (d, e) and the direct classifier agree on {:.0} %, κ {:.2}; \
             by how they turn κ {:.2}, with flips {:.2}",
            t.name,
            t.sweep.grid().len(),
            t.seconds,
            100.0 * t.agreement(),
            t.clusters.kappa(t.samples()),
            t.turning.kappa(t.samples()),
            t.flips.kappa(t.samples()),
        ));
    }
    json!(list)
}

/// Fig. 5.9: from low to high resolution, in the plane of drag and rotational lift (C_L2 = 1).
pub fn sampling(context: &Context, experiment: &Experiment) -> Result<Value, Error> {
    let black = plotters::style::RGBColor(20, 20, 20);
    let axis = Axis {
        low: 0.02 * PI,
        high: PI,
        count: 9,
    };
    let parameters = [Parameter::Control(0), Parameter::Control(1)];
    let mut sweep = Sweep::new(Grid::new(vec![axis; 2])?);
    let run = |sweep: &mut Sweep| {
        let go_on = |_, _| ControlFlow::Continue(());
        sweep.run_parameters(experiment, &parameters, &Classifier::default(), go_on)
    };
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for level in 0..4 {
        let before = sweep.clone();
        if level > 0 {
            sweep = sweep.refined(Sample::pattern)?;
        }
        let missing: Vec<usize> = (0..sweep.grid().len())
            .filter(|node| level > 0 && sweep.samples()[*node].is_none())
            .collect();
        let falls = sweep.remaining();
        run(&mut sweep)?;
        let count = sweep.grid().len();
        let title = format!("{count} nodes, {falls} of them simulated now");
        let mut panel = Panel::new(title, "C_D", "C_L1").equal();
        let half = 0.5 * sweep.grid().axes()[0].spacing();
        for pattern in Pattern::ALL {
            let nodes = (0..count).filter(|node| {
                sweep.samples()[*node].is_some_and(|sample| sample.pattern() == pattern)
            });
            let boxes = nodes.map(|node| {
                let p = sweep.grid().point(node);
                ((p[0] - half, p[1] - half), (p[0] + half, p[1] + half))
            });
            panel
                .items
                .push(Item::Boxes(boxes.collect(), color(pattern)));
        }
        let dots = missing.iter().map(|node| {
            let p = sweep.grid().point(*node);
            (p[0], p[1])
        });
        let size = if level < 2 { 3 } else { 1 };
        panel.items.push(Item::Dots(dots.collect(), black, size));
        panels.push(panel);
        let known = before.grid().len();
        rows.push(json!({ "nodes": count, "simulated": falls, "nodes_before": known }));
    }
    let title = "Fig. 5.9: only nodes between disagreeing neighbours (black) are simulated anew; \
                 red SD, magenta AR, blue AZ, green ZZ";
    context.write("fig_5_9_sampling.svg", title, &panels, 4, (360, 390));
    Ok(json!(rows))
}

/// Fig. 5.10: the subspaces after refinement, as slices.
pub fn subspaces(
    context: &Context,
    experiment: &Experiment,
    trained: &Trained,
    direct: bool,
    file: &str,
) -> Result<(Subspaces, Value), Error> {
    let start = Instant::now();
    let label = |sample: &Sample| trained.label(sample, direct);
    let mut fine = trained.sweep.refined(label)?;
    run(&mut fine, experiment)?;
    let seconds = start.elapsed().as_secs_f64();
    let labels = fine.samples().iter().flatten().map(label).collect();
    let subspaces = Subspaces::new(fine.grid().clone(), labels)?;
    let axis = fine.grid().axes()[0];
    let half = 0.5 * axis.spacing();
    let mut panels = Vec::new();
    for slice in (0..axis.count).step_by(2) {
        let title = format!("C_D = {:.2}", axis.value(slice));
        let mut panel = Panel::new(title, "C_L1", "C_L2").equal();
        for pattern in Pattern::ALL {
            let nodes = subspaces.nodes(pattern).into_iter();
            let inside = nodes.filter(|node| fine.grid().indices(*node)[0] == slice);
            let boxes = inside.map(|node| {
                let p = fine.grid().point(node);
                ((p[1] - half, p[2] - half), (p[1] + half, p[2] + half))
            });
            panel
                .items
                .push(Item::Boxes(boxes.collect(), color(pattern)));
        }
        panel.window = Some([(0.0, axis.high + half); 2]);
        panels.push(panel);
    }
    let who = if direct { "direct" } else { "k-means" };
    let simulated = fine.simulated() - trained.sweep.simulated();
    let title = format!(
        "Subspaces (Fig. 5.10), {}, {who}: {} nodes, {simulated} new falls; red SD, magenta AR, blue AZ, green ZZ",
        trained.name,
        fine.grid().len()
    );
    context.write(file, &title, &panels, 3, (350, 350));
    let fractions = subspaces.volume_fractions();
    let steady = regions(&fine, label);
    context.say(format!(
        "{}, {who}: refined to {} nodes with {simulated} new falls in {seconds:.2} s; shares SD {:.2}, AR {:.2}, \
         AZ {:.2}, ZZ {:.2}; large regions of SD: {steady:?} nodes",
        trained.name,
        fine.grid().len(),
        fractions[0],
        fractions[1],
        fractions[2],
        fractions[3],
    ));
    let value = json!({
        "name": trained.name,
        "labels": who,
        "nodes": fine.grid().len(),
        "new_falls": simulated,
        "seconds": seconds,
        "fractions": fractions,
        "steady_regions": steady,
    });
    Ok((subspaces, value))
}

/// How many labels the time step changes against a fine one, and how many a milliradian at the release;
/// in all, and among nodes whose neighbours agree.
pub fn step_error(experiment: &Experiment) -> Result<Value, Error> {
    let labels = |experiment: &Experiment| -> Result<Subspaces, Error> {
        let mut sweep = Sweep::new(Grid::of_coefficients(9, PI)?);
        run(&mut sweep, experiment)?;
        let patterns = sweep.patterns()?;
        Subspaces::new(sweep.grid().clone(), patterns)
    };
    let chosen = experiment.clone().for_training();
    let finest = Experiment {
        dt: 1.0 / 1920.0,
        ..chosen.clone()
    };
    let mut shaken = finest.clone();
    shaken.release.tilt += 1e-3;
    let reference = labels(&finest)?;
    let nodes = 0..reference.labels().len();
    let agreed = |node: &usize| {
        let neighbours = reference.grid().neighbours(*node);
        let same = |n: &usize| reference.labels()[*n] == reference.labels()[*node];
        neighbours.iter().all(same)
    };
    let inner: Vec<usize> = nodes.clone().filter(agreed).collect();
    let mut rows = Vec::new();
    for (name, other) in [
        ("1/240 s, as trained", chosen),
        ("1/120 s, as planned", experiment.clone()),
        ("a milliradian at the release", shaken),
    ] {
        let other = labels(&other)?;
        let changed = |node: &usize| other.labels()[*node] != reference.labels()[*node];
        rows.push(json!({
            "what": name,
            "changed": nodes.clone().filter(changed).count(),
            "of": nodes.len(),
            "inner_changed": inner.iter().filter(|node| changed(node)).count(),
            "inner": inner.len(),
        }));
    }
    Ok(json!(rows))
}
