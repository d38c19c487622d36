//! Compares every query of a surface with a reference, bit for bit.
//!
//! A [`Question`] is a query with its arguments in plain numbers. Its answer is a list of [`Found`]. Each
//! implementation that is compared implements [`Answers`]. [`Aims`] makes questions around any triangles. A
//! [`Comparison`] asks a reference, and then any number of other implementations; [`Agreement`] counts the results.
//!
//! ```
//! use clamber_verify::agreement::{Aims, Agreement, Answers, Comparison, Found, Question};
//! use clamber_verify::glam::Vec3;
//!
//! /// Answers only one kind of question: whether a ray meets anything within a distance.
//! struct Floor {
//!     height: f32,
//! }
//!
//! impl Answers for Floor {
//!     fn answer(&self, question: &Question, found: &mut Vec<Found>) {
//!         if let Question::IntersectsRay(line) = question {
//!             let way = line.direction.normalize_or_zero().y;
//!             let distance = (self.height - line.origin.y) / way;
//!             let is_met = distance >= 0.0 && distance <= line.max_distance;
//!             found.extend(is_met.then_some(Found::Any));
//!         }
//!     }
//! }
//!
//! let triangles = [[Vec3::ZERO, Vec3::X, Vec3::Z]];
//! let mut rng = fastrand::Rng::with_seed(1);
//! let mut questions = Vec::new();
//! Aims::new(&triangles, 1.0, &mut rng).all(&mut questions);
//! let mut comparison = Comparison::default();
//! let mut agreement = Agreement::default();
//! for question in &questions {
//!     comparison.ask(&Floor { height: 0.0 }, question);
//!     agreement.count(comparison.hold(&Floor { height: 0.0 }));
//! }
//! assert_eq!((agreement.questions, agreement.disagreements), (questions.len(), 0));
//!
//! // An implementation that finds nothing is found out.
//! struct Nothing;
//!
//! impl Answers for Nothing {
//!     fn answer(&self, _: &Question, _: &mut Vec<Found>) {}
//! }
//!
//! agreement.compare(&Floor { height: 0.0 }, &Nothing, &questions);
//! assert!(agreement.disagreements > 0);
//! ```

mod aims;
mod answer;
mod comparison;
mod question;

pub use aims::{Aims, extent, point_of, weights};
pub use answer::{Found, Hit};
pub use comparison::{Agreement, Answers, Comparison, Disagreement};
pub use question::{Among, Cast, Line, Question, Shape};
