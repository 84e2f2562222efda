//! Tests of stress under contacts: against published values, independent quadrature and the equations of elasticity.

mod extremes;
mod halfspace;
mod quadrature;
