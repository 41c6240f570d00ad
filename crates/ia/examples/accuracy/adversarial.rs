//! later
use crate::Request;
pub(crate) fn run(_: &Request) -> Result<bool, String> {
    Err("later".into())
}
