//! What the examples share is tested here: examples themselves have no tests.

#[path = "../../examples/support/mod.rs"]
mod support;

mod airplane;
mod animation;
mod falls;
mod leaves;
mod meshes;
mod pages;
mod specimens;
