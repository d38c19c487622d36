//! Climbers as physics engines see them.

mod body;
#[cfg(feature = "parry")]
mod clamp;
mod meeting;

pub use body::{ProxyBody, ProxyTouch};
pub use meeting::{ProxyMeeting, ProxyShare};
