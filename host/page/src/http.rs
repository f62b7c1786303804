//! `http`: HTTP/1.1 over one connection: heads and bodies of requests within their deadlines and lengths,
//! answers.
//!
//! What the page needs and no more: one request after the other, bodies of a stated length. Whatever else is
//! asked is refused with the status that the standard (RFC 9112) has for it, and ends the connection.

use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// The longest head of a request, bytes: a browser's has less than 2 kB.
const HEAD_MAX: usize = 16 * 1024;
/// Lines in a head: a browser sends 20.
const LINES_MAX: usize = 64;
/// Bytes and time that a refused request may still bring before its connection ends: closed at once, it would
/// lose the answer.
const LEFTOVER_LEN_MAX: usize = 64 * 1024;
const LEFTOVER_TIME: Duration = Duration::from_secs(1);

/// Status line's number and reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Status(pub(crate) u16, &'static str);

impl Status {
    pub(crate) const SWITCHING: Self = Self(101, "Switching Protocols");
    pub(crate) const OK: Self = Self(200, "OK");
    pub(crate) const BAD_REQUEST: Self = Self(400, "Bad Request");
    pub(crate) const FORBIDDEN: Self = Self(403, "Forbidden");
    pub(crate) const NOT_FOUND: Self = Self(404, "Not Found");
    pub(crate) const NOT_ALLOWED: Self = Self(405, "Method Not Allowed");
    pub(crate) const TIMED_OUT: Self = Self(408, "Request Timeout");
    pub(crate) const LENGTH_REQUIRED: Self = Self(411, "Length Required");
    pub(crate) const TOO_LARGE: Self = Self(413, "Content Too Large");
    pub(crate) const UNPROCESSABLE: Self = Self(422, "Unprocessable Content");
    pub(crate) const UPGRADE_REQUIRED: Self = Self(426, "Upgrade Required");
    pub(crate) const HEAD_TOO_LARGE: Self = Self(431, "Request Header Fields Too Large");
    pub(crate) const INTERNAL: Self = Self(500, "Internal Server Error");
    pub(crate) const UNAVAILABLE: Self = Self(503, "Service Unavailable");
}

/// A TCP stream whose reads and writes end by a deadline, however slowly the other side goes on.
#[derive(Debug)]
pub(crate) struct Wire {
    stream: TcpStream,
    /// Received and not yet taken.
    pub(crate) received: Vec<u8>,
}

impl Wire {
    pub(crate) fn new(stream: TcpStream) -> Self {
        Self { stream, received: Vec::new() }
    }

    /// The same stream, to write to while another thread reads.
    pub(crate) fn writer(&self) -> io::Result<Self> {
        Ok(Self::new(self.stream.try_clone()?))
    }

    /// Waits for more bytes; 0 at the end of the stream.
    pub(crate) fn receive(&mut self, by: Instant) -> io::Result<usize> {
        let mut bytes = [0; 4096];
        let n = loop {
            self.stream.set_read_timeout(Some(left(by)?))?;
            match self.stream.read(&mut bytes) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => break read.map_err(timed_out)?,
            }
        };
        self.received.extend_from_slice(&bytes[..n]);
        Ok(n)
    }

    /// Sends all of it.
    pub(crate) fn send(&mut self, mut bytes: &[u8], by: Instant) -> io::Result<()> {
        while !bytes.is_empty() {
            self.stream.set_write_timeout(Some(left(by)?))?;
            match self.stream.write(bytes) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(n) => bytes = &bytes[n..],
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(timed_out(error)),
            }
        }
        Ok(())
    }

    /// Ends both directions, for every thread that reads or writes it.
    pub(crate) fn close(&self) {
        // What is closed already needs nothing more.
        let _ = self.stream.shutdown(Shutdown::Both);
    }

    /// Ends the connection after an answer to a request that was not read to its end.
    fn linger(&mut self) {
        let (until, mut taken) = (Instant::now() + LEFTOVER_TIME, 0);
        if self.stream.shutdown(Shutdown::Write).is_err() {
            return;
        }
        while taken < LEFTOVER_LEN_MAX
            && let Ok(n @ 1..) = self.receive(until)
        {
            self.received.clear();
            taken += n;
        }
    }
}

/// The time until then; an error where it is over.
fn left(by: Instant) -> io::Result<Duration> {
    let left = by.saturating_duration_since(Instant::now());
    if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(left) }
}

/// Systems report a time-out by two codes.
fn timed_out(error: io::Error) -> io::Error {
    if error.kind() == io::ErrorKind::WouldBlock { io::ErrorKind::TimedOut.into() } else { error }
}

/// End of a connection without a request to answer.
#[derive(Debug)]
pub(crate) enum NoRequest {
    /// The connection has ended, failed, or sent no whole head in time.
    Gone,
    /// The request is answered with that status, and its connection ends.
    Refused(Status),
}

#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Head {
    pub(crate) method: String,
    pub(crate) path: String,
    pub(crate) query: String,
    headers: Vec<(String, Vec<u8>)>,
    /// The connection goes on after the answer.
    keeps: bool,
    length: usize,
}

