//! The table: time, tightness and escaped vertices of each method.

use std::error::Error;
use std::time::Duration;

use clamber::mesh::ColliderMesh;
use clamber::rig::Palette;
use clamber::skin::skin;
use clamber_scenes::measure::{Table, median_us, quantile, smallest_ball};
use glam::Vec3;

use crate::method::{METHODS, Method, Source, Workspace};
use crate::poses::Subject;

/// The results of all creatures so far.
pub(crate) struct Report {
    pub(crate) table: Table,
    /// Number of vertices outside refitted and derived bounds. Each one is a bug.
    pub(crate) escapes: usize,
}

impl Default for Report {
    fn default() -> Self {
        let columns = [
            "creature",
            "vertices",
            "parts",
            "bounds from",
            "shape",
            "us",
            "volume, median",
            "volume, p95",
            "outside, sampled",
            "outside, between",
            "outside, blended",
            "checked",
        ];
        Self {
            table: Table::new(&columns),
            escapes: 0,
        }
    }
}

/// A pose with its skinned vertices and exact bounds.
struct Truth {
    palette: Palette,
    skinned: Vec<Vec3>,
    /// Volume of the smallest ball around each part's vertices; 0 for a part without vertices.
    volumes: Vec<f64>,
}

impl Truth {
    fn new(mesh: &ColliderMesh, palette: Palette) -> Result<Self, Box<dyn Error>> {
        let skinned = skin(mesh, palette.matrices())?;
        let volume = |part: &clamber::mesh::Part| {
            let vertices = part.vertices.iter().map(|v| skinned[v.index()]);
            smallest_ball(vertices).map_or(0.0, |ball| ball.volume())
        };
        Ok(Self {
            volumes: mesh.parts().iter().map(volume).collect(),
            palette,
            skinned,
        })
    }
}

impl Report {
    /// Measures every method on a creature, with the time `budget` for each median.
    pub(crate) fn add(
        &mut self,
        subject: &Subject,
        budget: Duration,
    ) -> Result<(), Box<dyn Error>> {
        let mesh = &subject.creature.collider;
        let with_truth = |palettes: Vec<Palette>| -> Result<Vec<Truth>, Box<dyn Error>> {
            palettes.into_iter().map(|p| Truth::new(mesh, p)).collect()
        };
        let sampled = subject.sampled()?.into_iter().step_by(4).collect();
        let kinds = [
            with_truth(sampled)?,
            with_truth(subject.between()?)?,
            with_truth(subject.blended()?)?,
        ];
        for method in METHODS {
            self.add_method(subject, method, &kinds, budget);
        }
        Ok(())
    }

    fn add_method(
        &mut self,
        subject: &Subject,
        method: Method,
        kinds: &[Vec<Truth>; 3],
        budget: Duration,
    ) {
        let mesh = &subject.creature.collider;
        let mut workspace = Workspace::new(subject);
        let mut shares = Vec::new();
        let mut checked = 0;
        let outside = kinds.each_ref().map(|poses| {
            let mut outside = 0;
            for pose in poses {
                method.bound(subject, &pose.palette, &mut workspace);
                for (index, part) in mesh.parts().iter().enumerate() {
                    let Some(volume) = workspace.volumes[index] else {
                        continue;
                    };
                    let vertices = part.vertices.iter().map(|v| pose.skinned[v.index()]);
                    checked += vertices.len();
                    outside += vertices.filter(|p| !volume.contains(*p)).count();
                    if pose.volumes[index] > 0.0 {
                        shares.push(volume.volume() / pose.volumes[index]);
                    }
                }
            }
            outside
        });
        if method.source != Source::Precomputed {
            self.escapes += outside.iter().sum::<usize>();
        }
        let mut turn = kinds[1].iter().cycle();
        let cost = median_us(budget, || {
            if let Some(pose) = turn.next() {
                method.bound(subject, &pose.palette, &mut workspace);
            }
        });
        self.table.push(vec![
            subject.creature.name.clone(),
            mesh.positions().len().to_string(),
            mesh.parts().len().to_string(),
            method.source.to_string(),
            method.shape.to_string(),
            format!("{cost:.1}"),
            format!("{:.2}", quantile(&mut shares, 0.5)),
            format!("{:.2}", quantile(&mut shares, 0.95)),
            outside[0].to_string(),
            outside[1].to_string(),
            outside[2].to_string(),
            checked.to_string(),
        ]);
    }
}
