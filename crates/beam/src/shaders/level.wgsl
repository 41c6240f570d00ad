// What the kernels of a level of the quadtree share.

struct Level {
    // The side of its cells in pixels, and its base 2 logarithm.
    size: u32,
    exponent: u32,
    // Its place among the levels.
    number: u32,
    tolerance: f32,
    // The next level's cells in the image.
    extent: vec2u,
    // The first row of pixels here, and pixels in a row.
    row: u32,
    width: u32,
}

struct Cell {
    // Column and row in cells, 16 bits each.
    place: u32,
    start: f32,
}

