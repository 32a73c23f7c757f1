//! The small layer through which everything that is kept on this computer is read and written: the system's disk, or a simulated one that tests
//! fill up, lock and cut off at any call. A web page has its files in memory.

mod disk;
mod layer;
mod memory;
#[cfg(target_family = "wasm")]
pub(crate) mod page;
mod simulated;
#[cfg(not(target_family = "wasm"))]
mod system;

pub use disk::{replace_file, write_new_file};
pub use layer::{Files, Look, flush_name, process_id, replace};
pub use memory::{MemoryDisk, Shelf};
#[cfg(target_family = "wasm")]
pub use page::{Disk, look, open, page};
pub use simulated::{DiskFault, Remains, SimulatedDisk};
#[cfg(not(target_family = "wasm"))]
pub use system::{Disk, look, open};

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    const PATH: &str = "/keep/a.json";

    /// Replaces one file on a disk that fails at each call in turn.
    #[test]
    fn whatever_fails_and_wherever_it_is_cut_the_old_file_or_the_new_one_is_there_whole() {
        let disk = || {
            let disk = SimulatedDisk::default();
            disk.make_folder(Path::new("/keep")).unwrap();
            replace(&disk, Path::new(PATH), b"the old text").unwrap();
            disk
        };
        let mut cuts = 0;
        for fault in DiskFault::ALL {
            for call in 1.. {
                let disk = disk();
                disk.fail_at(call, fault);
                let kept = replace(&disk, Path::new(PATH), b"the new text");
                if disk.calls() < call {
                    assert!(kept.is_ok(), "{fault:?}: a call that was never made cannot fail");
                    break;
                }
                for remains in Remains::ALL {
                    let after = disk.after_crash(remains);
                    let text = after.read(Path::new(PATH)).unwrap();
                    assert!(
                        ["the old text", "the new text"].contains(&text.as_str()),
                        "{fault:?} {call}: {text}"
                    );
                    if kept.is_ok() {
                        assert_eq!(text, "the new text", "{fault:?} {call}: what is kept lasts");
                    }
                    cuts += 1;
                }
            }
        }
        assert!(cuts > 40, "{cuts}");
    }

    /// The simulated disk is no friendlier than a real one: without the two flushes a crash does harm.
    #[test]
    fn without_flushing_a_crash_leaves_a_torn_file_or_the_old_name() {
        let disk = SimulatedDisk::default();
        let [beside, path] = ["/keep/b", PATH].map(Path::new);
        disk.make_folder(Path::new("/keep")).unwrap();
        replace(&disk, path, b"the old text").unwrap();
        disk.write(beside, b"the new text").unwrap();
        disk.rename(beside, path).unwrap();
        assert_eq!(disk.read(path).unwrap(), "the new text", "until the power goes");
        let found: Vec<String> =
            Remains::ALL.iter().map(|remains| disk.after_crash(*remains).read(path).unwrap()).collect();
        assert!(
            found.contains(&"the old text".to_owned()) && found.contains(&"the ne".to_owned()),
            "{found:?}"
        );
    }
}
