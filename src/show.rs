//! `zeroset show`: what there is.
#[derive(clap::Args, Clone, Debug)]
/// Shows
pub(crate) struct Show {}
impl Show {
    pub(crate) fn run(&self) -> Result<(), crate::failure::Failure> {
        Ok(())
    }
}
