//! The window without a window: its keys, its mouse, its panel.

mod hand;
mod keys;
mod panel;
