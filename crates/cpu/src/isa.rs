//! The knob `isa`, which every method that runs on SIMD lanes has.

use zeroset_ia::Isa;
use zeroset_raycast::{Knob, KnobError, knob};

/// The knob with its value; `None` is the widest set that the machine has.
pub fn knob(isa: Option<Isa>) -> Knob {
    Knob {
        name: "isa",
        value: isa.map_or("auto", Isa::name).into(),
        doc: "instruction set: portable, avx2, avx512, or auto: the widest there is (default auto)",
    }
}

/// Reads the knob's value.
///
/// # Errors
/// For what is none, and for sets that this machine lacks: a record must not name what did not run.
pub fn read(value: &str) -> Result<Option<Isa>, KnobError> {
    let mut choices = vec![("auto", None)];
    choices.extend(Isa::available().into_iter().map(|isa| (isa.name(), Some(isa))));
    knob::choice("isa", value, &choices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_of_this_machine_read_back_and_no_others() {
        for isa in Isa::available().into_iter().map(Some).chain([None]) {
            assert_eq!(read(&knob(isa).value), Ok(isa));
        }
        for isa in [Isa::Portable, Isa::Avx2, Isa::Avx512] {
            assert_eq!(read(isa.name()).is_ok(), Isa::available().contains(&isa), "{isa:?}");
        }
        let error = read("mmx").unwrap_err().to_string();
        assert!(error.contains("auto or portable"), "{error}");
    }
}
