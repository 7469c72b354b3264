//! What bodies are immersed in: one fluid, or several in layers with a free surface below the uppermost.

use crate::error::Error;
use crate::flow::{Flow, FlowSample};
use crate::fluid::Fluid;
use crate::free_surface::{Elevation, FreeSurface, Level};
use crate::turbulence::TurbulentLayer;
use rapier3d::math::{Real, Vector};
use rapier3d::na::{Rotation3, Unit, Vector3};
use std::sync::Arc;

/// One fluid of a [`Medium`], with its motion.
///
/// ```
/// use rapier3d_immersed::flow::Uniform;
/// use rapier3d_immersed::{Fluid, Layer, Medium};
///
/// let river = Layer::new(Fluid::WATER).with_flow(Uniform::new(0.5, 0.0, 0.0)); // m/s
/// let medium = Medium::layered(Fluid::AIR, river);
/// assert_eq!(medium.fluids().count(), 2);
/// ```
#[derive(Clone)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Layer {
    /// The fluid.
    pub fluid: Fluid,
    /// Its velocity; `None` is a fluid at rest. Not part of a snapshot: set it again.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub flow: Option<Arc<dyn Flow>>,
    /// The turbulence on top of it. Not part of a snapshot either.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub turbulence: Option<TurbulentLayer>,
}

impl Layer {
    /// A fluid at rest.
    pub fn new(fluid: Fluid) -> Self {
        Self {
            fluid,
            flow: None,
            turbulence: None,
        }
    }

    /// The same fluid with a velocity field.
    pub fn with_flow(self, flow: impl Flow + 'static) -> Self {
        Self {
            flow: Some(Arc::new(flow)),
            ..self
        }
    }

    /// The same fluid with turbulence.
    pub fn with_turbulence(self, turbulence: impl Into<TurbulentLayer>) -> Self {
        Self {
            turbulence: Some(turbulence.into()),
            ..self
        }
    }

    /// Whether it is given a motion.
    pub(crate) fn moves(&self) -> bool {
        self.flow.is_some() || self.turbulence.is_some()
    }
}

impl From<Fluid> for Layer {
    fn from(fluid: Fluid) -> Self {
        Self::new(fluid)
    }
}

/// One fluid everywhere, or several: air over water, over layers of denser water.
///
/// The first two are parted by a free surface, at rest ([`Level`]) unless another is given, those below by planes at
/// a depth. A body that is cut by one of them feels of each fluid what is under and over: buoyancy of the volume cut
/// off, and drag, lift and added mass by its share of the volume. Each of its parts does by its own.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Medium};
///
/// let mut world = PhysicsWorld::new();
/// let log = ColliderBuilder::cuboid(1.0, 0.1, 0.2).density(600.0);
/// let (log, _) = world.insert(RigidBodyBuilder::dynamic().translation(Vector::Y), log);
/// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, log)?;
/// // Air over y = 0, water below.
/// let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
/// immersion.insert(log, hydro);
/// (0..600).for_each(|_| immersion.step(&mut world));
/// // It floats, 600/997 of it under water.
/// let draft = 0.1 - world.bodies[log].translation().y;
/// assert!((draft - 0.2 * 600.0 / 997.0).abs() < 2e-3);
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
#[derive(Clone)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Medium {
    /// From the uppermost down.
    layers: Vec<Layer>,
    /// Depth of each layer's top under the level, m: −∞, 0, and those that were given.
    tops: Vec<f64>,
    /// A point of the level.
    origin: Vector,
    /// Direction opposite to gravity, of length 1.
    up: Vector,
    /// Not part of a snapshot: set it again.
    #[cfg_attr(feature = "serde-serialize", serde(skip, default = "level"))]
    surface: Arc<dyn FreeSurface>,
}

/// The surface of a fluid at rest.
fn level() -> Arc<dyn FreeSurface> {
    Arc::new(Level)
}

impl From<Fluid> for Medium {
    fn from(fluid: Fluid) -> Self {
        Self::new(fluid)
    }
}

impl From<Layer> for Medium {
    fn from(layer: Layer) -> Self {
        Self::new(layer)
    }
}

impl Medium {
    /// Fluids that a medium may have at most.
    pub const MOST_LAYERS: usize = 15;

    /// One fluid everywhere.
    pub fn new(layer: impl Into<Layer>) -> Self {
        Self {
            layers: vec![layer.into()],
            tops: vec![f64::NEG_INFINITY],
            origin: Vector::ZERO,
            up: Vector::Y,
            surface: level(),
        }
    }

