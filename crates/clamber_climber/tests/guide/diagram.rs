//! The modes and their transitions as an SVG, for pages light and dark.

use clamber_climber::{ClimberMode, TRANSITIONS};

use crate::routes::{ROUTES, Route};

/// Width and height of the picture.
const SIZE: (i32, i32) = (960, 520);

/// Radius of the arrows' corners.
const CORNER: i32 = 10;

/// Length of an arrow's head, and half its width.
const HEAD: (i32, i32) = (9, 5);

/// Distance of an arrow's number from the arrow's start, where the first leg is long enough.
const LABEL: i32 = 24;

/// The box of a mode in the diagram.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    left: i32,
    top: i32,
    width: i32,
    height: i32,
}

impl Place {
    pub(crate) fn has_on_edge(&self, (x, y): (i32, i32)) -> bool {
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let is_within = (self.left..=right).contains(&x) && (self.top..=bottom).contains(&y);
        let is_on_edge = [self.left, right].contains(&x) || [self.top, bottom].contains(&y);
        is_within && is_on_edge
    }
}

pub(crate) fn place(mode: ClimberMode) -> Place {
    let column = |column: i32| Place {
        left: 42 + 172 * column,
        top: 205,
        width: 124,
        height: 60,
    };
    let bar = |top| Place {
        left: 60,
        top,
        width: 872,
        height: 46,
    };
    match mode {
        ClimberMode::Sliding => column(0),
        ClimberMode::Standing => column(1),
        ClimberMode::LedgeHanging => column(2),
        ClimberMode::Holding => column(3),
        ClimberMode::Hanging => column(4),
        ClimberMode::Falling => bar(28),
        ClimberMode::Tumbling => bar(412),
        // Custom modes are not in the diagram.
        ClimberMode::Custom(_) => bar(476),
    }
}

const fn says(mode: ClimberMode) -> &'static str {
    match mode {
        ClimberMode::Sliding => "ground too steep",
        ClimberMode::Standing => "on its feet",
        ClimberMode::LedgeHanging => "from a ledge",
        ClimberMode::Holding => "grips and climbs",
        ClimberMode::Hanging => "can only hold on",
        ClimberMode::Falling => "in the air",
        ClimberMode::Tumbling => "knocked off its feet",
        ClimberMode::Custom(_) => "the game's own",
    }
}

/// Fill and edge colours of a mode's box, by whether it holds on, is supported or neither.
const fn colors(mode: ClimberMode) -> (&'static str, &'static str) {
    if mode.is_holding() {
        ("#fde8c8", "#a8620a")
    } else if mode.is_supported() {
        ("#d5efd9", "#2c7a3f")
    } else {
        ("#dbe7f6", "#2f5f9e")
    }
}

/// An arrow's colour, by its target mode, so that it is easy to follow.
const fn stroke(to: ClimberMode) -> &'static str {
    match to {
        ClimberMode::Falling => "#2f5f9e",
        ClimberMode::Tumbling => "#b0362a",
        _ => "#3a4450",
    }
}

pub(crate) fn svg() -> String {
    let (width, height) = SIZE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         style=\"max-width:100%;height:auto\" role=\"img\" aria-labelledby=\"climber-modes\" \
         font-family=\"sans-serif\" text-anchor=\"middle\" fill=\"#1d232a\">\n\
         <title id=\"climber-modes\">A climber's seven modes and the transitions between them</title>\n\
         <rect x=\"1\" y=\"1\" width=\"{}\" height=\"{}\" rx=\"8\" fill=\"#fbfcfd\" stroke=\"#c3cad2\"/>\n",
        width - 2,
        height - 2,
    );
    for (number, (from, to, _)) in (1..).zip(TRANSITIONS) {
        let route = ROUTES
            .iter()
            .find(|route| (route.from, route.to) == (*from, *to));
        if let Some(route) = route {
            svg += &arrow(route, number);
        }
    }
    for mode in ClimberMode::ALL {
        svg += &boxed(mode);
    }
    // A new climber is in the air.
    svg += "<circle cx=\"22\" cy=\"51\" r=\"6\"/>\n<path d=\"M28 51H52\" stroke=\"#1d232a\" stroke-width=\"2\"/>\n";
    svg += "<path d=\"M60 51l-9 -5v10z\"/>\n<text x=\"27\" y=\"76\" font-size=\"12\">new</text>\n";
    let legend = [
        (90, ClimberMode::Standing, "carried by its ground"),
        (350, ClimberMode::Holding, "holds on: carried, and tires"),
        (610, ClimberMode::Falling, "no support: moves under gravity"),
    ];
    for (x, mode, text) in legend {
        let (fill, edge) = colors(mode);
        svg += &format!(
            "<rect x=\"{x}\" y=\"480\" width=\"18\" height=\"18\" rx=\"4\" fill=\"{fill}\" stroke=\"{edge}\"/>\n\
             <text x=\"{}\" y=\"494\" font-size=\"14\" text-anchor=\"start\">{text}</text>\n",
            x + 26,
        );
    }
    svg + "</svg>\n"
}

