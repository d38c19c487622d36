//! clamber's own messages. foxglove's `Encode` makes their schemas, prost writes and reads those that are read back. In
//! both, field numbers follow the order of the fields.
//!
//! Every `f64` of a message that is read back is `required`: prost leaves out other numbers that equal zero, and so
//! loses the sign of a negative zero.

mod climber;
mod tick;
mod view;

pub(crate) use climber::{Input, State, Struck};
pub(crate) use tick::{ArenaTick, Report, Saved, Tick};
pub(crate) use view::{Brain, Named, Touched};

use glam::{DQuat, DVec3};

/// Declares a message: each field with its type and prost's description of it. `of Type` also implements [`Mirror`] for
/// a type with the same fields.
macro_rules! message {
    ($(#[$doc:meta])* $name:ident {
        $($(#[$about:meta])* $field:ident: $type:ident $(<$inner:ident>)? ($($prost:tt)+),)+
    }) => {
        $(#[$doc])*
        #[derive(Clone, PartialEq, foxglove::Encode, prost::Message)]
        pub(crate) struct $name {
            $($(#[$about])* #[prost($($prost)+)] pub(crate) $field: $type $(<$inner>)?,)+
        }
    };
    ($(#[$doc:meta])* $name:ident of $own:ident {
        $($(#[$about:meta])* $field:ident: $type:ident $(<$inner:ident>)? ($($prost:tt)+),)+
    }) => {
        message!($(#[$doc])* $name {
            $($(#[$about])* $field: $type $(<$inner>)? ($($prost)+),)+
        });

        impl Mirror<$own> for $name {
            fn of(own: &$own) -> Self {
                Self { $($field: Mirror::of(&own.$field),)+ }
            }

            fn own(&self) -> Result<$own, String> {
                Ok($own { $($field: self.$field.own()?,)+ })
            }
        }
    };
}
use message;

/// A part of a message that stands for a value of another crate's type `T`, bit for bit.
pub(crate) trait Mirror<T> {
    /// The message of a value.
    fn of(own: &T) -> Self;

    /// The value of a message; `Err` says why there is none.
    fn own(&self) -> Result<T, String>;
}

macro_rules! mirror_themselves {
    ($($type:ty),+) => {
        $(impl Mirror<$type> for $type {
            fn of(own: &$type) -> Self {
                *own
            }

            fn own(&self) -> Result<$type, String> {
                Ok(*self)
            }
        })+
    };
}
mirror_themselves!(bool, f64, u32, u64);

impl<T, M: Mirror<T>> Mirror<Option<T>> for Option<M> {
    fn of(own: &Option<T>) -> Self {
        own.as_ref().map(M::of)
    }

    fn own(&self) -> Result<Option<T>, String> {
        self.as_ref().map(M::own).transpose()
    }
}

impl<const N: usize> Mirror<[f64; N]> for Vec<f64> {
    fn of(own: &[f64; N]) -> Self {
        own.to_vec()
    }

    fn own(&self) -> Result<[f64; N], String> {
        let numbers = self.as_slice().try_into();
        numbers.map_err(|_| format!("{} numbers where {N} were expected", self.len()))
    }
}

message! {
    /// A vector, in world space unless its field says otherwise.
    Vector of DVec3 {
        x: f64 (double, required, tag = 1),
        y: f64 (double, required, tag = 2),
        z: f64 (double, required, tag = 3),
    }
}

message! {
    /// A rotation as a quaternion.
    Rotation of DQuat {
        x: f64 (double, required, tag = 1),
        y: f64 (double, required, tag = 2),
        z: f64 (double, required, tag = 3),
        w: f64 (double, required, tag = 4),
    }
}

#[cfg(test)]
mod tests;
