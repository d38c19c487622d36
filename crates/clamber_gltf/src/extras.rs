//! Reads the key `clamber` in the extras of a file's objects:
//!
//! - a material: `{"clamber": {"surface": "fur", "user": 7}}`,
//! - a node with a mesh: `{"clamber": {"role": "collision"}}`,
//! - a node under a joint: `{"clamber": {"weak_point": {"hit_points": 3.0, "radius": 0.4, "major": true}}}`,
//! - an animation: `{"clamber": {"speed": 1.4, "markers": [{"name": "step_left", "time": 0.5}]}}`.

use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
use clamber_surface::rig::{Clip, Marker};
use gltf::{Animation, Material, Node};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::{GltfError, GltfErrorKind, ImportWarning};

/// The extras of an object; only this library's key is read.
#[derive(Deserialize)]
struct Extras<T> {
    clamber: Option<T>,
}

#[derive(Default, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object such as {\"surface\": \"fur\"}"
)]
struct MaterialExtras {
    #[serde(default)]
    surface: Surface,
    /// A key of old files. It is ignored with a warning, whatever its value (also `false`, but not `null`): climbers
    /// find ledges by their shape.
    ledge: Option<serde::de::IgnoredAny>,
    #[serde(default)]
    user: u32,
}

impl MaterialExtras {
    fn tag(&self) -> SurfaceTag {
        let kind = match self.surface {
            Surface::Skin => SurfaceKind::Skin,
            Surface::Fur => SurfaceKind::Fur,
            Surface::Stone => SurfaceKind::Stone,
        };
        SurfaceTag::new(kind).with_user(self.user)
    }
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Surface {
    #[default]
    Skin,
    Fur,
    Stone,
}

/// The extras of a node or a mesh.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object such as {\"role\": \"collision\"}"
)]
pub(crate) struct NodeExtras {
    pub(crate) role: Option<Role>,
    pub(crate) weak_point: Option<WeakPointExtras>,
}

/// The use of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Role {
    Collision,
    Visual,
    Both,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object such as {\"hit_points\": 3.0}"
)]
pub(crate) struct WeakPointExtras {
    pub(crate) hit_points: f64,
    /// Radius, in model units; `None` for the node's scale.
    pub(crate) radius: Option<f32>,
    #[serde(default)]
    pub(crate) major: Flag,
    /// By default 0, and 1 for a major weak point, which is hidden until all weak points of order 0 are used up.
    pub(crate) order: Option<u32>,
}

impl WeakPointExtras {
    fn check(&self) -> Result<(), String> {
        let hit_points = self.hit_points;
        if !(hit_points > 0.0 && hit_points.is_finite()) {
            return Err(format!(
                "a weak point has {hit_points} hit points, which must be finite and more than 0"
            ));
        }
        match self.radius {
            Some(radius) if !(radius >= 0.0 && radius.is_finite()) => Err(format!(
                "a weak point has a radius of {radius}, which must be finite and at least 0"
            )),
            _ => Ok(()),
        }
    }
}

/// Seconds by which a marker may be later than the end of its clip. The marker is then moved to the end, because the
/// times of key frames are rounded to f32 and its own time is not.
const ROUNDED: f64 = 1e-3;

#[derive(Debug, Default, PartialEq, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an object such as {\"markers\": [{\"name\": \"hit\", \"time\": 0.4}]}"
)]
struct AnimationExtras {
    /// Speed over ground, metres a second.
    speed: Option<f64>,
    #[serde(default)]
    markers: Vec<MarkerExtras>,
}

#[derive(Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct MarkerExtras {
    name: String,
    /// Time after the clip's first key frame, seconds.
    time: f64,
}

/// A boolean, which may also be written as 1 or 0: some tools have no checkbox for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "serde_json::Value")]
pub(crate) struct Flag(pub(crate) bool);

impl TryFrom<serde_json::Value> for Flag {
    type Error = String;

    fn try_from(value: serde_json::Value) -> Result<Self, String> {
        let number = value.as_f64();
        value
            .as_bool()
            .or_else(|| (number == Some(1.0)).then_some(true))
            .or_else(|| (number == Some(0.0)).then_some(false))
            .map(Self)
            .ok_or_else(|| format!("expected true or false, found {value}"))
    }
}

