//! Attacks on every reader of what comes from outside: none may end the program, hang, or take more than its share of time and memory.
//!
//! `cargo test --workspace --bench attacks -- --seconds 100` shares so many seconds among the readers (the test command does so);
//! `cargo bench -p brushwork-tests --bench attacks -- --inputs 10000000` gives each reader so many inputs; with both, what one reader does not
//! need of its time is for those after it. Inputs are small samples that were changed at random, and for a quarter of the time the worst
//! ones of 1 MB, until all of those were tried. `--only NAME`, `--seed NUMBER`; `--one NAME FILE` runs one input again.
//!
//! Each reader works in a process of its own, on a thread with the stack that threads of the program have. Time is that of the thread
//! itself, so that a busy computer blames nobody; memory is what was taken beyond what was held before.
#![expect(clippy::print_stdout, reason = "the table is what the benchmark is for")]

mod brought;
mod mutate;
mod targets;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{ExitCode, Stdio};
use std::time::{Duration, Instant};

use brushwork_child::Child;
use brushwork_tests::workspace;
use mutate::{Inputs, Worst};
use peak_alloc::PeakAlloc;
use targets::{TARGETS, Target};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What one input may take, whatever its length.
const MOST_MEMORY_BYTES: usize = 200 << 20;
/// What one input may take of a processor; builds that are not optimised take several times as long.
const MOST_TIME: Duration =
    if cfg!(debug_assertions) { Duration::from_secs(5) } else { Duration::from_secs(1) };
/// As threads of the program have it.
const STACK_BYTES: usize = 2 << 20;
/// What the worst inputs may take of a reader's time.
const WORST_SHARE: f64 = 0.25;
/// An input that takes so long of the wall's time hangs.
const HANGS_AFTER: Duration = Duration::from_secs(120);

struct Args {
    /// For all readers; of a child, for its own.
    seconds: Option<f64>,
    /// For each reader.
    inputs: Option<u64>,
    seed: u64,
    only: Option<String>,
    child: Option<String>,
    one: Option<(String, PathBuf)>,
    folder: Option<PathBuf>,
}

fn args() -> Result<Args, String> {
    let mut args =
        Args { seconds: None, inputs: None, seed: 1, only: None, child: None, one: None, folder: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} has no value"));
        let number = |text: String| text.parse::<f64>().map_err(|error| format!("{text}: {error}"));
        match word.as_str() {
            "--seconds" => args.seconds = Some(number(value()?)?),
            "--inputs" => {
                args.inputs = Some(value()?.parse().map_err(|error| format!("--inputs: {error}"))?);
            }
            "--seed" => args.seed = value()?.parse().map_err(|error| format!("--seed: {error}"))?,
            "--only" => args.only = Some(value()?),
            "--child" => args.child = Some(value()?),
            "--folder" => args.folder = Some(PathBuf::from(value()?)),
            "--one" => args.one = Some((value()?, PathBuf::from(value()?))),
            // Cargo says what it runs.
            "--bench" | "--test" => {}
            other => return Err(format!("{other} is no option of the attacks")),
        }
    }
    // Without either, a look at them all.
    if args.seconds.is_none() && args.inputs.is_none() {
        args.seconds = Some(60.0);
    }
    Ok(args)
}

fn main() -> ExitCode {
    let args = match args() {
        Ok(args) => args,
        Err(error) => {
            println!("{error}");
            return ExitCode::FAILURE;
        }
    };
    brushwork::install();
    if let Some((name, file)) = &args.one {
        let Some(target) = targets::named(name) else { return ExitCode::FAILURE };
        let bytes = fs::read(file).expect("the file of the attack");
        return on_a_thread(move || {
            let folder = folder();
            let finding = Attack::new(target, folder.path()).strike(&bytes);
            println!("{}", finding.clone().unwrap_or_else(|| "nothing was found".to_owned()));
            finding.is_none()
        });
    }
    if let (Some(name), Some(folder)) = (&args.child, args.folder.clone()) {
        let Some(target) = targets::named(name) else { return ExitCode::FAILURE };
        let (seed, inputs) = (args.seed, args.inputs.unwrap_or(u64::MAX));
        let seconds = args.seconds.unwrap_or(f64::INFINITY);
        return on_a_thread(move || besiege(target, &folder, seed, inputs, seconds));
    }
    parent(&args)
}

