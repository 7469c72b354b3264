//! The window without a window: its keys, its mouse, its panel.

mod events;
mod keys;
mod panel;
mod pointer;
