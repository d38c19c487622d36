use std::error::Error;
use std::ops::Range;
use std::path::Path;

use plotters::coord::combinators::IntoLogRange;
use plotters::prelude::*;

/// Measured points on two logarithmic axes, as an SVG.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// The title, drawn above the plot.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x: String,
    /// Label of the vertical axis, with its unit.
    pub y: String,
    /// True to join the points of a series by lines, in their order.
    pub joined: bool,
    /// Names in the legend, and points. Each series has its own colour, up to twelve.
    pub series: Vec<(String, Vec<(f64, f64)>)>,
}

const COLORS: [RGBColor; 12] = [
    RGBColor(200, 40, 40),
    RGBColor(31, 119, 180),
    RGBColor(44, 130, 44),
    RGBColor(148, 103, 189),
    RGBColor(230, 120, 20),
    RGBColor(23, 160, 175),
    RGBColor(120, 80, 60),
    RGBColor(220, 110, 180),
    RGBColor(110, 110, 110),
    RGBColor(150, 160, 30),
    RGBColor(20, 50, 120),
    RGBColor(0, 0, 0),
];

impl Plot {
    /// Adds a point to the series of this name. One with a coordinate that is not finite and above 0 is not drawn.
    pub fn add(&mut self, series: &str, (x, y): (f64, f64)) {
        let is_drawn = |value: f64| value.is_finite() && value > 0.0;
        let point = (is_drawn(x) && is_drawn(y)).then_some((x, y));
        match self.series.iter_mut().find(|(name, _)| name == series) {
            Some((_, points)) => points.extend(point),
            None => self
                .series
                .push((series.to_owned(), point.into_iter().collect())),
        }
    }

    /// Draws the plot into a file, and creates its folder if needed. Without a point to draw it writes no file.
    pub fn write_svg(&self, path: &Path) -> Result<(), Box<dyn Error>> {
        let points = || self.series.iter().flat_map(|(_, points)| points);
        let (Some(x), Some(y)) = (range(points().map(|p| p.0)), range(points().map(|p| p.1)))
        else {
            return Ok(());
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let root = SVGBackend::new(path, (1000, 620)).into_drawing_area();
        root.fill(&WHITE)?;
        let (area, legend) = root.split_horizontally(740);
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, ("sans-serif", 20))
            .margin(8)
            .x_label_area_size(44)
            .y_label_area_size(72)
            .build_cartesian_2d(x.log_scale(), y.log_scale())?;
        chart
            .configure_mesh()
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&number)
            .y_label_formatter(&number)
            .light_line_style(TRANSPARENT)
            .draw()?;
        for (index, (name, points)) in self.series.iter().enumerate() {
            let color = COLORS[index % COLORS.len()];
            if self.joined {
                let style = color.stroke_width(2);
                chart.draw_series(std::iter::once(PathElement::new(points.clone(), style)))?;
            }
            let dots = points.iter().map(|p| Circle::new(*p, 4, color.filled()));
            chart.draw_series(dots)?;
            let height = 50 + 24 * index as i32;
            legend.draw(&Circle::new((10, height), 5, color.filled()))?;
            let text = ("sans-serif", 15).into_font();
            legend.draw(&Text::new(name.clone(), (24, height - 8), text))?;
        }
        root.present()?;
        Ok(())
    }
}

/// A range that holds all values, with a margin of a factor of 1.5 at each end; `None` without values.
fn range(values: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (low <= high).then_some(low / 1.5..high * 1.5)
}

fn number(value: &f64) -> String {
    match value.abs() {
        size if size >= 1e6 => format!("{:.0} M", value / 1e6),
        size if size >= 1e3 => format!("{:.0} k", value / 1e3),
        size if size >= 1.0 => format!("{value:.0}"),
        size if size >= 1e-3 => format!("{value}"),
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_positive_points_are_drawn_and_none_make_no_file() {
        let folder = std::env::temp_dir().join(format!("clamber-plot-{}", std::process::id()));
        let path = folder.join("plot.svg");
        let mut plot = Plot {
            joined: true,
            ..Plot::default()
        };
        for point in [(1.0, 2.0), (0.0, 1.0), (10.0, f64::NAN), (100.0, 3e-9)] {
            plot.add("one", point);
        }
        plot.write_svg(&path).unwrap();
        let drawn = std::fs::read_to_string(&path).unwrap();
        // Two points, and one in the legend.
        assert_eq!(drawn.matches("<circle").count(), 3, "{drawn}");
        assert!(drawn.contains("one"));
        std::fs::remove_dir_all(&folder).unwrap();
        plot.series.clear();
        plot.write_svg(&path).unwrap();
        assert!(!path.exists());
    }
}