/// Runs work with the stack of a thread of the program.
fn on_a_thread(work: impl FnOnce() -> bool + Send + 'static) -> ExitCode {
    let thread = std::thread::Builder::new().name("attack".to_owned()).stack_size(STACK_BYTES);
    let done = thread.spawn(work).expect("the system gives a thread").join();
    if done.unwrap_or(false) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The processor time of this thread; the wall's where the system does not tell it.
fn spent() -> Duration {
    #[cfg(unix)]
    {
        let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::try_from(now).unwrap_or_default()
    }
    #[cfg(not(unix))]
    std::time::SystemTime::now().duration_since(std::time::SystemTime::UNIX_EPOCH).unwrap_or_default()
}

/// One reader under attack.
struct Attack {
    target: &'static Target,
    reader: targets::Reader,
    /// The input that is read, so that it is there when the reader takes the process with it.
    file: PathBuf,
    most_time: Duration,
    most_bytes: usize,
}

impl Attack {
    fn new(target: &'static Target, folder: &Path) -> Self {
        let file = folder.join("input");
        Self { target, reader: (target.reader)(folder), file, most_time: Duration::ZERO, most_bytes: 0 }
    }

    /// Lets the reader read one input; what is wrong with that, in a sentence.
    fn strike(&mut self, input: &[u8]) -> Option<String> {
        fs::write(&self.file, input).expect("the folder is the attack's");
        MEMORY.reset_peak_usage();
        let (held, begun) = (MEMORY.current_usage(), spent());
        (self.reader)(input, &self.file);
        let time = spent().saturating_sub(begun);
        let bytes = MEMORY.peak_usage().saturating_sub(held);
        self.most_time = self.most_time.max(time);
        self.most_bytes = self.most_bytes.max(bytes);
        let name = self.target.name;
        if time > MOST_TIME {
            return Some(format!("{name}: {} bytes took {:.1} s", input.len(), time.as_secs_f64()));
        }
        if bytes > MOST_MEMORY_BYTES {
            return Some(format!("{name}: {} bytes took {} MB of memory", input.len(), bytes >> 20));
        }
        None
    }
}

/// Attacks one reader until inputs or time are used up; whether nothing was found. The last line says what was tried.
fn besiege(target: &'static Target, folder: &Path, seed: u64, inputs: u64, seconds: f64) -> bool {
    let begun = Instant::now();
    let mut attack = Attack::new(target, folder);
    let samples = (target.samples)();
    let mut inputs_of = Inputs::new(seed, samples.clone(), target.words);
    let worst = Worst::new(samples, target.words);
    // Each run takes others first, since there may not be time for all.
    let first = usize::try_from(seed).unwrap_or(0).wrapping_mul(7919);
    let (mut tried, mut worst_tried, mut worst_took) = (0_u64, 0, 0.0);
    while tried < inputs {
        let since = begun.elapsed().as_secs_f64();
        if since >= seconds {
            break;
        }
        let is_worst = worst_tried < worst.len() && worst_took <= WORST_SHARE * since;
        let finding = if is_worst {
            // 7919 is a prime, so that all come, and those that are alike not one after the other.
            let number = first.wrapping_add(worst_tried.wrapping_mul(7919)) % worst.len();
            worst_tried += 1;
            attack.strike(&worst.get(number))
        } else {
            attack.strike(&inputs_of.next())
        };
        if let Some(finding) = finding {
            println!("{finding}");
            return false;
        }
        if is_worst {
            worst_took += begun.elapsed().as_secs_f64() - since;
        }
        tried += 1;
    }
    println!(
        "{:<28} {tried:>10} {worst_tried:>6} {:>9.0} {:>9.1}",
        target.name,
        attack.most_time.as_secs_f64() * 1e3,
        attack.most_bytes as f64 / f64::from(1 << 20),
    );
    true
}

fn parent(args: &Args) -> ExitCode {
    let chosen: Vec<&Target> = TARGETS
        .iter()
        .filter(|target| args.only.as_ref().is_none_or(|only| target.name.contains(only)))
        .collect();
    let begun = Instant::now();
    let kept = workspace::root().join("target/attacks");
    println!("seed {}; {} readers", args.seed, chosen.len());
    println!("{:<28} {:>10} {:>6} {:>9} {:>9}", "reader", "inputs", "1 MB", "most ms", "most MB");
    let mut found = 0;
    let count = chosen.len();
    for (number, target) in chosen.into_iter().enumerate() {
        let folder = folder();
        let mut command = std::process::Command::new(std::env::current_exe().expect("this program"));
        command.args(["--child", target.name, "--folder"]).arg(folder.path());
        command.args(["--seed", &args.seed.to_string()]);
        if let Some(inputs) = args.inputs {
            command.args(["--inputs", &inputs.to_string()]);
        }
        if let Some(seconds) = args.seconds {
            let left = seconds - begun.elapsed().as_secs_f64();
            command.args(["--seconds", &(left / (count - number) as f64).to_string()]);
        }
        let mut child = Child::spawn(&command, [Stdio::null(), Stdio::inherit(), Stdio::inherit()]);
        let input = folder.path().join("input");
        while child.is_running() && age(&input) < HANGS_AFTER {
            std::thread::sleep(Duration::from_millis(50));
        }
        let is_sound = if child.is_running() {
            println!("{}: an input hangs", target.name);
            false
        } else {
            child.finish(HANGS_AFTER).success()
        };
        if !is_sound {
            found += 1;
            fs::create_dir_all(&kept).expect("the build's folder");
            let file = kept.join(format!("{}.input", target.name.replace(' ', "-")));
            fs::copy(&input, &file).expect("the input of the attack");
            println!("{0}: FAILED; again: --one \"{0}\" {1}", target.name, file.display());
        }
    }
    if found == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// For the inputs. In memory, where the system has such a place: each of them is written before it is read.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).expect("a folder")
}

fn age(path: &Path) -> Duration {
    let changed = fs::metadata(path).and_then(|found| found.modified()).ok();
    changed.and_then(|changed| changed.elapsed().ok()).unwrap_or_default()
}
