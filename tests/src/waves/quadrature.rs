//! Adaptive quadrature by Gauss and Kronrod's rules of 7 and 15 points.

const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_22,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

/// ∫ f from the first to the last of `marks`, which rise, to a relative error of about 1e-7.
pub(super) fn integral(f: &dyn Fn(f64) -> f64, marks: &[f64]) -> f64 {
    let rough: Vec<(f64, f64)> = marks.windows(2).map(|m| rule(f, m[0], m[1])).collect();
    let total: f64 = rough.iter().map(|r| r.0).sum();
    let pieces = rough.len().max(1) as f64;
    let allowed = 1e-7 * total.abs() / pieces;
    marks
        .windows(2)
        .zip(rough)
        .map(|(m, first)| refined(f, m[0], m[1], first, allowed.max(1e-14), 30))
        .sum()
}

fn refined(
    f: &dyn Fn(f64) -> f64,
    a: f64,
    b: f64,
    (value, error): (f64, f64),
    allowed: f64,
    depth: u32,
) -> f64 {
    if error <= allowed || depth == 0 {
        return value;
    }
    let m = 0.5 * (a + b);
    refined(f, a, m, rule(f, a, m), 0.5 * allowed, depth - 1)
        + refined(f, m, b, rule(f, m, b), 0.5 * allowed, depth - 1)
}

/// Kronrod's value and its difference from Gauss's.
fn rule(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let (mut kronrod, mut gauss) = (0.0, 0.0);
    for (i, (node, weight)) in NODES.iter().zip(KRONROD).enumerate() {
        let sum = if *node == 0.0 {
            f(middle)
        } else {
            f(middle - half * node) + f(middle + half * node)
        };
        kronrod += weight * sum;
        if i % 2 == 1 {
            gauss += GAUSS[i / 2] * sum;
        }
    }
    (kronrod * half, (kronrod - gauss).abs() * half)
}
