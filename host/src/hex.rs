//! `hex`: bytes as hexadecimal digits and back, two digits a byte, the upper half first.

/// The digits of these bytes, in lower case.
pub(crate) fn encode(bytes: &[u8]) -> String {
    let halves = bytes.iter().flat_map(|byte| [byte >> 4, byte & 0x0f]);
    halves.filter_map(|half| char::from_digit(u32::from(half), 16)).collect()
}

/// The bytes of these digits.
///
/// # Errors
/// The place of what is no digit, or an odd number of them.
pub(crate) fn decode(text: &str) -> Result<Vec<u8>, String> {
    let digits = text.as_bytes();
    if let Some(at) = digits.iter().position(|digit| !digit.is_ascii_hexdigit()) {
        return Err(format!("something that is no hexadecimal digit at place {}", at + 1));
    }
    let (pairs, []) = digits.as_chunks::<2>() else { return Err(format!("{} digits", digits.len())) };
    let nibble = |digit: u8| char::from(digit).to_digit(16).unwrap_or(0) as u8;
    Ok(pairs.iter().map(|[high, low]| nibble(*high) << 4 | nibble(*low)).collect())
}
