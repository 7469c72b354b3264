//! The questionnaire of the example `methods` gives the E of thesis (7.1).

use std::process::Command;

/// Its numbers are computed in the page, and so in Node here, where there is one.
#[test]
fn the_questionnaire_gives_7_1() {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/browser/scoring.mjs");
    let Ok(output) = Command::new("node").arg(script).output() else {
        println!("not tested: there is no node");
        return;
    };
    let problem = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{problem}");
}
