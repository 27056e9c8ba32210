//! Aligned columns on the terminal, and large numbers that can be read.

/// Which side the text of a column stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Left,
    Right,
}

/// Rows as lines of aligned columns, two spaces apart, each line after `indent`; no spaces at the end of a line.
/// A column is as wide as its widest cell; what lies beyond the columns of `aligns` stands on the left.
pub(crate) fn columns(indent: &str, aligns: &[Align], rows: &[Vec<String>]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = indent.to_owned();
        for (column, cell) in row.iter().enumerate() {
            let width = widths[column];
            match aligns.get(column) {
                Some(Align::Right) => line.push_str(&format!("{cell:>width$}")),
                _ => line.push_str(&format!("{cell:<width$}")),
            }
            line.push_str("  ");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// The same, with the last cell of a row broken between words so that no line is wider than `width`.
pub(crate) fn wrapped(indent: &str, aligns: &[Align], rows: &[Vec<String>], width: usize) -> String {
    let last = rows.iter().map(Vec::len).max().unwrap_or(0).saturating_sub(1);
    let before: usize = (0..last)
        .map(|column| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0))
        .map(|cell| cell + 2)
        .sum();
    let room = width.saturating_sub(indent.chars().count() + before).max(20);
    let mut broken = Vec::new();
    for row in rows {
        let mut lines = lines(row.get(last).map_or("", String::as_str), room).into_iter();
        let mut first = row[..last.min(row.len())].to_vec();
        first.extend(lines.next());
        broken.push(first);
        broken.extend(lines.map(|line| [vec![String::new(); last], vec![line]].concat()));
    }
    columns(indent, aligns, &broken)
}

/// Text broken between words into lines of at most `width` characters; a longer word has a line of its own.
pub(crate) fn lines(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A row of cells.
pub(crate) fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

/// A number with thin groups of three digits: 12 345 678.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_align_and_lines_end_without_spaces() {
        let rows = [row(["a", "1", "x"]), row(["long", "22", ""])];
        assert_eq!(columns("  ", &[Align::Left, Align::Right], &rows), "  a      1  x\n  long  22\n");
    }

    #[test]
    fn wrapped_last_cell_hangs_below_itself() {
        let rows = [row(["a", "one two three four five six"]), row(["b", "seven"])];
        assert_eq!(wrapped("", &[], &rows, 10), "a  one two three four\n   five six\nb  seven\n");
        assert_eq!(lines("a bb verylongword c", 4), ["a bb", "verylongword", "c"]);
    }

    #[test]
    fn grouped_numbers_of_every_length() {
        assert_eq!([0, 12, 123, 1234, 1_234_567].map(grouped), ["0", "12", "123", "1 234", "1 234 567"]);
    }
}
