//! Who may call devices with the validation layer. The layer finds its instances and devices in a map without a lock
//! (KhronosGroup/Vulkan-ValidationLayers, issue 4391): while one is opened or closed, no other thread may call another.
//! In: a thread's wish to use what is open, or to open and close. Out: its turn.

use std::cell::Cell;
use std::marker::PhantomData;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The threads that use open devices, those that wait to open one, and whether it is their turn: the last user gives it
/// to them, because users come again too soon for anybody to come between.
struct Turns {
    users: usize,
    waiting: usize,
    opens: bool,
    taken: bool,
}

static TURNS: Mutex<Turns> = Mutex::new(Turns { users: 0, waiting: 0, opens: false, taken: false });
static CHANGED: Condvar = Condvar::new();

thread_local! {
    /// The turns of this thread to use, of which the first is counted, and to open.
    static USING: Cell<usize> = const { Cell::new(0) };
    static OPENING: Cell<usize> = const { Cell::new(0) };
}

/// The turn to use open devices. Turns of one thread may be within each other.
pub struct Using(PhantomData<*const ()>);

/// The turn to open devices, use and close them: nobody else has a turn meanwhile.
pub struct Opening(PhantomData<*const ()>);

fn turns() -> MutexGuard<'static, Turns> {
    TURNS.lock().unwrap_or_else(PoisonError::into_inner)
}

pub fn using() -> Using {
    if USING.get() == 0 && OPENING.get() == 0 {
        let free = CHANGED.wait_while(turns(), |turns| turns.opens);
        free.unwrap_or_else(PoisonError::into_inner).users += 1;
    }
    USING.set(USING.get() + 1);
    Using(PhantomData)
}

pub fn opening() -> Opening {
    if OPENING.get() == 0 {
        assert_eq!(USING.get(), 0, "a thread that uses a device would wait for itself");
        let mut turns = turns();
        turns.waiting += 1;
        turns.opens |= turns.users == 0;
        let free = CHANGED.wait_while(turns, |turns| !turns.opens || turns.taken);
        turns = free.unwrap_or_else(PoisonError::into_inner);
        turns.waiting -= 1;
        turns.taken = true;
    }
    OPENING.set(OPENING.get() + 1);
    Opening(PhantomData)
}

impl Drop for Using {
    fn drop(&mut self) {
        USING.set(USING.get() - 1);
        if USING.get() == 0 && OPENING.get() == 0 {
            let mut turns = turns();
            turns.users -= 1;
            turns.opens = turns.users == 0 && turns.waiting > 0;
            CHANGED.notify_all();
        }
    }
}

impl Drop for Opening {
    fn drop(&mut self) {
        OPENING.set(OPENING.get() - 1);
        if OPENING.get() == 0 {
            let mut turns = turns();
            turns.taken = false;
            turns.opens = turns.waiting > 0;
            CHANGED.notify_all();
        }
    }
}

/// Users on two threads and openers on two more, each with turns within turns: nobody has an opener for company.
#[test]
fn nobody_uses_a_device_while_another_opens() {
    use std::sync::atomic::{AtomicU32, Ordering::SeqCst};
    let [users, openers] = [const { AtomicU32::new(0) }; 2];
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                for _ in 0..200 {
                    let outer = using();
                    users.fetch_add(1, SeqCst);
                    let inner = using();
                    drop(outer);
                    std::thread::yield_now();
                    assert_eq!(openers.load(SeqCst), 0);
                    users.fetch_sub(1, SeqCst);
                    drop(inner);
                }
            });
            scope.spawn(|| {
                for _ in 0..200 {
                    let _outer = opening();
                    let _inner = (opening(), using());
                    assert_eq!(openers.fetch_add(1, SeqCst), 0);
                    std::thread::yield_now();
                    assert_eq!(users.load(SeqCst), 0);
                    openers.fetch_sub(1, SeqCst);
                }
            });
        }
    });
}
