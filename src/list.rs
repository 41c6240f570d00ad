//! `zeroset list`: what there is.
#[derive(clap::Args, Clone, Debug)]
/// Lists
pub(crate) struct List {}
impl List {
    pub(crate) fn run(&self) -> Result<(), crate::failure::Failure> {
        Ok(())
    }
}
