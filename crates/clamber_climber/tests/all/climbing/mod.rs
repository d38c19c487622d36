//! Gripping, climbing, hanging, ledges, and being shaken off.

mod catching;
mod corners;
mod crushing;
mod feet;
mod gripping;
mod hanging;
mod ledges;
mod lying;
mod shaking;
