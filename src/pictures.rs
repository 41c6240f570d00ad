//! Verdicts as what pictures of errors are made from.

use zeroset::bench::{Judgement, Verdict};
use zeroset::shade::Agreement;

/// The agreement of each answer with the reference.
pub(crate) fn agreement(judgement: &Judgement) -> Vec<Agreement> {
    let answers = judgement.verdict.iter().zip(&judgement.dt);
    answers
        .map(|(verdict, &dt)| match verdict {
            Verdict::CorrectHit => Agreement::Correct { dt },
            Verdict::CorrectMiss => Agreement::CorrectMiss,
            Verdict::FalseMiss => Agreement::FalseMiss,
            Verdict::FalseHit => Agreement::FalseHit,
            Verdict::WrongSheet => Agreement::WrongSheet,
            Verdict::Undecided => Agreement::Undecided,
            Verdict::NotSampled => Agreement::NotSampled,
        })
        .collect()
}
