//! What users change of a body that is in the fluid: its colliders, their shapes, poses and masses, its
//! additional mass, its switches.
//!
//! Rapier keeps to itself what was changed, so that each step compares each body that it moves with what it
//! was ([`SavedProperties::still_holds`]), and each look at the others does. A changed body is given back to
//! rapier but for what the user has set, read anew, and immersed anew, at once.

use super::admission::Admission;
use super::body_look::{BodyChanges, KeptCollider};
use super::rapier_sets::RapierSets;
use super::saved_properties::{Difference, SavedProperties};
use super::warning::Warning;
use crate::body::{Division, ImmersedBody};
use crate::error::Error;
use crate::hydro::HydroProperties;
use rapier3d::na::Vector3;

impl Admission<'_> {
    /// Looks at a body in the fluid that may have changed, and moves it in this step.
    pub fn take_over(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let handle = state.handle;
        let (Some(saved), Some(body)) = (&mut state.saved, sets.bodies.get(handle)) else {
            return;
        };
        if saved.difference(body, sets.colliders) == Difference::Nothing {
            // Nothing but a snapshot that was loaded.
            self.registry.newcomers.push(handle);
        } else if self.changes == BodyChanges::Ignore {
            self.ignore_change(index, sets);
        } else {
            self.wake(handle, sets);
            self.give_back(index, sets);
            self.enter_or_leave(index, sets);
        }
    }

    /// Lets a body that has changed go on as it was.
    fn ignore_change(&mut self, index: usize, sets: &mut RapierSets) {
        let Some(state) = self.registry.at_mut(index) else {
            return;
        };
        let handle = state.handle;
        let Some(saved) = state.saved.take() else {
            return;
        };
        saved.restore(handle, sets.bodies, sets.colliders);
        let (Some(shared), Some(body)) =
            (self.constants.get(state.constants), sets.bodies.get(handle))
        else {
            return;
        };
        let mut kept = SavedProperties::with_mass(saved.dry, body, sets.colliders);
        let mass = state.flight.solver_mass.into();
        kept.immerse(shared, mass, handle, sets.bodies, sets.colliders);
        state.saved = Some(Box::new(kept));
        if !std::mem::replace(&mut state.warned.change_ignored, true) {
            self.warnings.push(Warning::ChangeIgnored { body: handle });
        }
        self.registry.newcomers.push(handle);
    }

    /// Describes a body anew that comes back to the fluid as another shape than it left as, if what
    /// described it was made of its shape.
    ///
    /// # Errors
    /// Those of [`HydroProperties::from_body`].
    pub fn follow_shape(&mut self, index: usize, sets: &RapierSets) -> Result<(), Error> {
        let Some(state) = self.registry.at_mut(index) else {
            return Ok(());
        };
        let Some(body) = sets.bodies.get(state.handle) else {
            return Ok(());
        };
        let Some(mut left) = state.left.take() else {
            return Ok(());
        };
        let mut followed = Ok(());
        if left.difference(body, sets.colliders) == Difference::Shape {
            followed = self.describe_anew(index, &left.colliders, sets);
            if followed.is_ok() {
                // From now on the description goes with these.
                left.colliders = KeptCollider::all_of(body, sets.colliders);
            }
        }
        if let Some(state) = self.registry.at_mut(index) {
            state.left = Some(left);
        }
        followed
    }

    /// Describes a body by its shape if its description was made of the shape that it had, and warns if
    /// not.
    fn describe_anew(
        &mut self,
        index: usize,
        before: &[KeptCollider],
        sets: &RapierSets,
    ) -> Result<(), Error> {
        let Some(state) = &self.registry.states()[index] else {
            return Ok(());
        };
        let (handle, warned) = (state.handle, state.warned.shape_kept);
        let Some(known) = self.registry.description(state) else {
            return Ok(());
        };
        let was = described(before, known.hydro.reference);
        let was = was.map(ImmersedBody::new);
        if was.is_ok_and(|was| was.hydro == known.hydro && was.parts == known.parts) {
            let hydro = HydroProperties::from_body(sets.bodies, sets.colliders, handle)?;
            let body = ImmersedBody {
                law: known.law,
                ..ImmersedBody::new(hydro)
            };
            self.warnings.push_scope(handle, &body, self.registry);
            let description = self.registry.describe(body);
            self.registry.redescribe(index, description);
        } else if !warned {
            if let Some(state) = self.registry.at_mut(index) {
                state.warned.shape_kept = true;
            }
            self.warnings.push(Warning::ShapeKept { body: handle });
        }
        Ok(())
    }
}

/// What [`HydroProperties::from_body`] made of colliders, referred to a point of the body's frame.
fn described(colliders: &[KeptCollider], point: Vector3<f64>) -> Result<HydroProperties, Error> {
    let solid = colliders.iter().filter(|kept| kept.is_solid());
    // A shape that is not known any more describes nothing.
    let parts = solid.map(|kept| Some((kept.pose, kept.shape.as_deref()?)));
    let parts: Vec<_> = parts.collect::<Option<_>>().ok_or(Error::NoCollider)?;
    HydroProperties::of_parts(&parts, point, Division::Automatic)
}
