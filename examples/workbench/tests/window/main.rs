//! The window without a window: its keys, its mouse, its panel.

mod events;
mod hand;
mod keys;
mod panel;
