//! The rule for contacts: which contacts may be stood on, stepped onto, hung from, gripped and passed through.

mod friction;
mod gripping;
mod hanging;
mod passing;
mod scene;
mod standing;

pub(crate) use friction::{
    a_friction_out_of_range_counts_as_0_or_as_usual, an_icy_slope_pulls_down,
    ice_accelerates_and_brakes_slowly, ice_that_moves_takes_along_by_friction_alone,
    mud_slows_a_walk, the_stickiest_mud_holds_fast, wet_fur_slips_through_hands,
};
pub(crate) use gripping::{
    a_friend_is_neither_hung_from_nor_gripped_unless_the_rule_says_so,
    a_hold_that_is_refused_lets_go, armour_stops_hands,
};
pub(crate) use hanging::{
    a_ledge_that_is_refused_is_let_go_and_one_without_footing_is_only_hung_from,
    hands_stop_where_a_ledge_may_not_be_held,
};
pub(crate) use passing::{
    a_door_lets_one_pass_and_not_another, a_door_that_closes_on_a_climber_pushes_it_out,
    a_one_way_platform_is_jumped_through_stood_on_and_dropped_through,
    a_one_way_platform_that_moves_is_boarded_from_below,
};
pub(crate) use standing::{
    a_curb_that_may_not_be_stepped_onto_blocks, ground_that_may_not_be_stood_on_is_slid_off,
};
