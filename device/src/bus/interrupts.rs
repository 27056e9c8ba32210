//! Interrupt controller: status, enable, and the wire to whoever waits.
//!
//! Duties: latches lines that were raised, masks them, wakes waiting host threads.
//! Inputs: fence, vertical blank and error from the card's thread; enable and acknowledge from the bus.
//! Outputs: INTERRUPT_STATUS, INTERRUPT_ENABLE, [`Interrupts::wait`].
//! Clocks: none; a latch and two gates work beside everything else.
//!
//! A waiter looks at the latch for a few microseconds before it sleeps, because a fence is often
//! that near. To sleep it takes the lock, looks again, and only then waits; whoever raises a line
//! sets the latch first and then passes through the lock: no wake-up is lost, for any number of waiters.

use parking_lot::{Condvar, Mutex};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::SeqCst};
use std::time::{Duration, Instant};
use zga_abi::bus::INTERRUPT_ALL;

/// Looks at the latch before a waiter sleeps: about 5 microseconds, the price of a sleep and a wake-up.
const LOOKS: u32 = 200;

/// The interrupt controller.
#[derive(Debug, Default)]
pub(crate) struct Interrupts {
    status: AtomicU32,
    enable: AtomicU32,
    disconnected: AtomicBool,
    asleep: Mutex<()>,
    raised: Condvar,
}

impl Interrupts {
    /// Lines that occurred, enabled or not.
    pub(crate) fn status(&self) -> u32 {
        self.status.load(SeqCst)
    }

    /// Lines that reach the host.
    pub(crate) fn enable(&self) -> u32 {
        self.enable.load(SeqCst)
    }

    /// Raises `lines`.
    pub(crate) fn raise(&self, lines: u32) {
        self.status.fetch_or(lines, SeqCst);
        self.wake();
    }

    /// Acknowledges `lines`.
    pub(crate) fn acknowledge(&self, lines: u32) {
        self.status.fetch_and(!lines, SeqCst);
    }

    /// Sets which lines reach the host; a line that already occurred does so at once.
    pub(crate) fn set_enable(&self, lines: u32) {
        self.enable.store(lines & INTERRUPT_ALL, SeqCst);
        self.wake();
    }

    /// Sets both registers, as after a reset or a restore.
    pub(crate) fn set(&self, status: u32, enable: u32) {
        self.status.store(status & INTERRUPT_ALL, SeqCst);
        self.set_enable(enable);
    }

    /// Lets every waiter go, now and in future: the card has lost power.
    pub(crate) fn disconnect(&self) {
        self.disconnected.store(true, SeqCst);
        self.wake();
    }

    /// Waits until an enabled line of `mask` is pending; returns those that are, 0 after `timeout`.
    pub(crate) fn wait(&self, mask: u32, timeout: Duration) -> u32 {
        let pending = || self.status() & self.enable() & mask;
        let over = || self.disconnected.load(SeqCst);
        let start = Instant::now();
        for _ in 0..LOOKS {
            let lines = pending();
            if lines != 0 || timeout.is_zero() || over() {
                return lines;
            }
            std::hint::spin_loop();
        }
        let deadline = start.checked_add(timeout);
        let mut asleep = self.asleep.lock();
        loop {
            let lines = pending();
            if lines != 0 || over() {
                return lines;
            }
            match deadline {
                Some(deadline) if self.raised.wait_until(&mut asleep, deadline).timed_out() => return pending(),
                Some(_) => {}
                None => self.raised.wait(&mut asleep),
            }
        }
    }

    /// Wakes all who sleep; passing through the lock closes the gap between their look and their sleep.
    fn wake(&self) {
        drop(self.asleep.lock());
        self.raised.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wait_line_not_enabled_times_out() {
        let interrupts = Interrupts::default();
        interrupts.raise(1);
        assert_eq!(interrupts.wait(7, Duration::from_millis(5)), 0);
        interrupts.set_enable(1);
        assert_eq!(interrupts.wait(7, Duration::from_millis(5)), 1);
        assert_eq!(interrupts.wait(6, Duration::ZERO), 0);
    }

    #[test]
    fn wait_many_waiters_all_wake() {
        let interrupts = Interrupts::default();
        interrupts.set_enable(5);
        std::thread::scope(|threads| {
            let waiters: Vec<_> =
                (0..6).map(|_| threads.spawn(|| interrupts.wait(4, Duration::from_secs(60)))).collect();
            std::thread::sleep(Duration::from_millis(10));
            interrupts.raise(1);
            interrupts.raise(4);
            assert!(waiters.into_iter().all(|waiter| waiter.join().is_ok_and(|lines| lines == 4)));
        });
    }

    #[test]
    fn wait_power_lost_returns() {
        let interrupts = Interrupts::default();
        std::thread::scope(|threads| {
            let waiter = threads.spawn(|| interrupts.wait(7, Duration::MAX));
            interrupts.disconnect();
            assert_eq!(waiter.join().ok(), Some(0));
        });
    }
}
