//! Apps without a window, one step per update: what immersed bodies do there.

mod changes;
mod contexts;
mod fall;
mod leaving;
mod plain;
mod reflection;
mod support;
mod time;
mod warnings;
