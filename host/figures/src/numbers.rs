//! `numbers`: numbers as text. Fixed decimals with a true minus sign, and p in the usual form.

/// `value` with this number of decimals; the minus sign is U+2212, and zero has none.
pub fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
}

/// `value` without decimals where it is whole, as papers print shares.
pub fn printed(value: f64, decimals: usize) -> String {
    if (value - value.round()).abs() < 1e-9 { plain(value, 0) } else { plain(value, decimals) }
}

/// `value` with its sign.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = plain(value, decimals);
    let zero = text.chars().all(|c| matches!(c, '0' | '.'));
    match text.chars().next() {
        Some('−') => text,
        _ if zero => text,
        _ => format!("+{text}"),
    }
}

/// A probability: `p < 0.001`, `p = 0.035`, `p = 0.50`.
pub fn p(p: f64) -> String {
    if p < 0.001 {
        "p < 0.001".to_owned()
    } else if p < 0.1 {
        format!("p = {p:.3}")
    } else {
        format!("p = {p:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_digits_and_a_sign_where_it_says_something() {
        assert_eq!([plain(-0.04, 1), plain(-1.25, 1), plain(30.0, 0)], ["0.0", "−1.2", "30"]);
        assert_eq!([printed(25.0, 1), printed(59.5, 1)], ["25", "59.5"]);
        assert_eq!([signed(0.0, 1), signed(2.0, 1), signed(-2.0, 1)], ["0.0", "+2.0", "−2.0"]);
    }

    #[test]
    fn p_is_printed_as_exactly_as_it_matters() {
        assert_eq!([p(0.0004), p(0.0351), p(0.5)], ["p < 0.001", "p = 0.035", "p = 0.50"]);
    }
}
