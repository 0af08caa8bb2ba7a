//! Where lines must be, in f64, and figures of how drawn ones lie on them.
//!
//! [`mod@expected`] says which pieces of a mesh are lines in a view, [`cuts`] where objects run into
//! each other, [`mod@places`] which parts of them can be seen, [`figures`] what is drawn of them.

pub mod broad;
pub mod capsules;
pub mod cuts;
pub mod expected;
pub mod figures;
pub mod holes;
pub mod ink;
pub mod motion;
pub mod outline;
pub mod places;
pub mod show;
pub mod subjects;

pub use expected::{Kind, Line, expected};
pub use figures::{Figures, measure, measure_owners};
pub use places::{Place, places};
