//! Minor units of currencies, as ISO 4217 lists them.

/// Currencies whose minor unit is not a hundredth, each with its decimal digits.
const OTHERS: &str = "BIF0 CLP0 DJF0 GNF0 ISK0 JPY0 KMF0 KRW0 PYG0 RWF0 UGX0 UYI0 VND0 VUV0 XAF0 XOF0 XPF0 \
    BHD3 IQD3 JOD3 KWD3 LYD3 OMR3 TND3 CLF4 UYW4";

/// Decimal digits of a currency's minor unit.
pub(super) fn digits(currency: &str) -> u32 {
    let mut others = OTHERS.split(' ');
    let found = others.find_map(|other| other.strip_prefix(currency));
    found.map_or(2, |digits| digits.parse().unwrap_or(2))
}
