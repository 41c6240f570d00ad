//! Surfaces by name, file or equation.
use crate::failure::Failure;
use crate::options::SceneOptions;
use zeroset::raycast::Scene;
pub(crate) fn scene(_: &SceneOptions) -> Result<Scene, Failure> {
    Err(Failure::work("later"))
}
pub(crate) fn equation(_: &SceneOptions) -> Result<String, Failure> {
    Err(Failure::work("later"))
}
