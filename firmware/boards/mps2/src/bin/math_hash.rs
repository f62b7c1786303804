//! `math_hash`: golden-hash test of `geometry::math` and of the runtime's memory copy on the target. Prints
//! the golden hash of `geometry::math` (docs/architecture.md §2.4); exit code 0 if it equals the PC's and the
//! runtime's memory copy moves exactly the requested bytes, else 1.
#![allow(unsafe_code, reason = "registers, interrupts and flash are reached by address")]
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod check {
    use core::ffi::c_void;

    use cortex_m_semihosting::{debug, hprintln};
    use geometry::math::{GOLDEN_HASH, GOLDEN_ROUNDS, golden_hash};
    use panic_semihosting as _;
    // Links its functions of the run-time ABI.
    use runtime as _;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let hash = golden_hash(GOLDEN_ROUNDS);
        hprintln!("{:#018x}", hash);
        let copies = copies_are_exact();
        if !copies {
            hprintln!("a copy moved other bytes than it should");
        }
        let right = hash == GOLDEN_HASH && copies;
        loop {
            debug::exit(if right { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
        }
    }

    type Memcpy = unsafe extern "C" fn(*mut c_void, *const c_void, usize) -> *mut c_void;

    unsafe extern "C" {
        fn __aeabi_memcpy(to: *mut c_void, from: *const c_void, len: usize);
        fn __aeabi_memcpy4(to: *mut c_void, from: *const c_void, len: usize);
        fn memcpy(to: *mut c_void, from: *const c_void, len: usize) -> *mut c_void;
    }

    /// Every length up to a few rounds of the loop, at every alignment: the bytes arrive, and their
    /// neighbours stay unchanged.
    fn copies_are_exact() -> bool {
        // SAFETY: `is_exact` passes pointers into two arrays that do not overlap, each with at least `len`
        // bytes behind its pointer.
        let any = |to, from, len| unsafe { __aeabi_memcpy(to, from, len) };
        // SAFETY: as above; it is called with both offsets 0, where the arrays are aligned to four bytes.
        let copy = |to, from, len| unsafe { __aeabi_memcpy4(to, from, len) };
        // The compiler knows the result of `memcpy` and would not check it; through a black box it has to
        // call it.
        let memcpy = core::hint::black_box(memcpy as Memcpy);
        let returning = |to, from, len| {
            // SAFETY: as above.
            let returned = unsafe { memcpy(to, from, len) };
            assert_eq!(returned, to, "memcpy gives back where it copied to");
        };
        let everywhere = (0..4).flat_map(|to| (0..4).map(move |from| (to, from)));
        (0..LEN_MAX).all(|len| {
            is_exact(copy, 0, 0, len)
                && everywhere
                    .clone()
                    .all(|(to, from)| is_exact(any, to, from, len) && is_exact(returning, to, from, len))
        })
    }

    fn is_exact(
        copy: impl Fn(*mut c_void, *const c_void, usize),
        to: usize,
        from: usize,
        len: usize,
    ) -> bool {
        let (mut target, mut source) = (Aligned([0xee; BUFFER_LEN]), Aligned([0; BUFFER_LEN]));
        for (i, byte) in source.0.iter_mut().enumerate() {
            *byte = i as u8 + 1;
        }
        let (to, from) = (GUARD_LEN + to, GUARD_LEN + from);
        // SAFETY (of the functions passed in): both ranges lie within buffers of their own, the margins cover
        // all offsets.
        copy(target.0[to..].as_mut_ptr().cast(), source.0[from..].as_ptr().cast(), len);
        (0..BUFFER_LEN).all(|i| {
            let moved = (to..to + len).contains(&i);
            target.0[i] == if moved { (from + i - to) as u8 + 1 } else { 0xee }
        })
    }

    #[repr(align(8))]
    struct Aligned([u8; BUFFER_LEN]);

    const LEN_MAX: usize = 70;
    const GUARD_LEN: usize = 8;
    const BUFFER_LEN: usize = LEN_MAX + 2 * GUARD_LEN;
}

#[cfg(not(target_os = "none"))]
fn main() {}
