//! Measured falls of paper (`tests/data/paper`), and this crate's paper seen as the cameras saw it.

use rapier3d_immersed::geometry::Surface;
use rapier3d_immersed::rapier3d::na::{Unit, UnitQuaternion, Vector3};
use rapier3d_immersed::rapier3d::parry::math::Vector;
use rapier3d_immersed::rapier3d::parry::shape::SharedShape;
use rapier3d_immersed::{
    DryMass, Error, Fluid, FreeBody, HydroProperties, ImmersedBody, Integrator, ViscousLaw,
};

/// Frames a second, and how many of them the published tracks are averaged over.
pub const RATE: f64 = 98.0;
const AVERAGED: usize = 5;
/// 70 g/m² and 69.4 µm, in the air of the published analysis.
const GRAMMAGE: f64 = 0.070;
const THICKNESS: f64 = 69.4e-6;
const AIR: (f32, f32) = (1.2754, 1.48e-5);
/// Steps of the integrator in a frame: 1.7 ms, which is fixed so that results depend smoothly on parameters.
const STEPS: u32 = 6;
/// Standard deviation of a position, m: less is left of the tracks beside smooth curves, but their errors go
/// together over the five frames of their average, and the center of what a camera sees is not quite the
/// paper's.
pub const DEVIATION: f64 = 0.002;
/// Standard deviation of a visible area, as a share of the largest: blobs are blurred, and up to twice as
/// large as the paper's picture, so that their scale is fitted and their shape is not taken at its word.
const AREA_DEVIATION: f64 = 0.2;
/// m/s², z is up.
const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.81);
/// The cameras, m: beside the point below the flat release, and above the floor. They follow from the
/// calibration in the public repository. Those of the edge-down release are taken as the same.
pub const CAMERAS: [Vector3<f64>; 2] = [
    Vector3::new(-1.038, -0.668, 1.812),
    Vector3::new(-1.058, 0.355, 1.806),
];

/// A measured fall, from the first frame in which the whole paper is seen.
#[derive(Clone, Debug)]
pub struct Fall {
    /// File name without its ending.
    pub name: &'static str,
    pub hexagon: bool,
    /// Radius of a circle, apothem of a hexagon, m.
    pub radius: f64,
    /// Released edge down; otherwise flat.
    pub edge_down: bool,
    /// s from the first frame of the published track.
    pub times: Vec<f64>,
    /// m; z is up from the floor.
    pub positions: Vec<Vector3<f64>>,
    /// What each camera saw of the paper, pixels.
    pub areas: [Vec<f64>; 2],
}

macro_rules! falls {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../tests/data/paper/", $name, ".csv")))),*]
    };
}

/// Two repeats (a, b) of each experiment.
const FILES: [(&str, &str); 12] = falls![
    "circle_16mm_edge_a",
    "circle_16mm_edge_b",
    "circle_24mm_edge_a",
    "circle_24mm_edge_b",
    "circle_44mm_edge_a",
    "circle_44mm_edge_b",
    "circle_18mm_flat_a",
    "circle_18mm_flat_b",
    "hexagon_18mm_edge_a",
    "hexagon_18mm_edge_b",
    "hexagon_42mm_edge_a",
    "hexagon_42mm_edge_b",
];

impl Fall {
    /// All that the repository of this crate has; repeats follow each other.
    ///
    /// # Errors
    /// What cannot be read.
    pub fn all() -> Result<Vec<Self>, String> {
        let falls = FILES.iter().map(|(name, text)| Self::read(name, text));
        falls.collect()
    }

