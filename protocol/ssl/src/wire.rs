//! `wire`: fields of an undecoded message. Borrowed, without taking memory.

/// A field as it stands in the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Field<'a> {
    pub(crate) number: u32,
    pub(crate) value: Value<'a>,
}

/// A field's content by its wire type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Value<'a> {
    /// Wire type 0: a varint.
    Varint(u64),
    /// Wire type 1: eight bytes.
    Fixed64,
    /// Wire type 2: text, bytes, a message or packed numbers.
    Bytes(&'a [u8]),
    /// Wire type 5: four bytes.
    Fixed32,
}

impl Value<'_> {
    pub(crate) const fn wire_type(&self) -> u8 {
        match self {
            Self::Varint(_) => VARINT,
            Self::Fixed64 => FIXED64,
            Self::Bytes(_) => BYTES,
            Self::Fixed32 => FIXED32,
        }
    }
}

pub(crate) const VARINT: u8 = 0;
pub(crate) const FIXED64: u8 = 1;
pub(crate) const BYTES: u8 = 2;
pub(crate) const FIXED32: u8 = 5;

/// A varint of 64 bits has at most this many bytes; the last has one bit.
pub(crate) const VARINT_MAX: usize = 10;

/// A message's fields, outermost level. `Some(Err(_))` once, where the bytes are no message or hold a group,
/// which none of the league's messages does.
#[derive(Clone, Debug)]
pub(crate) struct Fields<'a> {
    rest: &'a [u8],
}

/// Error of bytes that are no field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoField;

impl<'a> Fields<'a> {
    pub(crate) const fn of(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    fn field(&mut self) -> Option<Field<'a>> {
        let key = self.varint()?;
        let number = u32::try_from(key >> 3).ok().filter(|number| (1..1 << 29).contains(number))?;
        let value = match (key & 7) as u8 {
            VARINT => Value::Varint(self.varint()?),
            FIXED64 => self.take(8).map(|_| Value::Fixed64)?,
            FIXED32 => self.take(4).map(|_| Value::Fixed32)?,
            BYTES => {
                let length = usize::try_from(self.varint()?).ok()?;
                Value::Bytes(self.take(length)?)
            }
            _ => return None,
        };
        Some(Field { number, value })
    }

    fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(length)?;
        self.rest = rest;
        Some(taken)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut number = 0;
        for at in 0..VARINT_MAX {
            let byte = *self.rest.get(at)?;
            number |= u64::from(byte & 0x7f) << (7 * at);
            if byte & 0x80 == 0 {
                self.rest = &self.rest[at + 1..];
                return (at + 1 < VARINT_MAX || byte <= 1).then_some(number);
            }
        }
        None
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = Result<Field<'a>, NoField>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let field = self.field();
        if field.is_none() {
            self.rest = &[];
        }
        Some(field.ok_or(NoField))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_wire_type_is_read_and_other_bytes_end_the_reading() {
        let bytes = [
            0x08, 0x96, 0x01, // 1: varint 150
            0x11, 0, 0, 0, 0, 0, 0, 0, 0, // 2: eight bytes
            0x1a, 2, 7, 8, // 3: two bytes of content
            0x25, 0, 0, 0, 0,    // 4: four bytes
            0x2b, // 5: start of a group
        ];
        let fields: Vec<_> = Fields::of(&bytes).collect();
        let field = |number, value| Ok(Field { number, value });
        assert_eq!(
            fields,
            [
                field(1, Value::Varint(150)),
                field(2, Value::Fixed64),
                field(3, Value::Bytes(&[7, 8])),
                field(4, Value::Fixed32),
                Err(NoField),
            ]
        );
        for broken in [&[0x08][..], &[0x1a, 3, 7], &[0x11, 0], &[0x00, 1], &[0xff; 12]] {
            assert_eq!(Fields::of(broken).collect::<Vec<_>>(), [Err(NoField)], "{broken:?}");
        }
    }
}
