//! Routes of the diagram's arrows: horizontal and vertical lines from the edge of one box to the edge of another.
//!
//! Falling and Tumbling, to which nearly every mode changes, are bars above and below the others, so that few arrows
//! cross.

use clamber_climber::ClimberMode;
use clamber_climber::ClimberMode::{
    Falling, Hanging, Holding, LedgeHanging, Sliding, Standing, Tumbling,
};

/// The route of an arrow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Route {
    pub(crate) from: ClimberMode,
    pub(crate) to: ClimberMode,
    /// The route's corners, including both ends.
    pub(crate) way: &'static [(i32, i32)],
}

const fn route(from: ClimberMode, to: ClimberMode, way: &'static [(i32, i32)]) -> Route {
    Route { from, to, way }
}

/// The routes of all arrows.
pub(crate) const ROUTES: [Route; 29] = [
    // Between neighbours.
    route(Sliding, Standing, &[(166, 223), (214, 223)]),
    route(Standing, Sliding, &[(214, 247), (166, 247)]),
    route(Standing, LedgeHanging, &[(338, 223), (386, 223)]),
    route(LedgeHanging, Standing, &[(386, 247), (338, 247)]),
    route(LedgeHanging, Holding, &[(510, 223), (558, 223)]),
    route(Holding, LedgeHanging, &[(558, 247), (510, 247)]),
    route(Holding, Hanging, &[(682, 223), (730, 223)]),
    route(Hanging, Holding, &[(730, 247), (682, 247)]),
    // Past the boxes between, above or below them.
    route(
        Standing,
        Holding,
        &[(310, 205), (310, 132), (586, 132), (586, 205)],
    ),
    route(
        Holding,
        Standing,
        &[(562, 205), (562, 156), (334, 156), (334, 205)],
    ),
    route(
        Sliding,
        LedgeHanging,
        &[(150, 265), (150, 322), (410, 322), (410, 265)],
    ),
    route(
        Sliding,
        Holding,
        &[(122, 265), (122, 352), (582, 352), (582, 265)],
    ),
    // To the bar above, and back.
    route(Sliding, Falling, &[(92, 205), (92, 74)]),
    route(Falling, Sliding, &[(116, 74), (116, 205)]),
    route(Standing, Falling, &[(240, 205), (240, 74)]),
    route(Falling, Standing, &[(264, 74), (264, 205)]),
    route(LedgeHanging, Falling, &[(436, 205), (436, 74)]),
    route(Falling, LedgeHanging, &[(460, 74), (460, 205)]),
    route(Holding, Falling, &[(632, 205), (632, 74)]),
    route(Falling, Holding, &[(656, 74), (656, 205)]),
    route(Hanging, Falling, &[(792, 205), (792, 74)]),
    // To the bar below, and back.
    route(Sliding, Tumbling, &[(84, 265), (84, 412)]),
    route(Standing, Tumbling, &[(252, 265), (252, 412)]),
    route(Tumbling, Standing, &[(300, 412), (300, 265)]),
    route(LedgeHanging, Tumbling, &[(470, 265), (470, 412)]),
    route(Holding, Tumbling, &[(642, 265), (642, 412)]),
    route(Hanging, Tumbling, &[(792, 265), (792, 412)]),
    route(Falling, Tumbling, &[(884, 74), (884, 412)]),
    route(Tumbling, Falling, &[(908, 412), (908, 74)]),
];
