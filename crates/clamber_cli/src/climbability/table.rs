use std::fmt::Write as _;

use clamber_navigation::{ClimbReport, ClipReport, Missing, PointReport};

/// The report as text.
pub(super) fn table(report: &ClimbReport, height: f64, ground: f64) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(&mut text, report, height, ground);
    text
}

fn write(text: &mut String, report: &ClimbReport, height: f64, ground: f64) -> std::fmt::Result {
    let share = 100.0 * report.reachable_area / report.area;
    writeln!(text, "height            {height:9.1} m")?;
    writeln!(text, "skin              {:9.1} m2", report.area)?;
    writeln!(text, "  can be gripped  {:9.1} m2", report.grip_area)?;
    writeln!(text, "  can be stood on {:9.1} m2", report.stand_area)?;
    writeln!(
        text,
        "  reachable       {:9.1} m2, {share:.1} %",
        report.reachable_area
    )?;
    writeln!(text, "  to rest on      {:9.1} m2", report.rest_area)?;
    if report.ways_on.is_empty() {
        writeln!(
            text,
            "ways on           none: nothing to stand on or to hold is low enough for a jump"
        )?;
    }
    for way in &report.ways_on {
        let [x, z] = [way.place.x, way.place.z];
        writeln!(
            text,
            "way on            {:9.1} m2 from {} entries, the lowest at x {x:.1}, z {z:.1}",
            way.area, way.entries
        )?;
    }
    let names = report.weak_points.iter().map(|point| point.name.len());
    let width = names.max().unwrap_or(0).max(17);
    for point in &report.weak_points {
        let up = point.place.y - ground;
        writeln!(text, "{:width$} {up:9.1} m up, {}", point.name, how(point))?;
    }
    if !report.clips.is_empty() {
        writeln!(text, "clips, for who is where a climber can get to:")?;
    }
    for clip in &report.clips {
        writeln!(text, "  {:17} {}", clip.name, treats(clip))?;
    }
    Ok(())
}

fn how(point: &PointReport) -> String {
    if let (Some(seconds), Some(stamina)) = (point.seconds, point.stamina) {
        return format!(
            "reached in {seconds:.1} s with {:.0} % of its strength left",
            100.0 * stamina
        );
    }
    match point.missing {
        Some(Missing::Reach(by)) => format!("not reachable: {by:.2} m of reach are missing"),
        Some(Missing::Strength(by)) => {
            format!("not reachable: it would have to hold on for {by:.1} s more without a rest")
        }
        _ => "not reachable: no way leads there".to_owned(),
    }
}

fn treats(clip: &ClipReport) -> String {
    // `HARDEST` stands for all harder shakes, too.
    let least = if clip.hardest_shake >= ClipReport::HARDEST {
        "shakes by at least"
    } else {
        "shakes up to"
    };
    let mut text = format!("{least} {:4.1} m/s2", clip.hardest_shake);
    if clip.slips_from > 0.0 {
        let _ = write!(text, ", tips {:.0} m2 too far to stand on", clip.slips_from);
    }
    if let Some(at) = clip.throws_at {
        let _ = write!(
            text,
            ", throws off {:.0} m2 from {at:.1} s on",
            clip.throws_from
        );
    }
    if let Some(at) = clip.exhausts_at {
        let _ = write!(
            text,
            ", exhausts on {:.0} m2 after {at:.1} s",
            clip.exhausts_on
        );
    }
    text
}
