#![no_main]

libfuzzer_sys::fuzz_target!(init: cusp_fuzz::work_here(), |bytes: &[u8]| cusp_fuzz::pipeline::pipeline(bytes));
