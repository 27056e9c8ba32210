//! The demos against their golden pictures, exactly: `demos/golden/NAME.png`.
//!
//! A demo that changed on purpose gets a new golden with `zga capture NAME --golden demos/golden
//! --update`, which is looked at before it is committed.

use std::path::Path;
use std::process::Command;

#[test]
fn demos_all_equal_their_goldens() {
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let differing: Vec<_> = zga_demos::demos::DEMOS
        .iter()
        .map(|demo| demo.name)
        .filter(|name| {
            let mut zga = Command::new(env!("CARGO_BIN_EXE_zga"));
            let output = zga.args(["capture", name, "--golden"]).arg(&golden).output();
            !output.is_ok_and(|output| output.status.success())
        })
        .collect();
    assert_eq!(differing, Vec::<&str>::new());
}
