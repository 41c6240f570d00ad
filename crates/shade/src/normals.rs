//! Normals as colours.

use glam::Vec3;
use zeroset_raycast::{Hits, View};

use crate::colour::byte;
use crate::legend::{Key, Legend};
use crate::picture::check_normals;
use crate::{Colour, Picture, ShadeError};

/// Unit normals that face the eye, in world space: red, green, blue = (n + 1) / 2.
///
/// The bytes are these numbers times 255, without sRGB's curve, so that they can be read back. Both
/// sides of a surface look the same: where the gradient points away from the eye, -n is shown.
/// Misses are dark, and hits without a normal grey.
///
/// # Errors
/// If the hits are not those of the view, or have no normals.
pub fn picture(view: &View, hits: &Hits) -> Result<Picture, ShadeError> {
    check_normals(view, hits, "normal")?;
    let background = Colour::oklch(0.23, 0.01, 270.0).bytes();
    let none = [128; 3];
    let description = "normals that face the eye, in world space: red, green, blue = 255(n+1)/2";
    let keys = [("+x", Vec3::X), ("+y", Vec3::Y), ("+z", Vec3::Z)]
        .into_iter()
        .flat_map(|(name, n)| [(name.to_owned(), n), (name.replace('+', "-"), -n)])
        .map(|(name, n)| Key::new(bytes(n), name))
        .collect();
    Picture::painted(view, description, Some(Legend { scale: None, keys }), |i| {
        if !hits.certificate[i].is_hit() {
            return background;
        }
        match seen(view, i, hits.normal[i]) {
            Some(Seen { normal, .. }) => bytes(normal),
            None => none,
        }
    })
}

fn bytes(normal: Vec3) -> [u8; 3] {
    (0.5 * (normal + Vec3::ONE)).to_array().map(byte)
}

/// Which side of the zero set the eye sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// The gradient points to the eye.
    Front,
    /// The gradient points away.
    Back,
}

/// A surface as it is seen.
pub(crate) struct Seen {
    /// The unit normal that faces the eye.
    pub normal: Vec3,
    /// The side that it is on.
    pub side: Side,
}

/// The normal of a pixel turned to the eye; `None` if there is no direction in it.
pub(crate) fn seen(view: &View, pixel: usize, normal: Vec3) -> Option<Seen> {
    let normal = normal.try_normalize()?;
    let ray = view.ray(pixel % view.width, pixel / view.width);
    Some(if normal.dot(ray.direction) > 0.0 {
        Seen { normal: -normal, side: Side::Back }
    } else {
        Seen { normal, side: Side::Front }
    })
}
