//! The fifty scenarios, each with its source, how it was carried over, and its tests.

/// What of the climber a scenario asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    /// A query alone.
    Query,
    /// How a body gets from where it was to where it wants to be.
    Mover,
    /// The whole of a step.
    Climber,
}

/// A scenario.
struct Row {
    number: u32,
    source: &'static str,
    level: Level,
    /// What was set up, and what differs from the source.
    scene: &'static str,
    /// What is demanded; where it differs from the source's, why.
    demand: &'static str,
    /// Names of its tests, which exist because the table itself declares them.
    tests: &'static [&'static str],
}

/// Declares the tests of all scenarios, and the table of them.
macro_rules! scenarios {
    ($($number:literal $source:literal $level:ident $scene:literal $demand:literal
        [$($group:ident::$test:ident),* $(,)?];)*) => {
        $($(
            #[test]
            fn $test() {
                crate::$group::$test();
            }
        )*)*

        const ROWS: &[Row] = &[$(Row {
            number: $number,
            source: $source,
            level: Level::$level,
            scene: $scene,
            demand: $demand,
            tests: &[$(stringify!($test)),*],
        }),*];
    };
}

scenarios! {
    01 "Jolt TestFallingAndJumping" Climber "" "" [ground::falls_lands_and_jumps];
    02 "Jolt" Climber "" "" [ground::slopes_are_stood_on_to_the_limit_and_slid_down_beyond];
    03 "Jolt" Climber "" "" [ground::a_run_downhill_sticks_to_the_floor_or_flies_off];
    04 "Jolt" Climber "" "" [stairs::stairs_are_walked_up_at_any_rate, stairs::stairs_block_who_cannot_step];
    05 "Jolt" Climber "" "" [stairs::a_wall_alongside_gives_no_speed];
    06 "Jolt" Climber "" "" [platforms::a_turning_platform_carries_without_lag];
    07 "Jolt" Climber "" "" [platforms::a_lift_carries_up_and_down_at_any_speed, platforms::a_lift_that_reverses_in_one_tick_keeps_who_sticks_to_it];
    08 "Jolt" Climber "" "" [walls::a_gutter_of_768_faces_is_walked_along_to_its_caps];
    09 "Jolt" Climber "" "" [walls::an_overlap_is_left_in_one_tick];
    10 "Jolt" Climber "" "" [walls::two_walls_through_the_body_lift_it_out_and_let_it_go];
    11 "Jolt" Climber "" "" [walls::six_hundred_metres_a_second_stop_at_a_box, walls::six_hundred_metres_a_second_stop_at_a_capsule];
    12 "Jolt" Climber "" "" [walls::edges_within_a_slope_are_not_felt];
    13 "Jolt" Climber "" "" [walls::edges_within_a_slope_are_not_felt_at_360_metres_a_second];
    14 "Jolt" Climber "" "" [walls::a_fin_on_an_edge_of_the_floor_is_met];
    18 "rapier" Climber "" "" [ground::a_slope_is_climbed_just_below_the_limit_and_not_just_above];
    19 "rapier" Climber "" "" [ground::ten_thousand_steps_stay_on_the_ground];
    20 "rapier" Climber "" "" [ground::any_direction_is_up];
    21 "rapier" Climber "" "" [walls::a_wall_pushes_who_does_nothing];
    22 "rapier" Climber "" "" [walls::a_ball_within_a_solid_box_comes_out_of_its_nearest_face];
    23 "rapier" Climber "" "" [walls::the_seam_of_two_fields_is_not_felt, walls::the_seam_between_terrain_and_a_foot_is_not_felt];
    24 "rapier" Climber "" "" [ground::a_walk_on_a_flat_box_keeps_its_height];
    25 "rapier" Climber "" "" [platforms::a_platform_that_could_move_is_as_good_as_ground, platforms::an_idle_rider_of_a_lift_stays_on_it];
    26 "rapier" Climber "" "" [platforms::a_minute_on_each_of_jolts_platforms, platforms::a_wall_that_comes_and_goes_shoves_and_leaves];
    27 "rapier" Climber "" "" [platforms::a_belt_carries_at_its_speed];
    28 "rapier" Climber "" "" [stairs::bumps_are_walked_over, stairs::what_only_looks_like_stairs_is_a_wall, stairs::walls_of_pillars_and_of_segments_do_not_snag, stairs::a_funnel_holds_who_falls_into_it, stairs::an_acute_corner_below_a_ceiling_stops_gently, stairs::a_hollow_box_is_solid_from_within];
    29 "rapier" Climber "" "" [platforms::going_down_askew_does_not_jitter];
    30 "rapier" Climber "" "" [platforms::a_jump_off_a_lift_that_goes_down_leaves_it];
    31 "rapier" Climber "" "" [platforms::a_reversal_throws_who_is_free_and_keeps_who_sticks];
    32 "rapier" Climber "" "" [platforms::the_edge_of_a_fast_lift_does_not_push_sideways];
    33 "rapier" Climber "" "" [platforms::a_platform_that_starts_in_one_tick_takes_its_rider_along];
    40 "rapier" Climber "" "" [ground::a_metre_a_second_is_one_at_any_rate];
    41 "rapier" Climber "" "" [ground::a_hitch_keeps_the_velocity_until_something_is_in_the_way];
}
