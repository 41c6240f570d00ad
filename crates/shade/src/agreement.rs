//! Error maps: agreement with the reference.

use zeroset_raycast::View;

use crate::legend::{Key, Legend, Scale, Tick};
use crate::palette::Palette;
use crate::picture::check_count;
use crate::{Colour, Picture, ShadeError};

/// How the answer for a ray compares with the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Agreement {
    /// Both hit the same sheet; `dt` is a distance along the ray, in units of space.
    Correct {
        /// Answer minus reference.
        dt: f64,
    },
    /// Both miss.
    CorrectMiss,
    /// The reference hits, the answer misses.
    FalseMiss,
    /// The reference misses, the answer hits.
    FalseHit,
    /// Both hit, but not the same sheet.
    WrongSheet,
    /// The reference does not know.
    Undecided,
    /// The reference was not asked.
    NotSampled,
}

/// Decades of |dt| that the colours span: 10^-8 to 1.
const DECADES: [i32; 2] = [-8, 0];

/// The colours and the names of everything but correct hits.
///
/// Mistakes are loud and differ in lightness and on the axis from yellow to blue, for colour-blind
/// eyes.
const KEYS: [(Agreement, &str, [f32; 3]); 6] = [
    (Agreement::FalseMiss, "false miss", [0.58, 0.27, 350.0]),
    (Agreement::FalseHit, "false hit", [0.83, 0.17, 80.0]),
    (Agreement::WrongSheet, "wrong sheet", [0.66, 0.22, 38.0]),
    (Agreement::Undecided, "undecided", [0.60, 0.0, 0.0]),
    (Agreement::CorrectMiss, "correct miss", [0.90, 0.008, 90.0]),
    (Agreement::NotSampled, "not sampled", [0.25, 0.0, 0.0]),
];

/// The error map: correct hits by |dt| from 10^-8 (nearly white) to 1 (deep blue) in decades, and
/// all else in colours of its own.
///
/// | pixel | colour |
/// |---|---|
/// | correct hit | white to blue, by the decades of the absolute dt; clamped outside |
/// | correct miss | light grey |
/// | false miss | magenta |
/// | false hit | amber |
/// | wrong sheet | vermilion |
/// | undecided, or dt is NaN | grey |
/// | not sampled | the colour of the sample to the left, or else above, dimmed; dark grey without one |
///
/// # Errors
/// If there is not one agreement for each pixel of the view.
pub fn picture(view: &View, agreement: &[Agreement]) -> Result<Picture, ShadeError> {
    check_count(view, "comparisons", agreement.len())?;
    let palette = Palette::ice();
    let keys = KEYS.map(|(kind, name, [l, c, h])| (kind, name, Colour::oklch(l, c, h).bytes()));
    let colour_of = |kind: Agreement| {
        // All but correct hits are in the list.
        keys.iter().find(|(k, ..)| *k == kind).map_or([0; 3], |(.., colour)| *colour)
    };
    let undecided = colour_of(Agreement::Undecided);
    let colour = |sample: usize| match agreement[sample] {
        Agreement::Correct { dt } if dt.is_nan() => undecided,
        Agreement::Correct { dt } => palette.at(position(dt)),
        other => colour_of(other),
    };
    let samples = samples(view, agreement);
    Picture::painted(view, describe(agreement), Some(legend(&palette, &keys)), |i| {
        match samples[i] {
            Some(sample) if sample != i => dimmed(colour(sample)),
            _ => colour(i),
        }
    })
}

/// The sample that stands for each pixel: the last to its left, or the one that stands for the
/// pixel above. Samples on a grid so fill their cells; single pixels could not be seen.
fn samples(view: &View, agreement: &[Agreement]) -> Vec<Option<usize>> {
    let mut samples: Vec<Option<usize>> = Vec::with_capacity(agreement.len());
    for (i, given) in agreement.iter().enumerate() {
        let left = i.checked_sub(1).filter(|_| i % view.width > 0).and_then(|j| samples[j]);
        let above = i.checked_sub(view.width).and_then(|j| samples[j]);
        let is_new = |sample: &usize| *sample >= i - i % view.width;
        samples.push(match given {
            Agreement::NotSampled => left.filter(is_new).or(above).or(left),
            _ => Some(i),
        });
    }
    samples
}

/// So dark that a pale colour does not pass for the grey of what is undecided.
fn dimmed(colour: [u8; 3]) -> [u8; 3] {
    Colour(0.15 * Colour::from_bytes(colour).0).bytes()
}

/// Where the logarithm of |dt| lies in the decades, 0 to 1; zero is at the least.
fn position(dt: f64) -> f32 {
    let [low, high] = DECADES.map(f64::from);
    ((dt.abs().log10() - low) / (high - low)).clamp(0.0, 1.0) as f32
}

fn legend(palette: &Palette, keys: &[(Agreement, &str, [u8; 3])]) -> Legend {
    let [low, high] = DECADES;
    let ticks = (low..=high)
        .step_by(2)
        .map(|d| Tick {
            position: (d - low) as f32 / (high - low) as f32,
            label: if d == 0 { "1".into() } else { format!("1e{d}") },
        })
        .collect();
    let scale = Scale { title: "|dt|, in units of space".into(), palette: palette.clone(), ticks };
    let label = |kind: Agreement, name: &str| match kind {
        Agreement::NotSampled => format!("dim: {name}"),
        _ => name.into(),
    };
    let keys = keys.iter().map(|(kind, name, colour)| Key::new(*colour, label(*kind, name)));
    let keys = keys.collect();
    Legend { scale: Some(scale), keys }
}

fn describe(agreement: &[Agreement]) -> String {
    let count = |test: &dyn Fn(&Agreement) -> bool| agreement.iter().filter(|a| test(a)).count();
    let mut words =
        vec![format!("{} correct hits", count(&|a| matches!(a, Agreement::Correct { .. })))];
    words.extend(KEYS.iter().map(|(kind, name, _)| format!("{} {name}", count(&|a| a == kind))));
    format!("error against the reference: {}", words.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_fill_their_cells() {
        use zeroset_raycast::{Camera, Domain};
        let domain = Domain::new(glam::DVec3::NEG_ONE, glam::DVec3::ONE).unwrap();
        let view = View::new(Camera::facing(&domain), 4, 3);
        let mut agreement = [Agreement::NotSampled; 12];
        assert_eq!(samples(&view, &agreement), [None; 12]);
        for i in [0, 2, 8, 10] {
            agreement[i] = Agreement::CorrectMiss;
        }
        let filled: Vec<_> = samples(&view, &agreement).into_iter().flatten().collect();
        assert_eq!(filled, [0, 0, 2, 2, 0, 0, 2, 2, 8, 8, 10, 10]);
        let picture = picture(&view, &agreement).unwrap();
        let [full, dim] = [picture.pixels()[0], picture.pixels()[1]];
        assert!(full != dim && picture.pixels()[5] == dim && picture.pixels()[8] == full);
    }

    #[test]
    fn decades_are_even_and_clamped() {
        assert_eq!(position(0.0), 0.0);
        assert_eq!(position(1e-300), 0.0);
        assert!((position(-1e-4) - 0.5).abs() < 1e-6);
        assert_eq!(position(1.0), 1.0);
        assert_eq!(position(f64::INFINITY), 1.0);
    }
}
