//! The index on programs of a few lines.

use super::*;
use crate::mcl::lower::SymbolKind;

const PROGRAM: &str = "\
size con 3
; one
; two
list var byte(size)
first var list(0).lownib
main
  if list(1) = size then
    list(1) = 0
  elseif list(1) = 2
    gosub add[1],list(2)
  else
    if first then main
  endif
#IFDEF nothing
  list(2) = size
#ENDIF
goto main

step2 var byte
add [step2]
  for step2 = 0 to 3
  next
return step2
";

fn index() -> Index {
    Index::of(PROGRAM)
}

fn at(word: &str) -> u32 {
    PROGRAM.find(word).unwrap() as u32
}

#[test]
fn every_place_of_a_name_is_found_also_in_what_directives_leave_out() {
    let index = index();
    let size = index.symbol("SIZE").unwrap();
    assert_eq!((size.kind, size.name.as_str()), (SymbolKind::Constant, "size"));
    assert_eq!(size.uses.len(), 3);
    assert!(size.uses.iter().all(|span| span.of(PROGRAM) == "size"));
    assert_eq!(index.symbol("list").unwrap().uses.len(), 6);
    assert_eq!(index.symbol_at(at("size con") + 4).unwrap().key, "size");
    // A modifier is no use of a variable of the same name.
    let text = "byte1 var word\nbyte1 = byte1.byte1\nend\n";
    assert_eq!(Index::of(text).symbol("byte1").unwrap().uses.len(), 2);
}

#[test]
fn words_of_a_block_belong_together() {
    let index = index();
    let words = |word: &str| -> Vec<&str> {
        index.block_at(at(word)).unwrap().words.iter().map(|span| span.of(PROGRAM)).collect()
    };
    assert_eq!(words("if list(1)"), ["if", "elseif", "else", "endif"]);
    assert_eq!(words("endif"), words("if list(1)"));
    assert_eq!(words("for "), ["for", "next"]);
    assert_eq!(words("#ENDIF"), ["#IFDEF", "#ENDIF"]);
    assert_eq!(index.block_at(at("if first")), None);
    let nested = Index::of("do\nwhile 1\nwend\nwhile 0\n");
    assert_eq!(nested.blocks.iter().map(|block| block.words.len()).collect::<Vec<_>>(), [2, 2]);
    assert!(!Index::of("if 1 then\nfor a = 1 to 2\nendif\n").blocks[1].is_closed);
}

#[test]
fn blocks_labels_and_comments_fold() {
    let fold = |first, last| Fold { first, last };
    assert_eq!(
        index().folds,
        [fold(2, 3), fold(6, 19), fold(7, 13), fold(14, 16), fold(20, 23), fold(21, 22)]
    );
}

#[test]
fn a_new_name_is_refused_where_the_program_would_change() {
    let index = index();
    assert_eq!(index.rename(at("size con"), "Count").unwrap().len(), 4);
    assert_eq!(index.rename(at("size con"), "SIZE").unwrap().len(), 4);
    assert_eq!(index.rename(at("con 3"), "x"), Err(RenameError::NoName));
    assert_eq!(index.rename(at("size con"), "2x"), Err(RenameError::NotAName("2x".into())));
    assert_eq!(index.rename(at("size con"), "goto"), Err(RenameError::Reserved("goto".into())));
    assert_eq!(
        index.rename(at("size con"), "Main"),
        Err(RenameError::Taken { name: "Main".into(), line: 6 })
    );
}

#[test]
fn pieces_of_a_line_have_their_colours() {
    let line = "  puts 0,[dec4 x.byte0,\"a;b\",SYSTICK] ; say \"it\"";
    let found: Vec<(&str, Class)> =
        classes(line).into_iter().map(|(range, class)| (&line[range], class)).collect();
    use Class::*;
    let expected = [
        ("puts", Command),
        ("0", Number),
        (",", Punctuation),
        ("[", Punctuation),
        ("dec4", Format),
        ("x", Name),
        (".", Punctuation),
        ("byte0", Modifier),
        (",", Punctuation),
        ("\"a;b\"", Text),
        (",", Punctuation),
        ("SYSTICK", Register),
        ("]", Punctuation),
        ("; say \"it\"", Comment),
    ];
    assert_eq!(found, expected);
    let one = |line: &str| classes(line).into_iter().map(|(_, class)| class).collect::<Vec<_>>();
    assert_eq!(one("main"), [Label]);
    assert_eq!(one("goto main"), [Command, Label]);
    assert_eq!(one("#IF a"), [Directive, Name]);
    assert_eq!(one("a = 1 ? 2"), [Name, Operator, Number, Wrong, Number]);
    assert_eq!(one("canout"), [Wrong]);
    assert_eq!(one(""), []);
}

#[test]
fn every_word_of_the_language_has_help() {
    for word in ["goto", "DIG", "hex", "hex4", "SLong", "bytetable", "canout", "#elseif", "#IFNDEF"] {
        assert!(!help(word).unwrap().text.is_empty(), "{word}");
    }
    let register = help("motorencpos").unwrap();
    assert_eq!(register.facts, ["SLong(2), read and write", "unit counts"]);
    assert_eq!(help("size"), None);
    let index = index();
    let described = index.describe(PROGRAM, index.symbol("list").unwrap());
    assert_eq!(described.facts, ["Byte(3), 8 bit, 0 to 255", "Line 4, used 6 times"]);
    for row in &crate::mcl::registers::REGISTERS {
        assert!(help(row.name).unwrap().text.ends_with('.'));
    }
}

fn offered(before: &str) -> Vec<String> {
    let text = format!("{PROGRAM}{before}");
    let found = Index::of(PROGRAM).completions(&text, text.len());
    found.entries.into_iter().map(|entry| entry.word).collect()
}

#[test]
fn what_fits_is_offered_and_nothing_else() {
    assert_eq!(offered("go"), ["gosub", "goto"]);
    assert_eq!(offered("GO"), ["GOSUB", "GOTO"]);
    assert_eq!(offered("x = SYSUS"), ["SYSUSTICK"]);
    assert_eq!(offered("x = list(2).hi"), ["HighBit", "HighNib", "HighByte"]);
    assert_eq!(offered("goto ")[..2], ["main", "add"]);
    assert_eq!(offered("#elseif"), ["#ELSEIF", "#ELSEIFDEF", "#ELSEIFNDEF"]);
    assert_eq!(offered("x var sl")[..1], ["slong"]);
    assert!(offered("puts 0,[\"go").is_empty());
    assert!(offered("; go").is_empty());
    assert!(offered("x = 12").is_empty());
}

#[test]
fn the_syntax_line_follows_the_cursor() {
    let hint = |line: &str| syntax_at(line, line.len()).map(|hint| (hint.word.name, hint.argument));
    assert_eq!(hint("move 0,100"), Some(("MOVE", 1)));
    assert_eq!(hint("puts 0,[dec a,b"), Some(("PUTS", 1)));
    assert_eq!(hint("if a then gosub x["), Some(("GOSUB", 0)));
    assert_eq!(hint("a = 1"), None);
    assert_eq!(hint("move 0 ; and"), None);
}

#[test]
fn no_text_is_too_odd_for_it() {
    for text in ["", "é", "if", "#", "\"", "then then", "a.b.c.d", "#IF\n#IF\n", "do\nwhile\nwend\nwend"] {
        let index = Index::of(text);
        for at in 0..=text.len() {
            let _ = (index.completions(text, at), index.symbol_at(at as u32), index.block_at(at as u32));
            let _ = syntax_at(text, at);
        }
        text.lines().for_each(|line| drop(classes(line)));
    }
}
