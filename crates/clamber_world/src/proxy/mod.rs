//! Climbers as physics engines see them.

mod body;
mod meeting;

pub use body::{ProxyBody, ProxyTouch};
pub use meeting::{ProxyMeeting, ProxyShare};
