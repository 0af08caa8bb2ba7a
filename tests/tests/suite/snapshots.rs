//! The pictures in `tests/suite`.

use genga_tests::snapshots::{cases, check};

#[test]
fn pictures_look_as_expected() {
    let cases = cases();
    assert!(cases.len() >= 8, "only {cases:?}");
    let faults: Vec<String> = cases.iter().filter_map(|case| check(case).err()).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
