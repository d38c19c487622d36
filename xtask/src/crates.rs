//! Draws `docs/crates.svg`, a picture of the workspace's crates and their dependencies.
//!
//! Each crate is a box, one layer above the highest crate that it depends on. An arrow leads from a crate to a crate
//! that it depends on, and is dashed if only a feature turns the dependency on. Dependencies of tests and of build
//! scripts are left out, as are arrows that follow from others: if A needs B and B needs C, no arrow leads from A to C.
//! Crates without any arrow are not drawn.

mod layers;

use std::collections::BTreeMap;

use cargo_metadata::{DependencyKind, Metadata};
use layers::{Arranged, Layers};

/// File of the picture, from the root of the repository.
const PATH: &str = "docs/crates.svg";

/// Width and height of a box, pixels.
const BOX: (i32, i32) = (148, 36);

/// Distance from the top of a layer to the top of the next one, pixels.
const LAYER: i32 = 84;

/// Distance from the boxes to the picture's edges, pixels.
const MARGIN: i32 = 24;

/// Height of the legend below the boxes, pixels.
const LEGEND: i32 = 44;

/// Length of an arrow's head, and half of its width, pixels.
const HEAD: (i32, i32) = (8, 4);

/// Colour of lines and arrow heads.
const INK: &str = "#3a4450";

/// Fill and edge colours of published crates.
const PUBLISHED: (&str, &str) = ("#dbe7f6", "#2f5f9e");

/// Fill and edge colours of crates that are not published.
const UNPUBLISHED: (&str, &str) = ("#e4e7ea", "#7d8893");

/// Attribute of a line for a dependency that only a feature turns on.
const DASHED: &str = " stroke-dasharray=\"5 4\"";

/// A member of the workspace.
struct Member {
    name: String,
    colors: (&'static str, &'static str),
    /// Indices of the members that this one depends on. The value is true if only a feature turns the dependency on.
    needs: BTreeMap<usize, bool>,
}

/// A drawn dependency, by indices of members.
struct Arrow {
    from: usize,
    to: usize,
    is_optional: bool,
}

/// Checks that the stored picture is up to date.
pub(crate) fn check(metadata: &Metadata) -> Result<(), String> {
    // A checkout may have other line endings.
    let stored = std::fs::read_to_string(PATH)
        .unwrap_or_default()
        .replace("\r\n", "\n");
    if stored == svg(metadata) {
        Ok(())
    } else {
        Err(format!(
            "{PATH} is out of date: `cargo xtask crates` draws it again"
        ))
    }
}

/// Stores the picture.
pub(crate) fn store(metadata: &Metadata) -> Result<(), String> {
    std::fs::write(PATH, svg(metadata)).map_err(|error| format!("{PATH}: {error}"))?;
    println!("   {PATH}");
    Ok(())
}

fn svg(metadata: &Metadata) -> String {
    let members = members(metadata);
    let arrows = arrows(&members);
    let is_drawn = |member: &usize| {
        let mut arrows = arrows.iter();
        arrows.any(|arrow| arrow.from == *member || arrow.to == *member)
    };
    let mut layers = Layers::default();
    let boxes: BTreeMap<usize, usize> = (0..members.len())
        .filter(is_drawn)
        .map(|member| (member, layers.add(depth(&members, member), BOX.0)))
        .collect();
    let mut ways = Vec::new();
    for arrow in &arrows {
        let mut way = vec![boxes[&arrow.from]];
        let passed = depth(&members, arrow.to) + 1..depth(&members, arrow.from);
        way.extend(passed.rev().map(|layer| layers.add(layer, 0)));
        way.push(boxes[&arrow.to]);
        for leg in way.windows(2) {
            layers.connect(leg[0], leg[1]);
        }
        ways.push(way);
    }
    let arranged = layers.arrange();
    let width = arranged.width + 2 * MARGIN;
    let height = LAYER * (arranged.layers - 1) + BOX.1 + LEGEND + 2 * MARGIN;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" style=\"max-width:100%;height:auto\" role=\"img\" aria-labelledby=\"crates\" \
         font-family=\"sans-serif\" fill=\"#1d232a\">\n\
         <title id=\"crates\">The crates of the workspace, with arrows to the crates that they depend on</title>\n\
         <rect x=\"1\" y=\"1\" width=\"{}\" height=\"{}\" rx=\"8\" fill=\"#fbfcfd\" stroke=\"#c3cad2\"/>\n",
        width - 2,
        height - 2,
    );
    for (arrow, way) in arrows.iter().zip(&ways) {
        let dash = if arrow.is_optional { DASHED } else { "" };
        svg += &line(way, &arranged, dash);
    }
    for (member, slot) in &boxes {
        let member = &members[*member];
        svg += &boxed(top_of(&arranged, *slot), &member.name, member.colors);
    }
    svg + &legend(height) + "</svg>\n"
}

