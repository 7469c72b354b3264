//! The coefficients that a search may change, and within which bounds.

use crate::PhysicalLaw;

/// One coefficient of the default law.
#[derive(Clone, Copy, Debug)]
pub struct Coefficient {
    /// Name of the field.
    pub name: &'static str,
    /// Bounds of the search.
    pub bounds: [f64; 2],
    field: fn(&mut PhysicalLaw) -> &mut f64,
}

macro_rules! coefficients {
    ($($name:ident $low:literal $high:literal)*) => {
        /// Those that the measurements decide about. Not among them are the coefficients of creeping
        /// flow and of bodies that are not plates, which have measurements of their own.
        pub const COEFFICIENTS: &[Coefficient] = &[$(Coefficient {
            name: stringify!($name),
            bounds: [$low, $high],
            field: |law| &mut law.$name,
        }),*];
    };
}

coefficients! {
    pressure_travel 0.0 0.3
    attached_lift 1.5 7.0
    attached_aspect 0.3 6.0
    stalled_lift 0.2 3.0
    stalled_aspect 0.0 6.0
    stall_sine 0.2 1.5
    stall_width 0.05 1.2
    rotational_lift 0.2 4.0
    rotational_aspect 0.0 12.0
    rotational_stall 0.0 1.0
    munk 0.0 1.0
    translation_damping 0.0 1.5
    rotation_damping 0.0 10.0
    friction 1.0 9.0
    edge_drag 0.0 2.0
    lift_onset 50.0 140.0
    damping_onset 0.0 60.0
    suction_loss 0.0 1.3
    induced_drag 0.0 3.0
}

impl Coefficient {
    /// Its value in a law.
    pub fn of(&self, law: &PhysicalLaw) -> f64 {
        *(self.field)(&mut law.clone())
    }

    /// Its place between its bounds in a law, 0 to 1.
    pub fn place(&self, law: &PhysicalLaw) -> f64 {
        let [low, high] = self.bounds;
        (self.of(law) - low) / (high - low)
    }
}

/// The default law with its coefficients at these places between their bounds; places beyond 0 and 1
/// are brought back.
///
/// # Panics
/// If there are not as many places as [`COEFFICIENTS`].
pub fn law_at(places: &[f64]) -> PhysicalLaw {
    assert_eq!(
        places.len(),
        COEFFICIENTS.len(),
        "one place per coefficient"
    );
    let mut law = PhysicalLaw::default();
    for (coefficient, place) in COEFFICIENTS.iter().zip(places) {
        let [low, high] = coefficient.bounds;
        *(coefficient.field)(&mut law) = low + (high - low) * place.clamp(0.0, 1.0);
    }
    law
}
