//! Loads the meshes of a creature: collision meshes are merged into one collider mesh, visual meshes are kept as they
//! are.

use std::collections::{BTreeMap, BTreeSet};

use gltf::{Mesh, Node, Primitive};

use crate::collision::Collision;
use crate::contents::Contents;
use crate::extras::Role;
use crate::looks;
use crate::members::Members;
use crate::readings;
use crate::skeleton::Joints;
use crate::vertices::{self, Binding, PassedOver};
use crate::visual::VisualMesh;
use crate::{GltfErrorKind, ImportWarning};

/// The meshes of a creature.
pub(crate) struct Meshes {
    pub(crate) collision: Collision,
    pub(crate) visual: Vec<VisualMesh>,
}

/// Meshes under construction.
#[derive(Default)]
struct Gathered {
    collision: Collision,
    visual: Vec<VisualMesh>,
    /// The place of each set of vertices that was added. Primitives often share vertices.
    places: BTreeMap<Vec<usize>, Place>,
    unweighted: usize,
    morphed: usize,
    /// Number of skipped primitives, by reason.
    passed_over: BTreeMap<PassedOver, usize>,
    /// Attributes that were not read.
    ignored: BTreeSet<String>,
}

#[derive(Clone, Copy)]
struct Place {
    vertices: usize,
    /// First vertex in the collider.
    collision: Option<u32>,
    /// Index of the visual mesh.
    visual: Option<usize>,
}

/// A node that shows a mesh, with the binding and the role of the mesh there.
struct Instance<'a> {
    node: &'a Node<'a>,
    mesh: Mesh<'a>,
    binding: Binding<'a>,
    /// The rest space. Meshes that are bound differently have different rest spaces.
    space: u32,
    role: Role,
    morph_weights: &'a [f32],
}

pub(crate) fn load(
    contents: &Contents<'_>,
    members: &Members,
    joints: &Joints,
    warnings: &mut Vec<ImportWarning>,
) -> Result<Meshes, GltfErrorKind> {
    let mut gathered = Gathered::default();
    // A mesh that several nodes show with one skin is loaded once, because the skin places it. But each of these nodes
    // may give it another role.
    let mut shown = BTreeSet::new();
    for instance in instances(contents, members, joints) {
        let weights: Vec<u32> = instance.morph_weights.iter().map(|w| w.to_bits()).collect();
        let mesh = format!("mesh {}", instance.mesh.index());
        contents
            .reader
            .charge(&mesh, size_of_val(weights.as_slice()))?;
        let role = instance.role as usize;
        if !shown.insert((instance.mesh.index(), instance.space, role, weights)) {
            continue;
        }
        for primitive in instance.mesh.primitives() {
            contents.reader.charge(&mesh, PRIMITIVE_BYTES)?;
            match vertices::passed_over(&primitive, &instance.binding) {
                Some(reason) => *gathered.passed_over.entry(reason).or_default() += 1,
                None => {
                    let object = format!("{mesh}, primitive {}", primitive.index());
                    gathered.add(&instance, &primitive, &object, contents)?;
                }
            }
        }
    }
    gathered.report(warnings);
    if gathered.collision.triangles.is_empty() {
        let object = members.object();
        return Err(GltfErrorKind::NoTriangles { object });
    }
    Ok(Meshes {
        collision: gathered.collision,
        visual: gathered.visual,
    })
}

/// Memory that a primitive takes besides its vertices and triangles, bytes, rounded up.
const PRIMITIVE_BYTES: usize = 256;

/// The nodes of a creature that show a mesh. If one of them has the role `collision`, nodes without a role are visual
/// only.
fn instances<'a>(
    contents: &'a Contents<'a>,
    members: &'a Members,
    joints: &'a Joints,
) -> impl Iterator<Item = Instance<'a>> {
    let Contents { tree, extras, .. } = contents;
    let role = |node: &usize| extras[*node].role;
    let split = members
        .meshes
        .iter()
        .any(|node| role(node) == Some(Role::Collision));
    let unsaid = if split { Role::Visual } else { Role::Both };
    members.meshes.iter().filter_map(move |index| {
        let node = &tree.nodes[*index];
        let mesh = node.mesh()?;
        let (binding, space) = match node.skin() {
            Some(skin) => {
                let of_skin = joints.of_skin.get(&skin.index())?;
                (Binding::Skin(of_skin), skin.index())
            }
            None => {
                let joint = joints.of_rigid.get(index)?;
                (Binding::Rigid(*joint), tree.skins.len() + index)
            }
        };
        Some(Instance {
            node,
            morph_weights: node.weights().or(mesh.weights()).unwrap_or_default(),
            mesh,
            binding,
            space: space as u32,
            role: role(index).unwrap_or(unsaid),
        })
    })
}

