//! What every method takes from a scene whose geometry is a function.

use zeroset_expr::{Function, Parameters, Tape};
use zeroset_raycast::{Domain, Error, Geometry, Scene, Unsupported};

/// Bits to which constants are known.
const PRECISION: usize = 128;

/// A function with values for its parameters, and the domain in which its roots count.
#[derive(Clone, Debug)]
pub struct Implicit {
    function: Function,
    /// The function with the values.
    pub tape: Tape,
    /// Where roots count.
    pub domain: Domain,
}

impl Implicit {
    /// The function of a scene, for the method of that id.
    ///
    /// # Errors
    /// If the scene has no function, or its parameters or domain are invalid.
    pub fn new(method: &str, scene: &Scene) -> Result<Self, Error> {
        let function = Self::function(method, scene)?.clone();
        let tape = function.tape(&scene.parameters, PRECISION)?;
        Ok(Self { function, tape, domain: checked(scene.domain)? })
    }

    /// The function of a scene, if it has one.
    ///
    /// # Errors
    /// If it has none.
    pub fn function<'a>(method: &str, scene: &'a Scene) -> Result<&'a Function, Unsupported> {
        match &scene.geometry {
            Geometry::Implicit(function) => Ok(function),
            _ => Err(Unsupported(format!("{method} casts rays at functions only"))),
        }
    }

    /// New values for the parameters; after an error the old ones stay.
    ///
    /// # Errors
    /// If a name is unknown or a value is no finite constant.
    pub fn set_parameters(&mut self, values: &Parameters) -> Result<(), Error> {
        self.tape = self.function.tape(values, PRECISION)?;
        Ok(())
    }
}

/// The domain, unless it is empty or not finite.
fn checked(domain: Domain) -> Result<Domain, Error> {
    let Domain { min, max, ball } = domain;
    let cuboid = Domain::new(min, max)?;
    ball.map_or(Ok(cuboid), |radius| cuboid.with_ball(radius))
}
