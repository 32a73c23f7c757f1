//! The real-time server on each of its endpoints, with clients as other programs are.

use crate::support::{PATIENCE, Parrot, eventually};
use brushwork_plant::machine::Machine;
use brushwork_plant::pacing::byte_time;
use brushwork_plant::server::{
    ChannelEnds, Endpoint, Server, ServerError, ServerOptions, SimHandle, measure_speed,
};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

fn serve(endpoint: &Endpoint, options: ServerOptions) -> SimHandle<Parrot> {
    Server::spawn(Parrot::new(), options, endpoint).expect("the endpoint is free")
}

fn options(faults: &[&str]) -> ServerOptions {
    let faults = faults.iter().map(|text| text.parse().expect("the test's faults are valid")).collect();
    ServerOptions { faults, ..ServerOptions::default() }
}

fn channel_exchange(client: &ChannelEnds, byte: u8) -> Option<Vec<u8>> {
    client.to_controller.send(vec![0x80, byte]).ok()?;
    client.from_controller.recv_timeout(PATIENCE).ok()
}

fn is_disconnected(client: &ChannelEnds) -> bool {
    client.from_controller.recv_timeout(PATIENCE).is_err_and(|error| error.is_disconnected())
}

#[test]
fn a_client_inside_the_program_gets_each_reply_as_one_message() {
    let handle = serve(&Endpoint::Channel, options(&[]));
    assert_eq!(handle.address(), "in-process");
    let client = handle.new_channel().expect("it is in-process");
    assert_eq!(channel_exchange(&client, 7), Some(vec![7; 4]));
    client.to_controller.send(vec![0x80]).expect("it serves");
    client.to_controller.send(vec![9]).expect("it serves");
    assert_eq!(client.from_controller.recv_timeout(PATIENCE), Ok(vec![9; 4]), "in pieces too");
    handle.stop();
    assert!(is_disconnected(&client), "the end disconnects the client");
}

#[test]
fn clients_inside_the_program_follow_each_other_and_the_machine_lives_on() {
    let handle = serve(&Endpoint::Channel, options(&[]));
    drop(handle.new_channel().expect("it is in-process"));
    let client = handle.new_channel().expect("it is in-process");
    assert_eq!(channel_exchange(&client, 1), Some(vec![1; 4]));
    let next = handle.new_channel().expect("it is in-process");
    assert!(is_disconnected(&client), "the one before is disconnected");
    assert_eq!(channel_exchange(&next, 2), Some(vec![2; 4]));
    assert_eq!(handle.inspect(|parrot| parrot.heard.len()).expect("it runs"), 4);
}

#[test]
fn unplugging_disconnects_a_client_and_plugging_in_lets_the_next_one_come() {
    let handle = serve(&Endpoint::Channel, options(&[]));
    let client = handle.new_channel().expect("it is in-process");
    handle.apply(0, WorldAction::Unplug { unplugged: true }).expect("it runs");
    assert!(is_disconnected(&client));
    assert!(matches!(handle.new_channel(), Err(ServerError::Unplugged)));
    handle.apply(0, WorldAction::Unplug { unplugged: false }).expect("it runs");
    let client = handle.new_channel().expect("it is plugged in");
    assert_eq!(channel_exchange(&client, 3), Some(vec![3; 4]));
}

#[test]
fn actions_reach_the_world_and_snapshots_follow_the_wall_clock() {
    let handle = serve(&Endpoint::Channel, options(&[]));
    handle.apply(0, WorldAction::LockShaft { motor: Motor::M2, on: true }).expect("it runs");
    handle.inspect(|parrot| parrot.duty = 0.5).expect("it runs");
    assert!(eventually(|| {
        let [first, second] = handle.views()[0].axes;
        first.truth.motor_radians > 1.0 && second.truth.shaft_locked
    }));
    assert_eq!(handle.views()[0].axes[1].truth.motor_radians, 0.0);
    let now = || handle.inspect(|parrot| parrot.now).expect("it runs");
    let (at, earlier) = (Instant::now(), now());
    assert!(eventually(|| now() >= earlier + Duration::from_millis(200)), "its time goes on");
    let passed = now() - earlier;
    assert!(passed <= at.elapsed(), "{passed:?}");
    assert!(eventually(|| handle.views()[0].now >= earlier + passed), "snapshots follow");
}

#[test]
fn a_handle_whose_server_has_ended_says_so() {
    let handle = serve(&Endpoint::Channel, options(&[]));
    // A machine that panics ends its thread; the handle must not hang on it.
    let answer =
        handle.inspect(|_| -> () { std::panic::resume_unwind(Box::new("the test ends the server")) });
    assert!(matches!(answer, Err(ServerError::Ended)));
    assert!(eventually(|| !handle.is_running()));
    assert!(matches!(handle.apply(0, WorldAction::EStop { pressed: true }), Err(ServerError::Ended)));
}

