//! Added mass against closed forms and tables: the proxy ellipsoid's and, with the feature `bake`, the
//! boundary elements'.

use super::draw::{self, Item, Panel};
use super::report::Row;
use super::{Computed, Effort, Failure, Progress};
use plotters::style::RGBColor;
use rapier3d_immersed::AddedMass;
use rapier3d_immersed::geometry::Ellipsoid;
use rapier3d_immersed::rapier3d::na::Vector3;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::training::thin_ellipsoid;
use rapier3d_immersed::{Error, HydroProperties};
use std::f64::consts::PI;

/// Ellipsoids a : b : c with added over displaced mass along the axes, and added over displaced moment of
/// inertia about them (Lamb, *Hydrodynamics*, §§ 114–115, evaluated with Carlson's integrals).
const ELLIPSOIDS: [([f64; 3], [f64; 3], [f64; 3]); 6] = [
    ([1.0, 1.0, 1.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]),
    (
        [2.0, 1.0, 1.0],
        [0.21002, 0.70421, 0.70421],
        [0.0, 0.23942, 0.23942],
    ),
    (
        [10.0, 1.0, 1.0],
        [0.02071, 0.96023, 0.96023],
        [0.0, 0.88354, 0.88354],
    ),
    (
        [1.0, 1.0, 0.5],
        [0.30959, 0.30959, 1.11506],
        [0.33858, 0.33858, 0.0],
    ),
    (
        [1.0, 1.0, 0.1],
        [0.07480, 0.07480, 6.18413],
        [4.02230, 4.02230, 0.0],
    ),
    (
        [3.0, 2.0, 1.0],
        [0.18526, 0.36454, 1.36153],
        [0.38327, 0.70824, 0.05990],
    ),
];

/// Thin rectangles: b/a, then m/(π/4 ρa²b), rotation about the long side over π/128 ρa⁴b and about the
/// short side over π/48 ρa²b³ (hypersingular collocation, extrapolated; the translation agrees with
/// DNV-RP-C205).
const RECTANGLES: [(f64, [f64; 3]); 6] = [
    (1.0, [0.57901, 0.8176, 0.3066]),
    (1.5, [0.68980, 0.8774, 0.4127]),
    (2.0, [0.75688, 0.9079, 0.4947]),
    (4.0, [0.87191, 0.954, 0.6835]),
    (5.0, [0.89668, 0.963, 0.7348]),
    (10.0, [0.94758, 0.982, 0.8545]),
];

/// The largest relative errors of the diagonal, translation and rotation, where the exact value is not 0.
fn errors(found: &AddedMass, exact: &[f64; 6]) -> [f64; 2] {
    let all = [found.linear.diagonal(), found.angular.diagonal()];
    [0, 1].map(|block| {
        (0..3)
            .filter(|i| exact[3 * block + i] > 0.0)
            .map(|i| (all[block][i] / exact[3 * block + i] - 1.0).abs())
            .fold(0.0, f64::max)
    })
}

/// Rows for the closed form and for what a user's shape gives.
fn push(rows: &mut Vec<Row>, case: &str, found: [f64; 2], bar: Option<f64>, source: &str) {
    for (what, error) in ["translation", "rotation"].into_iter().zip(found) {
        let case = format!("{case}, {what}");
        rows.push(Row::at_most(case, error, bar, source));
    }
}

pub fn compute(effort: Effort, progress: Progress) -> Result<Computed, Failure> {
    let mut rows = Vec::new();
    for (axes, linear, angular) in ELLIPSOIDS {
        let semi_axes = Vector3::from(axes);
        let volume = 4.0 / 3.0 * PI * semi_axes.product();
        let squares = semi_axes.component_mul(&semi_axes);
        let inertia = Vector3::repeat(squares.sum()) - squares;
        let exact: [f64; 6] = std::array::from_fn(|i| match i {
            0..3 => linear[i] * volume,
            _ => angular[i - 3] * volume * inertia[i - 3] / 5.0,
        });
        let [a, b, c] = axes;
        let name = format!("ellipsoid {a} : {b} : {c}");
        let formula = errors(&Ellipsoid { semi_axes }.added_mass(), &exact);
        // Half a unit of the last decimal of the smallest entry, .02071, is 2.4e-4 of it.
        let table = "Lamb §§ 114–115, evaluated to five decimals";
        push(
            &mut rows,
            &format!("{name}, formula"),
            formula,
            Some(3e-4),
            table,
        );
        let (hydro, _) = thin_ellipsoid(axes, 1.0)?;
        let mesh = errors(&hydro.added_mass, &exact);
        let source = "Lamb §§ 114–115; the triangles lie inside the ellipsoid";
        push(
            &mut rows,
            &format!("{name}, proxy of its mesh"),
            mesh,
            Some(0.02),
            source,
        );
    }
    let disc = Ellipsoid {
        semi_axes: Vector3::new(1.0, 1.0, 1e-6),
    }
    .added_mass();
    let thin = [
        disc.linear[(2, 2)] / (8.0 / 3.0),
        disc.angular[(0, 0)] / (16.0 / 45.0),
    ];
    let thin = thin.map(|ratio| (ratio - 1.0).abs());
    push(
        &mut rows,
        "thin disc, formula",
        thin,
        Some(1e-4),
        "8/3 ρa³, 16/45 ρa⁵",
    );
    let elliptic = Ellipsoid {
        semi_axes: Vector3::new(2.0, 1.0, 1e-6),
    }
    .added_mass();
    for (what, found, exact) in [
        ("translation", elliptic.linear[(2, 2)], 6.91758),
        (
            "rotation about the long axis",
            elliptic.angular[(0, 0)],
            0.79523,
        ),
        (
            "rotation about the short axis",
            elliptic.angular[(1, 1)],
            4.39131,
        ),
    ] {
        let case = format!("thin elliptic disc 2 : 1, formula, {what}");
        let source = "(4/3)πρab²/E(e), and Lamb's limits";
        rows.push(Row::number(case, [exact, found], "ρbⁿ", Some(1e-4), source));
    }
    progress(0.1);
    plates(&mut rows, effort, progress)?;
    let pictures = vec![("added_mass.svg".into(), picture()?)];
    Ok((rows, pictures))
}

