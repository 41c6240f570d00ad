//! What is wrong with an equation is said at its place, with the remedy where it can be guessed.

use zeroset_expr::{Definitions, Function, Parameter, ParseError};

fn fault(text: &str) -> ParseError {
    match Function::parse(text) {
        Ok(function) => panic!("`{text}` reads as {function}"),
        Err(error) => error,
    }
}

/// Checks the place (marked by `«` and `»`), a part of the message, and the help.
fn check(marked: &str, message: &str, help: Option<&str>) {
    let text = marked.replace(['«', '»'], "");
    let start = marked.find('«').expect("there is a start");
    let end = marked.find('»').expect("there is an end") - '«'.len_utf8();
    let error = fault(&text);
    let shown = error.render();
    assert_eq!(error.span, start..end, "{text}: the place\n{shown}");
    assert!(error.message.contains(message), "{text}: expected `{message}`\n{shown}");
    assert_eq!(error.help.as_deref(), help, "{text}: the help\n{shown}");
    assert_eq!(error.text, text);
    assert!(shown.starts_with(&format!("error: {}\n", error.message)));
}

#[test]
fn operators_that_are_missing_or_foreign() {
    for (marked, message, help) in [
        ("«2x»", "no operator between `2` and `x`", Some("write `2*x`")),
        ("x + «3 y»", "no operator between `3` and `y`", Some("write `3*y`")),
        ("«x y»", "no operator between `x` and `y`", Some("write `x*y`")),
        ("«2(»x+1)", "no operator between `2` and `(`", Some("write `2*(...)`")),
        ("«x(»y+1)", "no operator between `x` and `(`", Some("write `x*(...)`")),
        ("(x+1«)(»x-1)", "no operator between `)` and `(`", Some("write `(...)*(...)`")),
        ("(x+1«) y»", "no operator between `)` and `y`", Some("write `(...)*y`")),
        ("«2exp»(x)", "no operator between `2` and `exp`", Some("write `2*exp`")),
        ("x«**»2", "unexpected `**`", Some("write `^` for a power")),
        ("x «==» y", "unexpected `==`", Some("write one `=`")),
        ("x = y «=» z", "only one `=`", None),
        ("x «−» y", "unexpected character `−`", Some("write `-` for minus")),
        ("x «×» y", "unexpected character", Some("write `*` for a product")),
        ("x«²» + y", "unexpected character", Some("write `^2` for a square")),
        ("x «÷» 2", "unexpected character", Some("write `/` for a quotient")),
        ("«|»x| - 1", "unexpected character", Some("write `abs(...)` for an absolute value")),
        ("x «%» 2", "unexpected character", Some("write `mod(a, b)` for a remainder")),
        (
            "x «<» 1",
            "unexpected character",
            Some("a surface is where two sides are equal: write `=`"),
        ),
        ("2*«π»*x", "unexpected character", Some("write `pi`")),
        (
            "«é» + x",
            "unexpected character",
            Some("names consist of the letters a to z, digits and `_`"),
        ),
        ("x + «_»a", "unexpected character", Some("names start with a letter")),
        (
            "x + «\u{200b}»1",
            "unexpected character `\\u{200b}`",
            Some("an equation has numbers, names, `+ - * / ^ ( ) [ ] , = ;`"),
        ),
    ] {
        check(marked, message, help);
    }
}

#[test]
fn operands_and_brackets_that_are_missing() {
    let decimals = Some("decimals are written with a point, as in 0.5");
    for (marked, message, help) in [
        ("«»", "nothing to read", None),
        ("«»   ", "nothing to read", None),
        ("«»; a = 1", "nothing to read", None),
        ("x +«»", "expected a number, a name or `(`, but found the end", None),
        ("x =«»", "but found the end", None),
        ("«=» x", "but found `=`", None),
        ("«*»x", "but found `*`", None),
        ("x + «*»y", "but found `*`", None),
        ("«+»x", "but found `+`", Some("leave this `+` out")),
        ("x^«+»2", "but found `+`", Some("leave this `+` out")),
        ("(«)»", "but found `)`", None),
        ("«(»x + y", "this `(` is not closed", None),
        ("sin«(»x", "this `(` is not closed", None),
        ("«(»x + 1]", "not closed: found `]` first", None),
        ("x + 1«)»", "this `)` has no `(` before it", None),
        ("x«]»", "this `]` has no `[` before it", None),
        ("x + 1«,»5", "unexpected `,`", decimals),
        ("(x + 1«,»5)", "unexpected `,` in `(...)`", decimals),
        ("x «:» y", "unexpected `:`", None),
        ("x + «1.2.3»", "`1.2.3` is no number: it has two decimal points", None),
        ("«1..2»*x", "two decimal points", None),
        (
            "x + «.»",
            "unexpected character `.`",
            Some("a number has digits beside its point, as in 0.5"),
        ),
        ("«2e»", "the exponent of `2e` has no digits", Some("write `2e1`, or `2*e` for a product")),
        (
            "x*«1e»+y",
            "the exponent of `1e` has no digits",
            Some("write `1e1`, or `1*e` for a product"),
        ),
        (
            "x + «0x1F»",
            "`0x1F` is no decimal number",
            Some("write numbers in decimal, as 16 or 0.5 or 1.5e-3"),
        ),
    ] {
        check(marked, message, help);
    }
}

