//! `numbers`: number formatting. As many digits as its trials support, a true minus sign, and p in the usual
//! form.

/// With this number of decimals; a minus sign is U+2212, and zero has no sign.
pub(crate) fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
}

/// As the paper prints it: without decimals where it is whole.
pub(crate) fn printed(value: f64, decimals: usize) -> String {
    if (value - value.round()).abs() < 1e-9 { plain(value, 0) } else { plain(value, decimals) }
}

/// With its sign.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let text = plain(value, decimals);
    let zero = text.chars().all(|c| matches!(c, '0' | '.'));
    match text.chars().next() {
        Some('−') => text,
        _ if zero => text,
        _ => format!("+{text}"),
    }
}

/// `p < 0.001`, `p = 0.035`.
pub(crate) fn p(p: f64) -> String {
    if p < 0.001 {
        "p < 0.001".to_owned()
    } else if p < 0.1 {
        format!("p = {p:.3}")
    } else {
        format!("p = {p:.2}")
    }
}

/// Stars of a p: `*` below 0.05, `**` below 0.01, `***` below 0.001.
pub(crate) const fn marks(p: f64) -> &'static str {
    if p < 0.001 {
        "***"
    } else if p < 0.01 {
        "**"
    } else if p < 0.05 {
        "*"
    } else {
        ""
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
        assert_eq!([marks(0.0009), marks(0.009), marks(0.049), marks(0.05)], ["***", "**", "*", ""]);
    }
}
