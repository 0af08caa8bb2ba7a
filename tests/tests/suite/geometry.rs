//! Deformation and projection against f64 on the processor.
