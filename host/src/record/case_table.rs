//! `case_table`: the case base of a recording's hosts, in its header as hexadecimal digits, so that the
//! recording is replayed when its library has changed or is not at hand.

use casebase::CaseBase;

use crate::hex;

/// A table begins at a multiple of this many bytes.
const TABLE_ALIGNMENT: usize = 4;
/// Longest table that is written, bytes: with it a header of two hosts is shorter than 1 MiB.
const TABLE_LEN_MAX: usize = 400_000;

/// The table's bytes, two digits each; `None` of a table too long for a header.
pub(super) fn write(base: CaseBase<'_>) -> Option<String> {
    (base.bytes().len() <= TABLE_LEN_MAX).then(|| hex::encode(base.bytes()))
}

/// The case base that was written; its table is kept until the program ends, as hosts need it.
///
/// # Errors
/// What is wrong with the digits or the table.
pub(super) fn read(digits: &str) -> Result<CaseBase<'static>, String> {
    let table = hex::decode(digits)?;
    // A table is read where it lies, from a multiple of 4 on.
    let mut bytes = vec![0; TABLE_ALIGNMENT];
    bytes.extend(&table);
    let kept: &'static mut [u8] = Vec::leak(bytes);
    let start = kept.as_ptr().align_offset(TABLE_ALIGNMENT) % TABLE_ALIGNMENT;
    kept.copy_within(TABLE_ALIGNMENT.., start);
    CaseBase::from_bytes(&kept[start..start + table.len()]).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_as_it_was_written_and_a_damaged_one_is_refused() {
        let base = case_library::division_b();
        let digits = write(base).unwrap();
        let read = super::read(&digits).unwrap();
        assert_eq!((read.bytes(), read.hash(), read.len()), (base.bytes(), base.hash(), base.len()));
        let odd = super::read(&digits[1..]).unwrap_err();
        assert!(odd.contains("digits"), "{odd}");
        assert!(super::read(&digits.replace('0', "x")).unwrap_err().contains("hexadecimal"));
        for cut in [0, 2, (digits.len() / 2) & !1, digits.len() - 2] {
            super::read(&digits[..cut]).unwrap_err();
        }
    }
}
