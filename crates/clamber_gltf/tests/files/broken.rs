//! Files that claim too much memory, and files with changed values, flipped bits and cuts.

use allocation_counter::measure;
use clamber_gltf::{LoadOptions, Model, load_slice};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Playback;
use clamber_surface::surface::SkinnedSurface;
use serde_json::{Value, json};

use crate::builder::{File, remove};

/// Poses a rig in the middle of every clip, as a user would: a rig that was loaded must not panic later.
fn use_rig(model: &Model) {
    let mut surface = SkinnedSurface::new(model.rig.collider.clone());
    for clip in &model.rig.clips {
        let rest = model.rig.skeleton.rest_pose();
        if let Ok(pose) = clip.sample(&rest, clip.duration() * 0.5, Playback::Loop)
            && let Ok(palette) = model.rig.skeleton.palette(&pose)
        {
            let _ = surface.advance(&palette, Similarity::IDENTITY);
        }
    }
}

#[test]
fn data_that_is_read_many_times_is_refused_before_memory_runs_out() {
    let mut file = File::square();
    let primitive = file.primitive_on(0, &[[0.5; 3]; 4_998]);
    file.primitives().extend(vec![primitive; 2_000]);
    file.assert_refused("more than once");

    // A sparse accessor without a buffer view claims a huge count without data.
    let mut file = File::square();
    let accessor = file.json["accessors"][0].as_object_mut().unwrap();
    accessor.remove("bufferView");
    accessor.insert("count".into(), json!(1u64 << 40));
    accessor.insert(
        "sparse".into(),
        json!({
            "count": 1, "values": {"bufferView": 0},
            "indices": {"bufferView": 3, "componentType": 5123}
        }),
    );
    file.assert_refused("more memory");
}

#[test]
fn data_that_is_small_in_a_file_but_large_in_memory_is_refused() {
    // Every node shows every primitive.
    let mut file = File::square();
    let points = json!({"attributes": {"POSITION": 0}, "mode": 0});
    file.primitives().extend(vec![points; 1_000]);
    for _ in 0..1_000 {
        file.node_under(1, json!({"mesh": 0}));
    }
    file.assert_refused("more memory");

    let mut file = File::square();
    file.json["meshes"][0]["weights"] = json!(vec![0; 20_000]);
    for _ in 0..2_000 {
        file.node_under(1, json!({"mesh": 0}));
    }
    file.assert_refused("0 morph targets, but 20000 weights");

    // A long name of many joints.
    let mut file = File::square();
    file.json["nodes"][1]["name"] = json!("x".repeat(100_000));
    let binds: Vec<u8> = (0..600 * 64).map(|k| (k % 61) as u8).collect();
    let binds = file.accessor("MAT4", 5126, 600, &binds);
    file.json["skins"][0] = json!({"joints": vec![1; 600], "inverseBindMatrices": binds});
    file.assert_refused("more memory");
}

/// Loads files that take as much memory as they can: a large mesh, shown by as many nodes as the options allow, and by
/// one more. The first showing takes at most a hundred times the file, and each vertex of further showings at most 512
/// bytes.
#[test]
fn the_greediest_file_stays_within_its_bounds() {
    let vertices = 9_999;
    let mut rng = fastrand::Rng::with_seed(43);
    let points: Vec<[f32; 3]> = (0..vertices)
        .map(|_| [rng.f32(), rng.f32(), rng.f32()])
        .collect();
    let mut file = File::square();
    let positions = file.positions(&points);
    file.json["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": positions}}]);
    let zeros = json!({"componentType": 5126, "count": vertices, "type": "VEC3"});
    let zeros = file.push("accessors", zeros);
    let flat = json!({"primitives": [{"attributes": {"POSITION": zeros}}]});
    let flat = file.push("meshes", flat);
    // A strip makes two triangles of each vertex, which the limit allows.
    let strip = json!({"primitives": [{"attributes": {"POSITION": positions}, "mode": 5}]});
    let strip = file.push("meshes", strip);
    for mesh in [0, flat, strip] {
        for limit in [0, 5 * vertices] {
            let mut greedy = File {
                json: file.json.clone(),
                bytes: file.bytes.clone(),
            };
            greedy.json["nodes"][3] = json!({"mesh": mesh});
            remove(&mut greedy.json, "skins");
            let options = LoadOptions::default().with_max_repeated_vertices(limit);
            let (mut worst, mut nodes) = (0.0f64, 1);
            let refusal = loop {
                let glb = greedy.glb();
                let mut refusal = None;
                let memory = measure(|| refusal = load_slice(&glb, &options).err());
                let bound = 100 * glb.len() + (1 << 20) + 512 * limit;
                worst = worst.max(memory.bytes_max as f64 / bound as f64);
                match refusal {
                    Some(error) if error.to_string().contains("no usable triangle") => {}
                    Some(error) => break error.to_string(),
                    None => {}
                }
                greedy.node_under(1, json!({"mesh": mesh}));
                nodes += 1;
            };
            println!(
                "mesh {mesh}, limit {limit}: {nodes} nodes, {worst:.2} of the bound, {refusal}"
            );
            assert!(refusal.contains("max_repeated_vertices"), "{refusal}");
            assert_eq!(nodes, limit / vertices + 2);
            assert!(worst < 1.0, "mesh {mesh}: {worst} of the bound");
        }
    }
}

