//! Compiles one file of `cpp` for each library whose feature is on.

fn main() {
    println!("cargo::rerun-if-changed=cpp");
    #[cfg(feature = "bullet")]
    native::bullet();
    #[cfg(feature = "embree")]
    native::embree();
    #[cfg(feature = "fcl")]
    native::fcl();
}

#[cfg(any(feature = "bullet", feature = "embree", feature = "fcl"))]
#[expect(clippy::panic, reason = "how a build script says what is missing")]
mod native {
    use std::path::{Path, PathBuf};

    #[cfg(feature = "bullet")]
    pub(super) fn bullet() {
        let found = probe("bullet", "libbullet-dev");
        compile("bullet", &found.include_paths);
        // The peer calls only these two of Bullet's libraries.
        println!("cargo::rustc-link-lib=BulletCollision");
        println!("cargo::rustc-link-lib=LinearMath");
    }

    #[cfg(feature = "embree")]
    pub(super) fn embree() {
        // Embree has no file for pkg-config.
        if !Path::new("/usr/include/embree3/rtcore.h").exists() {
            missing(
                "embree",
                "libembree-dev",
                "no /usr/include/embree3/rtcore.h",
            );
        }
        compile("embree", &[]);
        println!("cargo::rustc-link-lib=embree3");
    }

    #[cfg(feature = "fcl")]
    pub(super) fn fcl() {
        let found = probe("fcl", "libfcl-dev");
        compile("fcl", &found.include_paths);
        println!("cargo::rustc-link-lib=fcl");
        println!("cargo::rustc-link-lib=ccd");
    }

    /// Finds a library. The callers print the libraries to link, since these must come after this crate's own archive.
    #[cfg(any(feature = "bullet", feature = "fcl"))]
    fn probe(library: &str, package: &str) -> pkg_config::Library {
        let found = pkg_config::Config::new()
            .cargo_metadata(false)
            .probe(library);
        match found {
            Ok(found) => found,
            Err(error) => missing(library, package, &error.to_string()),
        }
    }

    fn missing(library: &str, package: &str, why: &str) -> ! {
        panic!("the feature `{library}` needs a Debian package: apt-get install {package}\n{why}");
    }

    /// Compiles a library's file, optimised in every profile, so that a debug build measures the library itself.
    fn compile(library: &str, headers: &[PathBuf]) {
        let mut build = cc::Build::new();
        build
            .cpp(true)
            .std("c++17")
            .opt_level(2)
            // This warning is about FCL's contacts, which the compiler inlines.
            .flag_if_supported("-Wno-maybe-uninitialized")
            .file(format!("cpp/{library}.cpp"));
        // The compiler searches this folder by default. With `-isystem`, the folder would come before the compiler's
        // own headers, which expect it after them.
        let searched = Path::new("/usr/include");
        for folder in headers.iter().filter(|folder| *folder != searched) {
            // The compiler shows no warnings of system headers.
            build.flag("-isystem").flag(folder.display().to_string());
        }
        build.compile(&format!("clamber_peers_{library}"));
    }
}
