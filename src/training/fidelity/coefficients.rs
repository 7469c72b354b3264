//! The coefficients that a search may change, and within which bounds.

use crate::hydro::viscous::{Coefficient, PhysicalLaw};

/// The coefficients of the default law that the measurements of falls decide about, with the limits
/// between which a search looks for them. Not among them are those of bodies that are not plates, which
/// have measurements of their own.
pub fn searched() -> impl Iterator<Item = (&'static Coefficient<PhysicalLaw>, [f64; 2])> {
    let rows = PhysicalLaw::COEFFICIENTS.iter();
    rows.filter_map(|row| row.search.map(|limits| (row, limits)))
}

/// The places of a law's coefficients between their limits, 0 to 1, in the order of [`searched`].
///
/// ```
/// use rapier3d_immersed::PhysicalLaw;
/// use rapier3d_immersed::training::fidelity::{law_at, places, searched};
///
/// // A search works in the unit cube: here from the default law a tenth along the first coefficient.
/// let mut at = places(&PhysicalLaw::default());
/// at[0] = (at[0] + 0.1).min(1.0);
/// let law = law_at(&at);
/// let (first, [low, high]) = searched().next().unwrap();
/// assert!((first.of(&law) - (low + (high - low) * at[0])).abs() < 1e-12);
/// ```
pub fn places(law: &PhysicalLaw) -> Vec<f64> {
    let place = |(row, [low, high]): (&Coefficient<PhysicalLaw>, [f64; 2])| {
        (row.of(law) - low) / (high - low)
    };
    searched().map(place).collect()
}

/// The default law with its coefficients at these places between their limits; places beyond 0 and 1
/// are brought back.
///
/// # Panics
/// If there are not as many places as [`searched`] has coefficients.
pub fn law_at(places: &[f64]) -> PhysicalLaw {
    assert_eq!(
        places.len(),
        searched().count(),
        "one place per coefficient"
    );
    let mut law = PhysicalLaw::default();
    for ((row, [low, high]), place) in searched().zip(places) {
        *(row.field)(&mut law) = low + (high - low) * place.clamp(0.0, 1.0);
    }
    law
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The default law is within the limits of its own search, and found again from its places.
    #[test]
    fn the_default_law_can_be_found() {
        let default = PhysicalLaw::default();
        let places = places(&default);
        assert!(places.iter().all(|place| (0.0..=1.0).contains(place)));
        let again = law_at(&places);
        for row in PhysicalLaw::COEFFICIENTS {
            assert!(
                (row.of(&again) - row.of(&default)).abs() < 1e-12,
                "{}",
                row.name
            );
        }
    }
}
