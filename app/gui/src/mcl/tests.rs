//! The text and all that is done to it against a plain string, with random edits and letters of every kind.

use proptest::prelude::*;
use unicode_segmentation::UnicodeSegmentation as _;

use super::moves::{Move, byte_at_cell, cell_of, moved, word_at};
use super::{Buffer, Caret, DocId, Document, Kind};

/// Letters of one to four bytes, joined ones, line ends and blanks.
const LETTERS: [&str; 14] =
    ["a", "Z", "0", " ", "\t", "\n", ";", "ä", "€", "\u{1F600}", "e\u{301}", "\u{200D}", "\r", "中"];

fn any_text(most: usize) -> impl Strategy<Value = String> {
    proptest::collection::vec(0..LETTERS.len(), 0..most)
        .prop_map(|letters| letters.into_iter().map(|letter| LETTERS[letter]).collect())
}

/// Where in the text, as a part of its length, how much of it, and what comes in its place.
fn any_edit() -> impl Strategy<Value = (f64, f64, String, u8)> {
    (0.0..=1.0, 0.0..=0.3, any_text(6), 0u8..3)
}

fn kind(number: u8) -> Kind {
    [Kind::Typing, Kind::Erasing, Kind::Other][usize::from(number)]
}

/// The places that the edit takes away in `text`, on boundaries of characters.
fn range(text: &str, at: f64, part: f64) -> std::ops::Range<usize> {
    let floor =
        |byte: usize| (0..=byte.min(text.len())).rev().find(|byte| text.is_char_boundary(*byte)).unwrap_or(0);
    let start = floor((text.len() as f64 * at) as usize);
    start..floor(start + (text.len() as f64 * part) as usize).max(start)
}

fn agrees(buffer: &Buffer, model: &str) -> Result<(), TestCaseError> {
    prop_assert_eq!(buffer.text(), model);
    prop_assert_eq!(buffer.len(), model.len());
    let lines: Vec<&str> = model.split('\n').collect();
    prop_assert_eq!(buffer.line_count(), lines.len());
    let mut start = 0;
    for (index, line) in lines.iter().enumerate() {
        let held = buffer.line(index).into_owned();
        prop_assert_eq!(&held, line);
        prop_assert_eq!((buffer.line_start(index), buffer.line_end(index)), (start, start + line.len()));
        prop_assert_eq!(buffer.line_of(start + line.len()), index);
        start += line.len() + 1;
    }
    Ok(())
}

proptest! {
    #![proptest_config(proptest::test_runner::Config {
        rng_seed: proptest::test_runner::RngSeed::Fixed(0x5EED),
        failure_persistence: None,
        ..proptest::test_runner::Config::default()
    })]

    #[test]
    fn edits_do_to_the_text_what_they_do_to_a_string(
        begin in any_text(60), edits in proptest::collection::vec(any_edit(), 0..30)
    ) {
        let mut buffer = Buffer::new(&begin);
        let mut model = begin.clone();
        agrees(&buffer, &model)?;
        for (at, part, with, how) in edits {
            let range = range(&model, at, part);
            model.replace_range(range.clone(), &with);
            buffer.edit(kind(how), Caret::default(), [(range, with)], |_| Caret::default());
            agrees(&buffer, &model)?;
        }
        let end = buffer.text();
        while buffer.undo().is_some() {}
        agrees(&buffer, &begin)?;
        prop_assert!(!buffer.is_modified(), "the text is what it was");
        while buffer.redo().is_some() {}
        agrees(&buffer, &end)?;
    }

    #[test]
    fn any_byte_may_be_asked_for_and_no_character_is_cut(
        text in any_text(40), from in 0usize..200, to in 0usize..200
    ) {
        let mut buffer = Buffer::new(&text);
        let slice = buffer.slice(from..to).into_owned();
        prop_assert!(text.contains(&slice));
        buffer.edit(Kind::Other, Caret::default(), [(from..to, "x".to_owned())], |_| Caret::default());
        prop_assert!(buffer.text().contains('x'));
        prop_assert!(buffer.boundary(from) <= buffer.len());
    }

    #[test]
    fn the_caret_stands_between_characters_whatever_moves_it(
        text in any_text(60), moves in proptest::collection::vec((0u8..12, any::<bool>()), 0..40)
    ) {
        let buffer = Buffer::new(&text);
        let last = buffer.line_count() - 1;
        let mut caret = Caret::default();
        for (way, extend) in moves {
            let way = [
                Move::Left, Move::Right, Move::WordLeft, Move::WordRight, Move::Up, Move::Down, Move::PageUp(3),
                Move::PageDown(3), Move::LineStart, Move::LineEnd, Move::Start, Move::End,
            ][usize::from(way)];
            caret = moved(&buffer, caret, way, extend, |line, rows| line.saturating_add_signed(rows).min(last));
            prop_assert!(text.is_char_boundary(caret.head) && text.is_char_boundary(caret.anchor));
            let word = word_at(&buffer, caret.head);
            prop_assert!(word.start <= caret.head && caret.head <= word.end && word.end <= text.len());
        }
    }

    #[test]
    fn cells_and_bytes_of_a_line_agree(text in any_text(30)) {
        let line = text.replace('\n', "");
        for (byte, _) in line.grapheme_indices(true) {
            prop_assert_eq!(byte_at_cell(&line, cell_of(&line, byte)), byte);
        }
    }

    #[test]
    fn whatever_is_typed_undo_brings_the_program_back(
        begin in any_text(60), keys in proptest::collection::vec((0u8..16, any_text(4), any::<bool>()), 0..40)
    ) {
        let mut document = Document::new(DocId(1), String::new(), &begin);
        document.bookmarks.set([0, 1, 2]);
        for (key, text, extend) in keys {
            press(&mut document, key, &text, extend);
            let held = document.text.text();
            prop_assert!(held.is_char_boundary(document.caret.head) && held.is_char_boundary(document.caret.anchor));
            prop_assert!(document.bookmarks.iter().all(|line| line < document.text.line_count() + 3));
            prop_assert!(document.folds.rows(document.text.line_count()) >= 1);
        }
        while document.text.can_undo() {
            document.undo();
        }
        prop_assert_eq!(document.text.text(), begin);
    }
}

