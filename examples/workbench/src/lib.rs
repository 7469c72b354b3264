//! A workbench: place and throw bodies, change the fluid under them, see the forces on them, and go back in time.
//!
//! [`Bench`] is the whole of it: every [`Command`] is applied to it, so that whatever a window may ask for a test can do.

mod bench;
mod change;
mod dress;
mod film;
mod forces;
mod history;
mod kinds;
mod methods;
mod path;
mod phase;
mod saved;
mod settings;
mod state;
#[path = "../../support/mod.rs"]
mod support;
mod view;
#[cfg(feature = "window")]
pub mod window;

pub use bench::{Bench, Command, LONGEST_FALL};
pub use change::{Change, Placement, Rain, Setting};
pub use forces::{Line, lines};
pub use kinds::{Shape, kind};
pub use methods::Method;
pub use path::Followed;
pub use phase::{Marker, Phase};
pub use saved::Saved;
pub use settings::{Fluids, Law, Settings, ranges};
pub use state::{Body, Drive, GRAVITY, State};
pub use view::View;

/// A vector in f64.
pub type Vec3 = support::Vec3;
