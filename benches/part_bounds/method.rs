//! The methods of bounding all parts of a creature in one pose.

use std::fmt;

use clamber::geometry::{Similarity, Sphere};
use clamber::mesh::PartId;
use clamber::rig::Palette;
use clamber::skin::skin_into;
use clamber::surface::SkinnedSurface;
use clamber_scenes::part_bounds::{BoundingCapsule, BoundingVolume, JointMaps, NodeBounds};
use glam::Vec3;

use crate::poses::Subject;
use crate::precomputed::model_from_joint;

/// The way in which bounds are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Precomputed,
    Refitted,
    PaletteHull,
    PaletteInterval,
    /// The library's own bounds of parts: spheres, eight at a time in f32.
    Surface,
    /// From the palette: capsules by hull or by weight interval, whichever is smaller.
    Palette,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Sphere,
    Capsule,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Method {
    pub(crate) source: Source,
    pub(crate) shape: Shape,
}

const fn method(source: Source, shape: Shape) -> Method {
    Method { source, shape }
}

/// All measured methods.
pub(crate) const METHODS: [Method; 8] = [
    method(Source::Precomputed, Shape::Sphere),
    method(Source::Precomputed, Shape::Capsule),
    method(Source::Refitted, Shape::Sphere),
    method(Source::Refitted, Shape::Capsule),
    method(Source::PaletteHull, Shape::Sphere),
    method(Source::PaletteInterval, Shape::Sphere),
    method(Source::Surface, Shape::Sphere),
    method(Source::Palette, Shape::Capsule),
];

/// Memory that is reused from tick to tick.
pub(crate) struct Workspace {
    surface: SkinnedSurface,
    maps: JointMaps,
    positions: Vec<Vec3>,
    /// The bound of each part; `None` for a part without a bound.
    pub(crate) volumes: Vec<Option<BoundingVolume>>,
}

impl Workspace {
    pub(crate) fn new(subject: &Subject) -> Self {
        Self {
            surface: SkinnedSurface::new(subject.creature.collider.clone()),
            maps: JointMaps::default(),
            positions: Vec::new(),
            volumes: Vec::new(),
        }
    }

    /// Advances the surface by a tick, and reads its spheres of parts.
    fn ask(&mut self, palette: &Palette) {
        let advanced = self.surface.advance(palette, Similarity::IDENTITY);
        assert_eq!(advanced, Ok(()));
        self.volumes.resize(self.surface.mesh().parts().len(), None);
        for (part, sphere) in self.surface.in_model().part_spheres() {
            self.volumes[part.index()] = Some(BoundingVolume::Sphere(sphere));
        }
    }
}

impl Method {
    /// Bounds every part in the pose of a palette: one tick's work.
    ///
    /// # Panics
    /// If the palette does not fit the subject.
    pub(crate) fn bound(self, subject: &Subject, palette: &Palette, workspace: &mut Workspace) {
        workspace.volumes.clear();
        match self.source {
            Source::Precomputed => self.place(subject, palette, workspace),
            Source::Refitted => self.refit(subject, palette, workspace),
            Source::Surface => workspace.ask(palette),
            _ => self.derive(subject, palette, workspace),
        }
    }

    fn place(self, subject: &Subject, palette: &Palette, workspace: &mut Workspace) {
        let parts = subject.creature.collider.parts().iter().enumerate();
        workspace.volumes.extend(parts.map(|(index, part)| {
            let moved = model_from_joint(palette, part);
            match self.shape {
                Shape::Sphere => subject.precomputed.sphere(index, &moved),
                _ => subject.precomputed.capsule(index, &moved),
            }
        }));
    }

    fn refit(self, subject: &Subject, palette: &Palette, workspace: &mut Workspace) {
        let mesh = &subject.creature.collider;
        let skinned = skin_into(mesh, palette.matrices(), &mut workspace.positions);
        assert_eq!(skinned, Ok(()), "{}", subject.label());
        let positions = &workspace.positions;
        if self.shape == Shape::Sphere {
            // The method of the thesis (section 5.2.4).
            workspace.volumes.extend(mesh.parts().iter().map(|part| {
                let vertices = part.vertices.iter().map(|v| positions[v.index()]);
                Sphere::around_mean(vertices).map(BoundingVolume::Sphere)
            }));
        } else {
            workspace.volumes.extend(mesh.parts().iter().map(|part| {
                let vertices = part.vertices.iter().map(|v| positions[v.index()]);
                BoundingCapsule::around_principal_axis(vertices).map(BoundingVolume::Capsule)
            }));
        }
    }

    fn derive(self, subject: &Subject, palette: &Palette, workspace: &mut Workspace) {
        workspace.maps.update(palette);
        let maps = &workspace.maps;
        let volume = |node: &NodeBounds| match self.source {
            Source::PaletteHull => BoundingVolume::Sphere(node.hull(maps)),
            Source::PaletteInterval => BoundingVolume::Sphere(node.weight_interval(maps)),
            _ => BoundingVolume::Capsule(node.capsule(maps)),
        };
        let parts = (0..subject.bounds.part_count() as u32).map(PartId);
        let volumes = parts.map(|part| subject.bounds.node(part).map(volume));
        workspace.volumes.extend(volumes);
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.source, self.shape)
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Precomputed => "precomputed",
            Self::Refitted => "refitted",
            Self::PaletteHull => "palette, hull",
            Self::PaletteInterval => "palette, weight interval",
            Self::Surface => "surface",
            Self::Palette => "palette",
        })
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sphere => "sphere",
            Self::Capsule => "capsule",
        })
    }
}
