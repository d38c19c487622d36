//! What a material says about its surface: `{"clamber": {"surface": "fur", "ledge": true}}`.

use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
use gltf::Material;
use serde::Deserialize;

use crate::{GltfError, LoadOptions};

/// Extras of any tool's; only the key that is ours is read.
#[derive(Deserialize)]
struct Extras {
    clamber: Option<MaterialExtras>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialExtras {
    #[serde(default)]
    surface: Surface,
    #[serde(default)]
    ledge: bool,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Surface {
    #[default]
    Skin,
    Fur,
    Stone,
}

/// The tag of a primitive's material: what the caller says of its name, else what its extras say,
/// else the default.
pub(crate) fn tag_of(
    material: &Material<'_>,
    options: &LoadOptions<'_>,
) -> Result<SurfaceTag, GltfError> {
    let by_name = options.tag_of_material.zip(material.name());
    if let Some(tag) = by_name.and_then(|(tag_of, name)| tag_of(name)) {
        return Ok(tag);
    }
    match material.extras() {
        Some(extras) => parse(extras.get()).map_err(|e| {
            let name = material.name().unwrap_or("without a name");
            GltfError::invalid(format!("extras of material {name:?}"), e)
        }),
        None => Ok(SurfaceTag::default()),
    }
}

fn parse(extras: &str) -> Result<SurfaceTag, serde_json::Error> {
    // Extras may be any JSON; only an object can hold our key.
    if !extras.trim_start().starts_with('{') {
        return Ok(SurfaceTag::default());
    }
    let extras: Extras = serde_json::from_str(extras)?;
    let Some(ours) = extras.clamber else {
        return Ok(SurfaceTag::default());
    };
    let kind = match ours.surface {
        Surface::Skin => SurfaceKind::Skin,
        Surface::Fur => SurfaceKind::Fur,
        Surface::Stone => SurfaceKind::Stone,
    };
    Ok(SurfaceTag {
        kind,
        ledge: ours.ledge,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_extras_are_read_and_foreign_ones_passed_over() {
        let stone_ledge = SurfaceTag {
            kind: SurfaceKind::Stone,
            ledge: true,
        };
        let text = r#"{"other": [1], "clamber": {"surface": "stone", "ledge": true}}"#;
        assert_eq!(parse(text).unwrap(), stone_ledge);
        for foreign in [
            "{}",
            "7",
            "\"text\"",
            r#"{"clamber": {}}"#,
            r#"{"a": {"surface": 3}}"#,
        ] {
            assert_eq!(parse(foreign).unwrap(), SurfaceTag::default(), "{foreign}");
        }
    }

    #[test]
    fn a_misspelt_surface_is_an_error_that_lists_the_choices() {
        let error = parse(r#"{"clamber": {"surface": "furr"}}"#).unwrap_err();
        assert!(
            error.to_string().contains("`skin`, `fur`, `stone`"),
            "{error}"
        );
        assert!(parse(r#"{"clamber": {"surfaces": "fur"}}"#).is_err());
    }
}