fn press(document: &mut Document, key: u8, text: &str, extend: bool) {
    match key {
        0 => document.type_text(text),
        1 => document.new_line(),
        2 => document.erase(Move::Left),
        3 => document.erase(Move::WordRight),
        4 => document.indent(),
        5 => document.unindent(),
        6 => document.toggle_comment(),
        7 => document.duplicate_lines(),
        8 => document.delete_lines(),
        9 => document.move_lines(extend),
        10 => document.paste(text),
        11 => drop(document.cut()),
        12 => super::input::go(document, Move::Down, extend),
        13 => super::input::go(document, Move::WordRight, extend),
        14 => super::input::go(document, Move::Left, extend),
        _ => {
            let line = document.caret_line();
            document.folds.close(line, (line + 2).min(document.text.line_count() - 1));
        }
    }
}

fn document(text: &str, anchor: usize, head: usize) -> Document {
    let mut document = Document::new(DocId(1), String::new(), text);
    document.caret = Caret::selecting(anchor, head);
    document
}

#[test]
fn words_that_are_typed_in_a_row_are_undone_word_by_word() {
    let mut typed = document("", 0, 0);
    for letter in "goto main".chars() {
        typed.type_text(&letter.to_string());
    }
    typed.undo();
    assert_eq!(typed.text.text(), "goto ");
    typed.undo();
    assert_eq!(typed.text.text(), "");
    typed.redo();
    assert_eq!((typed.text.text(), typed.caret.head), ("goto ".to_owned(), 5));
}

#[test]
fn enter_indents_as_the_block_wants_and_closing_words_go_back() {
    let mut typed = document("", 0, 0);
    for line in ["while 1", "if x = 1 then", "x = 2", "else", "x = 3", "endif", "wend"] {
        for letter in line.chars() {
            typed.type_text(&letter.to_string());
        }
        typed.new_line();
    }
    let expected = "while 1\n    if x = 1 then\n        x = 2\n    else\n        x = 3\n    endif\nwend\n";
    assert_eq!(typed.text.text(), expected);
    let mut jump = document("if x = 1 then main", 18, 18);
    jump.new_line();
    assert_eq!(jump.text.text(), "if x = 1 then main\n", "an IF on one line opens nothing");
}

#[test]
fn backspace_within_the_indent_takes_a_step_of_it() {
    let mut indented = document("      x", 6, 6);
    indented.erase(Move::Left);
    assert_eq!(indented.text.text(), "    x");
    indented.erase(Move::Left);
    assert_eq!(indented.text.text(), "x");
}

