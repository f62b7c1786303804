//! `saved`: saved states: a mark, the format's version, a hash of the content, and the content (postcard).

use hil_sim::Fnv;
use pyo3::PyResult;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::refused;

/// The bytes of a value.
pub fn saved(value: &impl Serialize) -> PyResult<Vec<u8>> {
    let mut bytes = MARK.to_vec();
    bytes.push(VERSION);
    bytes.extend([0; HASH_LEN]);
    let mut bytes = postcard::to_extend(value, bytes).map_err(refused)?;
    let hash = hash(&bytes[CONTENT..]);
    bytes[CONTENT - HASH_LEN..CONTENT].copy_from_slice(&hash);
    Ok(bytes)
}

/// The value that [`saved`] made these bytes of.
pub fn restored<T: DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    if !bytes.starts_with(MARK) || bytes.len() <= CONTENT {
        return Err(refused("state: these bytes are no saved state; take those that save() returned"));
    }
    let version = bytes[MARK.len()];
    if version != VERSION {
        return Err(refused(format!(
            "state: saved in version {version} of the format, and this package reads version {VERSION}; save it again"
        )));
    }
    let content = &bytes[CONTENT..];
    if bytes[CONTENT - HASH_LEN..CONTENT] != hash(content) {
        return Err(refused("state: damaged: its bytes differ from those that were saved"));
    }
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        _ => Err(refused("state: saved by another build of onetwo; save it again with this one")),
    }
}

fn hash(content: &[u8]) -> [u8; HASH_LEN] {
    let mut hash = Fnv::default();
    hash.add(content);
    hash.value().to_le_bytes()
}

/// First bytes of a saved state.
const MARK: &[u8] = b"onetwo state";
/// Version of the content: raised whenever a saved struct changes.
const VERSION: u8 = 2;
/// Bytes of the hash, little endian.
const HASH_LEN: usize = 8;
/// Where the content starts.
const CONTENT: usize = MARK.len() + 1 + HASH_LEN;
