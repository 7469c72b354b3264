//! Laws that wind and turbulence must obey, one module per law.

mod cavity;
mod fractional_step;
mod k_epsilon;
mod langevin;
mod rotation;
mod shipped_table;
mod taylor_green;
mod wind;
