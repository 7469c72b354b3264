//! What the workbench promises.

mod commands;
mod methods;
mod time;
