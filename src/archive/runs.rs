//! A zlib stream of bytes that come in long runs, at a cost of the runs: each is taken as a whole, and costs two bits for
//! 258 bytes.
//!
//! Masks of today's screens are tens of millions of pixels, nearly all of them like their neighbours. Libraries look at every
//! byte; this writer is told about runs.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Longest match of deflate.
const LONGEST: u64 = 258;
/// Shortest match of deflate.
const SHORTEST: u64 = 3;
/// The symbol that ends a block.
const END: usize = 256;
/// The symbol of the longest match.
const LONGEST_SYMBOL: usize = 285;
/// Literals, end and lengths.
const SYMBOLS: usize = 286;
/// Longest code of deflate, in bits.
const LONGEST_CODE: u32 = 15;
const ADLER_MODULUS: u64 = 65_521;

/// The bytes of a zlib stream, gathered as runs.
#[derive(Debug)]
pub struct RunWriter {
    tokens: Vec<Token>,
    /// The run that may still grow.
    byte: u8,
    count: u64,
    frequencies: Vec<u64>,
    adler: Adler,
}

#[derive(Debug, Clone, Copy)]
enum Token {
    Literal(u8),
    /// The byte before so many times 258 times more.
    Longest(u64),
    /// The byte before 3 to 257 times more.
    Match(u16),
}

impl Default for RunWriter {
    /// An empty stream.
    fn default() -> Self {
        Self {
            tokens: Vec::new(),
            byte: 0,
            count: 0,
            frequencies: vec![0; SYMBOLS],
            adler: Adler { a: 1, b: 0 },
        }
    }
}

impl RunWriter {
    /// Adds a byte so many times.
    pub fn run(&mut self, byte: u8, count: u64) {
        if byte != self.byte {
            self.end_run();
            self.byte = byte;
        }
        self.count += count;
    }

    fn literal(&mut self, byte: u8) {
        self.tokens.push(Token::Literal(byte));
        self.frequencies[usize::from(byte)] += 1;
    }

    fn end_run(&mut self) {
        if self.count == 0 {
            return;
        }
        self.adler.run(self.byte, self.count);
        self.literal(self.byte);
        let rest = self.count - 1;
        self.count = 0;
        let (longest, rest) = (rest / LONGEST, rest % LONGEST);
        if longest > 0 {
            self.tokens.push(Token::Longest(longest));
            self.frequencies[LONGEST_SYMBOL] += longest;
        }
        if rest >= SHORTEST {
            self.tokens.push(Token::Match(rest as u16));
            self.frequencies[length_symbol(rest as u16).0] += 1;
        } else {
            for _ in 0..rest {
                self.literal(self.byte);
            }
        }
    }

