//! Exchanges against a scripted far end, in virtual time.

use crate::packet::{Ask, gate, transact};
use crate::tests::testing::{Answers, ScriptedTransport, Wiretap, ms, reply_to, script, with_crc};
use brushwork_link::clock::{Clock, VirtualClock};
use brushwork_link::exchange::Permit;
use brushwork_link::exchange::*;
use brushwork_link::messages::ActMessage;
use brushwork_link::{Transport, TransportError};
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number};
use std::cell::Cell;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Read main battery of 0x80: no CRC.
const READ_BATTERY: [u8; 2] = [0x80, 24];

fn exchange(
    far_end: impl FnMut(&[u8], Duration) -> Answers + Send + 'static,
) -> (Exchange, VirtualClock, Wiretap) {
    let clock = VirtualClock::new();
    let (transport, tap) = ScriptedTransport::new(&clock, far_end);
    (Exchange::new(transport, Arc::new(clock.clone())), clock, tap)
}

fn ask(
    exchange: &mut Exchange,
    watch: &dyn Watch,
    command: u8,
    values: &[i64],
) -> Result<Reply, ExchangeError> {
    let request = Request::new(Address::DEFAULT, command, values);
    let permit = Permit { motion: true, script: true, ..Permit::default() };
    transact(
        exchange,
        watch,
        &Ask { request: &request, generation: Generation::Gen1, permit, retries: RETRIES },
    )
}

/// The good reply "24.3 V": 00 F3 and CRC E886 (computed with the clients' code).
fn battery() -> Vec<u8> {
    vec![0x00, 0xF3, 0xE8, 0x86]
}

#[test]
fn a_reply_that_comes_in_pieces_is_put_together_and_dated() {
    let answers = vec![(ms(2), battery()[..1].to_vec()), (ms(5), battery()[1..].to_vec())];
    let (mut exchange, _, _) = exchange(script(vec![(READ_BATTERY.to_vec(), answers)]));
    let reply = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap();
    assert_eq!(reply.values.try_int("main_battery"), Some(243));
    assert_eq!(reply.span, Span { requested_at: ms(0), replied_at: ms(5) });
    let statistics = exchange.statistics();
    assert_eq!((statistics.transactions, statistics.bytes_out, statistics.bytes_in), (1, 2, 4));
}

/// A transport whose reader gets no processor for a while at its first read.
struct Starved {
    inner: Box<ScriptedTransport>,
    clock: VirtualClock,
    stolen: Option<Duration>,
}

impl Transport for Starved {
    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        match self.stolen.take() {
            Some(stolen) => {
                self.clock.advance_to(self.clock.now() + stolen);
                Ok(0)
            }
            None => self.inner.read(buffer, timeout),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.inner.write(bytes)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.inner.discard_input()
    }

    fn describe(&self) -> String {
        self.inner.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.inner.byte_time()
    }

    fn latency(&self) -> Duration {
        self.inner.latency()
    }
}

/// What a battery that answers after so long reads when the reader had no processor for `stolen` after asking.
fn starved(stolen: Duration, after: Duration) -> Result<Reply, ExchangeError> {
    asked_starved(stolen, after).0
}

/// The same, with how long the line may take from then on.
fn asked_starved(stolen: Duration, after: Duration) -> (Result<Reply, ExchangeError>, Duration) {
    let clock = VirtualClock::new();
    let far_end = script(vec![(READ_BATTERY.to_vec(), vec![(after, battery())])]);
    let (inner, _) = ScriptedTransport::new(&clock, far_end);
    let transport = Starved { inner, clock: clock.clone(), stolen: Some(stolen) };
    let mut exchange = Exchange::new(Box::new(transport), Arc::new(clock));
    let request = Request::new(Address::DEFAULT, number::READ_MAIN_BATTERY, &[]);
    let ask = Ask { request: &request, generation: Generation::Gen1, permit: Permit::default(), retries: 0 };
    let reply = transact(&mut exchange, &Unwatched, &ask);
    (reply, exchange.longest_turnaround())
}

#[test]
fn time_without_a_processor_does_not_make_a_line_late() {
    assert_eq!(asked_starved(ms(900), ms(10)).1, ms(50));
    assert_eq!(asked_starved(ms(0), ms(45)).1, ms(167), "three times a first reply of 45 ms, and 32");
}

#[test]
fn a_reply_that_came_while_there_was_no_processor_is_taken_however_late_that_is_seen() {
    assert_eq!(starved(ms(900), ms(20)).unwrap().values.try_int("main_battery"), Some(243));
}

