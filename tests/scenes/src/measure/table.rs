use std::fmt;
use std::io;
use std::path::Path;

/// Rows of text under named columns, to be printed as Markdown and written as CSV.
#[derive(Clone, Debug)]
pub struct Table {
    columns: Vec<&'static str>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: &[&'static str]) -> Self {
        Self {
            columns: columns.to_vec(),
            rows: Vec::new(),
        }
    }

    /// Appends a row.
    ///
    /// # Panics
    /// If the number of cells is not the number of columns.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(row.len(), self.columns.len(), "{row:?}");
        self.rows.push(row);
    }

    /// Writes the table as CSV, and creates the folder if needed.
    ///
    /// # Errors
    /// If the file or its folder cannot be written.
    pub fn write_csv(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let header = self.columns.iter().map(|c| quoted(c)).collect();
        let rows = self
            .rows
            .iter()
            .map(|row| row.iter().map(|c| quoted(c)).collect());
        let lines = std::iter::once(header).chain(rows);
        let text: String = lines
            .map(|line: Vec<String>| line.join(",") + "\n")
            .collect();
        std::fs::write(path, text)
    }
}

/// A cell as a CSV field, quoted if needed (RFC 4180).
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

impl fmt::Display for Table {
    /// Writes the table as Markdown with aligned columns.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |column: usize| {
            let cells = self.rows.iter().map(|row| row[column].chars().count());
            cells.fold(self.columns[column].chars().count(), usize::max)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let line = |f: &mut fmt::Formatter<'_>, cells: &[&str]| {
            for (cell, width) in cells.iter().zip(&widths) {
                write!(f, "| {cell:<width$} ")?;
            }
            writeln!(f, "|")
        };
        line(f, &self.columns)?;
        writeln!(f, "|{}", "---|".repeat(self.columns.len()))?;
        for row in &self.rows {
            line(f, &row.iter().map(String::as_str).collect::<Vec<_>>())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_markdown_and_writes_csv() {
        let mut table = Table::new(&["name", "us"]);
        table.push(vec!["a, \"b\"".into(), "1.5".into()]);
        assert_eq!(
            table.to_string(),
            "| name   | us  |\n|---|---|\n| a, \"b\" | 1.5 |\n"
        );
        let folder = std::env::temp_dir().join(format!("clamber-table-{}", std::process::id()));
        let path = folder.join("table.csv");
        table.write_csv(&path).unwrap();
        let written = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(written, "name,us\n\"a, \"\"b\"\"\",1.5\n");
    }
}
