//! One raw command of the table with typed arguments: its bytes are shown before anything is sent.
//!
//! What may go out is decided by the same gate as everywhere: commands that move need an armed screen, guesses go to
//! simulated controllers only. The device thread asks it again.

use crate::messages::WindowTypedMessage;
use brushwork_link::exchange::Permit;
use brushwork_link::{Failure, Message};
use brushwork_mcp_client::packet::{Ask, gate};
use brushwork_mcp_wire::packet_serial::{
    Address, COMMANDS, Command, Effect, Generation, Request, describe_reply, describe_request, lookup,
};
use brushwork_values::{Field, Kind, Value, Values};

/// Numbers of requests made here, apart from those of other parts of the window.
const FIRST_ID: u64 = 1 << 40;

/// What is being put together.
#[derive(Debug, Default)]
pub struct Composer {
    pub search: String,
    command: Option<u8>,
    /// What stands in the fields of the arguments that are not constants.
    pub arguments: Vec<String>,
    sent: u64,
    waiting: Option<(u64, Request, Generation)>,
    pub answer: Option<Result<String, String>>,
}

/// A command that is complete.
#[derive(Clone, Debug, PartialEq)]
pub struct Prepared {
    pub request: Request,
    pub bytes: Vec<u8>,
    /// In words.
    pub text: String,
    pub effect: Effect,
    /// Why it is not sent now, if so.
    pub refusal: Option<Message>,
}

impl Composer {
    /// The commands of a generation whose number, key or title has what is searched for.
    pub fn found(&self, generation: Generation) -> impl Iterator<Item = &'static Command> {
        let wanted = self.search.trim().to_lowercase();
        COMMANDS.iter().filter(move |row| {
            let listed = || format!("{} {} {}", row.number, row.key, row.title(generation)).to_lowercase();
            row.form(generation).is_some() && listed().contains(&wanted)
        })
    }

    pub fn command(&self) -> Option<&'static Command> {
        lookup(self.command?)
    }

    /// Takes a command; its arguments begin at what each field says is least or nothing.
    pub fn choose(&mut self, number: u8, generation: Generation) {
        self.command = Some(number);
        self.answer = None;
        self.arguments = self.fields(generation).iter().map(|field| first_text(field)).collect();
    }

    /// The arguments that are to be typed: constants are filled in.
    pub fn fields(&self, generation: Generation) -> Vec<&'static Field> {
        let form = self.command().and_then(|row| row.form(generation));
        form.map_or(Vec::new(), |form| form.request.iter().filter(|field| field.fixed.is_none()).collect())
    }

    /// The command as it would go out, or what is wrong with an argument.
    pub fn prepare(
        &self,
        address: Address,
        generation: Generation,
        permit: Permit,
    ) -> Result<Prepared, Message> {
        let command = self.command.ok_or(WindowTypedMessage::NoCommand)?;
        let fields = self.fields(generation);
        let typed = fields.iter().zip(&self.arguments);
        let values = typed.map(|(field, text)| value_of(field, text)).collect::<Result<Vec<Value>, _>>()?;
        let request = Request { address, command, values };
        let bytes = request
            .encode(generation)
            .map_err(|error| WindowTypedMessage::NotEncoded { clause: error.to_string() })?;
        let text = describe_request(&request, generation);
        let gated = gate(&Ask { request: &request, generation, permit, retries: 0 });
        let refusal = gated.err().map(|error| error.message());
        let effect = lookup(command).map_or(Effect::Query, |row| row.effect(generation));
        Ok(Prepared { request, bytes, text, effect, refusal })
    }

    /// It is being sent: gives the number that its answer will have.
    pub fn send(&mut self, request: Request, generation: Generation) -> u64 {
        let id = FIRST_ID + self.sent;
        self.sent += 1;
        self.answer = None;
        self.waiting = Some((id, request, generation));
        id
    }

    /// Whether the answer has not come yet.
    pub fn is_waiting(&self) -> bool {
        self.waiting.is_some()
    }

    pub fn answered(&mut self, id: u64, result: &Result<Values, Failure>) {
        let Some((_, request, generation)) = self.waiting.take_if(|(waiting, ..)| *waiting == id) else {
            return;
        };
        self.answer = Some(match result {
            Ok(values) => Ok(describe_reply(&request, values, generation)),
            Err(failure) => Err(failure.to_string()),
        });
    }

    /// The request was not taken, or its link is gone.
    pub fn forget_waiting(&mut self) {
        self.waiting = None;
    }
}

/// What a field begins with.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn first_text(field: &Field) -> String {
    match field.kind {
        Kind::Text { .. } | Kind::Ascii36 | Kind::Utf16Le36 | Kind::Bytes(_) | Kind::Counted(_) => {
            String::new()
        }
        _ => field.raw_range.map_or(0, |(least, most)| 0_i64.clamp(least, most)).to_string(),
    }
}

