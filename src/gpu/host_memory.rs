//! Memory of the host. Sets when the allocator of this process gives blocks back to the system, and makes it give back what
//! is free. Both are wishes: without them, the process only keeps more than it needs.

/// Blocks from this size on are given back to the system when they are freed.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const LARGE_BLOCK: nix::libc::c_int = 1 << 20;

/// Makes the allocator give all large blocks back. By itself, glibc keeps those below the largest one that was freed before,
/// up to 32 MiB: after a file of a mesh, all that was needed for a while stays.
pub fn prepare() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    {
        use nix::libc::{M_MMAP_THRESHOLD, mallopt};
        // SAFETY: it takes two numbers, and locks what it changes.
        unsafe { mallopt(M_MMAP_THRESHOLD, LARGE_BLOCK) };
    }
}

/// Gives back all memory that was freed: where a driver compiled, a lot of small blocks. Takes some milliseconds.
pub fn give_back() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    // SAFETY: it takes a number, and locks what it changes.
    unsafe {
        nix::libc::malloc_trim(0)
    };
}
