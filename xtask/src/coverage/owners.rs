//! Finds the targets whose tests are in a file.

use cargo_metadata::Package;
use cargo_metadata::camino::{Utf8Path, Utf8PathBuf};

use crate::parts::{Kind, Part, parts};

/// The parts with a test harness that a source file may belong to. A target's own file belongs to that target alone.
/// Any other file belongs to the targets in the nearest folder above it. If there are several, each of them may have
/// the file as a module, so all are returned.
pub(super) fn owners(package: &Package, file: &Utf8Path) -> Vec<Part> {
    let nearest = package.targets.iter().map(|target| {
        let folder = target.src_path.parent();
        let own = folder.filter(|folder| file.starts_with(folder));
        let depth = own.map_or(0, |folder| folder.components().count());
        let is_it = target.src_path == file;
        (is_it, depth)
    });
    let nearest = nearest.max().unwrap_or_default();
    let all = parts(package).into_iter();
    let with_harness = all.filter(|(part, target)| {
        let has_tests = matches!(part.kind, Kind::Library | Kind::Program | Kind::Test);
        has_tests && target.test && is_near(&target.src_path, file, nearest)
    });
    with_harness.map(|(part, _)| part).collect()
}

/// True if a target is as near to a file as the nearest target.
fn is_near(source: &Utf8PathBuf, file: &Utf8Path, (is_own, depth): (bool, usize)) -> bool {
    if is_own {
        return source == file;
    }
    let folder = source.parent().filter(|folder| file.starts_with(folder));
    folder.is_some_and(|folder| folder.components().count() == depth)
}
