//! The set of immersed bodies: what users hold.

use super::admission::{self, Admission};
use super::body_look::BodyChanges;
use super::control::SeriesTable;
use super::environment::Environment;
use super::rapier_sets::RapierSets;
use super::registry::Registry;
use super::shared_constants::ConstantsTable;
use super::step::driver::{self, StepParts};
use super::step::workspace::Workspace;
use super::warning::{Warning, Warnings};
use crate::body::ImmersedBody;
use crate::dynamics::Integrator;
use crate::medium::Medium;
use rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use rapier3d::geometry::ColliderSet;
use rapier3d::pipeline::{EventHandler, PhysicsHooks, PhysicsWorld};

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
/// With the feature `serde-serialize` a snapshot holds all but flow, turbulence and surface, which are set again.
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
    /// An empty set in a [`Fluid`](crate::Fluid) at rest, or in another [`Medium`].
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

    /// Warns of a medium that would not stay as it is.
    pub(super) fn warn_of_medium(&mut self) {
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
}
