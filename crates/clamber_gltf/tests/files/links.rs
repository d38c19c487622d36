//! Symbolic links in a model's folder: an untrusted document must not read files outside the folder.

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use clamber_gltf::{GltfErrorKind, load};

use crate::builder::File;

/// A model's folder, and a folder beside it with a buffer that the model must not read.
struct Folders {
    root: PathBuf,
    file: File,
}

impl Folders {
    fn new(name: &str) -> Self {
        let root =
            std::env::temp_dir().join(format!("clamber-links-{name}-{}", std::process::id()));
        let file = File::square();
        for folder in ["model/parts", "elsewhere"] {
            std::fs::create_dir_all(root.join(folder)).unwrap();
            std::fs::write(root.join(folder).join("data.bin"), &file.bytes).unwrap();
        }
        Self { root, file }
    }

    /// Makes a link in the model's folder.
    fn link(&self, target: impl AsRef<Path>, name: &str) {
        symlink(target, self.root.join("model").join(name)).unwrap();
    }

    /// Writes a document whose only buffer is at `uri`.
    fn document(&self, uri: &str) -> PathBuf {
        let document = self.root.join("model/square.gltf");
        std::fs::write(&document, self.file.gltf(uri)).unwrap();
        document
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.root);
    }
}

#[test]
fn links_that_lead_out_of_the_folder_are_refused() {
    let folders = Folders::new("out");
    folders.link(folders.root.join("elsewhere/data.bin"), "absolute.bin");
    folders.link("../elsewhere/data.bin", "relative.bin");
    folders.link("../elsewhere", "folder");
    folders.link("relative.bin", "twice.bin");
    folders.link("../model-beside.bin", "prefix.bin");
    // As text, the target's path begins with the folder's path, but the target is not in the folder.
    std::fs::write(folders.root.join("model-beside.bin"), &folders.file.bytes).unwrap();
    folders.link("/dev/zero", "endless.bin");
    for uri in [
        "absolute.bin",
        "relative.bin",
        "folder/data.bin",
        "./folder/./data.bin",
        "twice.bin",
        "prefix.bin",
        "endless.bin",
    ] {
        let document = folders.document(uri);
        let error = load(&document).map(|_| ()).unwrap_err();
        assert_eq!(error.path.as_ref(), Some(&document), "{uri}");
        let message = error.to_string();
        let GltfErrorKind::OutsideFolder { object, file, .. } = error.kind else {
            panic!("{uri}: {message}");
        };
        assert_eq!(object, "buffer 0", "{uri}");
        let wanted = folders.root.join("model").join(uri.replace("./", ""));
        assert_eq!(file, wanted, "{uri}");
        for part in [
            document.display().to_string(),
            object,
            file.display().to_string(),
        ] {
            assert!(message.contains(&part), "{uri}: {message} without {part}");
        }
    }
}

#[test]
fn links_that_stay_inside_the_folder_are_followed() {
    let folders = Folders::new("in");
    folders.link("parts/data.bin", "link.bin");
    folders.link("parts", "folder");
    folders.link("../model/parts/data.bin", "round.bin");
    for uri in ["link.bin", "folder/data.bin", "round.bin"] {
        load(folders.document(uri)).unwrap();
    }
}

#[test]
fn the_model_and_its_folder_may_be_links() {
    let folders = Folders::new("model");
    let document = folders.document("parts/data.bin");
    let beside = folders.root.join("model/link.gltf");
    symlink(&document, &beside).unwrap();
    load(&beside).unwrap();
    let folder = folders.root.join("linked");
    symlink(folders.root.join("model"), &folder).unwrap();
    load(folder.join("square.gltf")).unwrap();
    // The buffers are looked up beside the link, as in other programs.
    let apart = folders.root.join("elsewhere/link.gltf");
    symlink(folders.document("data.bin"), &apart).unwrap();
    load(&apart).unwrap();
}

#[test]
fn dangling_and_circular_links_cannot_be_read() {
    let folders = Folders::new("nowhere");
    folders.link("missing.bin", "dangling.bin");
    folders.link("loop.bin", "loop.bin");
    for uri in ["dangling.bin", "loop.bin"] {
        let error = load(folders.document(uri)).map(|_| ()).unwrap_err();
        assert!(matches!(error.kind, GltfErrorKind::Read { .. }), "{error}");
    }
}