#[test]
fn time_without_a_processor_is_given_to_the_reply_and_no_more_than_that() {
    assert_eq!(starved(ms(40), ms(80)).unwrap().values.try_int("main_battery"), Some(243));
    assert!(matches!(starved(ms(40), ms(120)), Err(ExchangeError::TimedOut { .. })));
    assert!(matches!(starved(ms(2), ms(60)), Err(ExchangeError::TimedOut { .. })), "a link that is well");
}

#[test]
fn silence_is_tried_three_times_with_the_gap_in_between() {
    let (mut exchange, clock, tap) = exchange(|_, _| Vec::new());
    let error = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap_err();
    assert_eq!(error.to_string(), "no answer within 50 ms (3 tries)");
    let times: Vec<_> = tap.writes().into_iter().map(|(time, _)| time).collect();
    assert_eq!(times, [ms(0), ms(50) + RECOVERY, ms(100) + RECOVERY * 2]);
    assert_eq!(clock.now(), ms(150) + RECOVERY * 2);
    let statistics = exchange.statistics();
    assert_eq!((statistics.retries, statistics.timeouts, statistics.transactions), (2, 3, 0));
}

/// A controller on a crowded computer, or one that is busy otherwise, is heard by a stop, which asks oftener than others.
#[test]
fn what_is_asked_oftener_than_thrice_is_waited_for_twice_as_long_each_time() {
    let asked_at = Arc::new(Mutex::new(Vec::new()));
    let noted = asked_at.clone();
    let (mut exchange, _, _) = exchange(move |_, now| {
        noted.lock().unwrap().push(now);
        if now < ms(250) { Vec::new() } else { vec![(ms(180), battery())] }
    });
    let request = Request::new(Address::DEFAULT, number::READ_MAIN_BATTERY, &[]);
    let ask = Ask { request: &request, generation: Generation::Gen1, permit: Permit::default(), retries: 4 };
    transact(&mut exchange, &Unwatched, &ask).unwrap();
    let asked_at = asked_at.lock().unwrap();
    let waits: Vec<_> = asked_at.windows(2).map(|pair| pair[1] - pair[0] - RECOVERY).collect();
    let usual = waits[0];
    assert_eq!(waits, [usual, usual, usual, usual * 2]);
}

#[test]
fn a_deadline_grows_with_the_bytes_and_the_baud_rate() {
    let clock = VirtualClock::new();
    let (transport, _) = ScriptedTransport::new(&clock, |_, _| Vec::new());
    // 2400 baud: ten bits take 4.1667 ms.
    let transport = transport.with_byte_time(Duration::from_micros(4_167));
    let mut exchange = Exchange::new(transport, Arc::new(clock.clone()));
    let error = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap_err();
    // Two bytes out, four back, and the latency of 50 ms.
    let expected = Duration::from_micros(6 * 4_167) + ms(50);
    let ExchangeError::TimedOut { waited, .. } = error else { panic!("{error}") };
    assert!(waited >= expected && waited < expected + ms(1), "{waited:?}");
}

/// As a serial server or a radio does it. Asked again before that, the controller would answer three times, and what is asked next would be answered too late.
#[test]
fn a_long_reply_that_is_handed_over_when_it_is_whole_is_waited_for() {
    const READ_SIGNALS: [u8; 2] = [0x80, number::READ_SIGNALS];
    let mut signals = vec![0; 1 + 18 * 45];
    signals[0] = 18;
    let reply = reply_to(&READ_SIGNALS, &signals);
    let clock = VirtualClock::new();
    // 38,400 baud: ten bits take 0.26 ms.
    let byte_time = Duration::from_micros(260);
    let on_the_wire = byte_time * u32::try_from(READ_SIGNALS.len() + reply.len()).unwrap();
    let answers = vec![(READ_SIGNALS.to_vec(), vec![(on_the_wire + ms(3), reply)])];
    let (transport, tap) = ScriptedTransport::new(&clock, script(answers));
    let mut exchange = Exchange::new(transport.with_byte_time(byte_time), Arc::new(clock.clone()));
    ask(&mut exchange, &Unwatched, number::READ_SIGNALS, &[]).unwrap();
    assert_eq!(tap.writes().len(), 1, "it is asked once");
    assert!(!exchange.is_late(), "the time of its bytes is no lateness");
}

