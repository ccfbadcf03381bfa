//! Puts graphs, shaders and experiments into the package: a wheel contains no files from outside of its folder.

use std::fs;
use std::io::Result;
use std::path::Path;

fn main() -> Result<()> {
    let home = Path::new("conelab/home");
    if home.exists() {
        fs::remove_dir_all(home)?;
    }
    for name in ["passes", "shaders", "configs"] {
        let from = Path::new("..").join(name);
        println!("cargo::rerun-if-changed={}", from.display());
        copy(&from, &home.join(name))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let (entry, target) = (entry?.path(), to.to_path_buf());
        let target = target.join(entry.file_name().unwrap_or_default());
        if entry.is_dir() {
            copy(&entry, &target)?;
        } else {
            fs::copy(&entry, &target)?;
        }
    }
    Ok(())
}
