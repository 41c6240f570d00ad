//! Samples as bytes.

use super::Fault;

/// The type of a sample in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Sample {
    U8,
    I8,
    U16,
    I16,
    U32,
    I32,
    F32,
    F64,
}

/// Which byte of a sample comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// The least significant.
    Little,
    /// The most significant.
    Big,
}

impl Sample {
    /// Bytes of a sample.
    pub fn width(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The samples in these bytes; a rest that is no whole sample is left.
    #[allow(clippy::cast_lossless, reason = "one text for all types")]
    pub(super) fn decode(self, order: ByteOrder, bytes: &[u8]) -> Vec<f32> {
        macro_rules! values {
            ($real:ty) => {{
                const WIDTH: usize = size_of::<$real>();
                let read = match order {
                    ByteOrder::Little => <$real>::from_le_bytes,
                    ByteOrder::Big => <$real>::from_be_bytes,
                };
                let (whole, _) = bytes.as_chunks::<WIDTH>();
                whole.iter().map(|bytes| read(*bytes) as f32).collect()
            }};
        }
        match self {
            Self::U8 => values!(u8),
            Self::I8 => values!(i8),
            Self::U16 => values!(u16),
            Self::I16 => values!(i16),
            Self::U32 => values!(u32),
            Self::I32 => values!(i32),
            Self::F32 => values!(f32),
            Self::F64 => values!(f64),
        }
    }
}

/// Numbers as text, between white space, of which there must be `count`.
pub(super) fn parse(text: &[u8], count: usize) -> Result<Vec<f32>, Fault> {
    // A number takes a digit, and a space before the next.
    if text.len().div_ceil(2) < count {
        return Err(Fault::new(format!(
            "{} bytes of text cannot hold {count} numbers; the file is cut off, or its size is wrong",
            text.len()
        )));
    }
    let mut values = Vec::with_capacity(count);
    let words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    for word in words {
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        let value: f32 = number.ok_or_else(|| {
            let word = String::from_utf8_lossy(&word[..word.len().min(40)]);
            Fault::new(format!("sample {} is {word:?}, which is no number", values.len()))
        })?;
        if values.len() == count {
            return Err(Fault::new(format!(
                "more than the {count} numbers of the size; correct it"
            )));
        }
        values.push(value);
    }
    if values.len() < count {
        return Err(Fault::new(format!(
            "{} numbers where the size asks for {count}; the file is cut off, or its size is wrong",
            values.len()
        )));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_read_in_both_orders() {
        let decode = |sample: Sample, bytes: &[u8]| {
            let reversed: Vec<u8> = bytes.iter().rev().copied().collect();
            assert_eq!(bytes.len(), sample.width());
            let little = sample.decode(ByteOrder::Little, bytes);
            assert_eq!(sample.decode(ByteOrder::Big, &reversed), little);
            little[0]
        };
        assert_eq!(decode(Sample::U8, &[200]), 200.0);
        assert_eq!(decode(Sample::I8, &[200]), -56.0);
        assert_eq!(decode(Sample::U16, &[1, 128]), 32769.0);
        assert_eq!(decode(Sample::I16, &[1, 128]), -32767.0);
        assert_eq!(decode(Sample::U32, &[1, 0, 0, 128]), 2f32.powi(31));
        assert_eq!(decode(Sample::I32, &[0, 0, 0, 128]), -2f32.powi(31));
        assert_eq!(decode(Sample::F32, &0.1f32.to_le_bytes()), 0.1);
        assert_eq!(decode(Sample::F64, &0.1f64.to_le_bytes()), 0.1);
    }

    #[test]
    fn text_is_numbers() {
        assert_eq!(parse(b" 1 -2.5\n3e2\t", 3).unwrap(), [1.0, -2.5, 300.0]);
        for (text, count, why) in [
            ("1    2", 3, "2 numbers"),
            ("1 2 3 4", 3, "more than the 3"),
            ("1 x 3", 3, "sample 1 is \"x\""),
            ("1 2", 1 << 30, "cannot hold"),
        ] {
            let said = parse(text.as_bytes(), count).unwrap_err().to_string();
            assert!(said.contains(why), "{said}");
        }
    }
}