#[test]
fn a_wrong_crc_is_retried_after_the_gap() {
    let answers = vec![
        (READ_BATTERY.to_vec(), vec![(ms(1), vec![0x00, 0xF3, 0xE8, 0x87])]),
        (READ_BATTERY.to_vec(), vec![(ms(1), battery())]),
    ];
    let (mut exchange, _, tap) = exchange(script(answers));
    let reply = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap();
    assert_eq!(reply.values.try_int("main_battery"), Some(243));
    assert!(tap.writes()[1].0 >= ms(1) + PACKET_GAP);
    let statistics = exchange.statistics();
    assert_eq!((statistics.crc_errors, statistics.retries, statistics.timeouts), (1, 1, 0));
}

#[test]
fn a_late_reply_is_not_taken_for_the_answer_to_the_next_request() {
    // The first answer comes 55 ms after the request, 5 ms after it was given up.
    let answers = vec![
        (READ_BATTERY.to_vec(), vec![(ms(55), reply_to(&READ_BATTERY, &[0x00, 0x01]))]),
        (READ_BATTERY.to_vec(), vec![(ms(2), battery())]),
    ];
    let (mut exchange, _, tap) = exchange(script(answers));
    let reply = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap();
    assert_eq!(reply.values.try_int("main_battery"), Some(243));
    assert_eq!(tap.writes()[1].0, ms(55) + RECOVERY, "the gap counts from the last byte");
    assert_eq!(exchange.statistics().stray_bytes, 4);
}

#[test]
fn bytes_left_over_from_before_are_thrown_away_before_a_request() {
    // An old firmware answers a write with two bytes 0xFF.
    let mut first = true;
    let (mut exchange, clock, _) = exchange(move |bytes, _| {
        if std::mem::take(&mut first) {
            return vec![(ms(1), vec![0xFF]), (ms(3), vec![0xFF])];
        }
        assert_eq!(bytes, READ_BATTERY);
        vec![(ms(2), battery())]
    });
    ask(&mut exchange, &Unwatched, number::DUTY_BOTH, &[0, 0]).unwrap();
    clock.advance(ms(5));
    let reply = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap();
    assert_eq!(reply.values.try_int("main_battery"), Some(243));
    assert_eq!(exchange.statistics().stray_bytes, 1);
}

#[test]
fn noise_instead_of_a_reply_ends_in_an_error_and_never_in_a_value() {
    let mut seed = 0x2545_F491_u32;
    for _ in 0..200 {
        let mut noise = || {
            seed ^= seed << 13;
            seed ^= seed >> 17;
            seed ^= seed << 5;
            seed.to_be_bytes().to_vec()
        };
        let chunks: Vec<_> = (0..6).map(|_| noise()).collect();
        let mut chunks = chunks.into_iter().cycle();
        let (mut exchange, _, _) =
            exchange(move |_, _| vec![(ms(1), chunks.next().unwrap()), (ms(2), chunks.next().unwrap())]);
        assert!(ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).is_err());
    }
}

#[test]
fn a_line_that_never_falls_silent_is_not_waited_for_without_end() {
    let babble = (0..10_000).map(|step| (ms(step), vec![0x55])).collect::<Vec<_>>();
    let mut first = true;
    let (mut exchange, clock, _) =
        exchange(move |_, _| if std::mem::take(&mut first) { babble.clone() } else { Vec::new() });
    assert!(ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).is_err());
    assert!(clock.now() < Duration::from_secs(2), "{:?}", clock.now());
}

#[test]
fn no_relative_or_buffered_motion_is_sent_twice_after_it_may_have_run() {
    // Every command that moves by an amount or queues a move, with values that fit its layout.
    let once = [41, 42, 43, 44, 45, 46, 51, 65, 66, 67, 119, 120, 121, 122, 123, 124, 125, 126, 127];
    for command in once {
        let row = brushwork_mcp_wire::packet_serial::lookup(command).unwrap();
        let form = row.form(Generation::Gen3).unwrap_or_else(|| panic!("{command} is in generation 3"));
        let values = vec![0; form.request.len()];
        for answer in [Vec::new(), vec![(ms(1), vec![0xFE])]] {
            let (mut exchange, _, tap) = exchange(move |_, _| answer.clone());
            let request = Request::new(Address::DEFAULT, command, &values);
            let permit = Permit { motion: true, ..Permit::default() };
            let ask = Ask { request: &request, generation: Generation::Gen3, permit, retries: RETRIES };
            let error = transact(&mut exchange, &Unwatched, &ask).unwrap_err();
            assert!(matches!(error, ExchangeError::MayHaveRun { .. }), "{command}: {error:?}");
            assert!(error.to_string().contains("may have been carried out"), "{error}");
            assert_eq!(tap.writes().len(), 1, "command {command} went out more than once");
        }
    }
}