    fn read(name: &'static str, text: &str) -> Result<Self, String> {
        const HEADER: &str = "t_s,x_m,y_m,z_m,area1_px,area2_px";
        let parts: Vec<&str> = name.split('_').collect();
        let radius = parts[1].trim_end_matches("mm").parse::<f64>();
        let mut fall = Self {
            name,
            hexagon: parts[0] == "hexagon",
            radius: 1e-3 * radius.map_err(|e| format!("{name}: {e}"))?,
            edge_down: parts[2] == "edge",
            times: Vec::new(),
            positions: Vec::new(),
            areas: Default::default(),
        };
        let mut lines = text.lines();
        if lines.next() != Some(HEADER) {
            return Err(format!("{name}: the header is not {HEADER}"));
        }
        for line in lines {
            let row: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
            match row.as_deref() {
                Ok([t, x, y, z, one, two]) => {
                    fall.times.push(*t);
                    fall.positions.push(Vector3::new(*x, *y, *z));
                    fall.areas[0].push(*one);
                    fall.areas[1].push(*two);
                }
                _ => return Err(format!("{name}: {line}: not six numbers")),
            }
        }
        Ok(fall)
    }

    pub fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    /// What is known of the first so many frames, one after the other, and its standard deviations.
    pub fn data(&self, frames: usize) -> (Vec<f64>, Vec<f64>) {
        let areas = self.areas.each_ref().map(|a| &a[..frames]);
        let largest = areas.map(|a| a.iter().copied().fold(1.0, f64::max));
        let rows = (0..frames).map(|i| {
            let p = self.positions[i];
            [
                p.x,
                p.y,
                p.z,
                areas[0][i] / largest[0],
                areas[1][i] / largest[1],
            ]
        });
        let row = [
            DEVIATION,
            DEVIATION,
            DEVIATION,
            AREA_DEVIATION,
            AREA_DEVIATION,
        ];
        (rows.flatten().collect(), row.repeat(frames))
    }
}

/// Time from the first frame until `other` is more than `limit` from `one`; `None` if that does not happen.
pub fn divergence(one: &[Vector3<f64>], other: &[Vector3<f64>], limit: f64) -> Option<f64> {
    let mut pairs = one.iter().zip(other);
    let frame = pairs.position(|(a, b)| (a - b).norm() > limit)?;
    Some(frame as f64 / RATE)
}

/// A motion state at the first frame less half of what is averaged: turns of the paper from its release
/// about two horizontal or vertical axes in its plane, rad; velocity, m/s; spins about the same axes, rad/s;
/// position, m. (It cannot be seen how a disc turns about its normal: it is taken not to.)
pub const STATE: [&str; 10] = [
    "turn 1", "turn 2", "u", "v", "w", "spin 1", "spin 2", "x", "y", "z",
];

/// The paper of a fall.
pub struct Paper {
    hydro: HydroProperties,
    mass: DryMass,
    fluid: Fluid,
    /// Normal at the release, and the axes of turns.
    normal: Unit<Vector3<f64>>,
    axes: [Vector3<f64>; 2],
}

/// What is seen of a paper that falls, frame by frame.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// m, averaged as the published tracks are.
    pub positions: Vec<Vector3<f64>>,
    /// Not averaged.
    pub normals: Vec<Vector3<f64>>,
    /// Solid angles of the paper in the view of each camera over that of a face-on one at 1 m, averaged.
    pub views: [Vec<f64>; 2],
}

