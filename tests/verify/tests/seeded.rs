//! Runs every fuzz target on seeded random bytes for a few seconds, as libFuzzer does for hours.

use clamber_verify::targets::{Palettes, Queries, builder, import, palettes, queries, square};

/// Random bytes for a target. The first four seed all choices beyond the last byte.
fn random_bytes(rng: &mut fastrand::Rng) -> Vec<u8> {
    let length = rng.usize(4..200);
    (0..length).map(|_| rng.u8(..)).collect()
}

/// A file with digits of the JSON replaced by tokens, bytes of the binary chunk changed, or the binary chunk cut. It
/// may still be valid.
fn mutated(json: &[u8], binary: &[u8], rng: &mut fastrand::Rng) -> Vec<u8> {
    /// Replacements for a digit: numbers at limits, other JSON values, and values that glTF uses elsewhere.
    const TOKENS: [&str; 12] = [
        "0",
        "-1",
        "7",
        "1e39",
        "4294967295",
        "0.5",
        "null",
        "[]",
        "{}",
        "\"\"",
        "5121",
        "\"VEC2\"",
    ];
    let (mut json, mut binary) = (json.to_vec(), binary.to_vec());
    for _ in 0..rng.usize(1..4) {
        match rng.u32(0..8) {
            0..4 => {
                let is_digit = |at: &usize| json[*at].is_ascii_digit();
                let digits: Vec<usize> = (0..json.len()).filter(is_digit).collect();
                let Some(&start) = rng.choice(&digits) else {
                    continue;
                };
                let token = TOKENS[rng.usize(0..TOKENS.len())];
                json.splice(start..start + 1, token.bytes());
            }
            4..7 => {
                let at = rng.usize(0..binary.len());
                binary[at] = [0, 1, 127, 128, 255, rng.u8(..)][rng.usize(0..6)];
            }
            _ => binary.truncate(rng.usize(1..=binary.len())),
        }
    }
    [&json[..], &[0], &binary].concat()
}

#[test]
fn files() {
    let (json, binary) = square();
    assert!(import(&[&json[..], &[0], &binary].concat()), "the seed");
    let mut rng = fastrand::Rng::with_seed(81);
    let count = 8_000;
    let loaded = (0..count).filter(|_| import(&mutated(&json, &binary, &mut rng)));
    let loaded = loaded.count();
    println!("{loaded} of {count} changed files load");
    assert!(loaded > count / 8 && loaded < count * 4 / 5, "{loaded}");
}

#[test]
fn meshes() {
    let mut rng = fastrand::Rng::with_seed(82);
    let count = 3_000;
    let built = (0..count).filter(|_| builder(&random_bytes(&mut rng)));
    let built = built.count();
    println!("{built} of {count} sources are built");
    assert!(built > count / 3 && built < count * 9 / 10, "{built}");
}

#[test]
fn poses() {
    let mut rng = fastrand::Rng::with_seed(83);
    let mut all = Palettes::default();
    for _ in 0..2_000 {
        let seen = palettes(&random_bytes(&mut rng));
        all.accepted += seen.accepted;
        all.refused += seen.refused;
        all.motions += seen.motions;
    }
    println!("{all:?}");
    assert!(all.accepted > 4_000, "{all:?}");
    assert!(all.refused > 1_000, "{all:?}");
    assert!(all.motions > 8_000, "{all:?}");
}

#[test]
fn questions() {
    let mut rng = fastrand::Rng::with_seed(84);
    let mut all = Queries::default();
    for _ in 0..1_500 {
        let seen = queries(&random_bytes(&mut rng));
        all.hits += seen.hits;
        all.answered += seen.answered;
        all.refused += seen.refused;
        all.edits += seen.edits;
    }
    println!("{all:?}");
    assert!(all.hits > 100_000, "{all:?}");
    assert!(all.answered > 20_000, "{all:?}");
    assert!(all.refused > 1_000, "{all:?}");
    assert!(all.edits > 2_000, "{all:?}");
}

#[test]
fn queries_at_coordinates_whose_squares_overflow() {
    // Inputs that once differed from brute force: coordinates beyond 1e18, whose squares overflow f32.
    for input in [
        "6f1cbfb1199a41eb13463526af80f3bbc38c2e6d7a7fe52464",
        "1579a8ad4e138dcf2c4450e601179303831f2b344d13d9ec73603efc6751d10810ab4c0c1ac73020759deffdf97f\
         876521d857e296756cdc13183ba1e7333e3d8825b3f1e55c66f87d1a1c97945c1170f90a9a3eb6",
        "b18a4b2ad3bb37c54006023c5cd48dfc169c3414c2421b09cf8834d3d953f0d1ec396efdf57300d769a9122c32fe\
         74b3177944a1234b5b7288def78247a76cc2b974d465e3cf7dd28c5a8d056b",
    ] {
        let bytes: Vec<u8> = (0..input.len() / 2)
            .map(|k| u8::from_str_radix(&input[2 * k..2 * k + 2], 16).unwrap())
            .collect();
        assert!(queries(&bytes).answered > 0, "{input}");
    }
}
