//! Scenes of quadrilaterals in which two triangles are not enough.

use glam::DVec3;

use super::Quadrilateral;

/// Quadrilaterals side by side, each with an edge from `rails` to the next, bit for bit.
fn strip(rails: impl Iterator<Item = [DVec3; 2]>) -> Vec<Quadrilateral> {
    // To single precision, as the patches like it.
    let rails: Vec<_> = rails.map(|ends| ends.map(|p| p.as_vec3().as_dvec3())).collect();
    rails.windows(2).map(|w| Quadrilateral([w[0][0], w[1][0], w[1][1], w[0][1]])).collect()
}

/// A strip along x of six quadrilaterals whose rungs turn by 75 degrees from one to the next: each is twisted
/// so far that its two triangles meet in a sharp fold, as in \[stoll2006\] Fig. 9. It is 6 long and 2 wide.
pub fn folded_strip() -> Vec<Quadrilateral> {
    strip((0..=6).map(|i| {
        let x = f64::from(i) - 3.0;
        let (sin, cos) = (75.0 * f64::from(i)).to_radians().sin_cos();
        [DVec3::new(x, -cos, -sin), DVec3::new(x, cos, sin)]
    }))
}

/// One quadrilateral over the square of side 2 around 0 whose corners lie `height` above and below it by
/// turns: z = height x y.
pub fn twisted(height: f64) -> Quadrilateral {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Quadrilateral(corners.map(|[x, y]| DVec3::new(x, y, height * x * y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_an_edge_bit_for_bit() {
        let strip = folded_strip();
        assert_eq!(strip.len(), 6);
        for pair in strip.windows(2) {
            let [[_, p2, p3, _], [p1, .., p4]] = [pair[0].0, pair[1].0];
            assert_eq!([p2, p3], [p1, p4]);
        }
    }

    #[test]
    fn triangles_miss_the_middle_by_far() {
        for quad in folded_strip() {
            let [p1, _, p3, _] = quad.0;
            let off = (quad.point(0.5, 0.5) - 0.5 * (p1 + p3)).length();
            assert!(off > 0.4, "{off}");
        }
        assert_eq!(twisted(0.5).point(0.75, 0.25), DVec3::new(0.5, -0.5, -0.125));
    }
}
