//! What the bodies of a context are in: resources for all contexts, a component for one.

use crate::context::RapierContextImmersion;
use crate::reflect::LangevinModeWrapper;
use bevy::prelude::*;
use rapier3d_immersed::flow::{Flow, Layers, Uniform};
use rapier3d_immersed::free_surface::FreeSurface;
use rapier3d_immersed::turbulence::{LangevinMode, TurbulenceState, TurbulentLayer};
use rapier3d_immersed::{Error, Fluid, Layer, turbulence};
use std::sync::Arc;

/// The fluid, or several in layers: air over water, over denser water. Air everywhere by default.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// let mut app = App::new();
/// app.insert_resource(Medium::from(Fluid::WATER)); // water everywhere
/// app.insert_resource(Medium::layered([Fluid::AIR, Fluid::WATER])); // a lake under y = 0
/// ```
#[derive(Resource, Reflect, Clone, Debug, PartialEq)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct Medium {
    /// From the uppermost down: 1 to 15. Between the first two is the free surface.
    pub layers: Vec<MediumLayer>,
    /// A point of the free surface at rest, m.
    pub level: Vec3,
    /// Direction up, of any length; opposite to the context's gravity.
    pub up: Vec3,
    /// Waves on the free surface, such as
    /// [`Waves::sea`](rapier3d_immersed::free_surface::Waves::sea); `None` is level.
    pub surface: Option<SharedSurface>,
}

/// One fluid of a [`Medium`].
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub struct MediumLayer {
    /// kg/m³, positive.
    pub density: f32,
    /// m²/s, positive.
    pub kinematic_viscosity: f32,
    /// A current, m/s, world axes: zero is a fluid at rest.
    pub current: Vec3,
    /// Depth of the layer's top under the level, m. Of no account for the first two layers, whose border is the level.
    pub top: f32,
}

impl From<Fluid> for MediumLayer {
    fn from(fluid: Fluid) -> Self {
        Self {
            density: fluid.density(),
            kinematic_viscosity: fluid.kinematic_viscosity(),
            current: Vec3::ZERO,
            top: 0.0,
        }
    }
}

/// Air at rest.
impl Default for MediumLayer {
    fn default() -> Self {
        Fluid::AIR.into()
    }
}

/// Air everywhere.
impl Default for Medium {
    fn default() -> Self {
        Fluid::AIR.into()
    }
}

/// One fluid everywhere.
impl From<Fluid> for Medium {
    fn from(fluid: Fluid) -> Self {
        Self::layered([fluid])
    }
}

impl Medium {
    /// These layers from the uppermost down, with a level surface at y = 0 under the first.
    pub fn layered<L: Into<MediumLayer>>(layers: impl IntoIterator<Item = L>) -> Self {
        Self {
            layers: layers.into_iter().map(Into::into).collect(),
            level: Vec3::ZERO,
            up: Vec3::Y,
            surface: None,
        }
    }

    /// The same with another free surface.
    pub fn with_surface(self, surface: impl FreeSurface + 'static) -> Self {
        Self {
            surface: Some(SharedSurface(Arc::new(surface))),
            ..self
        }
    }

    /// As the immersion has it, with this wind and turbulence in the uppermost layer.
    ///
    /// # Errors
    /// Those of [`Fluid::new`] and of [`rapier3d_immersed::Medium`]'s layers, level and up.
    fn immersed(
        &self,
        wind: &Wind,
        turbulence: Option<TurbulentLayer>,
    ) -> Result<rapier3d_immersed::Medium, Error> {
        let layer = |(index, own): (usize, &MediumLayer)| {
            let fluid = Fluid::new(own.density, own.kinematic_viscosity)?;
            let uppermost = index == 0;
            let flow = if uppermost {
                wind.flow_over(own.current)
            } else {
                Wind::default().flow_over(own.current)
            };
            let turbulence = turbulence.clone().filter(|_| uppermost);
            Ok(Layer {
                fluid,
                flow,
                turbulence,
            })
        };
        let layers: Result<Vec<Layer>, Error> = self.layers.iter().enumerate().map(layer).collect();
        let mut layers = layers?.into_iter();
        let count = self.layers.len();
        let none = Error::InvalidParameter {
            parameter: "layers of a medium",
            requirement: "1 to 15",
            value: count as f64,
        };
        let first = layers.next().ok_or(none)?;
        let mut medium = match layers.next() {
            Some(second) => rapier3d_immersed::Medium::layered(first, second),
            None => rapier3d_immersed::Medium::new(first),
        };
        for (layer, own) in layers.zip(self.layers.iter().skip(2)) {
            medium = medium.with_layer_below(own.top.into(), layer)?;
        }
        let medium = medium.with_level(self.level)?.with_up(self.up)?;
        Ok(match &self.surface {
            Some(SharedSurface(surface)) => medium.with_surface(surface.clone()),
            None => medium,
        })
    }
}

