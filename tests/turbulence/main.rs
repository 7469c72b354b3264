//! Laws that wind and turbulence must obey, one module per law.

mod cavity;
mod k_epsilon;

mod langevin;
mod taylor_green;
mod wind;