/// The tag in a material's extras, and true if it has a mark that is ignored; the default tag without extras.
pub(crate) fn tag_of(material: &Material<'_>) -> Result<(SurfaceTag, bool), GltfErrorKind> {
    let object = || {
        let name = material.name().unwrap_or("without a name");
        format!("extras of material {name:?}")
    };
    let extras: MaterialExtras = ours(material.extras(), object)?;
    Ok((extras.tag(), extras.ledge.is_some()))
}

/// Reads the tag in a material's extras, for files that another importer loads.
///
/// `extras` is the JSON of the extras. The result is `None` if they lack the key `clamber`, or if the text does not
/// begin with `{`.
///
/// ```
/// let tag = clamber_gltf::tag_in_extras(r#"{"clamber": {"surface": "stone", "user": 3}}"#)?;
/// assert!(tag.is_some_and(|tag| tag.user == 3));
/// assert_eq!(clamber_gltf::tag_in_extras(r#"{"price": 3}"#)?, None);
/// # Ok::<(), clamber_gltf::GltfError>(())
/// ```
///
/// # Errors
/// [`GltfErrorKind::Invalid`] for text that begins with `{` but is not valid JSON, and for an unknown key or value
/// under `clamber`.
pub fn tag_in_extras(extras: &str) -> Result<Option<SurfaceTag>, GltfError> {
    let ours: Result<Option<MaterialExtras>, _> = find(extras);
    match ours {
        Ok(ours) => Ok(ours.map(|extras| extras.tag())),
        Err(reason) => Err(GltfError {
            path: None,
            kind: GltfErrorKind::invalid("extras of a material", reason),
        }),
    }
}

