//! The set of immersed bodies: what users hold.

use super::admission::{self, Admission};
use super::body_look::BodyChanges;
use super::control::{OnContact, SeriesTable};
use super::environment::Environment;
use super::impulse;
use super::rapier_sets::RapierSets;
use super::readout;
use super::registry::Registry;
use super::shared_constants::ConstantsTable;
use super::step::driver::{self, StepParts};
use super::step::workspace::Workspace;
use super::surface_readout::AmongLayers;
use super::warning::{Warning, Warnings};
use crate::body::{DryMass, ImmersedBody};
use crate::dynamics::{ForceBreakdown, Hydrostatics, Integrator};
use crate::flow::Flow;
use crate::fluid::Fluid;
use crate::hydro::viscous::ForceFactors;
use crate::medium::{Layer, Medium};
use crate::motion::ControlSeries;
use crate::turbulence::TurbulentLayer;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::math::Vector;
use rapier3d::na::Matrix6;
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsWorld};
use std::sync::Arc;

/// Bodies of a rapier world that are immersed in one fluid.
///
/// Keyed by rapier's handles and otherwise independent of the world: bodies may be removed from
/// rapier at any time, and their handles reused.
///
/// # What it does to a body
/// From the step after its insertion until it is removed or disabled, an immersed body
/// * has all its mass properties moved to its first enabled collider, with the fluid's share of the
///   rotational inertia (and, near contacts, of the mass) added. Between steps rapier's `body.mass()` and
///   that collider's `mass()` therefore read the mass that the solver uses (the body's own in free flight,
///   that along the normal or the joint's pull when something holds it), its inertia reads I + ρA₂₂, other
///   colliders read `mass() == 0`, and so do the body's additional mass properties. The body's own mass is
///   [`Immersion::mass_of`], that of body and fluid [`Immersion::mass_matrix_of`];
/// * may rotate by more than 45° per step, and has rapier's gyroscopic forces off (the crate
///   integrates them);
/// * does not fall asleep unless it touches something, is jointed or has locked axes;
/// * keeps its user forces, gravity scale (which scales the buoyancy too), damping, locked axes and
///   joints.
///
/// What holds a body (joints of both kinds, locked axes, friction) feels the force of the fluid in full at any
/// step, and the added mass along the joint's pull from the first step on; a joint that opens leaves nothing
/// behind. In a fluid at rest no joint, lock or spring gives body and fluid more energy than they had. Links of
/// multibodies read their velocities at the end of the step (under plain rapier those of one substep before).
/// Kinematic bodies are left alone until they become dynamic.
///
/// # Between fluids
/// In a [`Medium`] of several fluids a body is in the layer that it is in, at any time, and one that a boundary cuts is
/// moved by both: see [`Medium`]. Rapier is given the inertia of the lowest fluid that the body is in, once when it
/// gets there; what changes while it bobs is in the force that the step hands over. A body that rests on fluids at rest
/// may sleep. Of the turbulence it feels that of the lowest fluid. [`Immersion::hydrostatics`] reads out how it floats.
///
/// # Changing a body
/// Colliders of an immersed body may be added, removed, disabled, moved, and given other shapes, densities and
/// masses, the body other additional mass, at any time between steps: the next step moves it as what it has
/// become, as [`Immersion::body_changes`] says. What is set on a collider or as additional mass is meant as for
/// a body without fluid; what is not set stays as it was before the immersion. `set_density(0.0)` on a collider
/// that reads a mass of zero is such a change, too; only an explicit `MassProperties::default()` on a collider at
/// the body's origin is not seen, unless the collider is the first. A body that cannot be immersed as what it
/// has become (without mass, say) is left to rapier, with a [`Warning::Refused`], until it can. A body that
/// sleeps is looked at once in 16 steps. What [`Immersion::remove`] gives back is what was set last.
///
/// Impulses: rapier's `apply_impulse(J)` pushes the body as if there were no fluid;
/// [`Immersion::apply_impulse`] moves the fluid that it drags along, too. Forces need no such care: the step
/// shares them between body and fluid.
///
/// One body belongs to one immersion; another one that it is inserted in says so
/// ([`Warning::ImmersedTwice`]) and leaves it alone. An immersion that is dropped cannot give its bodies back:
/// remove them first if the world goes on.
///
/// # Memory
/// About 800 bytes per body, besides what equal bodies share.
///
/// ```
/// use rapier3d_immersed::rapier3d::prelude::*;
/// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
///
/// let mut world = PhysicsWorld::new();
/// let coin = ColliderBuilder::cylinder(0.0008, 0.01).density(7000.0);
/// let (coin, _) = world.insert(RigidBodyBuilder::dynamic().rotation(Vector::X * 0.5), coin);
/// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, coin)?;
///
/// let mut immersion = Immersion::new(Fluid::WATER);
/// immersion.insert(coin, hydro);
/// for _ in 0..60 {
///     immersion.step(&mut world);
/// }
/// assert!((-0.5..-0.1).contains(&world.bodies[coin].translation().y)); // in vacuum it would be −4.9 m
/// # Ok::<(), rapier3d_immersed::Error>(())
/// ```
///
/// # Snapshots
/// With the feature `serde-serialize` a snapshot holds all but flow and turbulence, which are set again.
/// Together with one of the rapier world it goes on bit by bit. Loading refuses other versions and what
/// cannot be; saving fails between `before_step` and `after_step`.
#[derive(Clone)]
pub struct Immersion {
    /// How finely flight is integrated within a step of rapier.
    pub integrator: Integrator,
    /// What becomes of a body in the fluid whose colliders or mass its user changes.
    pub body_changes: BodyChanges,
    pub(super) enabled: bool,
    pub(super) environment: Environment,
    pub(super) registry: Registry,
    pub(super) series: SeriesTable,
    pub(super) warnings: Warnings,
    pub(super) constants: ConstantsTable,
    pub(super) workspace: Workspace,
}

