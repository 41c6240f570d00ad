//! A frame of an image that was seen before makes nothing on the device, whatever the camera, and reads
//! nothing but the answers and the time.
//!
//! Alone in its program: the counts are those of the whole device.

#[path = "../../gpu/tests/adapter/mod.rs"]
mod adapter;

use zeroset_beam::BeamGpu;
use zeroset_raycast::catalogue::Catalogue;
use zeroset_raycast::{Camera, Hits, Method, Progress, Rays, Request, View};

#[test]
fn frames_make_nothing_and_read_the_answers() {
    let Some(device) = adapter::device() else { return };
    let scene = Catalogue::builtin().get("tangle").expect("it is there").scene().expect("a scene");
    let intersector = BeamGpu::adaptive().prepare(&scene).expect("a device");
    let start = Camera::facing(&scene.domain);
    let mut before: Option<[usize; 2]> = None;
    let mut last = Vec::new();
    for turn in 0..4 {
        // From the axis too, where parts of the camera's frame are 0.
        let camera = match turn {
            0 | 1 => start,
            2 => Camera { eye: glam::DVec3::new(0.0, -12.0, 0.0), ..start },
            _ => Camera { eye: glam::DVec3::new(9.0, 5.0, 1.0), ..start },
        };
        let view = View::new(camera, 200, 150);
        let mut hits = Hits::new(Request::First, 200 * 150);
        intersector.intersect(Rays::View(&view), &mut hits, &Progress::new()).expect("answers");
        assert!(turn < 2 || hits.bracket != last, "the camera moved");
        last = hits.bracket;
        let [made, read] = device.counts();
        if let Some([made_before, read_before]) = before {
            assert_eq!(made, made_before, "turn {turn} made something");
            let clock = usize::from(device.report().timestamps);
            assert_eq!(read - read_before, 1 + clock, "turn {turn} read more");
        }
        before = Some([made, read]);
    }
}
