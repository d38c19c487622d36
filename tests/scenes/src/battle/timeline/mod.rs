//! A plot of the battle over time: height, state, drift and time of every tick, and the creature's states.

mod lanes;

use std::path::Path;

use clamber_climber::ClimberMode;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::{Battle, BattleError, Sample, Summary};

/// Height of the plots, and width of the labels beside them, pixels.
const PLOTS: u32 = 900;
const LABELS: u32 = 120;

/// A panel of the plot, with one curve.
struct Panel {
    title: &'static str,
    unit: &'static str,
    color: RGBColor,
    value: fn(&Sample) -> Option<f64>,
}

const PANELS: [Panel; 4] = [
    Panel {
        title: "height of the climber",
        unit: "m",
        color: RGBColor(31, 119, 180),
        value: |s| Some(s.height),
    },
    Panel {
        title: "state: 0 in the air, 1 sliding, 2 on the ground, 3 on the creature",
        unit: "",
        color: RGBColor(44, 130, 44),
        value: |s| {
            Some(match (s.mode, s.riding) {
                (ClimberMode::Falling | ClimberMode::Tumbling, _) => 0.0,
                (ClimberMode::Sliding, _) => 1.0,
                (_, false) => 2.0,
                (_, true) => 3.0,
            })
        },
    },
    Panel {
        title: "drift from the material point",
        unit: "micrometres",
        color: RGBColor(200, 60, 40),
        value: |s| s.drift.map(|drift| drift * 1e6),
    },
    Panel {
        title: "time of a tick",
        unit: "us",
        color: RGBColor(110, 80, 160),
        value: |s| Some(s.microseconds),
    },
];

/// Draws `timeline.svg` into an existing folder.
pub(super) fn draw(
    battle: &Battle<'_>,
    summary: &Summary,
    folder: &Path,
) -> Result<(), BattleError> {
    let path = folder.join("timeline.svg");
    let samples = battle.recording().samples();
    let brain = battle.life().map(|life| life.kind().brain());
    let states = brain.map_or_else(Vec::new, |brain| lanes::seen(samples, brain));
    let below = brain.map_or(0, |_| lanes::height(states.len()));
    let root = SVGBackend::new(&path, (1000, PLOTS + below)).into_drawing_area();
    let drawn = || {
        root.fill(&WHITE)?;
        let (above, below) = root.split_vertically(PLOTS);
        draw_panels(&above, samples, summary)?;
        if let Some(brain) = brain {
            lanes::draw(&below, samples, brain, &states)?;
        }
        root.present()
    };
    drawn().map_err(|error| BattleError::Write {
        path: path.clone(),
        reason: error.to_string(),
    })
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawError<'a> = DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;

fn draw_panels<'a>(
    root: &Area<'a>,
    samples: &[Sample],
    summary: &Summary,
) -> Result<(), DrawError<'a>> {
    let title = format!(
        "battle: {}, {:.0} m, {:.0} s",
        summary.creature, summary.height_m, summary.seconds
    );
    let inner = root.titled(&title, ("sans-serif", 22))?;
    for (area, panel) in inner.split_evenly((PANELS.len(), 1)).iter().zip(&PANELS) {
        draw_panel(area, samples, panel)?;
    }
    Ok(())
}

fn draw_panel<'a>(area: &Area<'a>, samples: &[Sample], panel: &Panel) -> Result<(), DrawError<'a>> {
    let end = samples.last().map_or(1.0, |s| s.seconds);
    let values = samples.iter().filter_map(panel.value);
    let (low, high) = values.fold((0.0, 0.0), |(low, high): (f64, f64), v| {
        (low.min(v), high.max(v))
    });
    let high = if high > low { high * 1.08 } else { low + 1.0 };
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, ("sans-serif", 15))
        .margin(6)
        .margin_right(16)
        .x_label_area_size(24)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(0.0..end, low..high)?;
    chart
        .configure_mesh()
        .x_labels(13)
        .y_labels(5)
        .y_desc(panel.unit)
        .x_label_formatter(&|x| format!("{x:.0} s"))
        .y_label_formatter(&|y| {
            format!("{y:.4}")
                .trim_end_matches('0')
                .trim_end_matches('.')
                .to_owned()
        })
        .light_line_style(TRANSPARENT)
        .draw()?;
    // A gap in the values is a gap in the curve.
    let mut run: Vec<(f64, f64)> = Vec::new();
    for sample in samples {
        match (panel.value)(sample) {
            Some(value) => run.push((sample.seconds, value)),
            None => {
                chart.draw_series(LineSeries::new(run.drain(..), &panel.color))?;
            }
        }
    }
    chart.draw_series(LineSeries::new(run, &panel.color))?;
    Ok(())
}