#[test]
fn names_and_calls() {
    for (marked, message, help) in [
        ("«sin» x", "expected `(` after the function `sin`", Some("write `sin(x)`")),
        ("«cos» 2*x", "expected `(` after the function `cos`", Some("write `cos(2)`")),
        ("«sqrt» + x", "expected `(` after the function `sqrt`", Some("write `sqrt(x)`")),
        ("«T»*x", "expected `(` after the function `T`", Some("write `T(4, x)`")),
        ("«sqtr»(x)", "unknown function `sqtr`", Some("did you mean `sqr` or `sqrt`?")),
        ("«SIN»(x)", "unknown function `SIN`", Some("did you mean `sin`?")),
        ("«ln»(x)", "unknown function `ln`", Some("write `log(x)`")),
        ("«arctan2»(y, x)", "unknown function `arctan2`", Some("write `atan2(y, x)`")),
        ("«elephant»(x)", "unknown function `elephant`", None),
        ("x + «e»", "unknown name `e`", Some("write `exp(1)`")),
        ("x + «radus»; radius = 1", "unknown name `radus`", Some("did you mean `radius`?")),
        (
            "x + «q»",
            "unknown name `q`",
            Some(
                "the variables are `x`, `y` and `z`; a parameter is defined at the end, as in `...; q = 1`",
            ),
        ),
        ("x + «inf»", "`inf` is no number", None),
        ("x + «NaN»", "`NaN` is no number", None),
        ("x - «Infinity»", "`Infinity` is no number", None),
        ("«sin(x, y)»", "`sin` takes 1 argument, not 2", Some("write `sin(x)`")),
        ("«sqr()»", "`sqr` takes 1 argument, not 0", Some("write `sqr(x)`")),
        ("«atan2(x)»", "`atan2` takes 2 arguments, not 1", Some("write `atan2(x, y)`")),
        ("«min(x)»", "`min` takes 2 or more arguments, not 1", Some("write `min(x, y)`")),
        ("«T(x)»", "`T` takes 2 arguments, not 1", Some("write `T(4, x)`")),
        ("T(«2.5», x)", "`T(n, x)` wants a literal integer n from 0 to 512, not `2.5`", None),
        ("Tpow(«-1», x)", "not `-1`", None),
        ("Tcos(«513», x)", "from 0 to 512, not `513`", None),
        ("T(«n», x); n = 3", "wants a literal integer", None),
        ("T(«x», x)", "wants a literal integer", None),
    ] {
        check(marked, message, help);
    }
}

#[test]
fn constants_sums_and_tables() {
    let sum = Some("write `sum(i, 1, 3, i*x^i)`");
    let table = Some("choose one by its index, as in `t[1]`");
    for (marked, message, help) in [
        ("«1 + pi»", "there is no x, y or z", None),
        ("«x - x»", "there is no x, y or z", None),
        ("x/«0»", "division by zero", None),
        ("x/«(1-1)»", "division by zero", None),
        ("mod(x, «0»)", "division by zero", None),
        ("x + «sqrt(-1)»", "`sqrt(-1)` is undefined", None),
        ("x + 2*«log(0)»", "`log(0)` is undefined", None),
        ("x + «0^-1»", "is undefined", None),
        ("x + «(-8)^(1/3)»", "`(-8)^(1/3)` is undefined", None),
        ("x^«1025»", "the exponent 1025 is too large: integers are limited to 1024", None),
        ("«x*1e400»", "beyond the range of doubles", None),
        ("x*«1e999999999999»", "too long: at most about 600 digits", None),
        ("sum(i, «x», 3, x)", "`x` varies, but a constant is expected here", None),
        ("sum(i, 1, «2.5», x)", "a bound of a sum is an integer, not `2.5`", None),
        ("«sum(i, 3, 1,» x)", "this sum from 3 to 1 has no terms", None),
        ("«sum(i, 1, 3)»", "`sum` takes an index, two bounds and a term, but found `)`", sum),
        ("sum(«1», 2, 3, x)", "expected the name of an index, but found `1`", sum),
        ("sum(«x», 1, 3, x)", "`x` has a meaning already: choose another index", None),
        ("sum(«r», 1, 3, x); r = 1", "`r` has a meaning already", None),
        ("x + sum«(»i, 1, 3, i", "this `(` is not closed", None),
        ("x + «t»; t = [1, 2]", "`t` is a table of 2 constants", table),
        ("x + t[«3»]; t = [1, 2]", "index 3 is outside of `t`, which has 1 to 2", None),
        ("x + t[«0»]; t = [1, 2]", "index 0 is outside", None),
        ("x + t[«1.5»]; t = [1, 2]", "an index is a constant integer, not `1.5`", None),
        ("x + t[«y»]; t = [1, 2]", "`y` varies", None),
        (
            "«x[»1]",
            "no operator between `x` and `[`",
            Some("only tables have entries: `t = [1, 2, 3]` and `t[2]`"),
        ),
        ("x + t[1]; t = «[]»", "this table has no entries", None),
        ("x + t[1]; t = [1,«» , 2]", "an entry of the table is missing here", None),
        (
            "x + t[1]; t = «[»1, 2",
            "this table is not closed",
            Some("a table is written as `[1, 2, 3]`"),
        ),
        (
            "x; «3 = 4»",
            "expected a definition after `;`",
            Some("definitions are written as `r = 1` or `t = [1, 2, 3]`"),
        ),
        ("x + r; r =«»", "nothing to read", None),
        ("x; «x» = 1", "`x` has a meaning already: choose another name", None),
        ("x; «sin» = 1", "`sin` has a meaning already", None),
        ("x + r; r = 1; «r» = 2", "`r` is defined twice", None),
        ("x + r; r = «y»", "`y` varies, but a constant is expected here", None),
        (
            "x + r; r = 1 «=» 2",
            "unexpected `=` in a constant",
            Some("definitions are separated by `;`, as in `a = 1; b = 2`"),
        ),
        ("x; a = «b»", "unknown name `b`", None),
        ("sum(k, 1, 2, a*x); a = «k» + 1", "unknown name `k`", None),
    ] {
        check(marked, message, help);
    }
}

