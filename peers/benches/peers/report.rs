//! The table and the plots.

use std::error::Error;

use clamber_peers::Plot;
use clamber_scenes::measure::{Bound, Cells, Table, measure_file};
use clamber_surface::mesh::ColliderMesh;

use crate::race::{Entrant, Lap};

/// Columns of the table.
const COLUMNS: [&str; 14] = [
    "method",
    "vertices",
    "triangles",
    "riders",
    "update, us",
    "ray, us",
    "overlap, us",
    "closest point, us",
    "sphere cast, us",
    "whole tick, us",
    "quartiles, us",
    "tick / clamber's",
    "hits / clamber's",
    "memory, MB",
];

/// Cell for a query that a peer does not have.
const CANNOT: &str = "cannot";

/// The results, one row for each method, size and number of riders.
pub(crate) struct Report {
    table: Table,
    rows: Vec<Row>,
}

struct Row {
    name: &'static str,
    vertices: usize,
    riders: usize,
    tick: Option<f64>,
}

impl Default for Report {
    fn default() -> Self {
        Self {
            table: Table::new(&COLUMNS),
            rows: Vec::new(),
        }
    }
}

impl Report {
    /// Adds the results of a race. clamber must be its first entrant, and clamber skinned ahead its second.
    pub(crate) fn add(
        &mut self,
        mesh: &ColliderMesh,
        riders: usize,
        entrants: &[Entrant],
        laps: Vec<Lap>,
    ) -> Result<(), Box<dyn Error>> {
        let [Some(ours), Some(eager)] = [0, 1].map(|index: usize| laps[index].tick.as_ref()) else {
            return Err("clamber has no times of whole ticks".into());
        };
        if ours.hits != eager.hits {
            return Err(format!("{} lazy hits a tick, {} eager", ours.hits, eager.hits).into());
        }
        let vertices = mesh.positions().len();
        for (entrant, lap) in entrants.iter().zip(&laps) {
            let mut row = vec![
                entrant.name.to_owned(),
                vertices.to_string(),
                mesh.triangles().len().to_string(),
                riders.to_string(),
                digits(lap.update),
            ];
            let queries = lap.queries.iter();
            row.extend(queries.map(|us| us.map_or(CANNOT.to_owned(), digits)));
            match &lap.tick {
                Some(tick) => {
                    let [low, high] = tick.quartiles.map(digits);
                    row.extend([
                        digits(tick.median),
                        format!("{low} to {high}"),
                        digits(tick.median / ours.median),
                        format!("{:.4}", tick.hits / ours.hits),
                    ]);
                }
                None => row.extend([CANNOT; 4].map(str::to_owned)),
            }
            row.push(digits(entrant.bytes as f64 / 1e6));
            println!("{}", row.join(", "));
            self.table.push(row);
            self.rows.push(Row {
                name: entrant.name,
                vertices,
                riders,
                tick: lap.tick.as_ref().map(|tick| tick.median),
            });
        }
        Ok(())
    }

    pub(crate) fn finish(self, brief: bool) -> Result<(), Box<dyn Error>> {
        println!("\n{}", self.table);
        self.table.write("peers", brief)?;
        self.compare(!brief)?;
        for (riders, what) in [(1, "1 rider"), (100, "100 riders")] {
            let points = self.rows.iter().filter(|row| row.riders == riders);
            let plot = plot(what, "vertices", points.map(|row| (row, row.vertices)));
            let name = format!("peers_{riders}_riders");
            plot.write_svg(&measure_file(&name, brief, "svg"))?;
        }
        let largest = self.rows.iter().map(|row| row.vertices).max().unwrap_or(0);
        let points = self.rows.iter().filter(|row| row.vertices == largest);
        let what = format!("{largest} vertices");
        let plot = plot(&what, "riders", points.map(|row| (row, row.riders)));
        plot.write_svg(&measure_file("peers_by_riders", brief, "svg"))
    }

    /// The fastest peer's time over clamber's, for each size and number of riders.
    fn compare(&self, full: bool) -> Result<(), Box<dyn Error>> {
        let mut cells = Cells::default();
        let mut ahead = 0;
        let ours = self.rows.iter().filter(|row| row.name == "clamber");
        for (row, own) in ours.filter_map(|row| Some((row, row.tick?))) {
            let others = self.rows.iter().filter(|other| {
                let same = (other.vertices, other.riders) == (row.vertices, row.riders);
                same && !other.name.starts_with("clamber")
            });
            let fastest = others
                .filter_map(|other| Some((other.tick?, other.name)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((tick, name)) = fastest {
                let cell = format!(
                    "{} vertices, {} riders: {name} / clamber",
                    row.vertices, row.riders
                );
                cells.push(&cell, tick / own, Bound::Least(0.8));
                ahead += usize::from(tick >= own);
            }
        }
        let bound = if full {
            Bound::Least(14.0)
        } else {
            Bound::None
        };
        cells.push("cells in which no peer is faster", ahead as f64, bound);
        cells.finish("peers_fastest", !full)
    }
}

/// A plot of whole ticks, over the number beside each row.
fn plot<'a>(what: &str, x: &str, rows: impl Iterator<Item = (&'a Row, usize)>) -> Plot {
    let mut plot = Plot {
        title: format!("A whole tick, {what}"),
        x: x.to_owned(),
        y: "us".to_owned(),
        joined: true,
        ..Plot::default()
    };
    for (row, place) in rows {
        if let Some(tick) = row.tick {
            plot.add(row.name, (place as f64, tick));
        }
    }
    plot
}

/// A number with at least three significant digits, or with three decimals if it is below 1.
fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        _ => 3,
    };
    format!("{value:.decimals$}")
}