impl Head {
    /// Takes the next head off the wire.
    pub(crate) fn read(wire: &mut Wire, by: Instant) -> Result<Self, NoRequest> {
        loop {
            if let Some((head, length)) = Self::parse(&wire.received).map_err(NoRequest::Refused)? {
                wire.received.drain(..length);
                return Ok(head);
            }
            if wire.received.len() >= HEAD_MAX {
                return Err(NoRequest::Refused(Status::HEAD_TOO_LARGE));
            }
            if !matches!(wire.receive(by), Ok(1..)) {
                return Err(NoRequest::Gone);
            }
        }
    }

    /// The head that these bytes begin with and its length; none where it is not complete.
    fn parse(bytes: &[u8]) -> Result<Option<(Self, usize)>, Status> {
        let mut lines = [httparse::EMPTY_HEADER; LINES_MAX];
        let mut request = httparse::Request::new(&mut lines);
        let length = match request.parse(bytes) {
            Ok(httparse::Status::Complete(length)) => length,
            Ok(httparse::Status::Partial) => return Ok(None),
            Err(httparse::Error::TooManyHeaders) => return Err(Status::HEAD_TOO_LARGE),
            Err(_) => return Err(Status::BAD_REQUEST),
        };
        let target = request.path.unwrap_or_default();
        // A proxy asks by the whole address.
        let target = target
            .strip_prefix("http://")
            .map_or(target, |rest| rest.find('/').map_or("/", |slash| &rest[slash..]));
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let headers =
            request.headers.iter().map(|line| (line.name.to_ascii_lowercase(), line.value.to_vec()));
        let mut head = Self {
            method: request.method.unwrap_or_default().to_owned(),
            path: path.to_owned(),
            query: query.to_owned(),
            headers: headers.collect(),
            ..Self::default()
        };
        head.keeps = request.version == Some(1) && !head.has_token("connection", "close");
        // Two readings of a body's length are how requests are smuggled: one length in plain digits, or none.
        if head.all("transfer-encoding").next().is_some() {
            return Err(Status::LENGTH_REQUIRED);
        }
        if let Some(digits) = head.one("content-length")? {
            let plain = digits.bytes().all(|byte| byte.is_ascii_digit());
            head.length = digits.parse().ok().filter(|_| plain).ok_or(Status::BAD_REQUEST)?;
        }
        Ok(Some((head, length)))
    }

    /// Takes the body off the wire, of `most` bytes.
    pub(crate) fn body(&self, wire: &mut Wire, most: usize, by: Instant) -> Result<Vec<u8>, NoRequest> {
        if self.length > most {
            return Err(NoRequest::Refused(Status::TOO_LARGE));
        }
        if wire.received.len() < self.length && self.has_token("expect", "100-continue") {
            wire.send(b"HTTP/1.1 100 Continue\r\n\r\n", by).map_err(|_| NoRequest::Gone)?;
        }
        while wire.received.len() < self.length {
            match wire.receive(by) {
                Ok(1..) => {}
                Err(error) if error.kind() == io::ErrorKind::TimedOut => {
                    return Err(NoRequest::Refused(Status::TIMED_OUT));
                }
                _ => return Err(NoRequest::Gone),
            }
        }
        Ok(wire.received.drain(..self.length).collect())
    }

    /// All values of a header; its name in lower case.
    pub(crate) fn all<'a, 'n>(&'a self, name: &'n str) -> impl Iterator<Item = &'a [u8]> + use<'a, 'n> {
        self.headers.iter().filter(move |(is, _)| is == name).map(|(_, value)| &value[..])
    }

    /// The value of a header that stands there once or not at all.
    pub(crate) fn one(&self, name: &str) -> Result<Option<&str>, Status> {
        let mut values = self.all(name);
        let Some(value) = values.next() else { return Ok(None) };
        let text = std::str::from_utf8(value).map_err(|_| Status::BAD_REQUEST)?;
        if values.next().is_some() { Err(Status::BAD_REQUEST) } else { Ok(Some(text.trim())) }
    }

    /// True where the header's list has that token, ignoring case (RFC 9110 §5.6.1).
    pub(crate) fn has_token(&self, name: &str, token: &str) -> bool {
        let values = self.all(name).filter_map(|value| std::str::from_utf8(value).ok());
        values.flat_map(|value| value.split(',')).any(|one| one.trim().eq_ignore_ascii_case(token))
    }

    /// The value of `name` in the query, as it stands there: neither tokens nor numbers need escapes.
    pub(crate) fn asked(&self, name: &str) -> Option<&str> {
        let pairs = self.query.split('&').map(|pair| pair.split_once('=').unwrap_or((pair, "")));
        pairs.filter(|(is, _)| *is == name).map(|(_, value)| value).next_back()
    }

    #[cfg(test)]
    pub(crate) fn with_headers(headers: &[(&str, &str)]) -> Self {
        let headers = headers.iter().map(|(name, value)| ((*name).to_owned(), value.as_bytes().to_vec()));
        Self { headers: headers.collect(), ..Self::default() }
    }
}