/// How the uppermost fluid moves, on top of its layer's current. At rest by default.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d_immersed::immersed::flow::Shear;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// let mut app = App::new();
/// app.insert_resource(Wind::uniform(Vec3::X * 2.0)); // m/s
/// app.insert_resource(Wind::field(Shear { rate: Vec3::X, ..Shear::default() }));
/// ```
#[derive(Resource, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct Wind {
    /// The same everywhere and always, m/s, world axes.
    pub velocity: Vec3,
    /// A velocity field on top of it: one of [`flow`](rapier3d_immersed::flow), or of the user's.
    pub field: Option<SharedFlow>,
}

impl Wind {
    /// The same velocity everywhere and always, m/s, world axes.
    pub fn uniform(velocity: Vec3) -> Self {
        Self {
            velocity,
            field: None,
        }
    }

    /// A velocity field.
    pub fn field(flow: impl Flow + 'static) -> Self {
        Self {
            velocity: Vec3::ZERO,
            field: Some(SharedFlow(Arc::new(flow))),
        }
    }

    /// The sum with a current; `None` if nothing moves.
    fn flow_over(&self, current: Vec3) -> Option<Arc<dyn Flow>> {
        let velocity = self.velocity + current;
        let uniform = Uniform { velocity };
        match &self.field {
            None if velocity == Vec3::ZERO => None,
            None => Some(Arc::new(uniform)),
            Some(SharedFlow(flow)) if velocity == Vec3::ZERO => Some(flow.clone()),
            Some(SharedFlow(flow)) => {
                Some(Arc::new(Layers::new().with(uniform).with(flow.clone())))
            }
        }
    }
}

/// Turbulence of the uppermost fluid, whose velocity then fluctuates around each body. None by default.
///
/// ```
/// use bevy::prelude::*;
/// use bevy_rapier3d_immersed::prelude::*;
///
/// // As behind a grid: 0.1 m²/s² that lasts for two seconds.
/// let turbulence = Turbulence { kinetic_energy: 0.1, dissipation: 0.05, ..default() };
/// App::new().insert_resource(turbulence);
/// ```
#[derive(Resource, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct Turbulence {
    /// Turbulent kinetic energy k, the same everywhere, m²/s². Zero is none.
    pub kinetic_energy: f32,
    /// Its dissipation rate ε, m²/s³.
    pub dissipation: f32,
    /// How it acts on bodies.
    #[reflect(remote = LangevinModeWrapper)]
    pub mode: LangevinMode,
    /// Seed of the noise, of which each body has its own.
    pub seed: u64,
    /// One that differs from place to place, in place of k and ε.
    pub source: Option<SharedTurbulence>,
}

impl Turbulence {
    /// As the immersion has it; `None` if there is none.
    fn immersed(&self) -> Option<TurbulentLayer> {
        let state = TurbulenceState {
            kinetic_energy: self.kinetic_energy,
            dissipation: self.dissipation,
        };
        let can_be = [self.kinetic_energy, self.dissipation]
            .iter()
            .all(|number| number.is_finite() && *number >= 0.0);
        let source = match &self.source {
            Some(SharedTurbulence(source)) => (**source).clone(),
            None if !can_be => {
                log::warn!("no turbulence: {state:?} cannot be");
                return None;
            }
            None if self.kinetic_energy == 0.0 => return None,
            None => turbulence::Turbulence::Homogeneous(state),
        };
        Some(TurbulentLayer {
            source,
            mode: self.mode,
            seed: self.seed,
        })
    }
}