/// The extras of each node; the default for a node without any. A node without a role has the role of its mesh.
pub(crate) fn of_nodes(
    nodes: &[Node<'_>],
    warnings: &mut Vec<ImportWarning>,
) -> Result<Vec<NodeExtras>, GltfErrorKind> {
    let mut roles_of_nothing = 0;
    let mut all = Vec::with_capacity(nodes.len());
    for node in nodes {
        let mut extras = of_node(node)?;
        match node.mesh() {
            Some(mesh) if extras.role.is_none() => {
                let object = || format!("extras of mesh {}", mesh.index());
                let of_mesh: NodeExtras = ours(mesh.extras(), object)?;
                extras.role = of_mesh.role;
            }
            Some(_) => {}
            None => roles_of_nothing += usize::from(extras.role.is_some()),
        }
        all.push(extras);
    }
    if roles_of_nothing > 0 {
        warnings.push(ImportWarning::RolesWithoutMesh {
            nodes: roles_of_nothing,
        });
    }
    Ok(all)
}

fn of_node(node: &Node<'_>) -> Result<NodeExtras, GltfErrorKind> {
    let object = || match node.name() {
        Some(name) => format!("extras of node {name:?}"),
        None => format!("extras of node {}", node.index()),
    };
    let extras: NodeExtras = ours(node.extras(), object)?;
    match extras.weak_point.as_ref().map(WeakPointExtras::check) {
        Some(Err(reason)) => Err(GltfErrorKind::invalid(object(), reason)),
        _ => Ok(extras),
    }
}

/// A clip with the markers and the speed in its animation's extras.
pub(crate) fn with_markers(animation: &Animation<'_>, clip: Clip) -> Result<Clip, GltfErrorKind> {
    let object = || format!("extras of animation {:?}", clip.name);
    let extras: AnimationExtras = ours(animation.extras(), object)?;
    let duration = clip.duration();
    let marker = |MarkerExtras { name, time }| Marker {
        name,
        // The times of key frames are rounded to f32; the marker's time is not.
        time: if time < duration + ROUNDED {
            time.min(duration)
        } else {
            time
        },
    };
    let markers = extras.markers.into_iter().map(marker).collect();
    let object = object();
    clip.with_markers(markers)
        .and_then(|clip| clip.with_ground_speed(extras.speed))
        .map_err(|reason| GltfErrorKind::invalid(object, reason))
}

fn ours<T: DeserializeOwned + Default>(
    extras: &gltf::json::Extras,
    object: impl Fn() -> String,
) -> Result<T, GltfErrorKind> {
    let text = extras.as_ref().map_or("{}", |extras| extras.get());
    parse(text).map_err(|reason| GltfErrorKind::invalid(object(), reason))
}

fn parse<T: DeserializeOwned + Default>(extras: &str) -> Result<T, serde_json::Error> {
    Ok(find(extras)?.unwrap_or_default())
}

/// The value of this library's key; `None` without the key.
fn find<T: DeserializeOwned>(extras: &str) -> Result<Option<T>, serde_json::Error> {
    // Extras may be any JSON, but only an object can hold the key.
    if !extras.trim_start().starts_with('{') {
        return Ok(None);
    }
    let extras: Extras<T> = serde_json::from_str(extras)?;
    Ok(extras.clamber)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_extras_are_read_and_those_of_other_tools_ignored() {
        let text = r#"{"other": [1], "clamber": {"surface": "stone", "user": 3}}"#;
        let stone: MaterialExtras = parse(text).unwrap();
        assert!(matches!(stone.surface, Surface::Stone) && stone.user == 3);
        for foreign in [
            "{}",
            "7",
            "\"text\"",
            r#"{"clamber": {}}"#,
            r#"{"clamber": null}"#,
            r#"{"a": {"surface": 3}}"#,
        ] {
            let skin: MaterialExtras = parse(foreign).unwrap();
            assert!(
                matches!(skin.surface, Surface::Skin) && skin.user == 0,
                "{foreign}"
            );
            assert_eq!(parse::<NodeExtras>(foreign).unwrap(), NodeExtras::default());
        }
        let text = r#"{"clamber": {"weak_point": {"hit_points": 3, "major": 1}, "role": "both"}}"#;
        let node: NodeExtras = parse(text).unwrap();
        assert_eq!(node.role, Some(Role::Both));
        assert!(
            node.weak_point
                .is_some_and(|w| w.hit_points == 3.0 && w.major.0)
        );
    }

    #[test]
    fn an_unknown_word_is_an_error_that_lists_the_valid_ones() {
        let error = |text| parse::<MaterialExtras>(text).err().map(|e| e.to_string());
        let furr = error(r#"{"clamber": {"surface": "furr"}}"#).unwrap();
        assert!(furr.contains("`skin`, `fur`, `stone`"), "{furr}");
        assert!(error(r#"{"clamber": {"surfaces": "fur"}}"#).is_some());
        assert!(error(r#"{"clamber": {"ledge": 2}}"#).is_none());
        let text = error(r#"{"clamber": "fur"}"#).unwrap();
        assert!(
            text.contains(r#"expected an object such as {"surface": "fur"}"#),
            "{text}"
        );
        let role = parse::<NodeExtras>(r#"{"clamber": {"role": "colision"}}"#).unwrap_err();
        assert!(
            role.to_string().contains("`collision`, `visual`, `both`"),
            "{role}"
        );
        assert!(parse::<NodeExtras>(r#"{"clamber": {"weak_point": {}}}"#).is_err());
    }

    #[test]
    fn an_animation_has_a_speed_and_markers() {
        let text = r#"{"clamber": {"speed": 1.5, "markers": [{"name": "hit", "time": 0.4}]}}"#;
        let extras: AnimationExtras = parse(text).unwrap();
        let (name, time) = ("hit".to_owned(), 0.4);
        assert_eq!(extras.markers, [MarkerExtras { name, time }]);
        assert_eq!(extras.speed, Some(1.5));
        for text in [
            r#"{"clamber": {"markers": [{"name": "hit"}]}}"#,
            r#"{"clamber": {"marker": []}}"#,
            r#"{"clamber": 0.4}"#,
        ] {
            assert!(parse::<AnimationExtras>(text).is_err(), "{text}");
        }
    }

    #[test]
    fn empty_extras_are_the_default_tag_and_missing_ones_no_tag() {
        let fur = tag_in_extras(r#"{"clamber": {"surface": "fur"}}"#).unwrap();
        let expected = SurfaceTag::new(SurfaceKind::Fur);
        assert_eq!(fur, Some(expected));
        let user = tag_in_extras(r#"{"clamber": {"user": 4294967295}}"#).unwrap();
        assert_eq!(user, Some(SurfaceTag::default().with_user(u32::MAX)));
        assert!(tag_in_extras(r#"{"clamber": {"user": -1}}"#).is_err());
        let said = tag_in_extras(r#"{"clamber": {}}"#).unwrap();
        assert_eq!(said, Some(SurfaceTag::default()));
        for foreign in ["", "{}", "7", r#"{"surface": "fur"}"#] {
            assert_eq!(tag_in_extras(foreign).unwrap(), None, "{foreign}");
        }
        let error = tag_in_extras(r#"{"clamber": {"surface": "furr"}}"#).unwrap_err();
        assert!(error.to_string().contains("`fur`"), "{error}");
        assert!(tag_in_extras("{").is_err());
    }
}
