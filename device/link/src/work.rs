//! Work beside the window: on a thread of its own, or at once where there are no threads, as in a web page.

use crossbeam_channel::{Receiver, RecvTimeoutError, Select, Sender, TryRecvError, TrySendError, bounded};
use std::io;
use std::sync::{Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A web page has none: whoever asks for one is refused.
pub const HAS_THREADS: bool = !cfg!(target_family = "wasm");

/// Does something on a thread of that name, or at once where there are none.
///
/// # Errors
/// The system gives no thread; nothing is done then.
pub fn spawn(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    if HAS_THREADS {
        thread::Builder::new().name(name.to_owned()).spawn(work).map(drop)
    } else {
        work();
        Ok(())
    }
}

/// Waits so long for what somebody else's thread sends. Without threads it is there already, or not yet.
///
/// # Errors
/// It has not come in that time, or never will.
pub fn wait<T>(channel: &Receiver<T>, time: Duration) -> Result<T, RecvTimeoutError> {
    if HAS_THREADS {
        return receive_within(channel, time);
    }
    channel.try_recv().map_err(|error| match error {
        TryRecvError::Empty => RecvTimeoutError::Timeout,
        TryRecvError::Disconnected => RecvTimeoutError::Disconnected,
    })
}

/// Waits at most so long for what comes through a channel, and sleeps meanwhile.
///
/// `recv_timeout` gives the processor away a few times in the hope of an early answer before it sleeps, and on a crowded computer each time
/// costs a turn of all the others: with 8 busy processes on 2 processors it woke 44 ms late in the median, 126 ms at the 90th percentile
/// (crossbeam-channel 0.5.17, waits of 20 ms), a choice among one channel, which sleeps at once, 4 and 16 ms.
///
/// # Errors
/// Nothing has come in that time, or nothing ever will.
pub fn receive_within<T>(channel: &Receiver<T>, time: Duration) -> Result<T, RecvTimeoutError> {
    let mut only = Select::new();
    only.recv(channel);
    let chosen = only.select_timeout(time).map_err(|_| RecvTimeoutError::Timeout)?;
    chosen.recv(channel).map_err(|_| RecvTimeoutError::Disconnected)
}

/// Does tasks one after the other, on a thread of its own, or each at once where there are none. Dropping it waits for what is still to be
/// done.
pub struct Worker<T>(Hands<T>);

enum Hands<T> {
    Thread {
        tasks: Option<Sender<T>>,
        thread: Option<JoinHandle<()>>,
    },
    /// Whoever gives the task does it.
    Here(Mutex<Box<dyn FnMut(T) + Send>>),
}

impl<T> std::fmt::Debug for Worker<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Worker")
    }
}

impl<T: Send + 'static> Worker<T> {
    /// Starts a thread of that name, for which so many tasks may wait. Where the system gives none, every task is refused.
    #[must_use]
    pub fn start(name: &str, queue: usize, mut act: impl FnMut(T) + Send + 'static) -> Self {
        if !HAS_THREADS {
            return Self::here(act);
        }
        let (sender, tasks) = bounded(queue);
        // Without a thread the sender's other end is gone.
        let work = move || tasks.iter().for_each(&mut act);
        let thread = thread::Builder::new().name(name.to_owned()).spawn(work).ok();
        Self(Hands::Thread { tasks: Some(sender), thread })
    }

    /// Does each task at once, in the hands of whoever gives it.
    #[must_use]
    pub fn here(act: impl FnMut(T) + Send + 'static) -> Self {
        Self(Hands::Here(Mutex::new(Box::new(act))))
    }

    /// Whether there is anybody to do tasks.
    #[must_use]
    pub fn is_there(&self) -> bool {
        match &self.0 {
            Hands::Thread { thread, .. } => thread.is_some(),
            Hands::Here(_) => true,
        }
    }

    /// Gives a task; never waits for a thread.
    ///
    /// # Errors
    /// As many wait as may, or there is nobody to do it.
    pub fn give(&self, task: T) -> Result<(), TrySendError<T>> {
        match &self.0 {
            Hands::Thread { tasks: Some(tasks), .. } => tasks.try_send(task),
            Hands::Thread { tasks: None, .. } => Err(TrySendError::Disconnected(task)),
            Hands::Here(act) => {
                act.lock().unwrap_or_else(PoisonError::into_inner)(task);
                Ok(())
            }
        }
    }
}

impl<T> Worker<T> {
    /// Takes no more tasks, and waits for those that were given.
    pub fn finish(&mut self) {
        if let Hands::Thread { tasks, thread } = &mut self.0 {
            *tasks = None;
            if let Some(thread) = thread.take() {
                // A panic of that thread has told itself already.
                let _ = thread.join();
            }
        }
    }
}

impl<T> Drop for Worker<T> {
    fn drop(&mut self) {
        self.finish();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn tasks_are_done_in_order_and_before_the_worker_is_gone_with_a_thread_and_without() {
        let done = Arc::new(Mutex::new(Vec::new()));
        let act = || {
            let done = done.clone();
            move |task| done.lock().unwrap().push(task)
        };
        for worker in [Worker::start("test", 8, act()), Worker::here(act())] {
            assert!(worker.is_there());
            (0..5).for_each(|task| worker.give(task).unwrap());
            drop(worker);
            assert_eq!(std::mem::take(&mut *done.lock().unwrap()), [0, 1, 2, 3, 4]);
        }
    }

    #[test]
    fn without_threads_a_task_is_done_when_it_is_given() {
        let (sender, seen) = bounded(1);
        let worker = Worker::here(move |task: u8| sender.send(task).unwrap());
        worker.give(7).unwrap();
        assert_eq!(seen.try_recv(), Ok(7));
    }

    #[test]
    fn a_worker_that_has_finished_refuses_tasks() {
        let mut worker = Worker::start("test", 1, |_: u8| {});
        worker.finish();
        assert_eq!(worker.give(1), Err(TrySendError::Disconnected(1)));
    }
}
