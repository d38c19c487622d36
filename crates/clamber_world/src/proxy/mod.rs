//! Climbers as physics engines see them.

mod body;
#[cfg(feature = "parry")]
mod clamp;
mod impact;
mod meeting;

pub use body::{ProxyBody, ProxyTouch};
pub use impact::ProxyImpact;
pub use meeting::{ProxyMeeting, ProxyShare};
