//! The registry of methods: one line each.

use std::fmt;

use zeroset_raycast::Method;

/// The standard methods, each with its default knobs.
pub fn methods() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(zeroset_cpu::Amp::default()),
        Box::new(zeroset_cpu::Amp::taylor()),
        Box::new(zeroset_cpu::Bisection::kmarch()),
        Box::new(zeroset_cpu::Bisection::tbisect()),
        Box::new(zeroset_cpu::Bisection::mitchell()),
        Box::new(zeroset_beam::Beam::uniform()),
        Box::new(zeroset_beam::Beam::adaptive()),
        Box::new(zeroset_gpu::AmpGpu::default()),
        Box::new(zeroset_gpu::AmpGpu::new(zeroset_cpu::RootTest::Taylor)),
        Box::new(zeroset_gpu::BisectionGpu::default()),
        Box::new(zeroset_beam::BeamGpu::uniform()),
        Box::new(zeroset_beam::BeamGpu::adaptive()),
        Box::new(zeroset_quadric::Quadrics::incremental()),
        Box::new(zeroset_quadric::Quadrics::brute()),
        Box::new(zeroset_quadric::QuadricsGpu::incremental()),
        Box::new(zeroset_quadric::QuadricsGpu::brute()),
        Box::new(zeroset_cpu::Reference::default()),
        Box::new(zeroset_quadric::QuadricReference),
    ]
}

/// The standard method of that id.
///
/// # Errors
/// If there is none; the message lists those that exist.
pub fn method(id: &str) -> Result<Box<dyn Method>, UnknownMethod> {
    Registry::standard().method(id)
}

/// A set of methods with distinct ids, in order.
#[derive(Debug)]
pub struct Registry {
    methods: Vec<Box<dyn Method>>,
}

impl Registry {
    /// The standard methods.
    pub fn standard() -> Self {
        Self { methods: methods() }
    }

    /// No methods.
    pub fn empty() -> Self {
        Self { methods: Vec::new() }
    }

    /// These and one more; it replaces one of the same id.
    #[must_use]
    pub fn with(mut self, method: Box<dyn Method>) -> Self {
        match self.methods.iter_mut().find(|m| m.id() == method.id()) {
            Some(old) => *old = method,
            None => self.methods.push(method),
        }
        self
    }

    /// The methods in order.
    pub fn iter(&self) -> impl Iterator<Item = &dyn Method> {
        self.methods.iter().map(AsRef::as_ref)
    }

    /// Their ids in order.
    pub fn ids(&self) -> Vec<&'static str> {
        self.iter().map(Method::id).collect()
    }

    /// Copies of the methods that have the knob `certify`, with it on.
    pub fn certified(&self) -> Vec<Box<dyn Method>> {
        let mut copies: Vec<_> = self.iter().map(Method::boxed).collect();
        copies.retain_mut(|method| method.set("certify", "on").is_ok());
        copies
    }

    /// A copy of the method of that id.
    ///
    /// # Errors
    /// If there is none; the message lists those that exist.
    pub fn method(&self, id: &str) -> Result<Box<dyn Method>, UnknownMethod> {
        self.iter().find(|m| m.id() == id).map(Method::boxed).ok_or_else(|| UnknownMethod {
            id: id.into(),
            near: nearest(id, &self.ids()),
            known: self.ids(),
        })
    }
}

/// The name most like `id`, if any is like it.
fn nearest(id: &str, known: &[&'static str]) -> Option<&'static str> {
    let wanted = id.to_lowercase();
    let likeness = |name: &str| {
        let prefix = !wanted.is_empty() && name.starts_with(&wanted);
        if prefix { 1.0 } else { strsim::jaro_winkler(name, &wanted) }
    };
    known
        .iter()
        .map(|name| (likeness(name), *name))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// An id that no method has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct UnknownMethod {
    /// What was asked for.
    pub id: String,
    /// The id that is most like it, if any is.
    pub near: Option<&'static str>,
    /// The ids that exist.
    pub known: Vec<&'static str>,
}

impl fmt::Display for UnknownMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no method {:?}; ", self.id)?;
        if let Some(near) = self.near {
            write!(f, "did you mean {near}? ")?;
        }
        write!(f, "the methods are {}", self.known.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_distinct_and_found() {
        let registry = Registry::standard();
        let mut ids = registry.ids();
        for id in &ids {
            assert_eq!(registry.method(id).unwrap().id(), *id);
            assert_eq!(method(id).unwrap().id(), *id);
        }
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), methods().len());
    }

    #[test]
    fn a_method_replaces_one_of_its_id() {
        let count = methods().len();
        let first = methods().swap_remove(0);
        let registry = Registry::standard().with(first.boxed());
        assert_eq!(registry.ids().len(), count);
        assert_eq!(Registry::empty().with(first).ids().len(), 1);
    }

    #[test]
    fn methods_that_can_certify_do() {
        let certified = Registry::standard().certified();
        assert_eq!(
            certified.iter().map(|m| m.id()).collect::<Vec<_>>(),
            ["amp-sign", "amp-taylor", "amp-sign-gpu", "amp-taylor-gpu"]
        );
        for method in certified {
            assert!(method.knobs().iter().any(|k| k.name == "certify" && k.value == "on"));
        }
    }

    #[test]
    fn near_names_are_suggested() {
        let known = ["amp-sign", "kmarch", "reference"];
        let near = |id| nearest(id, &known);
        assert_eq!(near("amp"), Some("amp-sign"));
        assert_eq!(near("AMP_sign"), Some("amp-sign"));
        assert_eq!(near("k-march"), Some("kmarch"));
        assert_eq!(near("referense"), Some("reference"));
        assert_eq!(near(""), None);
        assert_eq!(near("sdf"), None);
        let error = Registry::standard().method("kmarsh").unwrap_err().to_string();
        assert!(error.starts_with("no method \"kmarsh\"; did you mean kmarch?"), "{error}");
    }
}
