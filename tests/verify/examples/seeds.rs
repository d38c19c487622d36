//! Writes the seed file for fuzzing imports into a folder: `seeds fuzz/corpus/import`.

use std::io;
use std::path::PathBuf;

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        return Err(io::Error::other(
            "no folder given; usage: seeds fuzz/corpus/import",
        ));
    };
    std::fs::create_dir_all(&folder)?;
    let (json, binary) = clamber_verify::targets::square();
    std::fs::write(folder.join("square"), [&json[..], &[0], &binary].concat())
}
