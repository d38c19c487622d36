#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    clamber_verify::targets::queries(data);
});
