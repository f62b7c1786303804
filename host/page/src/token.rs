//! `token`: the secret that permits a viewer's requests where other machines can reach the page.

use std::fmt;

use subtle::ConstantTimeEq as _;
use thiserror::Error;

/// 128 random bits as 32 hexadecimal digits: part of the page's address, and of no file.
#[derive(Clone, PartialEq, Eq)]
pub struct Token(String);

/// The system returned no random numbers.
#[derive(Debug, Error)]
#[error("the system gives no random numbers ({0}); serve the page on 127.0.0.1, which needs no token")]
pub struct NoToken(getrandom::Error);

impl fmt::Debug for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(secret)")
    }
}

impl Token {
    /// A new one from the system's random numbers.
    pub fn random() -> Result<Self, NoToken> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(NoToken)?;
        let digit = |nibble: u8| char::from_digit(u32::from(nibble), 16).unwrap_or('0');
        Ok(Self(bytes.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()))
    }

    /// Digits of the token, as in the address.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// True where `brought` equals the token. Takes the same time for any number of correct digits, so that
    /// they cannot be guessed one by one.
    pub(crate) fn is(&self, brought: &str) -> bool {
        self.0.as_bytes().ct_eq(brought.as_bytes()).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_matches_only_itself() {
        let token = Token::random().unwrap();
        let text = token.as_str().to_owned();
        assert!(text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit()), "{text}");
        assert!(token.is(&text));
        for wrong in
            ["", &text[..31], &format!("{text}0"), &text.to_uppercase().replace(char::is_numeric, "f"), "é"]
        {
            assert!(!token.is(wrong), "{wrong}");
        }
        assert!(!token.is(Token::random().unwrap().as_str()));
    }

    #[test]
    fn debug_output_hides_the_token() {
        let token = Token::random().unwrap();
        assert!(!format!("{token:?}").contains(token.as_str()));
    }
}
