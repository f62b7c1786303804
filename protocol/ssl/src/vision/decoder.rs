//! `decoder`: allocation-free vision decoder that reuses one packet.
//!
//! A plain decode allocates memory for every list of balls and robots, and where the field comes with every
//! packet (README, trap 2) for each line's name.

use prost::{DecodeError, Message};

use super::{DetectionFrame, GeometryData, WrapperPacket};
use crate::wire::{Fields, Value};

/// Decodes packets into reused memory. The result equals that of
/// [`WrapperPacket::decode`](prost::Message::decode).
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    packet: WrapperPacket,
    /// Memory of the packet's parts while they are absent.
    spare_detection: DetectionFrame,
    spare_geometry: GeometryData,
    /// The bytes from which the present geometry was decoded; the same bytes are not decoded again.
    geometry_bytes: Vec<u8>,
}

impl Decoder {
    /// The packet in `bytes`; allocates memory only where it has more robots or balls than any before, or
    /// another field.
    pub fn decode(&mut self, bytes: &[u8]) -> Result<&WrapperPacket, DecodeError> {
        if let Some(detection) = self.packet.detection.take() {
            self.spare_detection = detection;
        }
        if let Some(geometry) = self.packet.geometry.take() {
            self.spare_geometry = geometry;
        }
        self.packet.source = None;
        if let Some(parts) = Parts::of(bytes) {
            self.decode_parts(&parts)?;
        } else {
            // Not as SSL-Vision sends it; prost decides whether it is a packet all the same.
            self.geometry_bytes.clear();
            self.packet = WrapperPacket::decode(bytes)?;
        }
        Ok(&self.packet)
    }

    fn decode_parts(&mut self, parts: &Parts<'_>) -> Result<(), DecodeError> {
        if let Some(bytes) = parts.detection {
            let mut detection = std::mem::take(&mut self.spare_detection);
            detection.clear();
            detection.merge(bytes)?;
            self.packet.detection = Some(detection);
        }
        if let Some(bytes) = parts.geometry {
            let mut geometry = std::mem::take(&mut self.spare_geometry);
            if self.geometry_bytes != bytes || bytes.is_empty() {
                // Should the decoding fail, these bytes were never decoded.
                self.geometry_bytes.clear();
                geometry.clear();
                geometry.merge(bytes)?;
                self.geometry_bytes.extend_from_slice(bytes);
            }
            self.packet.geometry = Some(geometry);
        }
        self.packet.source = parts.source;
        Ok(())
    }
}

/// A packet's parts, each at most once.
#[derive(Default)]
struct Parts<'a> {
    detection: Option<&'a [u8]>,
    geometry: Option<&'a [u8]>,
    source: Option<i32>,
}

impl<'a> Parts<'a> {
    /// `None` where the packet is not made of these three, each at most once.
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let mut parts = Self::default();
        for field in Fields::of(bytes) {
            let field = field.ok()?;
            let fresh = match (field.number, field.value) {
                (1, Value::Bytes(bytes)) => parts.detection.replace(bytes).is_none(),
                (2, Value::Bytes(bytes)) => parts.geometry.replace(bytes).is_none(),
                // As protobuf reads an enum: the low 32 bits.
                (3, Value::Varint(number)) => parts.source.replace(number as i32).is_none(),
                _ => false,
            };
            if !fresh {
                return None;
            }
        }
        Some(parts)
    }
}