#[test]
fn cycles_and_roots() {
    check("x + a; a = b; b = «a» + 1", "`a` is defined by itself", None);
    check("x + a; a = «a»", "`a` is defined by itself", None);
    check("x; a = «a» + 1", "`a` is defined by itself", None);
    check("x + t[1]; t = [«t»[1]]", "entry 1 of `t` is defined by itself", None);
    for (marked, message, help) in [
        (
            "x + a; a = root:«a»^3 + a",
            "`a` is defined by itself",
            Some("give the polynomial's unknown a name of its own"),
        ),
        ("x + a; a = «root:t^2 + 1»", "has 0 real roots, not one", None),
        ("x + a; a = «root:t^2 - 2»", "has 2 real roots, not one", None),
        ("x + a; a = «root:t^3 - t»", "has 3 real roots, not one", None),
        ("x + a; a = «root:sin(t)»", "is no polynomial", None),
        ("x + a; a = «root:pi*t + 1»", "coefficient that may not be rational", None),
        ("x + a; a = «root:0*t + 1»", "does not depend on its unknown", None),
        ("x + a; a = «root:(t+1)^999»", "is too large a polynomial", None),
        ("x + a; a = root:t + «u»", "`u` is a second unknown beside `t`", None),
        (
            "x + a; a = «root:5»",
            "this polynomial has no unknown",
            Some("write for example `root:7*u^3 + 7*u + 1`"),
        ),
        (
            "x + «root»:t",
            "a root can only be the whole value of a parameter",
            Some("write `...; a = root:7*u^3 + 7*u + 1`"),
        ),
    ] {
        check(marked, message, help);
    }
}

#[test]
fn definitions_that_come_with_an_equation_are_named() {
    let parameter = |name: &str, default: &str| Definitions {
        parameters: vec![Parameter { name: name.into(), default: default.into() }],
        tables: Vec::new(),
    };
    for (name, default, text, span, message) in [
        ("r", "1 +", "1 +", 3..3, "the default of `r`: expected a number"),
        ("r", "1 $", "1 $", 2..3, "the default of `r`: unexpected character `$`"),
        ("r", "", "", 0..0, "the default of `r`: there is nothing to read"),
        ("r", "sqrt(-2)", "sqrt(-2)", 0..8, "the default of `r`: `sqrt(-2)` is undefined"),
        ("2r", "1", "2r", 0..2, "`2r` is no name"),
        ("y", "1", "y", 0..1, "`y` has a meaning already"),
    ] {
        let definitions = parameter(name, default);
        let error = Function::parse_with("x + r", &definitions).expect_err(message);
        assert!(error.message.contains(message), "{}", error.render());
        assert_eq!((error.text.as_str(), error.span), (text, span));
    }
    let tables = vec![("t".into(), vec!["1".into(), "2 2".into()])];
    let definitions = Definitions { parameters: Vec::new(), tables };
    let error = Function::parse_with("x + t[1]", &definitions).expect_err("unused, but wrong");
    assert_eq!(error.message, "entry 2 of `t`: there is no operator between `2` and `2`");
}

#[test]
fn faults_are_shown_in_their_line() {
    assert_eq!(
        fault("x^2 + 2y").render(),
        "error: there is no operator between `2` and `y`\n  \
           |\n\
         1 | x^2 + 2y\n  \
           |       ^^\n  \
           = help: write `2*y`\n"
    );
    let text = format!("{}x +\ny + é", "x +\n".repeat(9));
    assert_eq!(
        fault(&text).render(),
        "error: unexpected character `é`\n   \
            |\n\
         11 | y + é\n   \
            |     ^\n   \
            = help: names consist of the letters a to z, digits and `_`\n"
    );
    assert_eq!(
        fault("x + sin(y").render(),
        "error: this `(` is not closed\n  |\n1 | x + sin(y\n  |        ^\n"
    );
    assert_eq!(fault("x +").to_string(), fault("x +").message);
}
