//! `csv_rows`: rows as CSV, and the hash that identifies them.

use hil_sim::Fnv;
use serde::Serialize;

/// Rows as `trials.csv`, with their columns' names in the first line.
pub fn to_csv<R: Serialize>(rows: &[R]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// One row without the columns' names, its end of line included.
pub(crate) fn to_line<R: Serialize>(row: &R) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.serialize(row)?;
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// The number that identifies an evaluation: FNV-1a-64 of its `trials.csv`, 16 hexadecimal digits.
pub fn csv_hash(csv: &[u8]) -> String {
    let mut hash = Fnv::default();
    hash.add(csv);
    hash.to_string()
}