#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) status: Status,
    pub(crate) headers: Vec<(&'static str, Cow<'static, str>)>,
    pub(crate) body: Cow<'static, [u8]>,
}

impl Answer {
    /// Of that kind (`Content-Type`).
    pub(crate) fn of(kind: &'static str, body: impl Into<Cow<'static, [u8]>>) -> Self {
        Self { status: Status::OK, headers: vec![("content-type", kind.into())], body: body.into() }
    }

    /// Answer of that plain text, UTF-8.
    pub(crate) fn text(status: Status, text: impl Into<Cow<'static, str>>) -> Self {
        let body = match text.into() {
            Cow::Borrowed(text) => Cow::Borrowed(text.as_bytes()),
            Cow::Owned(text) => Cow::Owned(text.into_bytes()),
        };
        Self { status, ..Self::of("text/plain; charset=utf-8", body) }
    }

    /// Answer whose text is the reason of the status line.
    pub(crate) fn bare(status: Status) -> Self {
        Self::text(status, status.1)
    }

    pub(crate) fn with(mut self, name: &'static str, value: impl Into<Cow<'static, str>>) -> Self {
        self.headers.push((name, value.into()));
        self
    }

    /// Sends it as the answer to `head`; whether the connection goes on.
    pub(crate) fn send(self, wire: &mut Wire, head: &Head, by: Instant) -> io::Result<bool> {
        self.write(wire, head.method != "HEAD", head.keeps, by).map(|()| head.keeps)
    }

    /// Sends it in place of an answer to a request that was not read to its end, and ends the connection.
    pub(crate) fn end(self, wire: &mut Wire, by: Instant) {
        if self.write(wire, true, false, by).is_ok() {
            wire.linger();
        }
    }

    fn write(self, wire: &mut Wire, body: bool, keeps: bool, by: Instant) -> io::Result<()> {
        let mut bytes = format!("HTTP/1.1 {} {}\r\n", self.status.0, self.status.1);
        for (name, value) in &self.headers {
            bytes.extend([name, ": ", value, "\r\n"]);
        }
        // Nothing follows the head of a changed protocol.
        if self.status != Status::SWITCHING {
            bytes.extend(["content-length: ", &self.body.len().to_string(), "\r\n"]);
            bytes.push_str(if keeps { "" } else { "connection: close\r\n" });
        }
        let mut bytes = (bytes + "\r\n").into_bytes();
        if body {
            bytes.extend_from_slice(&self.body);
        }
        wire.send(&bytes, by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head(text: &str) -> Result<Option<Head>, Status> {
        Head::parse(text.as_bytes()).map(|parsed| parsed.map(|(head, _)| head))
    }

    #[test]
    fn a_head_is_read_to_its_end_and_no_further() {
        let text = "GET /a/b?token=0f&from=3 HTTP/1.1\r\nHost: h\r\n\r\nmore";
        let (read, length) = Head::parse(text.as_bytes()).unwrap().unwrap();
        assert_eq!(&text[length..], "more");
        assert_eq!((&*read.method, &*read.path, read.keeps), ("GET", "/a/b", true));
        assert_eq!(
            (read.asked("token"), read.asked("from"), read.asked("to")),
            (Some("0f"), Some("3"), None)
        );
        assert_eq!(head(&text[..length - 1]), Ok(None));
        let whole = head("GET http://127.0.0.1:80/x HTTP/1.0\r\n\r\n").unwrap().unwrap();
        assert_eq!((&*whole.path, whole.keeps), ("/x", false));
    }

    #[test]
    fn a_body_has_one_length_in_plain_digits() {
        let of =
            |lines: &str| head(&format!("POST / HTTP/1.1\r\n{lines}\r\n")).map(|head| head.unwrap().length);
        assert_eq!(of(""), Ok(0));
        assert_eq!(of("Content-Length: 12\r\n"), Ok(12));
        for wrong in ["+12", "-1", "1,1", "", "99999999999999999999999"] {
            assert_eq!(of(&format!("Content-Length: {wrong}\r\n")), Err(Status::BAD_REQUEST), "{wrong}");
        }
        assert_eq!(of("Content-Length: 1\r\nContent-Length: 1\r\n"), Err(Status::BAD_REQUEST));
        assert_eq!(of("Transfer-Encoding: chunked\r\n"), Err(Status::LENGTH_REQUIRED));
    }

    #[test]
    fn malformed_heads_are_refused() {
        for wrong in
            ["\0\0\0\0", "GET\r\n\r\n", "GET / HTTP/3.0\r\n\r\n", "GET / HTTP/1.1\r\nno header\r\n\r\n"]
        {
            assert_eq!(head(wrong), Err(Status::BAD_REQUEST), "{wrong:?}");
        }
        let many = "a: b\r\n".repeat(LINES_MAX + 1);
        assert_eq!(head(&format!("GET / HTTP/1.1\r\n{many}\r\n")), Err(Status::HEAD_TOO_LARGE));
    }
}