#[test]
fn lines_are_moved_copied_commented_and_deleted_as_wholes() {
    let mut lines = document("a\nb\nc", 0, 3);
    lines.move_lines(true);
    assert_eq!((lines.text.text().as_str(), lines.caret.range()), ("c\na\nb", 2..5));
    lines.duplicate_lines();
    assert_eq!(lines.text.text(), "c\na\nb\na\nb");
    lines.toggle_comment();
    assert_eq!(lines.text.text(), "c\na\nb\n; a\n; b");
    lines.toggle_comment();
    assert_eq!(lines.text.text(), "c\na\nb\na\nb");
    lines.delete_lines();
    assert_eq!(lines.text.text(), "c\na\nb");
}

#[test]
fn a_joined_letter_is_one_step_for_the_caret() {
    let text = "e\u{301}x";
    let buffer = Buffer::new(text);
    let step = |caret, way| moved(&buffer, caret, way, false, |line, _| line).head;
    assert_eq!(step(Caret::at(0), Move::Right), 3);
    assert_eq!(step(Caret::at(3), Move::Left), 0);
}

#[test]
fn moving_up_and_down_keeps_to_the_column_over_short_lines_and_tabs() {
    let buffer = Buffer::new("abcdef\nx\n\tab");
    let step = |line: usize, rows: isize| line.saturating_add_signed(rows).min(2);
    let down = |caret| moved(&buffer, caret, Move::Down, false, step);
    let first = down(Caret::at(5));
    assert_eq!(first.head, 8, "the end of the short line");
    assert_eq!(down(first).head, 11, "behind the tab of four cells and one letter");
}

#[test]
fn names_are_changed_in_all_their_places_and_the_caret_stays_with_its_word() {
    let text = "speed_now VAR Long\nspeed_now = 1\nputs 0,[dec speed_now]\nend\n";
    let mut program = document(text, 22, 22);
    assert_eq!(program.rename("v"), Ok(3));
    assert_eq!(program.text.text(), "v VAR Long\nv = 1\nputs 0,[dec v]\nend\n");
    assert_eq!(program.caret_line(), 1);
    assert!(program.rename("goto").unwrap_err().to_string().ends_with('.'));
    program.undo();
    assert_eq!(program.text.text(), text);
}

#[test]
fn the_way_leads_to_definitions_and_matching_words() {
    let text = "main\n    if x = 1 then\n        x = 2\n    endif\ngoto main\nx VAR Byte\n";
    let goto = text.rfind("main").unwrap();
    let mut program = document(text, goto, goto);
    program.go_to_definition().unwrap();
    assert_eq!(program.caret.range(), 0..4);
    program.caret = Caret::at(text.find("if").unwrap());
    program.go_to_match().unwrap();
    assert_eq!(program.caret.head, text.find("endif").unwrap());
    program.go_to_match().unwrap();
    assert_eq!(program.caret.head, text.find("if").unwrap());
    assert!(program.go_to_definition().unwrap_err().to_string().contains("word of MCL"));
}

#[test]
fn a_fold_hides_lines_and_the_caret_does_not_stay_in_it() {
    let text = "while 1\n    x = 1\nwend\nend\n";
    let mut program = document(text, 12, 12);
    program.known();
    program.toggle_fold(0);
    assert!(program.folds.is_closed(0));
    assert_eq!(program.caret_line(), 0);
    super::input::go(&mut program, Move::Down, false);
    assert_eq!(program.caret_line(), 3, "over what is hidden");
    program.go_to_line(1);
    assert!(!program.folds.is_closed(0), "a jump into it opens it");
}

#[test]
fn a_program_is_read_in_the_language_that_its_name_ends_with() {
    let text = "begin program\nbeep 1,2\nend program\n";
    let mut document = Document::new(DocId(1), "crane.mecc".to_owned(), text);
    document.known();
    assert_eq!(document.findings.counts(), (0, 0), "{:?}", document.findings.problems);
    assert!(document.hover(15).and_then(|hover| hover.help).is_some_and(|help| help.title == "Beep"));
    document.tidy();
    assert!(document.text.text().contains("\n    beep 1, 2\n"), "{}", document.text.text());
    document.untitled = "crane".to_owned();
    document.replace_all(text);
    document.known();
    assert!(document.findings.counts().0 > 0, "it is no MCL");
}