/// What was typed for a field, as its value.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn value_of(field: &Field, text: &str) -> Result<Value, WindowTypedMessage> {
    match field.kind {
        Kind::Text { .. } | Kind::Ascii36 | Kind::Utf16Le36 => Ok(Value::Text(text.to_owned())),
        Kind::Bytes(count) => bytes_of(text, count).map(Value::Bytes).ok_or_else(|| {
            WindowTypedMessage::NotBytes { field: field.name, text: text.to_owned(), bytes: count }
        }),
        Kind::Counted(_) => Err(WindowTypedMessage::NoList { field: field.name }),
        _ => number_of(field, text).map(Value::Int),
    }
}

/// A decimal or hexadecimal number, or the name of a coded value.
fn number_of(field: &Field, text: &str) -> Result<i64, WindowTypedMessage> {
    let text = text.trim();
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |digits| (-1, digits));
    let plain = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(hex) => i64::from_str_radix(hex, 16).ok(),
        None => digits.parse().ok(),
    };
    let named = || brushwork_values::by_key(field.codes, text).map(|code| code.raw);
    let Some(number) = plain.map(|number: i64| sign * number).or_else(named) else {
        return Err(WindowTypedMessage::NoNumber { field: field.name, text: text.to_owned() });
    };
    match field.kind.limits() {
        Some((least, most)) if !(least..=most).contains(&number) => {
            Err(WindowTypedMessage::NotInRange { field: field.name, number, least, most })
        }
        _ => Ok(number),
    }
}

fn bytes_of(text: &str, count: usize) -> Option<Vec<u8>> {
    let digits: String = text.chars().filter(|letter| !letter.is_whitespace()).collect();
    let pairs = digits.as_bytes().chunks(2);
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
    let bytes: Vec<u8> = pairs.map(byte).collect::<Option<_>>()?;
    (bytes.len() == count && digits.len() == 2 * count).then_some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::packet_serial::number;

    const G1: Generation = Generation::Gen1;

    fn composer(command: u8, arguments: &[&str]) -> Composer {
        let mut composer = Composer::default();
        composer.choose(command, G1);
        composer.arguments = arguments.iter().map(|text| (*text).to_owned()).collect();
        composer
    }

    fn prepare(composer: &Composer, permit: Permit) -> Result<Prepared, Message> {
        composer.prepare(Address::DEFAULT, G1, permit)
    }

    #[test]
    fn a_command_is_shown_as_bytes_and_words_before_it_is_sent() {
        let prepared = prepare(&composer(number::READ_MAIN_BATTERY, &[]), Permit::default()).unwrap();
        assert_eq!(prepared.bytes, [0x80, 24]);
        assert_eq!(prepared.refusal, None);
        assert!(prepared.text.contains("main battery"), "{}", prepared.text);
    }

    #[test]
    fn what_moves_is_refused_until_a_screen_is_armed() {
        let duty = composer(number::DUTY_M1, &["0x1000"]);
        // 0x80, command 32, duty 0x1000, CRC.
        let refused = prepare(&duty, Permit::default()).unwrap();
        assert_eq!(refused.bytes[..4], [0x80, 32, 0x10, 0x00]);
        assert!(refused.refusal.is_some_and(|why| why.to_string().contains("armed")));
        assert_eq!(prepare(&duty, Permit { motion: true, ..Permit::default() }).unwrap().refusal, None);
    }

    #[test]
    fn a_guess_is_refused_on_a_controller_that_is_not_simulated() {
        let form = |row: &&Command| row.form(G1).is_some_and(|form| form.assumed.is_some());
        let guess = COMMANDS.iter().find(form).expect("some layouts are guesses");
        let mut composer = Composer::default();
        composer.choose(guess.number, G1);
        assert!(prepare(&composer, Permit::default()).unwrap().refusal.is_some());
        assert_eq!(
            prepare(&composer, Permit { guesses: true, motion: true, script: true, loader: true })
                .unwrap()
                .refusal,
            None
        );
    }

    #[test]
    fn arguments_that_make_no_sense_are_named() {
        let why = |arguments: &[&str]| {
            prepare(&composer(number::DUTY_M1, arguments), Permit::default()).unwrap_err().to_string()
        };
        assert_eq!(why(&["fast"]), "duty: \"fast\" is no number.");
        assert_eq!(why(&["40000"]), "duty: 40000 does not fit. It takes -32768 to 32767.");
        assert_eq!(bytes_of("01 fF", 2), Some(vec![1, 0xFF]));
        assert_eq!((bytes_of("1", 1), bytes_of("zz", 1), bytes_of("0102", 1)), (None, None, None));
    }

    #[test]
    fn every_command_of_every_generation_can_be_put_together_from_what_its_fields_begin_with() {
        for generation in Generation::ALL {
            let permit = Permit { motion: true, script: true, guesses: true, loader: true };
            let mut composer = Composer::default();
            let found: Vec<_> = composer.found(generation).collect();
            for row in found {
                composer.choose(row.number, generation);
                let fields = composer.fields(generation);
                let texts = fields.iter().map(|field| match field.kind {
                    Kind::Bytes(count) => "00".repeat(count),
                    _ => first_text(field),
                });
                composer.arguments = texts.collect();
                let prepared = composer.prepare(Address::DEFAULT, generation, permit);
                assert!(
                    prepared.as_ref().is_ok_and(|done| done.bytes[1] == row.number),
                    "{}: {prepared:?}",
                    row.key
                );
            }
        }
    }
}
