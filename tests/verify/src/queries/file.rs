//! Reads query files of the data sets of Wang, Ferguson, Schneider, Jiang, Attene and Panozzo 2021, *A
//! Large-Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision Detection*. A query has
//! eight rows. Each row is a vertex in rational numbers, and whether the query's motion ever touches.

use std::error::Error;
use std::path::Path;

use dashu_int::IBig;
use dashu_ratio::Relaxed;

use super::query::{FileQuery, QueryKind};
use crate::exact::Exact;

/// Number of rows of a query in a file: four points at two times.
const ROWS: usize = 8;

/// Reads the queries of a file, whose path must contain `edge-edge` or `vertex-face`. The last of these in
/// the path is the kind of the queries.
///
/// # Errors
/// If the file cannot be read, the path contains neither kind, a row is not valid, or the file ends within a query.
pub fn read_queries(file: &Path) -> Result<Vec<FileQuery>, Box<dyn Error>> {
    let text = std::fs::read_to_string(file);
    let text = text.map_err(|error| format!("{}: {error}", file.display()))?;
    parse_queries(file, &text)
}

/// Parses the queries of a file's text. The path `file` gives their kind, and is named in errors.
pub fn parse_queries(file: &Path, text: &str) -> Result<Vec<FileQuery>, Box<dyn Error>> {
    let name = file.display();
    let kind = kind_of(file)
        .ok_or_else(|| format!("{name}: expected `edge-edge` or `vertex-face` in the path"))?;
    let of_row = |line: usize, reason: &str| format!("{name}:{line}: {reason}");
    let mut rows = Vec::new();
    for (index, row) in text.lines().enumerate() {
        rows.push(parse_row(row).map_err(|reason| of_row(index + 1, &reason))?);
    }
    let (whole, rest) = rows.as_chunks::<ROWS>();
    if !rest.is_empty() {
        let rows = rows.len();
        return Err(format!("{name}: {rows} rows, not a multiple of the 8 rows of a query").into());
    }
    let mut queries = Vec::new();
    for (index, rows) in whole.iter().enumerate() {
        let line = index * ROWS + 1;
        let touches = rows[0].1;
        if let Some(other) = rows.iter().position(|(_, label)| *label != touches) {
            let reason = "column 7 differs from column 7 of the query's first row";
            return Err(of_row(line + other, reason).into());
        }
        let points = rows.each_ref().map(|(point, _)| point.clone());
        let query = FileQuery::new(kind, points, touches, line);
        queries.push(query.map_err(|reason| of_row(line, &reason))?);
    }
    Ok(queries)
}

fn kind_of(file: &Path) -> Option<QueryKind> {
    let path = file.to_string_lossy();
    // The last kind in the path counts: folders above may have any name.
    match (path.rfind("edge-edge"), path.rfind("vertex-face")) {
        (None, None) => None,
        (edge, vertex) if edge > vertex => Some(QueryKind::EdgeEdge),
        _ => Some(QueryKind::VertexFace),
    }
}

fn parse_row(row: &str) -> Result<(Exact, bool), String> {
    let columns: Vec<&str> = row.split(',').map(str::trim).collect();
    let [x, x_over, y, y_over, z, z_over, label] = columns[..] else {
        return Err(format!("expected 7 columns, found {}", columns.len()));
    };
    let point = [
        parse_number(1, x, x_over)?,
        parse_number(3, y, y_over)?,
        parse_number(5, z, z_over)?,
    ];
    let touches = match label {
        "0" => false,
        "1" => true,
        _ => return Err(format!("column 7: expected 0 or 1, found `{label}`")),
    };
    Ok((point, touches))
}

fn parse_number(column: usize, over: &str, under: &str) -> Result<Relaxed, String> {
    let [over, under] = [(column, over), (column + 1, under)].map(|(column, text)| {
        let parsed = text.parse::<IBig>();
        parsed.map_err(|_| format!("column {column}: expected an integer, found `{text}`"))
    });
    let (over, under) = (over?, under?);
    if under == IBig::ZERO {
        return Err(format!("column {}: a denominator of 0", column + 1));
    }
    Ok(Relaxed::from_parts_signed(over, under))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::number;

    /// A row with two fractions, and a number larger than 64 bits.
    const ROW: &str = "1,2,-3,4,162259276829213363391578010288128,1,1\n";

    #[test]
    fn rows_are_rational_numbers() {
        let (point, touches) = parse_row(ROW.trim()).unwrap();
        let large = number((1u128 << 107) as f64);
        assert_eq!(
            (point, touches),
            ([number(0.5), number(-0.75), large], true)
        );
    }

    #[test]
    fn the_last_kind_in_the_path_counts() {
        let kind = |path: &str| kind_of(Path::new(path));
        assert_eq!(kind("a/vertex-face/1.csv"), Some(QueryKind::VertexFace));
        assert_eq!(kind("a/edge-edge/1.csv"), Some(QueryKind::EdgeEdge));
        let both = "vertex-face/edge-edge/1.csv";
        assert_eq!(kind(both), Some(QueryKind::EdgeEdge));
        assert_eq!(kind("a/1.csv"), None);
    }

    #[test]
    fn errors_name_the_file_and_the_line() {
        let good = ["0,1,0,1,0,1,0\n"; 8].concat();
        let says = |file: &str, text: String| {
            let read = parse_queries(Path::new(file), &text);
            read.map(|queries| queries.len()).map_err(|e| e.to_string())
        };
        let error = |text: String| says("vertex-face.csv", text).unwrap_err();
        assert_eq!(says("vertex-face.csv", good.repeat(2)), Ok(2));
        assert_eq!(says("vertex-face.csv", String::new()), Ok(0));
        let unnamed = says("a.csv", good.clone()).unwrap_err();
        assert!(unnamed.contains("a.csv: expected `edge-edge`"), "{unnamed}");
        let replaced = |row: &str| error(good.clone() + row + &good[14..]);
        for (row, expected) in [
            ("0,1,0,1,0,1\n", ":9: expected 7 columns, found 6"),
            ("\n", ":9: expected 7 columns, found 1"),
            (
                "0,1,0,1,x,1,0\n",
                ":9: column 5: expected an integer, found `x`",
            ),
            ("0,1,0,0,0,1,0\n", ":9: column 4: a denominator of 0"),
            (
                "0,1,0,1,0,1,2\n",
                ":9: column 7: expected 0 or 1, found `2`",
            ),
            ("0,1,0,1,0,1,1\n", ":10: column 7 differs"),
            (
                "1,9999999999999999999999999999999999999,0,1,0,1,0\n",
                ":9: a query of extent 1e-37",
            ),
        ] {
            let found = replaced(row);
            assert!(found.contains(expected), "{found}\nexpected {expected}");
        }
        assert!(error(good + "0,1,0,1,0,1,0\n").contains("9 rows, not a multiple"));
        let missing = read_queries(Path::new("no/such/vertex-face.csv")).unwrap_err();
        assert!(missing.to_string().starts_with("no/such/vertex-face.csv: "));
    }
}
