//! Runs of bytes, deflated without looking at them twice.

use cusp_slicer::archive::runs::RunWriter;
use std::io::Read;

#[test]
fn a_stream_of_runs_is_what_another_library_inflates() {
    let mut random = fastrand::Rng::with_seed(29);
    for round in 0..300 {
        let mut stream = RunWriter::default();
        let mut expected = Vec::new();
        for _ in 0..random.usize(0..200) {
            let byte = if random.bool() { 0 } else { random.u8(..) };
            let count = match random.u8(0..10) {
                0 => random.usize(250..270),
                1 => random.usize(0..100_000),
                _ => random.usize(0..12),
            };
            stream.run(byte, count as u64);
            expected.extend(std::iter::repeat_n(byte, count));
        }
        // Literals of very different frequencies, which would give a fitted code long words.
        if round % 10 == 0 {
            for byte in 0..=255u8 {
                for _ in 0..1u32 << (byte % 13) {
                    stream.run(byte, 1);
                    stream.run(255 - byte, 1);
                    expected.extend([byte, 255 - byte]);
                }
            }
        }
        let bytes = stream.finish();
        let mut found = Vec::new();
        flate2::read::ZlibDecoder::new(bytes.as_slice())
            .read_to_end(&mut found)
            .unwrap();
        assert!(found == expected, "round {round}");
    }
}

#[test]
fn dark_pixels_cost_next_to_nothing() {
    let mut stream = RunWriter::default();
    stream.run(0, 11_520 * 5_120);
    // One byte per 258, and almost nothing once deflated again.
    let bytes = stream.finish();
    assert!((228_000..229_000).contains(&bytes.len()), "{}", bytes.len());
    let mut twice = flate2::write::DeflateEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut twice, &bytes).unwrap();
    let twice = twice.finish().unwrap().len();
    assert!(twice < 1_500, "{twice}");
}
