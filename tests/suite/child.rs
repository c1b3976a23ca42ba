//! Child processes of tests. Runs a command and returns its exit status and output. Child processes
//! end with their test however it ends; signals are sent without the `kill` program, which a
//! minimal system lacks. What a process does is measured in its CPU time, which a busy machine does not change.

use std::io::{BufRead, BufReader};
use std::process::{Child, ChildStdin, ChildStdout, Command, ExitStatus, Output};
use std::time::{Duration, Instant};

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

/// Longer than whatever a test waits for takes on the busiest machine.
pub const HANG: Duration = Duration::from_secs(600);

/// Between two looks at a process.
const STEP: Duration = Duration::from_millis(20);

/// Clock ticks of Linux a second, on all of its architectures (`USER_HZ`).
const TICKS: f64 = 100.0;

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
            std::thread::sleep(STEP);
        }
        self.0.take().unwrap().wait_with_output().unwrap()
    }

    /// Waits for the first line that it prints.
    pub fn first_line(&mut self) -> String {
        let mut line = String::new();
        let stdout = self.child().stdout.as_mut().unwrap();
        BufReader::with_capacity(1, stdout).read_line(&mut line).unwrap();
        line
    }

    /// Takes the ends of its pipes, to write to it and to read from it.
    pub fn pipes(&mut self) -> (ChildStdin, ChildStdout) {
        let child = self.child();
        (child.stdin.take().unwrap(), child.stdout.take().unwrap())
    }

    /// Waits while it runs and `condition` is false.
    pub fn wait_until(&mut self, mut condition: impl FnMut(&Running) -> bool) {
        let start = Instant::now();
        while self.ended().is_none() && !condition(self) {
            assert!(start.elapsed() < HANG, "nothing has happened for {HANG:?}");
            std::thread::sleep(STEP);
        }
    }

    /// Returns true once it handles the signal of Ctrl-C itself; `None` where the system has no `/proc`.
    pub fn handles_interrupts(&self) -> Option<bool> {
        let text = std::fs::read_to_string(format!("/proc/{}/status", self.id())).ok()?;
        let caught = text.lines().find_map(|line| line.strip_prefix("SigCgt:"))?;
        let mask = u64::from_str_radix(caught.trim(), 16).ok()?;
        Some(mask >> (Signal::SIGINT as i32 - 1) & 1 == 1)
    }

    /// Returns the seconds that its threads have run; `None` where the system has no `/proc`, or if it has ended.
    pub fn cpu_seconds(&self) -> Option<f64> {
        let text = std::fs::read_to_string(format!("/proc/{}/stat", self.id())).ok()?;
        // Behind the name in parentheses: the state, ten more fields, then the ticks of user and system.
        let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
        let ticks = |field: &str| field.parse::<f64>().ok();
        Some((ticks(fields.get(11)?)? + ticks(fields.get(12)?)?) / TICKS)
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
