//! Writes what fuzzing of imports starts from into a folder: `seeds fuzz/corpus/import`.

use std::io;
use std::path::PathBuf;

fn main() -> io::Result<()> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.ok_or_else(|| io::Error::other("which folder?"))?;
    std::fs::create_dir_all(&folder)?;
    let (json, binary) = clamber_fuzz::square();
    std::fs::write(folder.join("square"), [&json[..], &[0], &binary].concat())
}