    /// The zlib stream.
    pub fn finish(mut self) -> Vec<u8> {
        self.end_run();
        self.frequencies[END] = 1;
        let lengths = code_lengths(&self.frequencies);
        let codes = codes(&lengths);
        let mut bits = BitWriter::new();
        // Deflate with the smallest window, as nothing reaches back further than a byte.
        bits.bytes.extend([0x08, 0x1d]);
        write_header(&mut bits, &lengths);
        // The only distance has a code of one bit, which is 0.
        let write_symbol = |bits: &mut BitWriter, symbol: usize| {
            bits.write(u64::from(codes[symbol]), u32::from(lengths[symbol]));
        };
        for token in &self.tokens {
            match *token {
                Token::Literal(byte) => write_symbol(&mut bits, usize::from(byte)),
                Token::Match(length) => {
                    let (symbol, extra, extra_bits) = length_symbol(length);
                    write_symbol(&mut bits, symbol);
                    // With the distance behind it.
                    bits.write(u64::from(extra), extra_bits + 1);
                }
                Token::Longest(count) => {
                    let code = u64::from(codes[LONGEST_SYMBOL]);
                    bits.repeat(code, u32::from(lengths[LONGEST_SYMBOL]) + 1, count);
                }
            }
        }
        write_symbol(&mut bits, END);
        let mut bytes = bits.finish();
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
    /// n times the byte v add n · v to the first sum, and n · a + v · n (n + 1) / 2 to the second.
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

/// Symbol of a match length, its extra bits and how many they are (RFC 1951, 3.2.5).
fn length_symbol(length: u16) -> (usize, u16, u32) {
    if u64::from(length) == LONGEST {
        return (LONGEST_SYMBOL, 0, 0);
    }
    let offset = length - SHORTEST as u16;
    if offset < 8 {
        return (257 + usize::from(offset), 0, 0);
    }
    // Four symbols for every power of two.
    let extra_bits = offset.ilog2() - 2;
    let step = offset >> extra_bits;
    let symbol = 257 + 4 * extra_bits as usize + usize::from(step);
    (symbol, offset & ((1 << extra_bits) - 1), extra_bits)
}

/// Lengths of a prefix code for symbols of these frequencies (Huffman), 0 for one that does not occur.
fn code_lengths(frequencies: &[u64]) -> Vec<u8> {
    let total: u64 = frequencies.iter().sum();
    // No code can be longer than allowed if no symbol is rarer than this: Fibonacci numbers are the worst case.
    let least = total / 1024 + 1;
    let mut parents = vec![0; frequencies.len()];
    let mut heap: BinaryHeap<Reverse<(u64, usize)>> = frequencies
        .iter()
        .enumerate()
        .filter(|&(_, &frequency)| frequency > 0)
        .map(|(symbol, &frequency)| Reverse((frequency.max(least), symbol)))
        .collect();
    let is_used: Vec<bool> = frequencies.iter().map(|&frequency| frequency > 0).collect();
    if heap.len() == 1 {
        // A lone symbol still needs a bit.
        return is_used.into_iter().map(u8::from).collect();
    }
    while let (Some(Reverse(first)), Some(Reverse(second))) = (heap.pop(), heap.pop()) {
        let node = parents.len();
        parents.push(0);
        (parents[first.1], parents[second.1]) = (node, node);
        heap.push(Reverse((first.0 + second.0, node)));
        if heap.len() == 1 {
            break;
        }
    }
    let mut depths = vec![0u8; parents.len()];
    for node in (0..parents.len() - 1).rev() {
        if node >= frequencies.len() || is_used[node] {
            depths[node] = depths[parents[node]] + 1;
        }
    }
    depths.truncate(frequencies.len());
    debug_assert!(depths.iter().all(|&depth| u32::from(depth) <= LONGEST_CODE));
    depths
}

/// The canonical codes of these lengths, with the first bit lowest (RFC 1951, 3.2.2).
fn codes(lengths: &[u8]) -> Vec<u16> {
    let mut codes = vec![0; lengths.len()];
    let mut first = [0u32; LONGEST_CODE as usize + 1];
    let mut code = 0;
    for (length, first) in first.iter_mut().enumerate().skip(1) {
        let shorter = lengths
            .iter()
            .filter(|&&it| usize::from(it) == length - 1 && it > 0)
            .count();
        code = (code + shorter as u32) << 1;
        *first = code;
    }
    for (symbol, &length) in lengths
        .iter()
        .enumerate()
        .filter(|&(_, &length)| length > 0)
    {
        let code = &mut first[usize::from(length)];
        codes[symbol] = (*code as u16).reverse_bits() >> (16 - u32::from(length));
        *code += 1;
    }
    codes
}

/// The head of a last block with codes of its own (RFC 1951, 3.2.7). Code lengths are written with four bits each.
fn write_header(bits: &mut BitWriter, lengths: &[u8]) {
    const ORDER: [u8; 19] = [
        16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
    ];
    bits.write(1, 1);
    bits.write(2, 2);
    bits.write(SYMBOLS as u64 - 257, 5);
    bits.write(0, 5);
    bits.write(ORDER.len() as u64 - 4, 4);
    for symbol in ORDER {
        bits.write(if symbol < 16 { 4 } else { 0 }, 3);
    }
    for &length in lengths.iter().chain(&[1]) {
        bits.write(u64::from(length.reverse_bits() >> 4), 4);
    }
}

/// Bits, lowest first.
struct BitWriter {
    bytes: Vec<u8>,
    bits: u64,
    count: u32,
}

impl BitWriter {
    fn new() -> Self {
        Self {
            bytes: Vec::new(),
            bits: 0,
            count: 0,
        }
    }

    /// Adds up to 32 bits.
    fn write(&mut self, bits: u64, count: u32) {
        self.bits |= bits << self.count;
        self.count += count;
        if self.count >= 32 {
            self.bytes.extend((self.bits as u32).to_le_bytes());
            self.bits >>= 32;
            self.count -= 32;
        }
    }

    /// Adds a pattern of up to 16 bits so many times.
    fn repeat(&mut self, pattern: u64, length: u32, times: u64) {
        let at_once = 32 / length;
        let mut many = 0;
        for i in 0..at_once {
            many |= pattern << (i * length);
        }
        for _ in 0..times / u64::from(at_once) {
            self.write(many, at_once * length);
        }
        for _ in 0..times % u64::from(at_once) {
            self.write(pattern, length);
        }
    }

    fn finish(mut self) -> Vec<u8> {
        let rest = self.count.div_ceil(8) as usize;
        self.bytes.extend(&self.bits.to_le_bytes()[..rest]);
        self.bytes
    }
}