/// What a context has of its own in place of the resources. Goes on the entity with the
/// [`RapierContextSimulation`](bevy_rapier3d::prelude::RapierContextSimulation).
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ContextSurroundings {
    /// In place of the resource [`Medium`].
    pub medium: Option<Medium>,
    /// In place of the resource [`Wind`].
    pub wind: Option<Wind>,
    /// In place of the resource [`Turbulence`].
    pub turbulence: Option<Turbulence>,
}

/// Something that can be no field of an inspector: equal is what is the same.
macro_rules! shared {
    ($(#[$doc:meta])* $name:ident($of:ty)) => {
        $(#[$doc])*
        #[derive(Reflect, Clone, Deref)]
        #[reflect(opaque, Clone, Debug, PartialEq)]
        pub struct $name(pub Arc<$of>);

        impl PartialEq for $name {
            fn eq(&self, other: &Self) -> bool {
                std::ptr::addr_eq(Arc::as_ptr(&self.0), Arc::as_ptr(&other.0))
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}({:p})", stringify!($name), Arc::as_ptr(&self.0))
            }
        }
    };
}

shared! {
    /// A velocity field that several owners share.
    SharedFlow(dyn Flow)
}
shared! {
    /// A free surface that several owners share.
    SharedSurface(dyn FreeSurface)
}
shared! {
    /// A source of turbulence that several owners share.
    SharedTurbulence(turbulence::Turbulence)
}

/// What was told to an immersion last: at first what it is made with.
#[derive(Default)]
pub(crate) struct Applied {
    medium: Medium,
    wind: Wind,
    turbulence: Turbulence,
}

/// Tells the immersions what they are in, where that has changed.
pub(crate) fn surround(
    mut contexts: Query<(&mut RapierContextImmersion, Option<&ContextSurroundings>)>,
    medium: Res<Medium>,
    wind: Res<Wind>,
    turbulence: Res<Turbulence>,
) {
    for (mut immersion, own) in &mut contexts {
        let medium = own.and_then(|own| own.medium.as_ref()).unwrap_or(&medium);
        let wind = own.and_then(|own| own.wind.as_ref()).unwrap_or(&wind);
        let turbulence = own
            .and_then(|own| own.turbulence.as_ref())
            .unwrap_or(&turbulence);
        let known = &immersion.applied;
        let new_medium = known.medium != *medium;
        let new_wind = known.wind != *wind;
        let new_turbulence = known.turbulence != *turbulence;
        if !(new_medium || new_wind || new_turbulence) {
            continue;
        }
        immersion.applied = Applied {
            medium: medium.clone(),
            wind: wind.clone(),
            turbulence: turbulence.clone(),
        };
        if new_medium {
            match medium.immersed(wind, turbulence.immersed()) {
                Ok(medium) => {
                    immersion.set_medium(medium);
                    continue;
                }
                Err(error) => log::warn!("the medium stays as it was: {error}"),
            }
        }
        if new_wind {
            blow(&mut immersion, wind, medium);
        }
        if new_turbulence {
            match turbulence.immersed() {
                Some(turbulence) => immersion.set_turbulence(turbulence),
                None => immersion.clear_turbulence(),
            }
        }
    }
}

/// Another wind in the same medium.
fn blow(immersion: &mut RapierContextImmersion, wind: &Wind, medium: &Medium) {
    let current = |layer: &MediumLayer| layer.current;
    let uppermost = medium.layers.first().map(current).unwrap_or_default();
    let below = medium.layers.iter().skip(1);
    match wind.flow_over(uppermost) {
        Some(flow) => immersion.set_flow(flow),
        None if below.map(current).all(|current| current == Vec3::ZERO) => immersion.clear_flow(),
        None => immersion.set_flow(Uniform::default()),
    }
}
