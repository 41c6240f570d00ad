//! Single floats as reals and as packets of one lane.

use zeroset_ia::{Nearest, Packet, Real, Scalar};

/// Numbers in ascending order.
fn ascending<S: Scalar>() -> Vec<S> {
    [-1.0, 0.0, 0.5, 1.0].map(S::from_f64).into_iter().chain([S::INFINITY]).collect()
}

fn comparisons_are_exact<S: Scalar + Packet>() {
    let floats = ascending::<S>();
    let (one, two) = (S::from_f64(1.0), S::from_f64(2.0));
    for (i, &x) in floats.iter().enumerate() {
        for (j, &y) in floats.iter().enumerate() {
            let (less, at_most) = (u64::from(i < j), u64::from(i <= j));
            assert_eq!([x.lt(y), x.le(y)], [less, at_most], "{x:?} {y:?}");
            assert_eq!([x < y, x <= y, x > y, x >= y], [i < j, i <= j, i > j, i >= j]);
            assert_eq!(x.partial_cmp(&y), Some(i.cmp(&j)));
            assert_eq!(x.select_lt(y, one, two).to_f64(), if i < j { 1.0 } else { 2.0 });
            assert_eq!(Real::min(x, y).to_f64(), floats[i.min(j)].to_f64());
            assert_eq!(Real::max(x, y).to_f64(), floats[i.max(j)].to_f64());
        }
        assert_eq!([x.lt(S::NAN), x.le(S::NAN), S::NAN.lt(x), S::NAN.le(x)], [0; 4]);
        assert_eq!(x.partial_cmp(&S::NAN), None);
        assert_eq!(x.select_lt(S::NAN, one, two).to_f64(), 2.0);
        assert_eq!([x.lane(0), x.from_fn(|_| x), x.splat(x)].map(S::to_f64), [x.to_f64(); 3]);
    }
    assert_eq!([0, 1].map(|mask| one.select(mask, one, two).to_f64()), [2.0, 1.0]);
    assert!(S::NAN.is_nan() && !S::INFINITY.is_nan() && !one.is_nan());
    // Of equal operands the second, as the machine's lanes give.
    let zeros = [-0.0, 0.0].map(S::from_f64);
    assert!(Real::min(zeros[0], zeros[1]).to_f64().is_sign_positive());
    assert!(Real::min(zeros[1], zeros[0]).to_f64().is_sign_negative());
    assert!(Real::max(zeros[0], zeros[1]).to_f64().is_sign_positive());
    assert!(Real::max(zeros[1], zeros[0]).to_f64().is_sign_negative());
}

#[test]
fn comparisons() {
    comparisons_are_exact::<f32>();
    comparisons_are_exact::<f64>();
    comparisons_are_exact::<Nearest<f32>>();
    comparisons_are_exact::<Nearest<f64>>();
}

/// `[down, nearest, up]` of an exact result between two neighbours.
fn bounds<S: Scalar>(below: S, above: S, pairs: &[[S; 2]], place: &str) {
    for [down, up] in pairs {
        let [down, up, below, above] = [*down, *up, below, above].map(S::to_f64);
        assert!(down <= below && above <= up, "{place}: {down:e} {below:e} {above:e} {up:e}");
        let width = up - down;
        let least = above - below;
        assert!(width <= 3.0 * least, "{place}: {width:e} for {least:e}");
    }
}

fn marks_bound_the_exact_result<S: Scalar>(one_third: [S; 2], root: [S; 2], tenth: S) {
    let [one, two, three] = [1.0, 2.0, 3.0].map(S::from_f64);
    bounds(one_third[0], one_third[1], &[[one.div_down(three), one.div_up(three)]], "1/3");
    bounds(root[0], root[1], &[[two.sqrt_down(), two.sqrt_up()]], "sqrt 2");
    // Exact results, with a tenth that is a float.
    let exact = [
        (tenth + tenth, [tenth.add_down(tenth), tenth.add_up(tenth)]),
        (tenth, [(tenth + tenth).sub_down(tenth), (tenth + tenth).sub_up(tenth)]),
        (tenth * two, [tenth.mul_down(two), tenth.mul_up(two)]),
    ];
    for (value, [down, up]) in exact {
        assert!(down <= value && value <= up, "{down:?} {value:?} {up:?}");
        assert!(value.down() <= down && up <= value.up(), "{down:?} {value:?} {up:?}");
        assert!(down < up, "marks step");
    }
    assert_eq!(S::from_f64(1.5).ceil().to_f64(), 2.0);
    assert_eq!(S::from_f64(-1.5).ceil().to_f64(), -1.0);
    assert_eq!(S::from_f64(-1.5).floor().to_f64(), -2.0);
}

#[test]
fn marks() {
    marks_bound_the_exact_result(
        [f32::from_bits(0x3eaa_aaaa), f32::from_bits(0x3eaa_aaab)],
        [f32::from_bits(0x3fb5_04f3), f32::from_bits(0x3fb5_04f4)],
        0.1_f32,
    );
    marks_bound_the_exact_result(
        [f64::from_bits(0x3fd5_5555_5555_5555), f64::from_bits(0x3fd5_5555_5555_5556)],
        [f64::from_bits(0x3ff6_a09e_667f_3bcc), f64::from_bits(0x3ff6_a09e_667f_3bcd)],
        0.1_f64,
    );
}

#[test]
fn products_of_unbounded_ends_count_zero_times_infinity_as_zero() {
    let (zero, infinity) = (0.0_f64, f64::INFINITY);
    for (a, b, lo, hi) in [
        ([0.0, 1.0], [0.0, infinity], zero, infinity),
        ([0.0, 0.0], [-infinity, infinity], zero, zero),
        ([-1.0, 0.0], [2.0, infinity], -infinity, zero),
        ([-2.0, 3.0], [-5.0, 7.0], -15.0, 21.0),
        ([2.0, 3.0], [5.0, 7.0], 10.0, 21.0),
        ([-3.0, -2.0], [5.0, 7.0], -21.0, -10.0),
        ([-3.0, -2.0], [-7.0, -5.0], 10.0, 21.0),
        ([2.0, 3.0], [-7.0, -5.0], -21.0, -10.0),
    ] {
        let [down, up] = Real::mul_bounds_unbounded(a, b);
        assert!(down == lo.next_down() && up == hi.next_up(), "{a:?} {b:?}: {down} {up}");
        if a.iter().chain(&b).all(|x: &f64| x.is_finite()) {
            assert_eq!(Real::mul_bounds(a, b), [down, up]);
        }
    }
    assert_eq!(
        [f64::NAN, -infinity, infinity, -2.0].map(Real::zero_where_nan),
        [0.0, -infinity, infinity, -2.0]
    );
}
