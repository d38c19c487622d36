//! Tests that text is drawn where it is placed, and nowhere else.

use clamber_render::{Image, TextSize};

/// Width of the picture, pixels.
const WIDTH: u32 = 120;
/// Height of the picture, pixels.
const ROWS: u32 = 60;
/// Each channel of the background.
const GREY: u8 = 200;

fn grey(width: u32, height: u32) -> Image {
    Image {
        width,
        height,
        pixels: [GREY, GREY, GREY, 255].repeat((width * height) as usize),
    }
}

/// The object that a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shown {
    Picture,
    Box,
    Letter,
}

fn shown(image: &Image, column: u32, row: u32) -> Shown {
    let at = ((row * image.width + column) * 4) as usize;
    match image.pixels[at..at + 4] {
        [GREY, GREY, GREY, 255] => Shown::Picture,
        [255, 255, 255, 255] => Shown::Letter,
        [70, 70, 70, 255] => Shown::Box,
        ref other => unreachable!("{column}, {row}: {other:?}"),
    }
}

/// First and last column, and first and last row, of the pixels that show `wanted`.
fn extent(image: &Image, wanted: Shown) -> Option<[u32; 4]> {
    let mut found: Option<[u32; 4]> = None;
    for row in 0..image.height {
        for column in 0..image.width {
            if shown(image, column, row) == wanted {
                let [a, b, c, d] = found.unwrap_or([column, column, row, row]);
                found = Some([a.min(column), b.max(column), c.min(row), d.max(row)]);
            }
        }
    }
    found
}

#[test]
fn letters_are_in_their_box_and_nothing_else_changes() {
    for (size, width, height) in [(TextSize::Small, 6, 13), (TextSize::Large, 10, 20)] {
        let mut image = grey(WIDTH, ROWS);
        image.text([20, 4], size, "HEH\nH");
        // Eight pixels of margin on each side of three columns and two lines.
        let boxed = extent(&image, Shown::Box);
        let last = (20 + 16 + 3 * width - 1, 4 + 16 + 2 * height - 1);
        assert_eq!(
            boxed,
            Some([20, last.0, 4, last.1.min(ROWS - 1)]),
            "{size:?}"
        );
        let picture = (0..ROWS).flat_map(|row| (0..WIDTH).map(move |column| (column, row)));
        let outside = picture
            .filter(|(column, row)| !(20..=last.0).contains(column) || !(4..=last.1).contains(row));
        for (column, row) in outside {
            let seen = shown(&image, column, row);
            assert_eq!(seen, Shown::Picture, "{size:?} {column} {row}");
        }
        let Some([left, right, top, bottom]) = extent(&image, Shown::Letter) else {
            unreachable!("{size:?}: no letter");
        };
        let inner = (28..28 + 3 * width, 12..12 + 2 * height);
        assert!(
            inner.0.contains(&left) && inner.0.contains(&right),
            "{size:?}: {left} {right}"
        );
        assert!(
            inner.1.contains(&top) && inner.1.contains(&bottom),
            "{size:?}: {top} {bottom}"
        );
        // One letter in the second line, three in the first.
        let white = |columns: core::ops::Range<u32>, rows: core::ops::Range<u32>| {
            let places = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
            let letters = places.filter(|(column, row)| *row < ROWS && *column < WIDTH);
            letters
                .filter(|(column, row)| shown(&image, *column, *row) == Shown::Letter)
                .count()
        };
        let h = white(28..28 + width, 12..12 + height);
        let last = white(28 + 2 * width..28 + 3 * width, 12..12 + height);
        assert!(h > 10, "{size:?}: {h}");
        assert_eq!(h, last, "{size:?}: the same letter");
        let below = white(28..28 + width, 12 + height..12 + 2 * height);
        let beside = white(28 + width..28 + 3 * width, 12 + height..12 + 2 * height);
        assert_eq!((below, beside), (h, 0), "{size:?}");
    }
}

#[test]
fn text_that_reaches_out_of_the_picture_is_cut_off() {
    let long = "M".repeat(100_000);
    let high = "M\n".repeat(100_000);
    for (width, rows) in [(1, 1), (7, 3), (WIDTH, ROWS)] {
        for text in [&long, &high] {
            for corner in [[0, 0], [width - 1, rows - 1], [width / 2, rows / 2]] {
                let mut image = grey(width, rows);
                image.text(corner, TextSize::Large, text);
                assert_eq!(image.pixels.len(), (width * rows * 4) as usize);
                assert_ne!(
                    shown(&image, corner[0], corner[1]),
                    Shown::Picture,
                    "{corner:?}"
                );
            }
        }
    }
    // Text does not wrap around to the other side.
    let mut image = grey(WIDTH, ROWS);
    image.text([WIDTH - 30, 10], TextSize::Large, &long);
    let drawn = extent(&image, Shown::Box);
    assert_eq!(drawn, Some([WIDTH - 30, WIDTH - 1, 10, 45]));
    let letters = extent(&image, Shown::Letter);
    assert!(
        letters.is_some_and(|[left, ..]| left >= WIDTH - 22),
        "{letters:?}"
    );
}

#[test]
fn text_outside_of_the_picture_and_empty_text_draw_nothing() {
    let untouched = grey(WIDTH, ROWS);
    let mut image = untouched.clone();
    for corner in [
        [WIDTH, 0],
        [0, ROWS],
        [u32::MAX, u32::MAX],
        [u32::MAX - 3, 2],
    ] {
        image.text(corner, TextSize::Large, "far away");
        assert!(image == untouched, "{corner:?}");
    }
    image.text([3, 3], TextSize::Small, "");
    assert!(image == untouched);
    // A picture without pixels, and one with fewer pixels than its size.
    let mut broken = Image {
        width: 0,
        height: 0,
        pixels: Vec::new(),
    };
    broken.text([0, 0], TextSize::Small, "nowhere");
    broken.width = 50;
    broken.height = 50;
    broken.text([0, 0], TextSize::Small, "nowhere");
    assert!(broken.pixels.is_empty());
}

#[test]
fn characters_that_the_font_lacks_are_question_marks() {
    let write = |text: &str| {
        let mut image = grey(WIDTH, ROWS);
        image.text([0, 0], TextSize::Small, text);
        image
    };
    assert!(write("a\tb\u{e9}\u{1f409}") == write("a?b??"));
    assert!(write("a b") != write("a?b"));
    assert!(write("a\r\nb\n") == write("a\nb"), "ends of lines");
}
