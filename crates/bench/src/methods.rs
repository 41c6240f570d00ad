//! The registry of methods: one line each.

use std::fmt;

use zeroset_raycast::Method;

/// The standard methods, each with its default knobs.
pub fn methods() -> Vec<Box<dyn Method>> {
    vec![
        // Box::new(zeroset_cpu::Amp::default()),
        // Box::new(zeroset_cpu::Kmarch::default()),
        // Box::new(zeroset_cpu::Reference::default()),
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
        write!(f, "There are {}", self.known.join(", "))
    }
}