/// The workspace's members, sorted by name.
fn members(metadata: &Metadata) -> Vec<Member> {
    let mut packages = metadata.workspace_packages();
    packages.sort_by(|a, b| a.name.as_str().cmp(b.name.as_str()));
    let index = |name: &str| {
        let mut packages = packages.iter();
        packages.position(|package| package.name.as_str() == name)
    };
    let members = packages.iter().map(|package| {
        let is_published = package.publish.as_ref().is_none_or(|to| !to.is_empty());
        let normal = package
            .dependencies
            .iter()
            .filter(|dependency| dependency.kind == DependencyKind::Normal);
        Member {
            name: package.name.to_string(),
            colors: if is_published { PUBLISHED } else { UNPUBLISHED },
            needs: normal
                .filter_map(|dependency| Some((index(&dependency.name)?, dependency.optional)))
                .collect(),
        }
    });
    members.collect()
}

/// The dependencies that do not follow from others.
fn arrows(members: &[Member]) -> Vec<Arrow> {
    let mut arrows = Vec::new();
    for (from, member) in members.iter().enumerate() {
        for (to, is_optional) in &member.needs {
            if !follows(members, from, *to) {
                arrows.push(Arrow {
                    from,
                    to: *to,
                    is_optional: *is_optional,
                });
            }
        }
    }
    arrows
}

/// True if a member depends on another one through further members, independently of features.
fn follows(members: &[Member], from: usize, to: usize) -> bool {
    let mut needs = members[from].needs.iter();
    needs.any(|(through, is_optional)| {
        let needs_it = members[*through].needs.get(&to) == Some(&false);
        !*is_optional && (needs_it || follows(members, *through, to))
    })
}

/// Number of layers below a member: the length of its longest chain of dependencies.
fn depth(members: &[Member], member: usize) -> usize {
    let needs = members[member].needs.keys();
    let below = needs.map(|needed| depth(members, *needed) + 1);
    below.max().unwrap_or(0)
}

/// Middle of the top edge of a slot's box. For a bend, the middle of the box that would be there.
fn top_of(arranged: &Arranged, slot: usize) -> (i32, i32) {
    let (x, layer) = arranged.places[slot];
    (x + MARGIN, MARGIN + LAYER * (arranged.layers - 1 - layer))
}

/// An arrow from the bottom of its first slot's box, through the bends between, to the top of its last slot's box.
fn line(way: &[usize], arranged: &Arranged, dash: &str) -> String {
    let (mut x, mut y) = top_of(arranged, way[0]);
    y += BOX.1;
    let mut path = format!("M{x} {y}");
    for (index, slot) in way.iter().enumerate().skip(1) {
        let is_last = index + 1 == way.len();
        let (to_x, top) = top_of(arranged, *slot);
        let to_y = if is_last { top - HEAD.0 } else { top };
        let middle = (y + to_y) / 2;
        path += &format!("C{x} {middle} {to_x} {middle} {to_x} {to_y}");
        (x, y) = (to_x, to_y);
        if !is_last {
            // The line passes straight between the boxes of this layer.
            y += BOX.1;
            path += &format!("V{y}");
        }
    }
    let (length, half) = HEAD;
    format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"1.5\"{dash}/>\n\
         <path d=\"M{x} {}l-{half} -{length}h{}z\" fill=\"{INK}\"/>\n",
        y + length,
        2 * half,
    )
}

fn boxed((x, y): (i32, i32), name: &str, (fill, edge): (&str, &str)) -> String {
    let (width, height) = BOX;
    format!(
        "<rect x=\"{}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"6\" fill=\"{fill}\" stroke=\"{edge}\" \
         stroke-width=\"1.5\"/>\n\
         <text x=\"{x}\" y=\"{}\" font-size=\"14\" text-anchor=\"middle\">{name}</text>\n",
        x - width / 2,
        y + height / 2 + 5,
    )
}

/// The legend of colours and lines, at the picture's bottom.
fn legend(height: i32) -> String {
    let y = height - MARGIN - 6;
    let mut svg = String::new();
    let boxes = [
        (24, PUBLISHED, "published"),
        (152, UNPUBLISHED, "not published"),
    ];
    for (x, (fill, edge), text) in boxes {
        svg += &format!(
            "<rect x=\"{x}\" y=\"{}\" width=\"24\" height=\"16\" rx=\"4\" fill=\"{fill}\" stroke=\"{edge}\"/>\n\
             <text x=\"{}\" y=\"{y}\" font-size=\"13\">{text}</text>\n",
            y - 12,
            x + 32,
        );
    }
    let lines = [
        (308, "", "depends on"),
        (448, DASHED, "depends on, with a feature"),
    ];
    for (x, dash, text) in lines {
        svg += &format!(
            "<path d=\"M{x} {}h36\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"1.5\"{dash}/>\n\
             <text x=\"{}\" y=\"{y}\" font-size=\"13\">{text}</text>\n",
            y - 4,
            x + 44,
        );
    }
    svg
}
