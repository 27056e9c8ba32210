//! Find: the X server, and the module for it.

use std::path::{Path, PathBuf};

use super::SessionError;

/// The X server: the program itself, which needs no rights, not the wrapper of the same name.
pub const SERVER: &str = "/usr/lib/xorg/Xorg";

/// File name of the module.
pub const MODULE: &str = "zga_drv.so";

/// Where modules of the system are.
pub(super) const SYSTEM_MODULES: &str = "/usr/lib/xorg/modules";

/// The server, if it is there.
pub(super) fn server() -> Result<&'static Path, SessionError> {
    let path = Path::new(SERVER);
    match path.is_file() {
        true => Ok(path),
        false => Err(SessionError::NoServer { path: path.to_path_buf() }),
    }
}

/// The module: `named` if a place is named (a file, or the folder of [`MODULE`]), else beside the running program, one folder
/// above it (where Cargo puts examples and tests), in target/release, or where the system has its drivers.
///
/// # Errors
/// [`SessionError::NoModule`] with all places.
pub fn find_module(named: Option<&Path>) -> Result<PathBuf, SessionError> {
    let tried: Vec<PathBuf> = match named {
        Some(path) if path.is_dir() => vec![path.join(MODULE)],
        Some(path) => vec![path.to_path_buf()],
        None => {
            let program = std::env::current_exe().unwrap_or_default();
            let beside = program.ancestors().skip(1).take(2).map(|folder| folder.join(MODULE));
            let others = ["target/release".into(), PathBuf::from(SYSTEM_MODULES).join("drivers")];
            beside.chain(others.map(|folder: PathBuf| folder.join(MODULE))).collect()
        }
    };
    match tried.iter().find(|path| path.is_file()) {
        Some(path) => std::path::absolute(path).map_err(|reason| SessionError::System {
            path: path.clone(),
            doing: "has no absolute path",
            reason,
        }),
        None => Err(SessionError::NoModule { tried }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn module_that_is_nowhere_is_told_with_places_and_remedy() {
        let nowhere = Path::new("/nonexistent/zga_drv.so");
        let told = find_module(Some(nowhere)).expect_err("nowhere").to_string();
        for part in ["/nonexistent/zga_drv.so", "ddx-shim/setup.sh", "ddx-shim/test.sh build", "--module"] {
            assert!(told.contains(part), "{part} in {told}");
        }
    }

    #[test]
    fn module_is_found_by_its_file_and_by_its_folder() {
        let folder = std::env::temp_dir().join(format!("zga-find-{}", std::process::id()));
        std::fs::create_dir(&folder).expect("folder");
        let file = folder.join(MODULE);
        std::fs::write(&file, "").expect("file");
        assert_eq!(find_module(Some(&folder)).expect("by folder"), file);
        assert_eq!(find_module(Some(&file)).expect("by file"), file);
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