fn boxed(mode: ClimberMode) -> String {
    let at = place(mode);
    let (fill, edge) = colors(mode);
    let (x, y) = (at.left + at.width / 2, at.top + at.height / 2);
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"8\" fill=\"{fill}\" stroke=\"{edge}\" \
         stroke-width=\"2\"/>\n\
         <text x=\"{x}\" y=\"{}\" font-size=\"14\" font-weight=\"bold\">{mode:?}</text>\n\
         <text x=\"{x}\" y=\"{}\" font-size=\"12\">{}</text>\n",
        at.left,
        at.top,
        at.width,
        at.height,
        y - 3,
        y + 15,
        says(mode),
    )
}

/// Unit direction from a point to another one beside, above or below it.
fn toward(from: (i32, i32), to: (i32, i32)) -> (i32, i32) {
    ((to.0 - from.0).signum(), (to.1 - from.1).signum())
}

fn along(from: (i32, i32), (dx, dy): (i32, i32), by: i32) -> (i32, i32) {
    (from.0 + dx * by, from.1 + dy * by)
}

fn arrow(route: &Route, number: u32) -> String {
    let way = route.way;
    let last = way.len() - 1;
    let mut path = format!("M{} {}", way[0].0, way[0].1);
    for corner in way.windows(3) {
        let (before, after) = (toward(corner[1], corner[0]), toward(corner[1], corner[2]));
        let (a, b) = (
            along(corner[1], before, CORNER),
            along(corner[1], after, CORNER),
        );
        let (x, y) = corner[1];
        path += &format!("L{} {}Q{x} {y} {} {}", a.0, a.1, b.0, b.1);
    }
    let back = toward(way[last], way[last - 1]);
    let neck = along(way[last], back, HEAD.0);
    path += &format!("L{} {}", neck.0, neck.1);
    let aside = (back.1, back.0);
    let (a, b) = (along(neck, aside, HEAD.1), along(neck, aside, -HEAD.1));
    let color = stroke(route.to);
    let tip = way[last];
    let leg = (way[1].0 - way[0].0).abs() + (way[1].1 - way[0].1).abs();
    // The arrow's head takes up part of a short leg.
    let half = (leg - HEAD.0) / 2;
    let (x, y) = along(way[0], toward(way[0], way[1]), LABEL.min(half));
    format!(
        "<path d=\"{path}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"2\"/>\n\
         <path d=\"M{} {}L{} {}L{} {}z\" fill=\"{color}\"/>\n\
         <rect x=\"{}\" y=\"{}\" width=\"18\" height=\"15\" rx=\"3\" fill=\"#fbfcfd\"/>\n\
         <text x=\"{x}\" y=\"{}\" font-size=\"12\" fill=\"{color}\">{number}</text>\n",
        tip.0,
        tip.1,
        a.0,
        a.1,
        b.0,
        b.1,
        x - 9,
        y - 8,
        y + 4,
    )
}

/// The picture as a link's target (a data URI), for pages that cannot refer to a file.
pub(crate) fn link(svg: &str) -> String {
    let mut link = "[modes]: data:image/svg+xml,".to_owned();
    for byte in svg.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'/' | b':' | b'=' | b',' => {
                link.push(char::from(byte));
            }
            _ => link += &format!("%{byte:02X}"),
        }
    }
    link + "\n"
}
