//! A lane for each state of a creature's brain, with a bar wherever it was in that state.

use clamber_colossus::Brain;
use clamber_colossus::brain::{Act, StateId};
use plotters::prelude::*;

use super::{Area, DrawError, LABELS};
use crate::battle::Sample;

/// Height of a lane, and of title and axis, pixels.
const LANE: u32 = 15;
const FRAME: u32 = 62;

/// States that attack, that shake or roar, and others.
const ATTACK: RGBColor = RGBColor(200, 60, 40);
const WILD: RGBColor = RGBColor(225, 140, 20);
const OTHER: RGBColor = RGBColor(110, 130, 150);

/// The states that a creature was in, in the brain's order.
pub(super) fn seen(samples: &[Sample], brain: &Brain) -> Vec<StateId> {
    let is_seen = |state: &StateId| samples.iter().any(|sample| sample.state == Some(*state));
    brain.states().filter(is_seen).collect()
}

/// Height of the panel, pixels.
pub(super) fn height(lanes: usize) -> u32 {
    FRAME + LANE * lanes as u32
}

pub(super) fn draw<'a>(
    area: &Area<'a>,
    samples: &[Sample],
    brain: &Brain,
    states: &[StateId],
) -> Result<(), DrawError<'a>> {
    let end = samples.last().map_or(1.0, |sample| sample.seconds);
    // The first state is on top.
    let count = states.len();
    let lanes = (0..count).into_segmented();
    let mut chart = ChartBuilder::on(area)
        .caption(
            "state of the creature: attacks red, whole acts orange",
            ("sans-serif", 15),
        )
        .margin(6)
        .margin_right(16)
        .x_label_area_size(24)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(0.0..end, lanes)?;
    let name = |lane: &SegmentValue<usize>| {
        let (SegmentValue::Exact(lane) | SegmentValue::CenterOf(lane)) = lane else {
            return String::new();
        };
        let state = count
            .checked_sub(lane + 1)
            .and_then(|index| states.get(index));
        let path = state.map_or("", |state| brain.path(*state));
        path.rsplit('/').next().unwrap_or_default().to_owned()
    };
    chart
        .configure_mesh()
        .x_labels(13)
        .x_label_formatter(&|x| format!("{x:.0} s"))
        .y_labels(count)
        .y_label_formatter(&name)
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (index, state) in states.iter().enumerate() {
        let lane = count - 1 - index;
        let color = match brain.act(*state) {
            Some(Act::Attack(_)) => ATTACK,
            Some(Act::Once(_)) => WILD,
            _ => OTHER,
        };
        let bars = stays(samples, *state).into_iter().map(|[from, to]| {
            let [low, high] = [SegmentValue::Exact(lane), SegmentValue::Exact(lane + 1)];
            Rectangle::new([(from, low), (to, high)], color.filled())
        });
        chart.draw_series(bars)?;
    }
    Ok(())
}

/// When it was in a state: seconds from and to.
fn stays(samples: &[Sample], state: StateId) -> Vec<[f64; 2]> {
    let mut stays: Vec<[f64; 2]> = Vec::new();
    let mut before = 0.0;
    let mut is_in = false;
    for sample in samples {
        let now = sample.state == Some(state);
        match stays.last_mut() {
            Some(stay) if now && is_in => stay[1] = sample.seconds,
            _ if now => stays.push([before, sample.seconds]),
            _ => {}
        }
        (is_in, before) = (now, sample.seconds);
    }
    stays
}
