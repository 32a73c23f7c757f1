//! The worst programs, on a small stack: compiler and formatter end with a program or with an error that has a place, in a bounded time.

use brushwork_script::diagnostic::MOST_TOLD;
use brushwork_script::image;
use brushwork_script::mcl::LONGEST_TEXT;
use brushwork_script::mecc::format::format;
use brushwork_script::mecc::{codes, compile};
use brushwork_script::text::Lines;
use std::time::{Duration, Instant};

/// As for MCL: half of what the smallest main thread has.
const STACK_BYTES: usize = 512 * 1024;
/// As for MCL: what 20 kB may take, and each more.
const MOST_TIME: Duration = Duration::from_millis(500);

/// A start, a piece as often as there is room, an end.
const REPEATED: [(&str, &str, &str); 48] = [
    ("", "?", ""),
    ("", "\"", ""),
    ("", "\n", ""),
    ("", "(", ""),
    ("", "end ", ""),
    ("", "end loop\n", ""),
    ("", "until\n", ""),
    ("", "case\n", ""),
    ("", "declare ", ""),
    ("", "declare byte a\n", ""),
    ("", "declare datatable t\n", ""),
    ("", "declare datatable t\nreserve 65535\nend datatable\n", ""),
    ("declare datatable t\n", "\"abcdefgh\",", "1\nend datatable\n"),
    ("declare datatable t\n", "reserve 65535\n", "end datatable\n"),
    ("", "declare function f(", ""),
    ("declare function f(", "a as word, ", ""),
    ("", "declare function f()\nend function\n", ""),
    ("", "declare eventhandler h()\n", ""),
    ("", "begin program\n", ""),
    ("", "begin program\nend program\n", ""),
    ("begin program\n", "loop\n", ""),
    ("begin program\n", "do\n", ""),
    ("begin program\n", "do\ntransmit p\n", ""),
    ("begin program\n", "while 1\n", "end program"),
    ("begin program\n", "if 1 then\n", ""),
    ("begin program\n", "if 1 then ", ""),
    ("begin program\n", "if 1 then\nelse\n", ""),
    ("begin program\n", "select 1\n", ""),
    ("begin program\n", "select 1\ncase 1\n", ""),
    ("begin program\nselect 1\n", "case 1\n", "end select\nend program"),
    ("begin program\nselect 1\ncase 1", ",1", "\nend select\nend program"),
    ("begin program\n", "wait ", ""),
    ("begin program\n", "wait 1\n", "end program"),
    ("begin program\n", "beep 1, 2\n", "end program"),
    ("begin program\n", "declare byte a\n", "end program"),
    ("begin program\n", "frob a\n", "end program"),
    ("begin program\n", "setevent frobevent, h\n", "end program"),
    ("declare byte a\nbegin program\na = ", "(", ""),
    ("declare byte a\nbegin program\na = ", "-", "1\nend program"),
    ("declare byte a\nbegin program\na = ", "not ", "1\nend program"),
    ("declare byte a\nbegin program\na = 1", "+1", "\nend program"),
    ("declare byte a\nbegin program\na = 1", "/0", "\nend program"),
    ("declare byte a\nbegin program\na = 1", "<1", "\nend program"),
    ("declare byte a\nbegin program\na = 1", " or 1 and 1 = 1 + 1 * 1", "\nend program"),
    ("declare byte a\nbegin program\na = ", "f(", ""),
    ("declare byte a\nbegin program\na = f(", "1,", "1)\nend program"),
    ("declare datapointer p\nbegin program\n", "transmit p\n", "end program"),
    ("declare datapointer p\ndeclare byte a\nbegin program\n", "a = readdata(p)\n", "end program"),
];

fn worst(bytes: usize) -> Vec<(String, String)> {
    let repeated = REPEATED.iter().map(|(start, piece, end)| {
        let count = bytes.saturating_sub(start.len() + end.len()) / piece.len();
        (format!("{start}{piece}..{end}"), format!("{start}{}{end}", piece.repeat(count)))
    });
    let named = |what: &str, line: &dyn Fn(usize) -> String| {
        (what.to_owned(), (0..bytes / 24).map(line).collect::<String>())
    };
    let many = [
        named("names", &|at| format!("declare byte name{at}\n")),
        named("functions", &|at| format!("declare function f{at}()\nend function\n")),
        named("unknown names", &|at| format!("begin program\nx{at} = y{at}\n")),
    ];
    let whole = [
        ("a name".to_owned(), "n".repeat(bytes)),
        ("a number".to_owned(), "1".repeat(bytes)),
        ("a comment".to_owned(), ";".repeat(bytes)),
    ];
    repeated.chain(many).chain(whole).collect()
}

#[test]
fn the_worst_programs_end_with_a_program_or_an_error_that_has_a_place() {
    let run = || {
        for (name, text) in worst(20_000) {
            let began = Instant::now();
            let compiled = compile(&text);
            let lines = Lines::of(&text);
            assert!(compiled.diagnostics.len() <= 2 * (MOST_TOLD + 1), "{name}");
            for said in &compiled.diagnostics {
                assert!(said.span.start <= said.span.end && said.span.end as usize <= text.len(), "{name}");
                assert!(said.render("x", &text, &lines).len() < 4_000, "{name}");
            }
            let is_wrong = compiled.diagnostics.iter().any(|said| said.code.starts_with('E'));
            assert_eq!(compiled.program.is_none(), is_wrong, "{name}");
            if let Some(program) = compiled.program {
                assert!(image::decode(&image::encode(&program)).is_ok_and(|read| read == program), "{name}");
            }
            let formatted = format(&text);
            assert!(formatted.len() <= text.len() * 50 + 10, "{name}");
            // On a busy computer others run meanwhile; what goes with the square takes minutes.
            assert!(began.elapsed() < MOST_TIME * 8, "{name}: {:?}", began.elapsed());
        }
    };
    let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn(run).expect("a thread");
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
}

#[test]
fn deep_nesting_is_refused_with_a_sentence() {
    for text in [
        "Declare Byte a\nBegin Program\na = ".to_owned()
            + &"(".repeat(200)
            + "1"
            + &")".repeat(200)
            + "\nEnd Program\n",
        "Begin Program\n".to_owned() + &"Loop\n".repeat(200) + &"End Loop\n".repeat(200) + "End Program\n",
    ] {
        assert!(compile(&text).diagnostics.iter().any(|said| said.code == codes::TOO_DEEP));
    }
}

#[test]
fn a_text_that_is_too_long_is_refused_where_the_bound_is() {
    let text = ";\n".repeat(LONGEST_TEXT / 2) + ";";
    let compiled = compile(&text);
    let [only] = &compiled.diagnostics[..] else { panic!("{:?}", compiled.diagnostics) };
    assert_eq!((only.code, only.span.start as usize), (codes::TOO_LARGE, LONGEST_TEXT));
    assert_eq!(format(&text), text);
}