fn tcp_address(handle: &SimHandle<Parrot>) -> SocketAddr {
    let text = handle.address().strip_prefix("tcp:").expect("it is on TCP");
    text.parse().expect("it is an address")
}

fn tcp_client(address: SocketAddr) -> TcpStream {
    let client = TcpStream::connect(address).expect("it listens");
    client.set_read_timeout(Some(PATIENCE)).expect("a time-out is allowed");
    client
}

fn tcp_exchange(client: &mut TcpStream, byte: u8) -> std::io::Result<[u8; 4]> {
    client.write_all(&[0x80, byte])?;
    let mut reply = [0; 4];
    client.read_exact(&mut reply)?;
    Ok(reply)
}

#[test]
fn a_tcp_client_comes_goes_and_comes_back_and_a_second_one_is_turned_away() {
    let any: SocketAddr = "127.0.0.1:0".parse().expect("it is an address");
    let handle = serve(&Endpoint::Tcp(any), options(&[]));
    let address = tcp_address(&handle);
    let mut client = tcp_client(address);
    assert_eq!(tcp_exchange(&mut client, 5).expect("it answers"), [5; 4]);
    let mut second = tcp_client(address);
    assert!(tcp_exchange(&mut second, 6).is_err(), "one at a time");
    assert_eq!(tcp_exchange(&mut client, 7).expect("the first is not disturbed"), [7; 4]);
    drop(client);
    assert!(eventually(|| tcp_exchange(&mut tcp_client(address), 8).is_ok_and(|reply| reply == [8; 4])));
    assert!(matches!(handle.new_channel(), Err(ServerError::NotInProcess { .. })));
    handle.stop();
    assert!(eventually(|| TcpStream::connect(address).is_err()), "the end closes the port");
}

#[test]
fn unplugging_closes_the_tcp_client() {
    let any: SocketAddr = "127.0.0.1:0".parse().expect("it is an address");
    let handle = serve(&Endpoint::Tcp(any), options(&[]));
    let mut client = tcp_client(tcp_address(&handle));
    assert_eq!(tcp_exchange(&mut client, 5).expect("it answers"), [5; 4]);
    handle.apply(0, WorldAction::Unplug { unplugged: true }).expect("it runs");
    assert_eq!(client.read(&mut [0; 4]).expect("closed in order"), 0);
}

#[test]
fn other_computers_are_refused_and_so_is_a_port_in_use() {
    let open = |text: &str| {
        let address = text.parse().expect("it is an address");
        Server::spawn(Parrot::new(), options(&[]), &Endpoint::Tcp(address))
    };
    let refusal = open("0.0.0.0:0").expect_err("anybody could reach it").to_string();
    assert!(refusal.starts_with("controllers are only served on this computer, not on 0.0.0.0:0"));
    let first = open("127.0.0.1:0").expect("it is free");
    let taken = tcp_address(&first).to_string();
    let refusal = open(&taken).expect_err("it is in use").to_string();
    assert!(refusal.starts_with(&format!("nothing can listen on {taken} (")), "{refusal}");
    assert!(refusal.ends_with("; is another program using that port?"), "{refusal}");
}

#[test]
fn a_paced_line_takes_its_time_on_the_wall_clock_too() {
    let handle = serve(&Endpoint::Channel, ServerOptions { pace: true, ..options(&[]) });
    handle.inspect(|parrot| parrot.bits_per_second = 2400).expect("it runs");
    let client = handle.new_channel().expect("it is in-process");
    let begin = Instant::now();
    let mut reply = channel_exchange(&client, 7).expect("it begins");
    while reply.len() < 4 {
        reply.extend(client.from_controller.recv_timeout(PATIENCE).expect("it goes on"));
    }
    assert_eq!(reply, [7; 4]);
    let least = byte_time(2400) * 6;
    assert!(begin.elapsed() >= least, "{:?} is less than {least:?}", begin.elapsed());
}

#[test]
fn faults_are_played_in_real_time() {
    let handle = serve(&Endpoint::Channel, options(&["plant:locked-shaft@50ms,motor=2", "drop=1,dir=in"]));
    let client = handle.new_channel().expect("it is in-process");
    client.to_controller.send(vec![0x80, 1]).expect("it serves");
    assert!(eventually(|| handle.views()[0].axes[1].truth.shaft_locked));
    assert_eq!(handle.inspect(|parrot| parrot.heard.len()).expect("it runs"), 0);
}

#[test]
fn virtual_time_is_measured_over_exactly_the_time_asked_for() {
    let mut parrot = Parrot::new();
    parrot.duty = 0.5;
    let mut calls = 0;
    let speed =
        measure_speed(&mut parrot, Duration::from_secs(10), Duration::from_millis(10), |_| calls += 1);
    assert_eq!(
        (calls, parrot.now(), speed.simulated),
        (1000, Duration::from_secs(10), Duration::from_secs(10))
    );
    assert!(speed.times_real_time() > 1.0, "{}", speed.times_real_time());
}
