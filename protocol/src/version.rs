//! `version`: what a robot runs, as it reports it to its host (protocol/SPEC.md, VersionReport).
//!
//! Such a frame's payload begins with [`KIND`], which is no [`TeamMessage`](crate::team::TeamMessage): hosts
//! of before refuse it for its payload. It is sealed under the robot's own key, as telemetry is.

use core::fmt;

/// First byte of the payload.
pub const KIND: u8 = 7;
/// Bytes of the payload.
pub const PAYLOAD_LEN: usize = 16;

/// Version and hashes of what a robot runs; or what its host expects it to run. A hash of 0 is unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct VersionReport {
    /// Version of the firmware: major, minor, patch.
    pub version: [u8; 3],
    /// Hash of the sources that the image was built from.
    pub image: u32,
    /// [`hash_of`] the description (`robot.toml`) that the image was built for.
    pub robot: u32,
    /// Hash of the table of its case base.
    pub case_base: u32,
}

impl VersionReport {
    /// The payload of a frame.
    pub fn payload(&self) -> [u8; PAYLOAD_LEN] {
        let [major, minor, patch] = self.version;
        let mut payload = [KIND, major, minor, patch, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        let hashes = [self.image, self.robot, self.case_base];
        for (bytes, hash) in payload.chunks_exact_mut(4).skip(1).zip(hashes) {
            bytes.copy_from_slice(&hash.to_le_bytes());
        }
        payload
    }

    /// From a payload; `None` where it is no such report.
    pub fn read(payload: &[u8]) -> Option<Self> {
        let (head, rest) = payload.split_first_chunk::<4>()?;
        let (&[KIND, major, minor, patch], [image, robot, case_base]) = (head, rest.as_chunks::<4>().0)
        else {
            return None;
        };
        (payload.len() == PAYLOAD_LEN).then(|| Self {
            version: [major, minor, patch],
            image: u32::from_le_bytes(*image),
            robot: u32::from_le_bytes(*robot),
            case_base: u32::from_le_bytes(*case_base),
        })
    }

    /// Which of version, image, `robot.toml` and case base are other than expected; unknown ones are not.
    pub fn differences(&self, expected: &Self) -> impl Iterator<Item = &'static str> {
        let parts = [
            (self.version != expected.version, "version"),
            (is_other(self.image, expected.image), "image"),
            (is_other(self.robot, expected.robot), "robot.toml"),
            (is_other(self.case_base, expected.case_base), "case base"),
        ];
        parts.into_iter().filter(|(differs, _)| *differs).map(|(_, part)| part)
    }
}

impl fmt::Display for VersionReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, patch] = self.version;
        let Self { image, robot, case_base, .. } = self;
        write!(
            f,
            "{major}.{minor}.{patch} (image {image:08x}, robot.toml {robot:08x}, cases {case_base:08x})"
        )
    }
}

/// Whether two hashes are known and differ.
const fn is_other(own: u32, expected: u32) -> bool {
    own != expected && own != 0 && expected != 0
}

/// FNV-1a hash of a text, 32 bits: no proof against forgery, which the frame's tag is for.
pub const fn hash_of(text: &[u8]) -> u32 {
    let (mut hash, mut i) = (0x811c_9dc5_u32, 0);
    while i < text.len() {
        hash = (hash ^ text[i] as u32).wrapping_mul(0x0100_0193);
        i += 1;
    }
    hash
}

/// Major, minor and patch of a version as cargo writes it; parts that are no number are 0.
pub const fn parts_of(version: &str) -> [u8; 3] {
    let (text, mut parts, mut part, mut i) = (version.as_bytes(), [0_u8; 3], 0, 0);
    while i < text.len() && part < parts.len() {
        match text[i] {
            b'.' => part += 1,
            digit @ b'0'..=b'9' => parts[part] = parts[part].wrapping_mul(10).wrapping_add(digit - b'0'),
            _ => return parts,
        }
        i += 1;
    }
    parts
}

/// A hash from its hexadecimal digits; 0 where it is none.
pub const fn parse_hash(digits: Option<&str>) -> u32 {
    match digits {
        Some(digits) => match u32::from_str_radix(digits, 16) {
            Ok(hash) => hash,
            Err(_) => 0,
        },
        None => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_read_as_written_and_no_other_length_or_kind_is_one() {
        let report = VersionReport { version: [0, 2, 1], image: 0x0102_0304, robot: 5, case_base: u32::MAX };
        let payload = report.payload();
        assert_eq!(VersionReport::read(&payload), Some(report));
        for cut in 0..PAYLOAD_LEN {
            assert_eq!(VersionReport::read(&payload[..cut]), None);
        }
        assert_eq!(VersionReport::read(&[&payload[..], &[0]].concat()), None);
        assert_eq!(VersionReport::read(&[5; PAYLOAD_LEN]), None);
    }

    #[test]
    fn differences_are_named_and_what_is_unknown_differs_in_nothing() {
        let report = VersionReport { version: parts_of("0.12.3-rc.1"), image: 1, robot: 2, case_base: 3 };
        assert_eq!(report.version, [0, 12, 3]);
        let unknown = VersionReport { image: 0, robot: 0, case_base: 0, ..report };
        assert_eq!(report.differences(&unknown).count(), 0);
        let other = VersionReport { version: [0, 2, 0], image: 9, robot: 2, case_base: 9 };
        assert!(report.differences(&other).eq(["version", "image", "case base"]));
        assert_eq!((parse_hash(Some("00ff")), parse_hash(Some("x")), parse_hash(None)), (255, 0, 0));
        assert_eq!(hash_of(b"a"), 0xe40c_292c, "the published value");
    }
}
