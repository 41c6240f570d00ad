//! The roots of a quadric along a ray.

use num_traits::Float;

/// alpha t^2 + 2 beta t + gamma = 0: \[stoll2006\] Eq. 6.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equation<T> {
    /// d'A d.
    pub alpha: T,
    /// d'(A o + b).
    pub beta: T,
    /// f(o).
    pub gamma: T,
}

/// The roots of an equation where the ray enters the inside, and where it leaves it; none if it does not.
pub type Roots<T> = [Option<T>; 2];

impl<T: Float> Equation<T> {
    /// beta^2 - alpha gamma; at a root, alpha t + beta is its square root but for the sign.
    pub fn discriminant(self) -> T {
        self.beta * self.beta - self.alpha * self.gamma
    }

    /// Without cancellation and without a case for small alpha.
    ///
    /// With s the root of the discriminant, the ray enters at (-beta - s)/alpha (Eq. 14), which is
    /// gamma/(s - beta): the one that adds numbers of one sign is taken. As alpha goes to 0 one of the two
    /// roots goes to infinity and the other is found all the same.
    pub fn roots(self) -> Roots<T> {
        let Self { alpha, beta, gamma } = self;
        let square = self.discriminant();
        if !(square >= T::zero()) {
            return [None; 2];
        }
        let s = square.sqrt();
        let roots = if beta < T::zero() {
            let q = s - beta;
            [gamma / q, q / alpha]
        } else {
            let q = -(beta + s);
            [q / alpha, gamma / q]
        };
        roots.map(finite)
    }

    /// Eq. 7, and -gamma/(2 beta) where alpha is small: the paper's formula with faces turned away culled.
    pub fn roots_by_quotient(self) -> Roots<T> {
        let Self { alpha, beta, .. } = self;
        let square = self.discriminant();
        if !(square >= T::zero()) {
            return [None; 2];
        }
        if alpha.abs() < small() {
            return self.linear();
        }
        let s = square.sqrt();
        [(-beta - s) / alpha, (-beta + s) / alpha].map(finite)
    }

    /// Eq. 15, with the sign of its root mended: the paper's formula for both sides. The nearest root before
    /// the eye is the greatest positive reciprocal, -beta/gamma + sqrt((beta/gamma)^2 - alpha/gamma).
    pub fn roots_by_reciprocal(self) -> Roots<T> {
        let Self { alpha, beta, gamma } = self;
        let (b, a) = (beta / gamma, alpha / gamma);
        let square = b * b - a;
        if !(square >= T::zero()) {
            return [None; 2];
        }
        let s = square.sqrt();
        let roots = [s - b, -b - s].map(|reciprocal| finite(reciprocal.recip()));
        // From where f is positive, the first of them is where the ray enters.
        if gamma > T::zero() { roots } else { [roots[1], roots[0]] }
    }

    /// 2 beta t + gamma = 0.
    fn linear(self) -> Roots<T> {
        let root = finite(-self.gamma / (self.beta + self.beta));
        if self.beta < T::zero() { [root, None] } else { [None, root] }
    }
}

fn finite<T: Float>(t: T) -> Option<T> {
    t.is_finite().then_some(t)
}

/// "If |alpha| becomes small": the paper names no number.
fn small<T: Float>() -> T {
    T::from(1e-6).expect("every float has it")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn equation<T>(alpha: T, beta: T, gamma: T) -> Equation<T> {
        Equation { alpha, beta, gamma }
    }

    #[test]
    fn roots_of_known_equations() {
        let enters = |alpha, beta, gamma| equation(alpha, beta, gamma).roots()[0];
        assert_eq!(enters(1.0, -3.0, 8.0), Some(2.0));
        assert_eq!(enters(0.0, -0.5, 1.0), Some(1.0));
        assert_eq!(enters(-1.0, -0.5, 0.75), Some(0.5));
        assert_eq!(enters(-1.0, 0.5, 0.75), Some(1.5));
        assert_eq!(equation(1.0, -3.0, 8.0).roots()[1], Some(4.0));
        assert_eq!(equation(1.0, 0.0, 1.0).roots(), [None; 2]);
        // The eye on the surface: the root is at 0, and there is another.
        assert_eq!(equation(1.0, -2.0, 0.0).roots(), [Some(0.0), Some(4.0)]);
        assert_eq!(equation(0.0, 0.0, 1.0).roots(), [None; 2]);
        assert_eq!(equation(f64::NAN, 0.0, 1.0).roots(), [None; 2]);
    }

    proptest! {
        #[test]
        fn the_first_root_enters_and_the_second_leaves(
            alpha in prop_oneof![-1e3..1e3, -1e-12..1e-12, Just(0.0)],
            beta in -1e3..1e3_f64,
            gamma in prop_oneof![-1e3..1e3, -1e-12..1e-12],
        ) {
            let e = equation(alpha, beta, gamma);
            for (k, root) in e.roots().into_iter().enumerate() {
                let Some(t) = root else { continue };
                let (value, size) = (
                    (alpha * t + 2.0 * beta) * t + gamma,
                    (alpha * t).abs() * t.abs() + (2.0 * beta * t).abs() + gamma.abs(),
                );
                prop_assert!(value.abs() <= 1e-14 * size, "{e:?} at {t}: {value}");
                let slope = alpha * t + beta;
                let error = 1e-7 * (beta.abs() + (alpha * t).abs());
                prop_assert!(if k == 0 { slope <= error } else { slope >= -error }, "{e:?} at {t}");
            }
        }

        #[test]
        fn the_papers_formulas_agree_where_they_are_well_conditioned(
            alpha in prop_oneof![0.1..10.0, -10.0..-0.1],
            beta in prop_oneof![0.1..10.0, -10.0..-0.1],
            gamma in prop_oneof![0.1..10.0, -10.0..-0.1],
        ) {
            let e: Equation<f64> = equation(alpha, beta, gamma);
            prop_assume!(e.discriminant() > 1e-3);
            for roots in [e.roots_by_quotient(), e.roots_by_reciprocal()] {
                for (a, b) in e.roots().into_iter().zip(roots) {
                    let (a, b) = (a.unwrap(), b.unwrap());
                    prop_assert!((a - b).abs() <= 1e-11 * a.abs(), "{e:?}: {a} {b}");
                }
            }
        }
    }
}
