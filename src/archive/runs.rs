//! Writes zlib streams of data that consists of long runs. Time is proportional to the number of runs; a run takes one byte
//! of the stream per 258 bytes of data.
//!
//! Masks of today's screens have tens of millions of pixels, nearly all equal to their neighbours. Libraries look at
//! every byte; this writer takes runs.
//!
//! Its prefix code is constant, and every token takes whole bytes. So whatever repeats in a mask also repeats in the bytes
//! of its stream, where a second pass of deflate, as zips do, finds it.

use std::sync::LazyLock;

/// Longest match of deflate.
const LONGEST: u64 = 258;
/// Shortest match of deflate.
const SHORTEST: u64 = 3;
/// The symbol that ends a block.
const END: usize = 256;
/// The symbol of the shortest match.
const SHORTEST_SYMBOL: usize = 257;
/// The symbol of the longest match.
const LONGEST_SYMBOL: usize = 285;
/// Literals, end and lengths.
const SYMBOLS: usize = 286;
/// Literals that are rare in rows of one-bit pixels, because several runs begin within such a byte. Their codes are longer
/// than a byte: there are not enough short codes for all.
const RARE: [std::ops::Range<usize>; 2] = [0xa0..0xaa, 0xaa..0xb6];
const ADLER_MODULUS: u64 = 65_521;

/// Writes a zlib stream run by run.
#[derive(Debug)]
pub struct RunWriter {
    bits: BitWriter,
    /// The run that may still grow.
    byte: u8,
    count: u64,
    adler: Adler,
}

impl Default for RunWriter {
    /// An empty stream.
    fn default() -> Self {
        Self {
            bits: CODE.head.clone(),
            byte: 0,
            count: 0,
            adler: Adler { a: 1, b: 0 },
        }
    }
}

impl RunWriter {
    /// Adds `count` equal bytes.
    pub fn run(&mut self, byte: u8, count: u64) {
        if byte != self.byte {
            self.end_run();
            self.byte = byte;
        }
        self.count += count;
    }

    fn end_run(&mut self) {
        if self.count == 0 {
            return;
        }
        self.adler.run(self.byte, self.count);
        let literal = CODE.words[usize::from(self.byte)];
        self.bits.write(literal);
        let rest = self.count - 1;
        self.count = 0;
        let (longest, rest) = (rest / LONGEST, rest % LONGEST);
        self.bits.repeat(CODE.words[LONGEST_SYMBOL], longest);
        if rest >= SHORTEST {
            self.bits.write(CODE.matches[(rest - SHORTEST) as usize]);
        } else {
            for _ in 0..rest {
                self.bits.write(literal);
            }
        }
    }

    /// The zlib stream.
    pub fn finish(mut self) -> Vec<u8> {
        self.end_run();
        self.bits.write(CODE.words[END]);
        let mut bytes = self.bits.finish();
        bytes.extend(self.adler.sum().to_be_bytes());
        bytes
    }
}

/// The checksum of zlib.
#[derive(Debug)]
struct Adler {
    a: u64,
    b: u64,
}

impl Adler {
    /// n bytes of value v add n · v to the first sum, and n · a + v · n (n + 1) / 2 to the second.
    fn run(&mut self, byte: u8, count: u64) {
        let value = u64::from(byte);
        let triangle = if count.is_multiple_of(2) {
            count / 2 % ADLER_MODULUS * ((count + 1) % ADLER_MODULUS)
        } else {
            count.div_ceil(2) % ADLER_MODULUS * (count % ADLER_MODULUS)
        };
        let count = count % ADLER_MODULUS;
        self.b = (self.b + count * self.a + triangle % ADLER_MODULUS * value) % ADLER_MODULUS;
        self.a = (self.a + count * value) % ADLER_MODULUS;
    }

    fn sum(&self) -> u32 {
        (self.b << 16 | self.a) as u32
    }
}

/// The bits of a token, first bit lowest.
#[derive(Debug, Clone, Copy, Default)]
struct Word {
    bits: u32,
    count: u32,
}

/// The code that all streams share.
static CODE: LazyLock<Code> = LazyLock::new(Code::new);

struct Code {
    /// The head of a stream, up to its first token.
    head: BitWriter,
    /// The words of all symbols; those of matches include the distance.
    words: Vec<Word>,
    /// The words of matches of 3 to 257 bytes.
    matches: Vec<Word>,
}

impl Code {
    fn new() -> Self {
        let lengths = code_lengths();
        let mut words = words(&lengths);
        // The only distance has a one-bit code, 0.
        for word in &mut words[SHORTEST_SYMBOL..] {
            word.count += 1;
        }
        let matches = (SHORTEST as u16..LONGEST as u16).map(|length| {
            let (symbol, extra, extra_bits) = length_symbol(length);
            let Word { bits, count } = words[symbol];
            Word {
                // Extra bits come between the symbol and the distance.
                bits: bits | u32::from(extra) << (count - 1),
                count: count + extra_bits,
            }
        });
        Self {
            matches: matches.collect(),
            head: head(&lengths),
            words,
        }
    }
}

