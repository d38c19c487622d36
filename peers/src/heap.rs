/// The result of `make`, and the number of bytes by which the heap has grown meanwhile. Rust and C++ share one heap.
/// The number is 0 if the C library is not glibc, since only glibc reports it.
pub fn taken_from_heap<T>(make: impl FnOnce() -> T) -> (T, usize) {
    let before = held();
    let made = make();
    (made, held().saturating_sub(before))
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn held() -> usize {
    #[expect(unsafe_code, reason = "a call into the C library")]
    // SAFETY: the function takes no argument, and may be called at any time.
    let heap = unsafe { libc::mallinfo2() };
    heap.uordblks + heap.hblkhd
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn held() -> usize {
    0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    fn a_megabyte_is_counted() {
        // Without `black_box` a release build would not allocate.
        let (made, bytes) = taken_from_heap(|| std::hint::black_box(vec![1u8; 1 << 20]));
        assert!(bytes >= made.len(), "{bytes}");
    }
}
