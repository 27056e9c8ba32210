//! Server and viewers with a card in this process: what arrives, what is refused, who waits for whom.

use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

use zga_abi::Reg;
use zga_abi::packet::Opcode;
use zga_device::{Card, CardBus, CardOptions};
use zga_driver::{Driver, Target, TargetOptions};

use super::message::{Kind, MAGIC};
use super::*;

/// Longest wait for what has to come. Never the measure of anything.
const LONG: Duration = Duration::from_secs(60);
/// Long enough for some vertical blanks to have passed.
const BLANKS: Duration = Duration::from_millis(100);

/// A folder of its own for each test, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Folder {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("zga-link-{}-{number}", std::process::id()));
        std::fs::create_dir(&path).expect("a folder");
        Folder(path)
    }

    fn socket(&self) -> PathBuf {
        self.0.join("card")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A card with a screen, and its server. The server goes before the card.
struct Bench {
    server: Option<Server>,
    driver: Driver<CardBus>,
    target: Target,
    card: Card,
    folder: Folder,
}

impl Bench {
    fn new([width, height]: [u32; 2]) -> Bench {
        let folder = Folder::new();
        let card = Card::power_on(CardOptions { threads: 1, ..CardOptions::default() }).expect("power");
        let mut driver = Driver::open(card.bus()).expect("card");
        let target = driver.create_target(TargetOptions::new(width, height)).expect("target");
        driver.begin_scene(&target).expect("scene");
        driver.clear(Some([1, 2, 3, 255]), Some(1.0)).expect("clear");
        driver.end_scene().expect("end");
        driver.present(&target).expect("present");
        driver.packet(Opcode::RegisterWrite, &[Reg::ScanoutControl.offset(), 1]).expect("continuous");
        driver.finish().expect("finish");
        let server = Server::start(&folder.socket(), card.connector(), card.bus()).expect("server");
        Bench { server: Some(server), driver, target, card, folder }
    }

    fn viewer(&self) -> Viewer {
        Viewer::connect(&self.folder.socket(), LONG).expect("attached")
    }

    fn fill(&mut self, grey: u8) {
        self.driver.begin_scene(&self.target).expect("scene");
        self.driver.clear(Some([grey, grey, grey, 255]), Some(1.0)).expect("clear");
        self.driver.end_scene().expect("end");
        self.driver.finish().expect("finish");
    }

    /// A connection that speaks for itself.
    fn raw(&self) -> UnixStream {
        let socket = UnixStream::connect(self.folder.socket()).expect("connected");
        socket.set_read_timeout(Some(LONG)).expect("timeout");
        socket
    }
}

fn grey(level: u32) -> u32 {
    0xFF00_0000 | (level * 0x01_0101)
}

fn send(socket: &mut UnixStream, words: &[u32]) {
    socket.write_all(bytemuck::cast_slice(words)).expect("sent");
}

/// All that the server still says before it hangs up, as text.
fn last_words(mut socket: UnixStream) -> String {
    let mut bytes = Vec::new();
    // A connection that is reset has said its last word too.
    let _ = socket.read_to_end(&mut bytes);
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Waits until `condition` holds.
fn until(what: &str, mut condition: impl FnMut() -> bool) {
    let deadline = Instant::now() + LONG;
    while !condition() {
        assert!(Instant::now() < deadline, "never came: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn frame_shows_what_the_card_puts_out_and_comes_once() {
    let mut bench = Bench::new([40, 30]);
    let mut viewer = bench.viewer();
    assert_eq!(viewer.card(), bench.driver.card_info());
    assert_eq!(viewer.process(), std::process::id());

    let first = viewer.next_frame(LONG).expect("link").expect("frame");
    assert_eq!((first.width, first.height), (40, 30));
    assert_eq!(first.pixels, vec![0xFF01_0203; 40 * 30]);
    assert_eq!(viewer.next_frame(BLANKS).expect("link"), None, "nothing has changed");

    bench.fill(9);
    let second = viewer.next_frame(LONG).expect("link").expect("frame");
    assert_eq!(second.pixels, vec![grey(9); 40 * 30]);
    assert!(second.number > first.number);
}

#[test]
fn frame_with_the_same_pixels_written_again_is_not_sent() {
    let mut bench = Bench::new([40, 30]);
    let mut viewer = bench.viewer();
    bench.fill(5);
    until("the fill", || viewer.next_frame(BLANKS).expect("link").is_some_and(|frame| frame.pixels[0] == grey(5)));
    bench.fill(5);
    assert_eq!(viewer.next_frame(BLANKS).expect("link"), None);
}

#[test]
fn status_is_what_the_driver_reads() {
    let mut bench = Bench::new([40, 30]);
    let mut viewer = bench.viewer();
    let status = viewer.status(LONG).expect("status");
    let counters = bench.driver.counters();
    assert_eq!(status.counter("frontend.packets"), counters.by_name("frontend.packets"));
    assert_eq!(status.counters.len(), zga_abi::Counter::COUNT);
    assert_eq!(status.effects, bench.driver.effects_called());
    assert_eq!(status.units, bench.driver.units_powered());
    bench.fill(7);
    let since = viewer.status(LONG).expect("status").since(&status);
    assert!(since.counter("frontend.fences").is_some_and(|fences| fences >= 1));
}

#[test]
fn status_between_frames_loses_none() {
    let mut bench = Bench::new([40, 30]);
    let mut viewer = bench.viewer();
    assert!(viewer.next_frame(LONG).expect("link").is_some());
    assert!(viewer.next_frame(Duration::ZERO).expect("link").is_none());
    bench.fill(3);
    // The frame that was asked for comes before, among or after these.
    for _ in 0..20 {
        viewer.status(LONG).expect("status");
    }
    let frame = viewer.next_frame(LONG).expect("link").expect("frame");
    assert_eq!(frame.pixels[0], grey(3));
}

#[test]
fn nobody_watching_nothing_is_composed() {
    let bench = Bench::new([40, 30]);
    assert!(!bench.card.connector().is_watched());
    let mut viewer = bench.viewer();
    viewer.status(LONG).expect("status");
    assert!(!bench.card.connector().is_watched(), "counters alone need no frames");
    assert!(viewer.next_frame(LONG).expect("link").is_some());
    assert!(bench.card.connector().is_watched());
    drop(viewer);
    until("the monitor is unplugged", || !bench.card.connector().is_watched());
}

#[test]
fn slow_viewer_misses_frames_and_slows_nobody() {
    // 4 MiB a frame: more than a socket holds, so an answer to who does not read stays half sent.
    let mut bench = Bench::new([1024, 1024]);
    let mut slow = bench.raw();
    send(&mut slow, &[Kind::Hello as u32, 3, MAGIC[0], MAGIC[1], VERSION, Kind::NextFrame as u32, 0]);
    let mut quick = bench.viewer();
    assert!(quick.next_frame(LONG).expect("link").is_some());
    for level in 10..40 {
        bench.fill(level);
        let expected = grey(level.into());
        until("the frame", || quick.next_frame(LONG).expect("link").is_some_and(|frame| frame.pixels[0] == expected));
    }
    drop(slow);
    assert!(quick.status(LONG).is_ok());
}

#[test]
fn several_viewers_see_the_same() {
    let mut bench = Bench::new([64, 64]);
    bench.fill(77);
    let viewers: Vec<Viewer> = (0..5).map(|_| bench.viewer()).collect();
    for mut viewer in viewers {
        let frame = viewer.next_frame(LONG).expect("link").expect("frame");
        assert_eq!(frame.pixels, vec![grey(77); 64 * 64]);
    }
}

#[test]
fn one_viewer_too_many_is_refused_and_a_seat_becomes_free() {
    let bench = Bench::new([16, 16]);
    let mut viewers: Vec<Viewer> = (0..MOST_VIEWERS).map(|_| bench.viewer()).collect();
    let refused = Viewer::connect(&bench.folder.socket(), LONG).expect_err("full");
    assert!(matches!(refused, LinkError::Refused { .. }), "{refused}");
    assert!(refused.to_string().contains("refused: 16 viewers are attached already"), "{refused}");
    viewers.pop();
    until("a free seat", || Viewer::connect(&bench.folder.socket(), LONG).is_ok());
}

#[test]
fn damaged_requests_are_told_and_others_not_disturbed() {
    let bench = Bench::new([16, 16]);
    let mut other = bench.viewer();
    let hello = [Kind::Hello as u32, 3, MAGIC[0], MAGIC[1], VERSION];
    let (frame, status) = (Kind::NextFrame as u32, Kind::Status as u32);
    let cases: [(&[u32], &str); 9] = [
        (&[0x2054_4547, 0x2F20_2F20], "kind 542393671, expected one of this side's messages"),
        (&[Kind::Hello as u32, 3, 1, 2, 3], "no magic number in the hello"),
        (&[Kind::Hello as u32, 3, MAGIC[0], MAGIC[1], 99], "version 99 of the link, expected 1"),
        (&[Kind::Hello as u32, 1 << 30], "1073741824 words, expected at most 3 of kind Hello"),
        (&[frame, 0], "NextFrame before a hello"),
        (&[&hello[..], &hello[..]].concat(), "Hello again before the answer"),
        (&[&hello[..], &[frame, 1, 0]].concat(), "1 words, expected at most 0 of kind NextFrame"),
        (&[&hello[..], &[Kind::Frame as u32, 0]].concat(), "kind 4, expected one of this side's messages"),
        (&[&hello[..], &[status, 0, 6, 0]].concat(), "kind 6, expected one of this side's messages"),
    ];
    for (words, expected) in cases {
        let mut socket = bench.raw();
        send(&mut socket, words);
        let said = last_words(socket);
        assert!(said.contains(expected), "{words:?}: expected {expected:?}, found {said:?}");
    }
    assert!(other.status(LONG).is_ok());
    assert!(other.next_frame(LONG).expect("link").is_some());
}

#[test]
fn viewers_that_hang_up_anywhere_leave_the_server_whole() {
    let bench = Bench::new([512, 512]);
    let words = [Kind::Hello as u32, 3, MAGIC[0], MAGIC[1], VERSION, Kind::NextFrame as u32, 0];
    let bytes: &[u8] = bytemuck::cast_slice(&words);
    for end in 0..=bytes.len() {
        let mut socket = bench.raw();
        socket.write_all(&bytes[..end]).expect("sent");
    }
    let mut viewer = bench.viewer();
    assert!(viewer.next_frame(LONG).expect("link").is_some());
}

#[test]
fn server_that_ends_is_told_and_takes_its_socket_along() {
    let mut bench = Bench::new([16, 16]);
    let mut viewer = bench.viewer();
    bench.server = None;
    assert!(!bench.folder.socket().exists());
    assert!(matches!(viewer.status(LONG), Err(LinkError::HungUp { .. })));
    let missing = Viewer::connect(&bench.folder.socket(), LONG).expect_err("gone").to_string();
    assert!(missing.contains("there is no socket here"), "{missing}");
}

#[test]
fn card_without_power_is_no_card_and_no_hang() {
    let Bench { server, card, folder, driver, .. } = Bench::new([16, 16]);
    let mut viewer = Viewer::connect(&folder.socket(), LONG).expect("attached");
    assert!(viewer.next_frame(LONG).expect("link").is_some());
    drop((card, driver));
    assert_eq!(viewer.next_frame(BLANKS).expect("link"), None);
    let refused = Viewer::connect(&folder.socket(), LONG).expect_err("no power").to_string();
    assert!(refused.contains("identification 0xffffffff, expected 0x5a474131"), "{refused}");
    drop(server);
}

#[test]
fn socket_of_the_dead_is_taken_over_and_of_the_living_not() {
    let folder = Folder::new();
    drop(UnixListener::bind(folder.socket()).expect("bound"));
    assert!(matches!(Viewer::connect(&folder.socket(), LONG), Err(LinkError::Dead { .. })));
    let card = Card::power_on(CardOptions::default()).expect("power");
    let start = |path: &Path| Server::start(path, card.connector(), card.bus());
    let server = start(&folder.socket()).expect("taken over");
    assert!(matches!(start(&folder.socket()), Err(LinkError::InUse { .. })));
    assert!(Viewer::connect(server.path(), LONG).is_ok(), "the living one is not disturbed");
    // A socket that somebody put in its place is not the server's to remove.
    std::fs::remove_file(folder.socket()).expect("removed");
    let _other = UnixListener::bind(folder.socket()).expect("bound");
    drop(server);
    assert!(folder.socket().exists());
}

#[test]
fn path_of_a_file_or_too_long_is_refused() {
    let folder = Folder::new();
    let card = Card::power_on(CardOptions::default()).expect("power");
    let start = |path: &Path| Server::start(path, card.connector(), card.bus()).expect_err("refused");
    std::fs::write(folder.socket(), "precious").expect("written");
    assert!(matches!(start(&folder.socket()), LinkError::NotASocket { .. }));
    assert_eq!(std::fs::read_to_string(folder.socket()).expect("left alone"), "precious");
    assert!(matches!(Viewer::connect(&folder.socket(), LONG), Err(LinkError::NotASocket { .. })));
    let long = folder.0.join("x".repeat(200));
    assert!(start(&long).to_string().contains("expected at most 107 for the path of a socket"));
    let nowhere = start(&folder.0.join("none/card")).to_string();
    assert!(nowhere.contains("its folder cannot be opened"), "{nowhere}");
}

/// Serves `words` to one viewer, takes what it says and hangs up.
fn impostor(words: &[u32]) -> (Folder, std::thread::JoinHandle<()>) {
    let folder = Folder::new();
    let listener = UnixListener::bind(folder.socket()).expect("bound");
    let words = words.to_vec();
    let thread = std::thread::spawn(move || {
        let (mut socket, _) = listener.accept().expect("accepted");
        // The viewer may have left already.
        let _ = socket.write_all(bytemuck::cast_slice(&words));
        let _ = socket.shutdown(std::net::Shutdown::Write);
        let _ = socket.read_to_end(&mut Vec::new());
    });
    (folder, thread)
}

#[test]
fn impostors_are_told_from_cards() {
    let hello = |version| [Kind::Hello as u32, 11, MAGIC[0], MAGIC[1], version];
    let rest = [1, zga_abi::IDENTIFICATION, zga_abi::ABI_VERSION, 0, 0, 0, 0, 0];
    let good = [&hello(VERSION)[..], &rest].concat();
    let cases: [(Vec<u32>, &str); 6] = [
        (vec![], "it hung up at once"),
        (vec![0x5053_4948, 0], "kind 1347635528"),
        (vec![Kind::Hello as u32, 2, 1, 2], "no magic number"),
        (hello(7)[..].iter().copied().chain(rest).collect(), "speaks version 7 of the link, expected 1"),
        (vec![Kind::Hello as u32, 4, MAGIC[0], MAGIC[1], VERSION, 0], "its hello has not 11 words"),
        (good[..9].to_vec(), "it hung up at once"),
    ];
    for (words, expected) in cases {
        let (folder, thread) = impostor(&words);
        let found = Viewer::connect(&folder.socket(), LONG).expect_err(expected).to_string();
        assert!(found.contains(expected), "expected {expected:?}, found {found:?}");
        thread.join().expect("served");
    }
}

#[test]
fn damaged_frames_are_refused() {
    let rest = [1, zga_abi::IDENTIFICATION, zga_abi::ABI_VERSION, 0, 0, 0, 0, 0];
    let good = [&[Kind::Hello as u32, 11, MAGIC[0], MAGIC[1], VERSION][..], &rest].concat();
    let frame = Kind::Frame as u32;
    let cases: [(&[u32], &str); 6] = [
        (&[frame, 3, 1, 1, 0], "a frame of 3 words, expected at least 4"),
        (&[frame, 5, 1, 2, 0, 0, 9], "1 pixels of a frame of 1 x 2, expected 2"),
        (&[frame, 4, 0, 2, 0, 0], "a frame of 0 x 2, expected 1 to 16384 on a side"),
        (&[frame, 5, 99_999, 2, 0, 0, 9], "a frame of 99999 x 2"),
        (&[frame, u32::MAX], "4294967295 words, expected at most 268435460 of kind Frame"),
        (&[Kind::Status as u32, 1, 0], "Status, expected a frame"),
    ];
    for (words, expected) in cases {
        let (folder, thread) = impostor(&[&good[..], words].concat());
        let mut viewer = Viewer::connect(&folder.socket(), LONG).expect("looks like a card");
        let found = viewer.next_frame(LONG).expect_err(expected).to_string();
        assert!(found.contains(expected), "expected {expected:?}, found {found:?}");
        drop(viewer);
        thread.join().expect("served");
    }
}

#[test]
fn server_that_never_answers_is_a_timeout() {
    let folder = Folder::new();
    let _silent = UnixListener::bind(folder.socket()).expect("bound");
    let found = Viewer::connect(&folder.socket(), Duration::from_millis(50)).expect_err("silent").to_string();
    assert!(found.contains("no answer within 50 ms"), "{found}");
}
