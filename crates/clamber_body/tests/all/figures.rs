use clamber_body::{Figure, Humanoid, Retarget};
use clamber_scenes::test_data;
use clamber_surface::mesh::Rig;

pub(crate) fn hero_rig() -> Rig {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/hero.glb");
    clamber_gltf::load(file).unwrap().rig
}

pub(crate) fn hero() -> Figure {
    let rig = hero_rig();
    let humanoid = Humanoid::find(&rig.skeleton).unwrap();
    Figure::new(rig.skeleton, humanoid, rig.clips).unwrap()
}

/// Another figure at the hero's size, with the hero's clips.
fn other(name: &str) -> Option<Figure> {
    let file = test_data::file("another body", &format!("models/{name}.glb"))?;
    let hero = hero_rig();
    let own = Humanoid::find(&hero.skeleton).unwrap();
    let rig = clamber_gltf::load(file).unwrap().rig;
    let body = Humanoid::find(&rig.skeleton).unwrap();
    let retarget = Retarget::new((&hero.skeleton, &own), (&rig.skeleton, &body)).unwrap();
    let clips = hero.clips.iter().map(|clip| retarget.clip(clip).unwrap());
    let clips = clips.collect();
    let scale = own.legs[0].length() / body.legs[0].length();
    Some(Figure::with_scale(rig.skeleton.clone(), body, clips, scale).unwrap())
}

/// The hero, Character, George and CesiumMan.
pub(crate) fn all() -> Vec<(&'static str, Figure)> {
    let others = ["Character", "George", "CesiumMan"].into_iter();
    let others = others.filter_map(|name| Some((name, other(name)?)));
    core::iter::once(("hero", hero())).chain(others).collect()
}
