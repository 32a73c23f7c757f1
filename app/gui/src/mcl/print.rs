//! A program on paper: pages of PDF with line numbers, the colours of the words, and a head with name and page.

use brushwork_script::language::Language;
use brushwork_script::mcl::index::Class;
use egui::Color32;
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str, TextStr};

use super::moves::TAB_CELLS;
use super::paint::color_of;
use super::typeface::{FontFace, Typeface};
use crate::mcl::messages::PrintMessage;
use crate::theme::Palette;
use brushwork_core::keep::today;

/// A4, in points.
const PAGE: (f32, f32) = (595.0, 842.0);
const MARGIN: f32 = 50.0;
const SIZE: f32 = 8.5;
const ROW: f32 = 11.5;
/// Width of a letter of the fixed font, in sizes.
const ADVANCE: f32 = 0.602;
/// The font's name within the file.
const FONT: Name<'static> = Name(b"F");

/// A stretch of a row in one colour: the cell where it begins, and its letters.
type Piece = (usize, String, Color32);

/// One row on paper: its line number, unless it goes on with the line before.
struct Row {
    number: Option<usize>,
    pieces: Vec<Piece>,
}

/// The pages of a program.
///
/// # Errors
/// What the writer of the file says, without a full stop.
pub fn pdf(title: &str, text: &str) -> Result<Vec<u8>, String> {
    let face = FontFace::of_the_window().ok_or("the window's fixed font is missing")?;
    let mut typeface = face.typeface()?;
    let language = Language::of_file(title);
    let digits = text.lines().count().max(1).to_string().len();
    let left = MARGIN + (digits + 2) as f32 * SIZE * ADVANCE;
    let cells = ((PAGE.0 - MARGIN - left) / (SIZE * ADVANCE)) as usize;
    let rows: Vec<Row> = text
        .split('\n')
        .enumerate()
        .flat_map(|(index, line)| rows_of(index + 1, line, cells, language))
        .collect();
    let per_page = ((PAGE.1 - 2.0 * MARGIN - 2.0 * ROW) / ROW) as usize;
    let pages = rows.len().div_ceil(per_page);
    let date = today();

    let mut numbers = Ref::new(1);
    let [catalog, tree, info, font] = [(); 4].map(|()| numbers.bump());
    let mut pdf = Pdf::new();
    let mut kids = Vec::new();
    for (index, rows) in rows.chunks(per_page).enumerate() {
        let mut pen = Pen { content: Content::new(), typeface: &mut typeface };
        pen.head(title, date.get(..10).unwrap_or(&date), index + 1, pages);
        for (row, contents) in rows.iter().enumerate() {
            pen.row(contents, left, digits, MARGIN + 3.0 * ROW + row as f32 * ROW);
        }
        let [page, contents] = [(); 2].map(|()| numbers.bump());
        pdf.stream(contents, &pen.content.finish());
        let mut written = pdf.page(page);
        written.media_box(Rect::new(0.0, 0.0, PAGE.0, PAGE.1)).parent(tree).contents(contents);
        written.resources().fonts().pair(FONT, font);
        written.finish();
        kids.push(page);
    }
    pdf.pages(tree).count(i32::try_from(kids.len()).unwrap_or(i32::MAX)).kids(kids);
    typeface.embed(&mut pdf, font, &mut numbers)?;
    pdf.document_info(info).title(TextStr(title));
    pdf.catalog(catalog).pages(tree);
    Ok(pdf.finish())
}

/// A line as rows that fit the page.
fn rows_of(number: usize, line: &str, cells: usize, language: Language) -> Vec<Row> {
    let line = line.trim_end_matches('\r');
    let palette = Palette::of_theme(egui::Theme::Light);
    let pieces = language.classes(line);
    let class_at =
        |byte: usize| pieces.iter().find(|(range, _)| range.contains(&byte)).map(|(_, class)| *class);
    let mut rows = vec![Row { number: Some(number), pieces: Vec::new() }];
    let mut cell = 0;
    for (byte, letter) in line.char_indices() {
        if letter == '\t' {
            cell = (cell / TAB_CELLS + 1) * TAB_CELLS;
            continue;
        }
        if cell >= cells {
            rows.push(Row { number: None, pieces: Vec::new() });
            cell = 0;
        }
        let color = color_of(&palette.syntax, class_at(byte).unwrap_or(Class::Punctuation), palette);
        let letter = if letter.is_control() { ' ' } else { letter };
        let last = rows.last_mut().and_then(|row| row.pieces.last_mut());
        match last.filter(|(start, text, used)| *used == color && start + text.chars().count() == cell) {
            Some((_, text, _)) => text.push(letter),
            None => {
                rows.last_mut()
                    .into_iter()
                    .for_each(|row| row.pieces.push((cell, letter.to_string(), color)));
            }
        }
        cell += 1;
    }
    rows
}

/// Writes on one page.
struct Pen<'a, 'b> {
    content: Content,
    typeface: &'a mut Typeface<'b>,
}

impl Pen<'_, '_> {
    /// A text whose first letter begins at `x` from the left and stands on a line at `y` from the top.
    fn text(&mut self, x: f32, y: f32, text: &str, color: Color32) {
        let [r, g, b, _] = color.to_normalized_gamma_f32();
        self.content.begin_text().set_font(FONT, SIZE).set_fill_rgb(r, g, b).next_line(x, PAGE.1 - y);
        self.content.show(Str(&self.typeface.glyphs(text))).end_text();
    }

    fn head(&mut self, title: &str, date: &str, page: usize, pages: usize) {
        let palette = Palette::of_theme(egui::Theme::Light);
        self.text(MARGIN, MARGIN, title, palette.text);
        let right = PrintMessage::Page { date: date.to_string(), page, pages }.to_string();
        let width = right.chars().count() as f32 * SIZE * ADVANCE;
        self.text(PAGE.0 - MARGIN - width, MARGIN, &right, palette.weak_text);
    }

    fn row(&mut self, row: &Row, left: f32, digits: usize, y: f32) {
        let palette = Palette::of_theme(egui::Theme::Light);
        if let Some(number) = row.number {
            self.text(MARGIN, y, &format!("{number:>digits$}"), palette.weak_text);
        }
        for (cell, text, color) in &row.pieces {
            self.text(left + *cell as f32 * SIZE * ADVANCE, y, text, *color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_are_written_for_any_text() {
        for text in
            ["", "goto main\n\tpause 10 ; ä € \u{4e2d}\r\n", &"x = 1 ".repeat(100), &"end\n".repeat(200)]
        {
            let pdf = pdf("a.mcl", text).unwrap();
            assert!(pdf.starts_with(b"%PDF-") && pdf.len() > 500, "{}", pdf.len());
        }
    }

    #[test]
    fn a_line_that_is_too_long_goes_on_in_the_next_row_without_a_number() {
        let rows = rows_of(7, &"a".repeat(25), 10, Language::Mcl);
        let numbers: Vec<Option<usize>> = rows.iter().map(|row| row.number).collect();
        assert_eq!(numbers, [Some(7), None, None]);
        assert_eq!(rows[2].pieces[0].1, "aaaaa");
    }

    #[test]
    fn words_keep_their_colours_on_paper() {
        let rows = rows_of(1, "goto main ; away", 80, Language::Mcl);
        let colors: Vec<Color32> = rows[0].pieces.iter().map(|(_, _, color)| *color).collect();
        let syntax = Palette::of_theme(egui::Theme::Light).syntax;
        assert!(colors.contains(&syntax.command) && colors.contains(&syntax.comment), "{colors:?}");
    }
}
