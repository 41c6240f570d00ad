//! Numbers from text, and numbers for people.

/// Reads a finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(x) => Err(format!("{x} is not finite")),
        Err(_) => Err(format!("{text:?} is not a number")),
    }
}

/// Reads a finite number above 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        x if x > 0.0 => Ok(x),
        x => Err(format!("{x} is not above 0")),
    }
}

/// A number in four digits, for tables; records hold the exact one.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        format!("{x}")
    } else if !(1e-3..1e6).contains(&size) {
        format!("{x:.2e}")
    } else {
        // Digits before the point; at least one counts.
        let whole = (size.log10().floor() as i32 + 1).max(1);
        format!("{x:.*}", (4 - whole).max(0) as usize)
    }
}

/// A share in per cent: never 0 or 100 unless it is.
pub(crate) fn percent(count: usize, of: usize) -> String {
    if of == 0 {
        return "-".into();
    }
    let share = 100.0 * count as f64 / of as f64;
    match count {
        0 => "0 %".into(),
        _ if count == of => "100 %".into(),
        _ if share < 0.01 => "<0.01 %".into(),
        _ if share > 99.99 => ">99.99 %".into(),
        _ if !(1.0..=99.0).contains(&share) => format!("{share:.2} %"),
        _ => format!("{share:.1} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_numbers_are_numbers() {
        assert_eq!(finite(" -1e-3 "), Ok(-1e-3));
        for bad in ["", "x", "1,2", "0x10", "inf", "nan", "1e999"] {
            assert!(finite(bad).is_err(), "{bad}");
        }
        for bad in ["0", "-0", "-1", "nan", "inf"] {
            assert!(positive(bad).is_err(), "{bad}");
        }
        assert_eq!(positive("1e-300"), Ok(1e-300));
    }

    #[test]
    fn four_digits() {
        for (x, text) in [
            (0.0, "0"),
            (1234567.0, "1.23e6"),
            (123456.0, "123456"),
            (1234.5, "1234"),
            (12.3456, "12.35"),
            (0.012345, "0.012"),
            (0.00012, "1.20e-4"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn shares_do_not_hide_the_last_ray() {
        assert_eq!(percent(0, 65536), "0 %");
        assert_eq!(percent(1, 65536), "<0.01 %");
        assert_eq!(percent(65535, 65536), ">99.99 %");
        assert_eq!(percent(65536, 65536), "100 %");
        assert_eq!(percent(1, 0), "-");
        assert_eq!(percent(1, 3), "33.3 %");
    }
}