    /// One fluid over another, with a level surface at y = 0 between.
    pub fn layered(above: impl Into<Layer>, below: impl Into<Layer>) -> Self {
        let mut medium = Self::new(above);
        medium.layers.push(below.into());
        medium.tops.push(0.0);
        medium
    }

    /// The same medium with another one of its layers under a depth below the level, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the depth is not below the tops of all others or not finite,
    /// [`Error::InvalidParameter`] if there is no free surface to count it from or no room for one more.
    pub fn with_layer_below(mut self, depth: f64, layer: impl Into<Layer>) -> Result<Self, Error> {
        let count = self.layers.len();
        let room = (2..Self::MOST_LAYERS).contains(&count);
        Error::check(
            "layers of a medium",
            count as f64,
            room,
            "2 to 14 before one more",
        )?;
        let last = self.tops.last().copied().unwrap_or(0.0);
        let below = depth > last && depth.is_finite();
        Error::check("depth of a layer", depth, below, "below the layer before")?;
        self.layers.push(layer.into());
        self.tops.push(depth);
        Ok(self)
    }

    /// The same medium with its level through a point, m.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn with_level(self, origin: Vector) -> Result<Self, Error> {
        let place = origin.to_array().map(f64::from);
        Error::check_all_finite("point of the level", &place)?;
        Ok(Self { origin, ..self })
    }

    /// The same medium with another direction up, of any length but zero (default +Y). It should be opposite to the
    /// world's gravity: buoyancy acts along it wherever a body is cut.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::InvalidParameter`].
    pub fn with_up(self, up: Vector) -> Result<Self, Error> {
        Error::check_all_finite("up", &up.to_array().map(f64::from))?;
        Error::check_positive("length of up", up.length().into())?;
        Ok(Self {
            up: up.normalize(),
            ..self
        })
    }

    /// The same medium with another surface between the first two fluids.
    pub fn with_surface(self, surface: impl FreeSurface + 'static) -> Self {
        Self {
            surface: Arc::new(surface),
            ..self
        }
    }

    /// The fluids, from the uppermost down.
    pub fn fluids(&self) -> impl ExactSizeIterator<Item = &Fluid> {
        self.layers.iter().map(|layer| &layer.fluid)
    }

    /// The layers, from the uppermost down.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// The layers, to be given another motion.
    pub(crate) fn layers_mut(&mut self) -> &mut [Layer] {
        &mut self.layers
    }

    /// The surface between the first two.
    pub fn surface(&self) -> &dyn FreeSurface {
        &*self.surface
    }

    /// Sets the surface between the first two.
    pub(crate) fn set_surface(&mut self, surface: Arc<dyn FreeSurface>) {
        self.surface = surface;
    }

    /// Direction up, of length 1.
    pub fn up(&self) -> Vector {
        self.up
    }

    /// A point of the level.
    pub fn level(&self) -> Vector {
        self.origin
    }

    /// Whether there are several fluids, with a free surface between the first two.
    pub(crate) fn has_surface(&self) -> bool {
        self.layers.len() > 1
    }

    /// Whether the fluid of a layer is given a motion, or moved by the waves over it.
    #[inline(always)]
    pub(crate) fn moves(&self, layer: usize) -> bool {
        self.layers.get(layer).is_some_and(Layer::moves) || (layer == 1 && !self.surface.is_still())
    }

    /// Whether nothing moves in it.
    pub(crate) fn is_still(&self) -> bool {
        (0..self.layers.len()).all(|layer| !self.moves(layer))
    }

    /// Whether there is a free surface, and a gravity that is off its up by more than 0.6°.
    pub(crate) fn is_tilted(&self, gravity: Vector) -> bool {
        let length = gravity.length();
        self.has_surface() && length > 0.0 && gravity.dot(self.up) > -0.99995 * length
    }

    /// Maps level axes to those of the world.
    pub(crate) fn axes(&self) -> Rotation3<f64> {
        let up = Vector3::new(self.up.x, self.up.y, self.up.z).map(f64::from);
        let half_turn = || Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        Rotation3::rotation_between(&Vector3::y(), &Unit::new_normalize(up))
            .unwrap_or_else(half_turn)
    }

    /// Height of a point over the level, m.
    #[inline(always)]
    pub(crate) fn height(&self, point: Vector) -> Real {
        (point - self.origin).dot(self.up)
    }

    /// Depth of the boundary over a layer under the level, m.
    pub(crate) fn top(&self, layer: usize) -> f64 {
        self.tops.get(layer).copied().unwrap_or(f64::INFINITY)
    }

    /// A point in level axes.
    pub(crate) fn to_level(&self, axes: &Rotation3<f64>, point: Vector) -> Vector3<f64> {
        let from = point - self.origin;
        axes.inverse() * Vector3::new(from.x, from.y, from.z).map(f64::from)
    }

    /// The layer that a point is in.
    pub(crate) fn layer_at(&self, point: Vector, time: f64) -> usize {
        if !self.has_surface() {
            return 0;
        }
        let height = f64::from(self.height(point));
        let highest = self.surface.highest();
        if height > highest {
            return 0;
        }
        if height > -highest {
            let at = self.to_level(&self.axes(), point);
            if at.y > self.elevation(&at, time).height {
                return 0;
            }
        }
        // What is in the trough of a wave above the level is under the surface all the same.
        let under = self.tops.iter().rposition(|top| height < -top);
        under.unwrap_or(1).max(1)
    }

    /// The first and the last layer that a body within a radius of a point may be in, which moves up or down by at most
    /// `way`, m.
    #[inline(always)]
    pub(crate) fn layers_within(
        &self,
        center: Vector,
        radius: Real,
        way: Real,
        time: f64,
    ) -> (usize, usize) {
        let height = f64::from(self.height(center));
        let reach = f64::from(radius + way);
        let highest = self.surface.highest();
        if height - reach > highest {
            return (0, 0);
        }
        let below = |height: f64| {
            let under = self.tops.iter().rposition(|top| height < -top);
            under.unwrap_or(1).max(1)
        };
        let mut first = below(height + reach);
        let last = below(height - reach);
        if height + reach < -highest {
            return (first, last);
        }
        if self.surface.is_still() {
            return (usize::from(height + reach < 0.0).min(first), last);
        }
        // Close to a wave the surface at the place decides, with some room for its slope and its motion.
        let at = self.to_level(&self.axes(), center);
        let here = self.elevation(&at, time);
        if self.is_plane_over(2.0 * f64::from(radius)) {
            let [x, z] = here.slope;
            let room = reach + f64::from(radius) * (1.0 + (x * x + z * z).sqrt());
            if height - room > here.height {
                return (0, 0);
            }
            first = usize::from(height + room < here.height).min(first);
        } else {
            first = 0;
        }
        (first, last)
    }

    /// Whether the free surface is a plane over a body of this length, m: one of a quarter of a wave at most.
    pub(crate) fn is_plane_over(&self, length: f64) -> bool {
        4.0 * length < self.surface.bend()
    }

    /// The free surface over or under a point in level axes; level where the surface is no number.
    pub(crate) fn elevation(&self, at: &Vector3<f64>, time: f64) -> Elevation {
        let found = self.surface.elevation(at.x, at.z, time);
        let finite = (found.height + found.slope[0] + found.slope[1]).is_finite();
        if finite { found } else { Elevation::default() }
    }

    /// What the fluid of a layer does at many points: its flow and, right under the surface, the motion of the waves.
    pub(crate) fn sample(
        &self,
        layer: usize,
        points: &[Vector],
        time: f64,
        samples: &mut [FlowSample],
    ) {
        let Some(own) = self.layers.get(layer) else {
            return;
        };
        if let Some(flow) = &own.flow {
            flow.sample(points, time, samples);
        }
        if layer == 1 && !self.surface.is_still() {
            let axes = self.axes();
            for (point, sample) in points.iter().zip(samples) {
                let at = self.to_level(&axes, *point);
                let [x, y, z]: [f64; 3] = (axes * self.surface.velocity(&at, time)).into();
                sample.velocity += Vector::new(x as Real, y as Real, z as Real);
            }
        }
    }

    /// What the fluid of a layer does at a point.
    pub(crate) fn flow_at(&self, layer: usize, point: Vector, time: f64) -> FlowSample {
        let mut sample = [FlowSample::default()];
        self.sample(layer, &[point], time, &mut sample);
        sample[0]
    }

    /// # Errors
    /// Of a file: what the functions above refuse.
    #[cfg(feature = "serde-serialize")]
    pub(crate) fn check(&self) -> Result<(), Error> {
        let count = self.layers.len();
        let room = (1..=Self::MOST_LAYERS).contains(&count) && self.tops.len() == count;
        Error::check("layers of a medium", count as f64, room, "1 to 15")?;
        Error::check_all_finite("point of the level", &self.origin.to_array().map(f64::from))?;
        let length = f64::from(self.up.length());
        Error::check("length of up", length, (length - 1.0).abs() < 1e-3, "1")?;
        for (layer, top) in self.tops.iter().enumerate() {
            let sorted = match layer {
                0 => *top == f64::NEG_INFINITY,
                1 => *top == 0.0,
                _ => top.is_finite() && *top > self.tops[layer - 1],
            };
            Error::check("depth of a layer", *top, sorted, "below the layer before")?;
        }
        Ok(())
    }
}