/// Code lengths of all symbols. A literal takes eight bits; so does the longest match with its distance. Shorter matches
/// take eight or sixteen bits, extra bits and distance included. The codes that are left go to rare literals and the end.
fn code_lengths() -> [u8; SYMBOLS] {
    let mut lengths = [8; SYMBOLS];
    lengths[RARE[0].clone()].fill(11);
    lengths[RARE[1].clone()].fill(12);
    lengths[END] = 12;
    lengths[SHORTEST_SYMBOL..SHORTEST_SYMBOL + 8].fill(7);
    for extra_bits in 1..=5 {
        lengths[SHORTEST_SYMBOL + 4 + 4 * extra_bits..][..4].fill(15 - extra_bits as u8);
    }
    lengths[LONGEST_SYMBOL] = 7;
    lengths
}

/// The symbol of a match length below the longest, its extra bits, and their number (RFC 1951, 3.2.5).
fn length_symbol(length: u16) -> (usize, u16, u32) {
    let offset = length - SHORTEST as u16;
    if offset < 8 {
        return (SHORTEST_SYMBOL + usize::from(offset), 0, 0);
    }
    // Four symbols for every power of two.
    let extra_bits = offset.ilog2() - 2;
    let step = offset >> extra_bits;
    let symbol = SHORTEST_SYMBOL + 4 * extra_bits as usize + usize::from(step);
    (symbol, offset & ((1 << extra_bits) - 1), extra_bits)
}

/// The canonical prefix code of these lengths, with the first bit lowest (RFC 1951, 3.2.2).
fn words(lengths: &[u8]) -> Vec<Word> {
    let mut words = vec![Word::default(); lengths.len()];
    let mut code = 0u16;
    for length in 1..=15 {
        code <<= 1;
        for (word, _) in words.iter_mut().zip(lengths).filter(|it| *it.1 == length) {
            let count = u32::from(length);
            *word = Word {
                bits: u32::from(code.reverse_bits() >> (16 - count)),
                count,
            };
            code += 1;
        }
    }
    words
}

/// The head of a zlib stream of one dynamic block (RFC 1951, 3.2.7), in whole bytes.
fn head(lengths: &[u8; SYMBOLS]) -> BitWriter {
    /// Repeats the previous length 3 to 6 times.
    const REPEAT: usize = 16;
    const ORDER: [usize; 19] = [
        16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
    ];
    let mut second = [0; 19];
    for (length, count) in [(REPEAT, 1), (8, 3), (13, 5), (14, 5)]
        .into_iter()
        .chain([1, 7, 10, 11, 12].map(|length| (length, 4)))
    {
        second[length] = count;
    }
    let second_words = words(&second);

    let mut bits = BitWriter::default();
    let number = |bits, count| Word { bits, count };
    // Deflate with the smallest window that zlib allows: matches reach back a single byte.
    bits.write(number(0x1d08, 16));
    bits.write(number(0b101, 3));
    bits.write(number(SYMBOLS as u32 - 257, 5));
    bits.write(number(0, 5));
    bits.write(number(ORDER.len() as u32 - 4, 4));
    for symbol in ORDER {
        bits.write(number(u32::from(second[symbol]), 3));
    }
    for run in lengths.chunk_by(|a, b| a == b).chain([&[1][..]]) {
        let word = second_words[usize::from(run[0])];
        bits.write(word);
        let mut rest = run.len() as u32 - 1;
        while rest >= 3 {
            let times = rest.min(6);
            bits.write(second_words[REPEAT]);
            bits.write(number(times - 3, 2));
            rest -= times;
        }
        for _ in 0..rest {
            bits.write(word);
        }
    }
    debug_assert_eq!(bits.count % 8, 0);
    bits
}

/// Writes bits, lowest first.
#[derive(Debug, Clone, Default)]
struct BitWriter {
    bytes: Vec<u8>,
    bits: u64,
    count: u32,
}

impl BitWriter {
    #[inline]
    fn write(&mut self, word: Word) {
        self.bits |= u64::from(word.bits) << self.count;
        self.count += word.count;
        if self.count >= 32 {
            self.bytes.extend((self.bits as u32).to_le_bytes());
            self.bits >>= 32;
            self.count -= 32;
        }
    }

    /// Adds a word of eight bits `times` times.
    fn repeat(&mut self, word: Word, times: u64) {
        if self.count.is_multiple_of(8) {
            let whole = self.count as usize / 8;
            self.bytes.extend(&self.bits.to_le_bytes()[..whole]);
            (self.bits, self.count) = (0, 0);
            let length = self.bytes.len() + times as usize;
            self.bytes.resize(length, word.bits as u8);
        } else {
            for _ in 0..times {
                self.write(word);
            }
        }
    }

    fn finish(mut self) -> Vec<u8> {
        let rest = self.count.div_ceil(8) as usize;
        self.bytes.extend(&self.bits.to_le_bytes()[..rest]);
        self.bytes
    }
}
