//! Child processes of tests. Runs a command and returns its exit status and output. Child processes
//! end with their test however it ends; signals are sent without the `kill` program, which a
//! minimal system lacks.

use std::process::{Child, Command, ExitStatus, Output};
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

pub struct Running(Option<Child>);

impl Running {
    pub fn start(command: &mut Command) -> Running {
        Running(Some(command.spawn().unwrap()))
    }

    pub fn id(&self) -> Pid {
        Pid::from_raw(self.0.as_ref().unwrap().id() as i32)
    }

    fn child(&mut self) -> &mut Child {
        self.0.as_mut().unwrap()
    }

    /// The exit status, once it has ended.
    pub fn ended(&mut self) -> Option<ExitStatus> {
        self.child().try_wait().unwrap()
    }

    /// Sends the signal of Ctrl-C in a terminal.
    pub fn interrupt(&self) {
        kill(self.id(), Signal::SIGINT).unwrap();
    }

    /// Waits for its end, up to a timeout, and takes its output.
    pub fn output(mut self, most: Duration) -> Output {
        let start = Instant::now();
        while self.ended().is_none() {
            assert!(start.elapsed() < most, "still running after {most:?}");
            std::thread::sleep(Duration::from_millis(20));
        }
        self.0.take().unwrap().wait_with_output().unwrap()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            // It may have ended already.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
