//! CPU benchmarks live in `benches/cpu.rs`; run them by `cargo bench -p genga-benches`.
