//! Expressions to text that reads as the same expression.

use num_traits::Signed;

use crate::function::Parameter;
use crate::graph::{Graph, Id, Node};
use crate::parser::Binding;
use crate::rational;

/// What is still to be printed.
enum Item {
    /// A node, in parentheses if it binds more loosely than that.
    Node(Id, Option<Binding>),
    Text(&'static str),
    /// The negative of a number.
    Negative(Id),
}

impl Graph {
    /// Text that reads as the expression at `root`.
    pub(crate) fn print(&self, root: Id, parameters: &[Parameter]) -> String {
        use Binding::{Power, Product, Sign, Sum};
        let mut out = String::new();
        // Not recursive: a sum of many terms is as deep as it is long. Last printed, first pushed.
        let mut stack = vec![Item::Node(root, Some(Sum))];
        while let Some(item) = stack.pop() {
            let (id, loosest) = match item {
                Item::Text(text) => {
                    out.push_str(text);
                    continue;
                }
                Item::Negative(id) => {
                    let r = self.number(id).expect("it is a number");
                    out.push_str(&rational::text(&-r));
                    continue;
                }
                Item::Node(id, loosest) => (id, loosest),
            };
            let node = self.node(id);
            // An operand binds more tightly than any operator.
            let binding = self.binding(node);
            if binding.is_some_and(|b| loosest.is_none_or(|l| b < l)) {
                out.push('(');
                stack.push(Item::Text(")"));
            }
            let infix = |stack: &mut Vec<_>, a, left, operator, b, right| {
                stack.push(Item::Node(b, right));
                stack.push(Item::Text(operator));
                stack.push(Item::Node(a, left));
            };
            match *node {
                Node::Variable(axis) => out.push(['x', 'y', 'z'][usize::from(axis)]),
                Node::Number(ref r) => out.push_str(&rational::text(r)),
                Node::Pi => out.push_str("pi"),
                Node::Parameter(i, _) => out.push_str(&parameters[i as usize].name),
                Node::Root(p) => {
                    out.push_str("root:");
                    stack.push(Item::Node(p, Some(Sum)));
                }
                Node::Add(a, b) => match self.node(b) {
                    // Constants are added, but read better subtracted.
                    Node::Number(r) if r.is_negative() => {
                        stack.push(Item::Negative(b));
                        stack.push(Item::Text(" - "));
                        stack.push(Item::Node(a, Some(Sum)));
                    }
                    &Node::Neg(b) => infix(&mut stack, a, Some(Sum), " - ", b, Some(Product)),
                    _ => infix(&mut stack, a, Some(Sum), " + ", b, Some(Product)),
                },
                Node::Sub(a, b) => infix(&mut stack, a, Some(Sum), " - ", b, Some(Product)),
                Node::Mul(a, b) => infix(&mut stack, a, Some(Product), "*", b, Some(Power)),
                Node::Div(a, b) => infix(&mut stack, a, Some(Product), "/", b, Some(Power)),
                Node::Neg(a) => {
                    out.push('-');
                    stack.push(Item::Node(a, Some(Power)));
                }
                Node::Power(a, b) => infix(&mut stack, a, None, "^", b, Some(Sign)),
                Node::Unary(f, a) => {
                    out.push_str(f.name());
                    out.push('(');
                    stack.push(Item::Text(")"));
                    stack.push(Item::Node(a, Some(Sum)));
                }
                Node::Binary(f, a, b) => {
                    out.push_str(f.name());
                    out.push('(');
                    stack.push(Item::Text(")"));
                    infix(&mut stack, a, Some(Sum), ", ", b, Some(Sum));
                }
                Node::Chebyshev(form, n, a) => {
                    out.push_str(&format!("{form}({n}, "));
                    stack.push(Item::Text(")"));
                    stack.push(Item::Node(a, Some(Sum)));
                }
            }
        }
        out
    }

    /// How tightly the outermost operator of the text binds, if there is one.
    fn binding(&self, node: &Node) -> Option<Binding> {
        match node {
            Node::Number(r) if !rational::text(r).contains('/') => {
                r.is_negative().then_some(Binding::Sign)
            }
            Node::Number(_) | Node::Mul(..) | Node::Div(..) => Some(Binding::Product),
            Node::Add(..) | Node::Sub(..) => Some(Binding::Sum),
            Node::Neg(_) => Some(Binding::Sign),
            Node::Power(..) => Some(Binding::Power),
            _ => None,
        }
    }
}
