//! Minor units of currencies, as ISO 4217 lists them.

/// Currencies whose minor unit is not a hundredth, by its decimal digits.
const OTHERS: [(u32, &str); 3] = [
    (
        0,
        "BIF CLP DJF GNF ISK JPY KMF KRW PYG RWF UGX UYI VND VUV XAF XOF XPF",
    ),
    (3, "BHD IQD JOD KWD LYD OMR TND"),
    (4, "CLF UYW"),
];

/// Decimal digits of a currency's minor unit.
pub(super) fn digits(currency: &str) -> u32 {
    let mut others = OTHERS.iter();
    let found = others.find(|(_, codes)| codes.contains(currency));
    found.map_or(2, |(digits, _)| *digits)
}