impl Paper {
    /// # Errors
    /// [`Error::InvalidParameter`] for a size that cannot be.
    pub fn new(fall: &Fall) -> Result<Self, Error> {
        let (hydro, mass) = if fall.hexagon {
            // A prism as high as wide, made thin afterwards: a hull in f32 cannot be as thin as this.
            let corner = |k: u8| {
                let angle = f32::from(k % 6) * std::f32::consts::FRAC_PI_3;
                let out = 2.0 / 3f32.sqrt();
                let y = if k < 6 { -1.0 } else { 1.0 };
                Vector::new(out * angle.cos(), y, out * angle.sin())
            };
            let corners: Vec<Vector> = (0..12).map(corner).collect();
            let prism = SharedShape::convex_hull(&corners).expect("twelve corners of a prism");
            let size = Vector3::new(fall.radius, 0.5 * THICKNESS, fall.radius);
            let surface = Surface::from_shape(prism.as_ref())?.map(|v| v.component_mul(&size));
            let area = 2.0 * 3f64.sqrt() * fall.radius * fall.radius;
            (
                HydroProperties::from_surface(&surface, Vector3::zeros()),
                DryMass::uniform(&surface, GRAMMAGE * area)?,
            )
        } else {
            let disc = SharedShape::cylinder(0.5 * THICKNESS as f32, fall.radius as f32);
            (
                HydroProperties::from_shape(disc.as_ref())?,
                DryMass::of_shape(disc.as_ref(), GRAMMAGE / THICKNESS)?,
            )
        };
        let (normal, axes) = if fall.edge_down {
            (Vector3::x_axis(), [Vector3::y(), Vector3::z()])
        } else {
            (Vector3::z_axis(), [Vector3::x(), Vector3::y()])
        };
        Ok(Self {
            hydro,
            mass,
            fluid: Fluid::new(AIR.0, AIR.1)?,
            normal,
            axes,
        })
    }

    /// Where to look for the [`STATE`], given the track.
    pub fn ranges(&self, fall: &Fall) -> Vec<(f64, f64)> {
        let first = fall.positions[0];
        let velocity = (fall.positions[3] - first) * (RATE / 3.0);
        let before = first - velocity * ((AVERAGED / 2) as f64 / RATE);
        let (turn, spin) = if fall.edge_down {
            ([1.6, 1.0], [40.0, 20.0])
        } else {
            ([0.6; 2], [15.0; 2])
        };
        let mut ranges: Vec<(f64, f64)> = turn.map(|t| (-t, t)).into();
        ranges.extend(velocity.iter().map(|v| (v - 1.0, v + 1.0)));
        ranges.extend(spin.map(|s| (-s, s)));
        ranges.extend(before.iter().map(|x| (x - 0.03, x + 0.03)));
        ranges
    }

    /// So many frames of a fall from this [`STATE`].
    ///
    /// # Errors
    /// Those of the law's coefficients.
    pub fn fall(&self, law: ViscousLaw, state: &[f64], frames: usize) -> Result<Seen, Error> {
        let body = ImmersedBody::new(self.hydro.clone()).with_law(law)?;
        let mut body = FreeBody::new(&body, &self.mass, &self.fluid)?;
        body.integrator = Integrator {
            iterations: 2,
            ..Integrator::default()
        };
        let three = |k: usize| Vector3::from_column_slice(&state[k..k + 3]);
        let along = |k: usize| self.axes[0] * state[k] + self.axes[1] * state[k + 1];
        let flat = UnitQuaternion::rotation_between(&Vector3::y(), &self.normal);
        let turn = UnitQuaternion::from_scaled_axis(along(0));
        body.set_orientation(turn * flat.unwrap_or_default());
        body.set_velocity(three(2), along(5));
        body.position = three(7);
        let mut sharp = Seen::default();
        for frame in 0..frames + AVERAGED - 1 {
            if frame > 0 {
                for _ in 0..STEPS {
                    body.step(1.0 / (RATE * f64::from(STEPS)), GRAVITY);
                }
            }
            sharp.positions.push(body.position);
            sharp.normals.push(body.normal());
            for (views, camera) in sharp.views.iter_mut().zip(CAMERAS) {
                let sight = body.position - camera;
                views.push(body.normal().dot(&sight).abs() / sight.norm().powi(3));
            }
        }
        let share = 1.0 / AVERAGED as f64;
        let averaged = sharp.positions.windows(AVERAGED);
        Ok(Seen {
            positions: averaged
                .map(|w| w.iter().sum::<Vector3<f64>>() * share)
                .collect(),
            normals: sharp.normals[AVERAGED / 2..][..frames].to_vec(),
            views: sharp.views.map(|views| {
                let averaged = views.windows(AVERAGED);
                averaged.map(|w| w.iter().sum::<f64>() * share).collect()
            }),
        })
    }
}
