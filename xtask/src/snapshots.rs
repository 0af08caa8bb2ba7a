//! `cargo xtask snapshots`: looking through pictures that differ from the expected ones, and
//! taking them over.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::{Error, Result};

/// Where failing tests leave `actual.png`, `expected.png` and `difference.png`, by area and case.
const RESULTS: &str = "out/snapshots";
/// Where the expected pictures are, by area and case.
const SUITE: &str = "tests/suite";

/// Lists what differs, writes a page to compare it on, and with `update` takes it over.
pub(crate) fn snapshots(root: &Path, update: bool) -> Result<()> {
    let results = root.join(RESULTS);
    let mut cases = Vec::new();
    if results.is_dir() {
        find_cases(&results, Path::new(""), &mut cases)?;
    }
    if cases.is_empty() {
        println!("No test has left a picture that differs in {RESULTS}.");
        return Ok(());
    }
    for case in &cases {
        println!("{}", case.display());
    }
    if !update {
        let page = results.join("index.html");
        fs::write(&page, review_page(&cases)).map_err(Error::io("cannot write", &page))?;
        println!("\nCompare them on {}", page.display());
        println!("then take all of them over with `cargo xtask snapshots --update`.");
        return Ok(());
    }
    for case in &cases {
        let (from, to) = (results.join(case), root.join(SUITE).join(case));
        fs::create_dir_all(&to).map_err(Error::io("cannot make the folder", &to))?;
        let picture = to.join("expected.png");
        fs::copy(from.join("actual.png"), &picture).map_err(Error::io("cannot write", &picture))?;
        fs::remove_dir_all(&from).map_err(Error::io("cannot remove", &from))?;
    }
    println!("\n{} pictures taken over into {SUITE}.", cases.len());
    Ok(())
}

/// Finds the folders under `results/case` that hold an `actual.png`, as paths below `results`.
fn find_cases(results: &Path, case: &Path, cases: &mut Vec<PathBuf>) -> Result<()> {
    let folder = results.join(case);
    if folder.join("actual.png").is_file() {
        cases.push(case.to_owned());
    }
    let list = || fs::read_dir(&folder)?.collect::<std::io::Result<Vec<_>>>();
    let mut entries = list().map_err(Error::io("cannot list", &folder))?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        if entry.path().is_dir() {
            find_cases(results, &case.join(entry.file_name()), cases)?;
        }
    }
    Ok(())
}

fn review_page(cases: &[PathBuf]) -> String {
    let mut page = String::from(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>Snapshots</title>\n\
         <style>\nbody { font: 16px sans-serif; margin: 2em }\nfigure { display: inline-block }\n\
         img { width: 384px; image-rendering: pixelated; background: #ccc }\n</style>\n",
    );
    for case in cases {
        let case = case.display();
        // Writing to a string cannot fail.
        let _ = writeln!(page, "<h2>{case}</h2>");
        for kind in ["expected", "actual", "difference"] {
            let _ = writeln!(
                page,
                "<figure><img src=\"{case}/{kind}.png\" alt=\"none\">\
                 <figcaption>{kind}</figcaption></figure>"
            );
        }
    }
    page.push_str("</html>\n");
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_update_takes_over_what_differs_and_nothing_else() {
        let root = std::env::temp_dir().join(format!("genga-snapshots-{}", std::process::id()));
        let result = root.join(RESULTS).join("lines/cube");
        let expected = root.join(SUITE).join("lines/cube/expected.png");
        let other = root.join(SUITE).join("lines/ball/expected.png");
        for file in [&result.join("actual.png"), &expected, &other] {
            fs::create_dir_all(file.parent().unwrap()).unwrap();
        }
        fs::write(result.join("actual.png"), "new").unwrap();
        fs::write(&expected, "old").unwrap();
        fs::write(&other, "old").unwrap();

        snapshots(&root, false).unwrap();
        assert_eq!(fs::read_to_string(&expected).unwrap(), "old");
        let page = fs::read_to_string(root.join(RESULTS).join("index.html")).unwrap();
        assert!(page.contains("lines/cube/actual.png"));

        snapshots(&root, true).unwrap();
        assert_eq!(fs::read_to_string(&expected).unwrap(), "new");
        assert_eq!(fs::read_to_string(&other).unwrap(), "old");
        assert!(!result.exists());
        snapshots(&root, true).unwrap();
        fs::remove_dir_all(&root).unwrap();
    }
}