impl Gathered {
    /// Adds warnings about what was skipped or repaired.
    fn report(&self, warnings: &mut Vec<ImportWarning>) {
        for (reason, &primitives) in &self.passed_over {
            warnings.push(match reason {
                PassedOver::NoWeights => ImportWarning::PrimitivesWithoutWeights { primitives },
                PassedOver::PointsOrLines => ImportWarning::PointsOrLines { primitives },
                PassedOver::NoPositions => ImportWarning::PrimitivesWithoutPositions { primitives },
            });
        }
        if self.unweighted > 0 {
            let vertices = self.unweighted;
            warnings.push(ImportWarning::UnweightedVertices { vertices });
        }
        if self.morphed > 0 {
            let primitives = self.morphed;
            warnings.push(ImportWarning::MorphTargets { primitives });
        }
        if !self.ignored.is_empty() {
            let names = self.ignored.iter().cloned().collect();
            warnings.push(ImportWarning::UnreadAttributes { names });
        }
    }

    fn add(
        &mut self,
        instance: &Instance<'_>,
        primitive: &Primitive<'_>,
        object: &str,
        contents: &Contents<'_>,
    ) -> Result<(), GltfErrorKind> {
        let place = self.place(instance, primitive, object, contents)?;
        let Contents {
            reader, readings, ..
        } = contents;
        let triangles = readings.triangles(primitive, place.vertices, object, reader)?;
        let tag = contents.tag(primitive.material().index());
        if let Some(base) = place.collision {
            let collision = &mut self.collision;
            collision
                .triangles
                .extend(triangles.iter().map(|t| t.map(|v| v + base)));
            let (first, count) = (collision.tags.len(), collision.triangles.len());
            collision.tags.resize(count, tag);
            let material = primitive.material().index();
            let uses = material.map(|material| (material, first..count));
            collision.materials.extend(uses);
        }
        if let Some(visual) = place.visual {
            self.visual[visual].push(primitive, tag, triangles.to_vec());
        }
        Ok(())
    }

    /// The place of a primitive's vertices. They are read unless another primitive has the same vertices.
    fn place(
        &mut self,
        instance: &Instance<'_>,
        primitive: &Primitive<'_>,
        object: &str,
        contents: &Contents<'_>,
    ) -> Result<Place, GltfErrorKind> {
        let key = key(instance, primitive);
        if let Some(place) = self.places.get(&key) {
            return Ok(*place);
        }
        let Contents {
            reader, readings, ..
        } = contents;
        let (mesh, weights) = (instance.mesh.index(), instance.morph_weights);
        let shape = readings.shape(mesh, primitive, weights, object, reader)?;
        let vertices = vertices::vertices(&shape, primitive, &instance.binding, object, reader)?;
        let count = vertices.positions.len();
        self.unweighted += vertices.unweighted;
        self.morphed += usize::from(primitive.morph_targets().next().is_some());
        let visual = if instance.role == Role::Collision {
            None
        } else {
            let looks = shape.looks(primitive, weights, object, reader)?.clone();
            self.ignored.extend(looks::ignored(primitive));
            let name = instance
                .node
                .name()
                .or(instance.mesh.name())
                .unwrap_or_default();
            reader.charge(object, name.len())?;
            let mesh = VisualMesh::new(name.to_owned(), &vertices, looks, object)?;
            self.visual.push(mesh);
            Some(self.visual.len() - 1)
        };
        let collision = if instance.role == Role::Visual {
            None
        } else {
            Some(self.collision.append(&vertices, instance.space, object)?)
        };
        let place = Place {
            vertices: count,
            collision,
            visual,
        };
        self.places.insert(key, place);
        Ok(place)
    }
}

/// A key that is equal for primitives with the same vertices.
fn key(instance: &Instance<'_>, primitive: &Primitive<'_>) -> Vec<usize> {
    let mut key = vec![instance.space as usize, instance.role as usize];
    key.extend(readings::attributes(primitive));
    // Morphed vertices belong to one primitive of one node.
    if primitive.morph_targets().next().is_some() {
        key.extend([instance.node.index(), primitive.index()]);
    }
    key
}