/// Exact normal added mass and the two rotations (about x, the long side, and about y) of a rectangle a × b
/// in the x–y plane, b along x.
fn rectangle(ratio: f64, [m, long, short]: [f64; 3]) -> [f64; 3] {
    [
        m * PI / 4.0 * ratio,
        long * PI / 128.0 * ratio,
        short * PI / 48.0 * ratio.powi(3),
    ]
}

/// The proxy of a real thin box of a × b × a/100, relative to the exact rectangle without thickness.
fn proxy_error(ratio: f64, exact: [f64; 3]) -> Result<[f64; 3], Error> {
    let shape = SharedShape::cuboid(0.5 * ratio as f32, 0.5, 0.005);
    let found = HydroProperties::from_shape(shape.as_ref())?.added_mass;
    Ok(relative(&found, exact))
}

fn relative(found: &AddedMass, exact: [f64; 3]) -> [f64; 3] {
    let found = [
        found.linear[(2, 2)],
        found.angular[(0, 0)],
        found.angular[(1, 1)],
    ];
    std::array::from_fn(|i| found[i] / exact[i] - 1.0)
}

const PLATE_MOTIONS: [&str; 3] = [
    "broadside",
    "rotation about the long side",
    "rotation about the short side",
];

fn plates(rows: &mut Vec<Row>, effort: Effort, progress: Progress) -> Result<(), Failure> {
    let cases = &RECTANGLES[..effort.choose(RECTANGLES.len(), 2)];
    for (i, (ratio, table)) in cases.iter().enumerate() {
        let exact = rectangle(*ratio, *table);
        let source = "thin rectangle, hypersingular collocation; the proxy has no bar";
        let proxy = proxy_error(*ratio, exact)?;
        for (what, error) in PLATE_MOTIONS.into_iter().zip(proxy) {
            let case = format!("plate 1 × {ratio}, proxy, {what}");
            rows.push(Row::at_most(case, error, None, source));
        }
        #[cfg(feature = "bake")]
        {
            use rapier3d_immersed::geometry::Sheet;
            let sheet = Sheet::rectangle(*ratio, 1.0, 1e-6, 8)?;
            let (found, _) = AddedMass::solve_sheet(&sheet, &Default::default())?;
            for (what, error) in PLATE_MOTIONS.into_iter().zip(relative(&found, exact)) {
                let case = format!("plate 1 × {ratio}, boundary elements, {what}");
                let source = "thin rectangle, hypersingular collocation";
                rows.push(Row::at_most(case, error.abs(), Some(0.01), source));
            }
        }
        progress(0.1 + 0.9 * (i + 1) as f64 / cases.len() as f64);
    }
    let cube = SharedShape::cuboid(0.5, 0.5, 0.5);
    let proxy = HydroProperties::from_shape(cube.as_ref())?.added_mass;
    let source = "cube: .638 ρa³ (source boundary elements, polarisability); the proxy has no bar";
    rows.push(Row::number(
        "cube, proxy",
        [0.638, proxy.linear[(0, 0)]],
        "ρa³",
        None,
        source,
    ));
    #[cfg(feature = "bake")]
    {
        let (found, _) = AddedMass::of_shape(cube.as_ref(), Default::default(), 0.005)?;
        let pair = [0.638, found.linear[(0, 0)]];
        let case = "cube, boundary elements";
        rows.push(Row::number(
            case,
            pair,
            "ρa³",
            Some(0.01),
            "polarisability of the cube",
        ));
    }
    Ok(())
}

/// Where the proxy is good enough: its error over the slenderness of a plate.
fn picture() -> Result<String, Failure> {
    const COLORS: [RGBColor; 3] = [
        RGBColor(30, 90, 200),
        RGBColor(211, 47, 47),
        RGBColor(220, 140, 20),
    ];
    let mut panel = Panel::new("", "long side over short side", "proxy over exact − 1, %");
    panel.window = Some([(0.8, 10.5), (-30.0, 30.0)]);
    panel.items.push(Item::Line(
        vec![(0.8, 0.0), (10.5, 0.0)],
        RGBColor(120, 120, 120),
        1,
    ));
    for (i, (name, color)) in PLATE_MOTIONS.into_iter().zip(COLORS).enumerate() {
        let mut points = Vec::new();
        for (ratio, table) in RECTANGLES {
            let error = proxy_error(ratio, rectangle(ratio, table))?;
            points.push((ratio, 100.0 * error[i]));
        }
        panel.items.push(Item::Line(points.clone(), color, 2));
        panel.items.push(Item::Dots(points, color, 4));
        let label = Item::Label((7.5, 27.0 - 3.5 * i as f64), name.into(), color);
        panel.items.push(label);
    }
    let title = "Added mass of thin rectangles: the proxy ellipsoid against the exact plate";
    draw::svg(title, &[panel], 1, (720, 480))
}