impl Immersion {
    /// An empty set in a [`Fluid`] at rest, or in another [`Medium`].
    pub fn new(medium: impl Into<Medium>) -> Self {
        let mut immersion = Self {
            integrator: Integrator::default(),
            body_changes: BodyChanges::default(),
            enabled: true,
            environment: Environment::new(medium.into()),
            registry: Registry::default(),
            series: SeriesTable::default(),
            warnings: Warnings::default(),
            constants: ConstantsTable::default(),
            workspace: Workspace::default(),
        };
        immersion.warn_of_medium();
        immersion
    }

    /// Immerses a body from the next step on. Equal descriptions are stored once.
    ///
    /// `body` is [`HydroProperties`](crate::HydroProperties) (under the default law) or an
    /// [`ImmersedBody`]. A handle that is stale or becomes stale is no error; a body that is already
    /// immersed gets the new description and goes on with the velocities that it has. What cannot be immersed (without mass, say) is left to
    /// plain rapier and reported in [`Immersion::warnings`], as is what the default law does not see of a shape
    /// ([`ImmersedBody::out_of_scope`]).
    pub fn insert(&mut self, handle: RigidBodyHandle, body: impl Into<ImmersedBody>) {
        self.insert_all([handle], body);
    }

    /// Immerses many equal bodies: `body` is compared with the known descriptions only once.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let confetti = ColliderBuilder::cuboid(0.005, 0.0001, 0.003).density(700.0);
    /// let handles: Vec<_> = (0..100)
    ///     .map(|i| {
    ///         let body = RigidBodyBuilder::dynamic().translation(Vector::X * (0.1 * i as f32));
    ///         world.insert(body, confetti.clone()).0
    ///     })
    ///     .collect();
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, handles[0])?;
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.insert_all(handles, hydro);
    /// assert_eq!(immersion.len(), 100);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn insert_all(
        &mut self,
        handles: impl IntoIterator<Item = RigidBodyHandle>,
        body: impl Into<ImmersedBody>,
    ) {
        let body = body.into();
        let mut handles = handles.into_iter().peekable();
        if let Some(first) = handles.peek() {
            self.warnings.push_scope(*first, &body, &self.registry);
        }
        let description = self.registry.describe(body);
        for handle in handles {
            self.registry.insert(handle, description);
            if let Some(index) = self.registry.index(handle) {
                // What cannot be immersed is refused, and reported, with the next step.
                let _ = admission::renew_constants_of(
                    index,
                    &mut self.registry,
                    &mut self.constants,
                    &self.environment,
                );
            }
        }
    }

    /// Takes a body out of the fluid and gives it back the mass properties and switches that it had.
    /// Unknown handles are no error.
    pub fn remove(
        &mut self,
        handle: RigidBodyHandle,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) {
        let state = self.registry.remove(handle);
        if let Some(saved) = state.and_then(|state| state.saved) {
            saved.restore(handle, bodies, colliders);
        }
    }

    /// Whether a body is in the set, enabled or not.
    pub fn contains(&self, handle: RigidBodyHandle) -> bool {
        self.registry.index(handle).is_some()
    }

    /// Number of bodies in the set as the last step found it: bodies that were removed from rapier since
    /// count until the next. [`Immersion::len_in`] is right at once.
    ///
    /// A sleeping body whose removal rapier's number of bodies does not show, because another was inserted
    /// in the same step, counts for up to 16 steps.
    pub fn len(&self) -> usize {
        self.registry.len()
    }

    /// Number of bodies in the set that rapier still has, right also between a removal and the next step.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1));
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, HydroProperties::from_body(&world.bodies, &world.colliders, ball)?);
    /// world.remove_body(ball);
    /// assert_eq!(immersion.len_in(&world.bodies), 0);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn len_in(&self, bodies: &RigidBodySet) -> usize {
        let states = self.registry.states().iter().flatten();
        states.filter(|state| bodies.contains(state.handle)).count()
    }

    /// Whether no body is immersed.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The description of a body.
    pub fn get(&self, handle: RigidBodyHandle) -> Option<&ImmersedBody> {
        let state = self.registry.get(handle)?;
        self.registry.description(state)
    }

    /// Switches the fluid off or on for the whole set, from the next step on. While off, the world
    /// steps as plain rapier: mass properties and switches are those from before immersion.
    pub fn set_enabled(&mut self, enabled: bool) {
        self.enabled = enabled;
        self.registry.changed = true;
    }

    /// Whether the fluid is on for the set.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// Switches the fluid off or on for one body, from the next step on.
    pub fn set_body_enabled(&mut self, handle: RigidBodyHandle, enabled: bool) {
        if let Some(state) = self.registry.get_mut(handle) {
            state.enabled = enabled;
            state.refused = None;
            self.registry.changed = true;
        }
    }

    /// The fluid; of several layers the uppermost.
    pub fn fluid(&self) -> &Fluid {
        &self.environment.medium.layers()[0].fluid
    }

    /// What the bodies are in.
    pub fn medium(&self) -> &Medium {
        &self.environment.medium
    }

    /// Puts all bodies into another fluid, from the next step on, with the flow and turbulence that there are; of
    /// several layers those of the uppermost. Bodies go on with the velocities that they have, and
    /// sleeping ones wake. [`Immersion::forces`] are those in the new fluid at once.
    pub fn set_fluid(&mut self, fluid: Fluid) {
        let uppermost = self.environment.medium.layers()[0].clone();
        self.set_medium(Layer { fluid, ..uppermost });
    }

    /// Puts all bodies into another medium, with its flows and its turbulence, from the next step on; the rest as
    /// [`Immersion::set_fluid`].
    pub fn set_medium(&mut self, medium: impl Into<Medium>) {
        self.environment.set_medium(medium.into());
        self.warn_of_medium();
        self.constants.clear();
        self.registry.forget_constants();
        // What cannot be immersed is refused, and reported, with the next step.
        let _ =
            admission::renew_constants(&mut self.registry, &mut self.constants, &self.environment);
    }

    /// Sets the velocity field of the fluid; of several layers that of the uppermost: the wind.
    ///
    /// ```
    /// use rapier3d_immersed::flow::Uniform;
    /// use rapier3d_immersed::{Fluid, Immersion};
    ///
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.set_flow(Uniform::new(2.0, 0.0, 0.0)); // a breeze along +x
    /// ```
    pub fn set_flow(&mut self, flow: impl Flow + 'static) {
        self.set_flow_of(0, flow);
    }

    /// Sets the velocity field of one layer of the medium, counted from the uppermost: that of layer 1 is the current
    /// of the water under air. A layer that the medium has not is no error.
    pub fn set_flow_of(&mut self, layer: usize, flow: impl Flow + 'static) {
        self.environment.set_flow(layer, Arc::new(flow));
    }

    /// Lets all fluids rest, but for their turbulence and the waves: the same as a flow that is zero everywhere.
    pub fn clear_flow(&mut self) {
        for layer in 0..self.environment.medium.layers().len() {
            if self.environment.medium.layers()[layer].flow.is_some() {
                self.environment.come_to_rest(layer);
            }
        }
    }

    /// Warns of a medium that would not stay as it is.
    fn warn_of_medium(&mut self) {
        let fluids: Vec<_> = self.environment.medium.fluids().copied().collect();
        for (above, pair) in fluids.windows(2).enumerate() {
            let [over, under] = [pair[0].density(), pair[1].density()];
            if over > under {
                self.warnings.push_once(Warning::LighterBelow {
                    layer: above + 1,
                    density: under,
                    above: over,
                });
            }
        }
    }

    /// Adds turbulence to the mean flow; of several layers to that of the uppermost. Its fluctuations differ from body to
    /// body.
    ///
    /// A [`Turbulence`](crate::turbulence::Turbulence) acts as the fluctuating velocity of the fluid
    /// that a body sees, with seed 0; [`TurbulentLayer`] chooses otherwise.
    ///
    /// ```
    /// use rapier3d_immersed::turbulence::{Turbulence, TurbulenceState};
    /// use rapier3d_immersed::{Fluid, Immersion};
    ///
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.set_turbulence(Turbulence::Homogeneous(TurbulenceState {
    ///     kinetic_energy: 0.1, // m²/s²
    ///     dissipation: 0.05,   // m²/s³
    /// }));
    /// ```
    pub fn set_turbulence(&mut self, turbulence: impl Into<TurbulentLayer>) {
        self.set_turbulence_of(0, turbulence);
    }

    /// Adds turbulence to the flow of one layer of the medium, counted from the uppermost. A layer that the medium has
    /// not is no error.
    pub fn set_turbulence_of(&mut self, layer: usize, turbulence: impl Into<TurbulentLayer>) {
        if let Some(own) = self.environment.medium.layers_mut().get_mut(layer) {
            own.turbulence = Some(turbulence.into());
        }
    }

    /// Ends the turbulence of all layers.
    pub fn clear_turbulence(&mut self) {
        for state in self.registry.iter_mut() {
            state.flight.turbulence = Default::default();
        }
        for layer in 0..self.environment.medium.layers().len() {
            let own = &mut self.environment.medium.layers_mut()[layer];
            let ended = own.turbulence.take().is_some();
            if own.flow.is_none() && ended {
                self.environment.come_to_rest(layer);
            }
        }
    }

    /// Seconds that the set has been stepped while it was enabled.
    pub fn time(&self) -> f64 {
        self.environment.time
    }

    /// What the steps so far had to say; [`Immersion::clear_warnings`] forgets it. The same text
    /// goes to the `log` crate at level `warn`.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings.list
    }

    /// Forgets the warnings so far.
    pub fn clear_warnings(&mut self) {
        self.warnings.list.clear();
    }

    /// Steps the world, with the immersed bodies in their fluid.
    pub fn step(&mut self, world: &mut PhysicsWorld) {
        self.step_with_events(world, &(), &());
    }

    /// Steps the world with rapier's physics hooks and event handler.
    pub fn step_with_events(
        &mut self,
        world: &mut PhysicsWorld,
        hooks: &dyn PhysicsHooks,
        events: &dyn EventHandler,
    ) {
        self.before_step(&mut RapierSets::of(world));
        world.step_with_events(hooks, events);
        self.after_step(&mut RapierSets::of(world));
    }

    /// To be called right before `PhysicsPipeline::step`, with [`Immersion::after_step`] right after
    /// it. Sets each immersed body's force, torque and velocity so that rapier's step moves it as
    /// the fluid would.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, Immersion, RapierSets};
    ///
    /// let mut world = PhysicsWorld::new(); // or the sets that an engine holds: see `RapierSets`
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.before_step(&mut RapierSets::of(&mut world));
    /// world.step();
    /// immersion.after_step(&mut RapierSets::of(&mut world));
    /// ```
    pub fn before_step(&mut self, sets: &mut RapierSets) {
        let mut admission = self.admission();
        admission.admit(sets);
        admission.sweep(sets);
        self.environment.gravity = sets.gravity;
        if self.environment.medium.is_tilted(sets.gravity) {
            self.warnings.push_once(Warning::TiltedGravity);
        }
        if driver::give_back(&mut self.parts(), sets) {
            self.warnings.push_once(Warning::UnfinishedStep);
        }
        if self.enabled {
            driver::before_step(&mut self.parts(), sets);
            self.take_over_changes(sets);
            self.warn_of_flows();
        }
    }

    /// Moves the bodies that their users have changed as what they have become, and looks at those that have
    /// stopped moving.
    fn take_over_changes(&mut self, sets: &mut RapierSets) {
        let mut changed = std::mem::take(&mut self.workspace.changed);
        let mut sunk = std::mem::take(&mut self.workspace.sunk);
        if !changed.is_empty() || !sunk.is_empty() {
            let mut admission = self.admission();
            for index in changed.drain(..) {
                admission.take_over(index as usize, sets);
            }
            for (index, layer) in sunk.drain(..) {
                admission.change_layer(index as usize, layer, sets);
            }
            driver::move_newcomers(&mut self.parts(), sets);
            // Those that were just let in anew are as they should be.
            self.workspace.changed.clear();
            self.workspace.sunk.clear();
        }
        (self.workspace.changed, self.workspace.sunk) = (changed, sunk);
        if self.workspace.moved != self.workspace.moved_before {
            let missed: Vec<_> = self.workspace.missed().collect();
            let mut admission = self.admission();
            for index in missed {
                admission.look_at_missed(index, sets);
            }
        }
    }

    fn admission(&mut self) -> Admission<'_> {
        Admission {
            enabled: self.enabled,
            changes: self.body_changes,
            environment: &self.environment,
            registry: &mut self.registry,
            constants: &mut self.constants,
            warnings: &mut self.warnings,
            last: None,
        }
    }

    /// Warns of bodies at which the flow was no number, of each once.
    fn warn_of_flows(&mut self) {
        for body in self.workspace.bad_flows.drain(..) {
            if let Some(state) = self.registry.get_mut(body)
                && !std::mem::replace(&mut state.warned.flow, true)
            {
                self.warnings.push(Warning::FlowNotFinite { body });
            }
        }
    }

    /// To be called right after `PhysicsPipeline::step`: gives users' forces back and corrects the
    /// velocities of bodies in contact.
    pub fn after_step(&mut self, sets: &mut RapierSets) {
        driver::after_step(&mut self.parts(), sets);
        if self.enabled {
            let dt = sets.integration_parameters.dt.max(0.0);
            self.environment.time += f64::from(dt);
            self.environment.steps += 1;
            if self.environment.rests_now() {
                for state in self.registry.iter_mut() {
                    state.flight.fluid_velocity = Default::default();
                }
            }
        }
    }

    fn parts(&mut self) -> StepParts<'_> {
        StepParts {
            integrator: self.integrator,
            environment: &self.environment,
            constants: &self.constants,
            series: &self.series,
            registry: &mut self.registry,
            workspace: &mut self.workspace,
        }
    }

    /// The forces on a body in the state that it has now, or `None` if it is not immersed (yet: a
    /// body enters the fluid with the first step after its insertion). Gravity is that of the last
    /// step.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    /// let forces = immersion.forces(&world.bodies, ball).unwrap();
    /// assert!((forces.buoyancy.force.y - 997.0 * 0.004189 * 9.81).abs() < 0.2); // ρVg, N
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn forces(&self, bodies: &RigidBodySet, handle: RigidBodyHandle) -> Option<ForceBreakdown> {
        let state = self.registry.get(handle)?;
        let body = bodies.get(handle)?;
        readout::forces(state, &self.constants, &self.environment, body, None)
    }

    /// How a body lies in the free surface of the medium, as it is now; `None` if it is not immersed (yet), or in a single
    /// fluid.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion, Medium};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let raft = ColliderBuilder::cuboid(1.0, 0.1, 0.5).density(500.0);
    /// let (raft, _) = world.insert(RigidBodyBuilder::dynamic(), raft);
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, raft)?;
    /// let mut immersion = Immersion::new(Medium::layered(Fluid::AIR, Fluid::WATER));
    /// immersion.insert(raft, hydro);
    /// immersion.step(&mut world);
    /// let floats = immersion.hydrostatics(&world.bodies, raft).unwrap();
    /// assert!((floats.submerged_share - 0.5).abs() < 0.01);
    /// assert!((floats.waterplane_area - 2.0).abs() < 1e-4); // m²
    /// // BM = I/V of the waterplane, a rectangle of 2 m × 1 m, about its long axis.
    /// assert!((floats.metacentric_radii[0] - 2.0 / 12.0 / floats.submerged_volume).abs() < 1e-4);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn hydrostatics(
        &self,
        bodies: &RigidBodySet,
        handle: RigidBodyHandle,
    ) -> Option<Hydrostatics> {
        let state = self.registry.get(handle)?;
        let body = bodies.get(handle)?;
        let among = AmongLayers::of(state, &self.constants, &self.environment, body)?;
        Some(among.hydrostatics())
    }

    /// The mass, center of mass and inertia of a body itself, without any fluid, as its user means them; `None`
    /// if it is not in the fluid (yet: a body enters with the first step after its insertion). A change is in
    /// them after the next step. Rapier's own `body.mass()` is what the solver uses meanwhile: see
    /// [`Immersion`].
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1).mass(2.0));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    /// world.bodies[ball].set_additional_mass(0.5, true); // ballast
    /// immersion.step(&mut world);
    /// assert!((immersion.mass_of(ball).unwrap().mass - 2.5).abs() < 1e-6);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn mass_of(&self, handle: RigidBodyHandle) -> Option<DryMass> {
        Some(self.registry.get(handle)?.saved.as_ref()?.dry)
    }

    /// The 6×6 mass 𝕄 of a body with the fluid that it drags along: `𝕄 (v, ω)` is the momentum, N·s, and
    /// angular momentum, N·m·s, about the center of mass that it takes to move body and fluid at v, m/s, and
    /// ω, rad/s. Axes of the body's frame. A body that the boundary of two fluids cuts drags along what it did in the
    /// last step. `None` if the body is not in the fluid (yet).
    pub fn mass_matrix_of(&self, handle: RigidBodyHandle) -> Option<Matrix6<f64>> {
        let state = self.registry.get(handle)?;
        state.saved.as_ref()?;
        let shared = self.constants.get(state.constants)?;
        Some(state.mass_matrix(shared))
    }

    /// Pushes a body at its center of mass with an impulse in N·s, world axes, that moves the fluid around it,
    /// too: its velocities change at once by `𝕄⁻¹ (J, 0)`, 𝕄 being [`Immersion::mass_matrix_of`]. Rapier's own
    /// `apply_impulse` pushes a body as if there were no fluid, by J/m: a plate that is pushed broadside on in
    /// water then gets many times the velocity that the impulse is good for.
    ///
    /// For a wanted change of velocity Δv the impulse is `𝕄 (Δv, 0)`, or `m·Δv` with m =
    /// [`DryMass::mass`] plus the added mass along Δv. Locked axes keep their velocity. A body that is not in
    /// the fluid gets rapier's impulse. Wakes the body. A link of a multibody does not feel it, as it does not
    /// feel rapier's: rapier moves it by its multibody's generalized velocities alone. Push links by forces.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let (ball, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(0.1).density(997.0));
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, ball)?;
    /// let mut immersion = Immersion::new(Fluid::WATER);
    /// immersion.insert(ball, hydro);
    /// immersion.step(&mut world);
    ///
    /// let before = world.bodies[ball].linvel();
    /// let impulse = Vector::X * immersion.mass_of(ball).unwrap().mass as f32;
    /// immersion.apply_impulse(&mut world.bodies, ball, impulse);
    /// // A ball drags half of the water that it displaces along: m·(1 m/s) makes two thirds of 1 m/s.
    /// let change = world.bodies[ball].linvel() - before;
    /// assert!((change.x - 2.0 / 3.0).abs() < 1e-3);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn apply_impulse(
        &mut self,
        bodies: &mut RigidBodySet,
        handle: RigidBodyHandle,
        impulse: Vector,
    ) {
        if let Some(body) = bodies.get(handle) {
            let center = body.center_of_mass();
            self.apply_impulse_at_point(bodies, handle, impulse, center);
        }
    }

    /// The same at a point, m, world axes: velocities change by `𝕄⁻¹ (J, r × J)`, r being the lever from the
    /// center of mass.
    pub fn apply_impulse_at_point(
        &mut self,
        bodies: &mut RigidBodySet,
        handle: RigidBodyHandle,
        impulse: Vector,
        point: Vector,
    ) {
        let Some(body) = bodies.get_mut(handle) else {
            return;
        };
        let state = self.registry.get(handle);
        let immersed = state.filter(|state| state.saved.is_some() && body.is_dynamic());
        let Some(shared) = immersed.and_then(|state| self.constants.get(state.constants)) else {
            body.apply_impulse_at_point(impulse, point, true);
            return;
        };
        let lever = point - body.center_of_mass();
        let mass = state.map_or_else(|| shared.mass_matrix(), |state| state.mass_matrix(shared));
        if let Some((linear, angular)) = impulse::velocity_change(&mass, body, impulse, lever) {
            body.set_linvel(body.linvel() + linear, true);
            body.set_angvel(body.angvel() + angular, true);
            // One that slept is not listed as active before rapier's next step.
            self.registry.newcomers.push(handle);
        }
    }

    /// Multiplies the forces of a body's law, from the next step on (default 1): the control parameters c̃
    /// of the pattern-driven method, as [`FreeBody::control`](crate::FreeBody::control). A series that the
    /// body replays is stopped.
    ///
    /// Unknown handles, and factors that [`ForceFactors::check`] refuses, are ignored.
    ///
    /// ```
    /// use rapier3d_immersed::rapier3d::prelude::*;
    /// use rapier3d_immersed::{Fluid, ForceFactors, HydroProperties, Immersion};
    ///
    /// let mut world = PhysicsWorld::new();
    /// let leaf = ColliderBuilder::cuboid(0.0365, 0.00015, 0.021).density(300.0);
    /// let (leaf, _) = world.insert(RigidBodyBuilder::dynamic(), leaf);
    /// let hydro = HydroProperties::from_body(&world.bodies, &world.colliders, leaf)?;
    /// let mut immersion = Immersion::new(Fluid::AIR);
    /// immersion.insert(leaf, hydro);
    /// immersion.set_control(leaf, ForceFactors { drag: 3.0, ..ForceFactors::ONE });
    /// assert_eq!(immersion.control(leaf).unwrap().drag, 3.0);
    /// # Ok::<(), rapier3d_immersed::Error>(())
    /// ```
    pub fn set_control(&mut self, handle: RigidBodyHandle, factors: ForceFactors) {
        if let Some(state) = self.registry.get_mut(handle) {
            state.control.set(factors);
        }
    }

    /// The factors on the forces of a body's law: those that were set or, during a replay, those of the last
    /// step.
    pub fn control(&self, handle: RigidBodyHandle) -> Option<ForceFactors> {
        self.registry.get(handle).map(|state| state.control.factors)
    }

    /// Lets a body replay a series from its beginning, at the next step; after its last entry that one
    /// stays. The body must be what the series was planned for: [`Immersion::replay_planned`] checks that. A body that is held by a joint or has locked axes counts
    /// as touching: under [`OnContact::Restart`] its series begins when it is free, under [`OnContact::Stop`]
    /// it ends at once. Unknown handles are ignored.
    pub fn replay(
        &mut self,
        handle: RigidBodyHandle,
        series: &ControlSeries,
        on_contact: OnContact,
    ) {
        let Some(index) = self.registry.index(handle) else {
            return;
        };
        let states = self.registry.states().iter().flatten();
        let used = || states.filter_map(|state| state.control.series());
        let series = self.series.intern(series.clone(), used);
        if let Some(state) = self.registry.at_mut(index) {
            state.control.replay(series, on_contact);
        }
    }

    /// Stops the series that a body replays: it goes on under its own law. Nothing to stop is no error.
    pub fn stop_replay(&mut self, handle: RigidBodyHandle) {
        if let Some(state) = self.registry.get_mut(handle) {
            state.control.stop();
        }
    }

    /// How far a body has come in the series that it replays, s; `None` if it replays none.
    pub fn replay_time(&self, handle: RigidBodyHandle) -> Option<f64> {
        self.registry.get(handle)?.control.time()
    }
}