#[test]
fn an_absolute_motion_is_sent_again() {
    let duty = with_crc(&[0x80, 34, 0x0C, 0xCC, 0x0C, 0xCC]);
    let answers = vec![(duty.clone(), Vec::new()), (duty, vec![(ms(1), vec![0xFF])])];
    let (mut exchange, _, _) = exchange(script(answers));
    ask(&mut exchange, &Unwatched, number::DUTY_BOTH, &[0x0CCC, 0x0CCC]).unwrap();
    assert_eq!(exchange.statistics().retries, 1);
}

/// Breaks in at a time.
struct BreakAt<'a>(Duration, Interruption, &'a Cell<u32>);

impl Watch for BreakAt<'_> {
    fn interruption(&self, now: Duration) -> Option<Interruption> {
        self.2.set(self.2.get() + 1);
        (now >= self.0).then_some(self.1)
    }

    fn next(&self) -> Option<Duration> {
        Some(self.0)
    }
}

#[test]
fn waiting_ends_at_the_very_moment_something_breaks_in() {
    let looks = Cell::new(0);
    let (mut exchange, clock, _) = exchange(|_, _| Vec::new());
    let moment = Duration::from_micros(20_300);
    let watch = BreakAt(moment, Interruption::DeadMan, &looks);
    let error = ask(&mut exchange, &watch, number::READ_MAIN_BATTERY, &[]).unwrap_err();
    assert_eq!(error.interruption(), Some(Interruption::DeadMan));
    assert_eq!(clock.now(), moment);
    assert!(looks.get() >= 20, "it looks at least once a millisecond");
}

#[test]
fn a_move_that_is_broken_into_after_it_was_sent_may_have_run_and_one_before_has_not() {
    let looks = Cell::new(0);
    let (mut exchange, _, tap) = exchange(|_, _| Vec::new());
    let early = BreakAt(ms(0), Interruption::Stop, &looks);
    let error = ask(&mut exchange, &early, 41, &[100, 50, 0]).unwrap_err();
    assert!(matches!(error, ExchangeError::Interrupted { .. }), "{error:?}");
    assert_eq!(tap.writes().len(), 0);
    let late = BreakAt(ms(5), Interruption::Stop, &looks);
    let error = ask(&mut exchange, &late, 41, &[100, 50, 0]).unwrap_err();
    assert!(matches!(error, ExchangeError::MayHaveRun { .. }), "{error:?}");
    assert_eq!(error.interruption(), Some(Interruption::Stop));
}

#[test]
fn an_unplugged_port_is_told_at_once_and_not_retried() {
    let (mut exchange, _, tap) = exchange(|_, _| Vec::new());
    let plug = tap.clone();
    tap.at(ms(3), move || plug.unplug());
    let error = ask(&mut exchange, &Unwatched, number::READ_MAIN_BATTERY, &[]).unwrap_err();
    assert!(error.is_link_lost());
    assert_eq!(tap.writes().len(), 1);
    assert_eq!(
        error
            .failure(ActMessage::Read { phrase: "read the main battery".to_owned() }, "0x80 at /dev/test")
            .to_string(),
        "Could not read the main battery on 0x80 at /dev/test: the link is lost: the far end is gone (unplugged). \
         Check the cable and connect again."
    );
}

#[test]
fn nothing_that_moves_a_motor_passes_without_arming_and_no_guess_reaches_a_real_controller() {
    use brushwork_mcp_wire::packet_serial::COMMANDS;
    let mut guarded = 0;
    for row in COMMANDS {
        for form in row.forms {
            let values = vec![0; form.request.len()];
            let request = Request::new(Address::DEFAULT, row.number, &values);
            let permit = |motion, script, guesses| Permit { motion, script, guesses, loader: false };
            let allowed =
                |permit| gate(&Ask { request: &request, generation: form.first, permit, retries: 0 }).is_ok();
            if form.effect.may_move() {
                guarded += 1;
                assert!(!allowed(permit(false, false, true)), "{} passes unarmed", row.number);
                assert!(allowed(permit(true, true, true)));
            }
            if form.assumed.is_some() {
                assert!(!allowed(permit(true, true, false)), "{} is a guess", row.number);
            }
        }
    }
    assert!(guarded > 40, "only {guarded} forms can move a motor?");
    for command in [180, 190, 191] {
        let request = Request::new(Address::DEFAULT, command, &[0; 6]);
        let ask =
            Ask { request: &request, generation: Generation::Gen4, permit: Permit::default(), retries: 0 };
        assert!(matches!(gate(&ask), Err(ExchangeError::Unproven { .. })), "{command}");
    }
}