#[test]
fn sparse_accessors_cannot_replace_more_elements_than_there_are() {
    let mut file = File::square();
    let indices = file.accessor("SCALAR", 5121, 5, &[0, 1, 2, 3, 3]);
    let values = file.floats("VEC3", &[0.5; 15]);
    file.json["accessors"][0]["sparse"] = json!({
        "count": 5, "indices": {"bufferView": indices, "componentType": 5121},
        "values": {"bufferView": values}
    });
    file.assert_refused("replaces 5 of 4 elements");
    file.json["accessors"][0]["sparse"]["count"] = json!(1);
    let moved = file.load().unwrap().rig.collider.positions()[0];
    assert_eq!(moved, glam::Vec3::splat(0.5));
}

/// Appends JSON pointers to every place in a value.
fn pointers(value: &Value, at: String, all: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                pointers(item, format!("{at}/{k}"), all);
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                pointers(field, format!("{at}/{name}"), all);
            }
        }
        _ => {}
    }
    all.push(at);
}

#[test]
fn no_change_of_a_value_panics() {
    let file = File::square();
    let mut all = Vec::new();
    pointers(&file.json, String::new(), &mut all);
    let hostile = [
        json!(0),
        json!(1),
        json!(3),
        json!(-1),
        json!(999),
        json!(u32::MAX),
        json!(u64::MAX),
        json!(0.5),
        json!(1e308),
        json!(null),
        json!(true),
        json!(""),
        json!("VEC2"),
        json!([]),
        json!([0, 0, 0, 0]),
        json!({}),
        json!(5121),
        json!(5125),
    ];
    let (mut loaded, mut refused) = (0, 0);
    for pointer in &all {
        for value in &hostile {
            let mut json = file.json.clone();
            *json.pointer_mut(pointer).unwrap() = value.clone();
            let changed = File {
                json,
                bytes: file.bytes.clone(),
            };
            match changed.load() {
                Ok(model) => {
                    use_rig(&model);
                    let tall = LoadOptions::default().with_height(7.0);
                    if let Ok(model) = load_slice(&changed.glb(), &tall) {
                        use_rig(&model);
                    }
                    loaded += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(
        loaded > 100 && refused > 500,
        "{loaded} loaded, {refused} refused"
    );
}

#[test]
fn no_flip_or_cut_of_bytes_panics() {
    let file = File::square();
    let glb = file.glb();
    let mut rng = fastrand::Rng::with_seed(31);
    for _ in 0..20_000 {
        let mut broken = glb.clone();
        for _ in 0..rng.usize(1..4) {
            let at = rng.usize(0..broken.len());
            broken[at] ^= 1 << rng.u32(0..8);
        }
        if let Ok(model) = load_slice(&broken, &LoadOptions::default()) {
            use_rig(&model);
        }
    }
    for cut in 0..glb.len() {
        // First with the header's length unchanged, then with the length that is left.
        let mut broken = glb[..cut].to_vec();
        assert!(
            load_slice(&broken, &LoadOptions::default()).is_err(),
            "cut at {cut}"
        );
        if cut >= 12 {
            broken[8..12].copy_from_slice(&(cut as u32).to_le_bytes());
            let _ = load_slice(&broken, &LoadOptions::default());
        }
    }
    // The header alone, with a claimed length of 0.
    let mut short = glb[..12].to_vec();
    short[8..12].fill(0);
    assert!(load_slice(&short, &LoadOptions::default()).is_err());
}
