//! What `scripts/drivers.sh install` brings, where it was run.

use std::path::PathBuf;

/// A place in the folder where the script puts everything, if it is there.
pub fn find(path: &str) -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).map(PathBuf::from);
    let cache = || set("XDG_CACHE_HOME").or_else(|| Some(set("HOME")?.join(".cache")));
    let folder = set("SHADOWS_DRIVERS").or_else(|| Some(cache()?.join("shadows-drivers")))?;
    let found = folder.join(path);
    found.exists().then_some(found)
}

/// A command of this name, there or in `PATH`.
pub fn command(name: &str) -> Option<PathBuf> {
    find(&format!("validators/usr/bin/{name}")).or_else(|| {
        let path = std::env::var_os("PATH")?;
        let places = std::env::split_paths(&path).map(|folder| folder.join(name));
        places.into_iter().find(|file| file.is_file())
    })
}

/// An empty folder for files of one test.
pub fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
