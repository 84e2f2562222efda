//! Tests of stress under contacts: against published values, independent quadrature and the equations of elasticity.

mod curvature;
mod extremes;
mod halfspace;
mod near_field;
mod quadrature;
mod strips;
