//! The scenarios: each with its source, how it was adapted, its limits, and its tests.

/// The layer that a scenario tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    /// A query alone.
    Query,
    /// One movement of a body.
    Mover,
    /// A whole step of a climber.
    Climber,
}

/// A scenario.
struct Row {
    number: u32,
    source: &'static str,
    level: Level,
    /// The setup, and its differences from the source.
    scene: &'static str,
    /// The limits, and the reason for each difference from the source.
    demand: &'static str,
    /// Names of the scenario's tests, which the table itself declares.
    tests: &'static [&'static str],
}

/// Declares the tests of all scenarios, and the table.
macro_rules! scenarios {
    ($($number:literal $source:literal $level:ident $scene:literal $demand:literal
        [$($group:ident::$test:ident),+ $(,)?];)*) => {
        $($(
            #[test]
            fn $test() {
                crate::scenarios::plays::in_every_setting(stringify!($test), crate::scenarios::$group::$test);
            }
        )+)*

        /// The rows of the table.
        const ROWS: &[Row] = &[$(Row {
            number: $number,
            source: $source,
            level: Level::$level,
            scene: $scene,
            demand: $demand,
            tests: &[$(stringify!($test)),+],
        }),*];
    };
}

// Jolt's capsule has a radius of .3, a cylinder of 1.35 and a padding of .02 that keeps it away from obstacles. Our
// climber rests at its radius, with a core that is smaller by the margin: radius .32, height 1.35, margin .02. Then
// positions of the feet are the same as Jolt's. Unless a row says otherwise: 60 Hz, gravity 9.81, slopes up to 50
// degrees, snap .5, steps .4, feet that stick to any ground (as Jolt's do), no tumbling, no stamina.
scenarios! {
    1 "Jolt TestFallingAndJumping" Climber
        "Drops 2 m onto a box, jumps at 1 m/s, lands."
        "At rest within 1e-6 m both times; the jump's first velocity 1 - 9.81/60 to 1e-12."
        [ground::falls_lands_and_jumps, ground::a_landing_is_reported_once];
    2 "Jolt TestMovingOnSlope" Climber
        "Slopes of 5, 15 .. 75 degrees; stands after the landing tick, then walks up, down, across and diagonally at \
         2 m/s. Ours walks 2 m/s along the slope; Jolt's velocity is level and projected."
        "Slips 1e-5 in a tick; walks 3 m each way to 1e-4; beyond 50 degrees a frictionless slide to 1e-4."
        [ground::slopes_are_stood_on_to_the_limit_and_slid_down_beyond];
    3 "Jolt TestStickToFloor" Climber
        "Runs at 10 m/s from level ground over an edge of 45 degrees. Ours walks along slopes, so it can leave the \
         ground only at an edge."
        "With snap .5 stands in each tick, on the slope to 1e-4; with snap 0 flies off, ballistic to 1e-4."
        [ground::a_run_downhill_sticks_to_the_floor_or_flies_off];
    4 "Jolt TestWalkStairs" Climber
        "Ten steps of .3 by .3 m at 60, 120, 240 and 360 Hz, 4 m/s; and without stepping."
        "Stands in each tick, always moves on, sideways 1e-6, at the top in 1.5 times the time of the straight way. \
         Without stepping: stops at -.32 to 1.1e-2. A step may gain up to r (1 - sin 50 degrees) + margin."
        [stairs::stairs_are_walked_up_at_any_rate, stairs::stairs_block_a_climber_that_cannot_step];
    5 "Jolt TestStairWalkAlongWall" Climber
        "Walks (5, 0, -1) m/s along a wall at -Z, at four rates, with stepping on."
        "After 1 s at (5, 0, 0) to 1e-2."
        [stairs::a_wall_alongside_gives_no_speed];
    6 "Jolt TestRotatingPlatform" Climber
        "9 m from the axis of a platform that turns once a second."
        "Stands; at its material point to 1e-3, without Jolt's lag of a tick."
        [platforms::a_turning_platform_carries_without_lag];
    7 "Jolt TestMovingPlatformUp" Climber
        "Up, pause and down at .5, 5 and 20 m/s; up and down without a pause."
        "Stands; 1e-4 (Jolt's limit is 1e-2)."
        [
            platforms::a_lift_carries_up_and_down_at_any_speed,
            platforms::a_lift_that_reverses_in_one_tick_keeps_a_rider_with_sticky_feet,
        ];
    8 "Jolt TestContactPointLimit" Climber
        "In a half-pipe of 768 faces, 1 cm wider than the ball, to either cap. Ours has no limit of contacts: all are \
         used. Stepping is off; otherwise it would step onto the rim."
        "More than 256 contacts; caps to 1e-4; ground normal y > .999."
        [edges::a_gutter_of_768_faces_is_walked_along_to_its_caps];
    9 "Jolt TestInitiallyIntersecting" Mover
        ".005, .05 and .2 m into a wall. Ours has no recovery factor: Jolt's cases with less than 1 have no \
         counterpart."
        "Out after one tick, and for two more, to 1e-6."
        [walls::an_overlap_is_left_in_one_tick];
    10 "Jolt TestInitiallyIntersecting2" Climber
        "Two walls of 75 degrees that cross below the body, above a floor; then walks out along the crease at 2 m/s \
         for 2 s."
        "Ten ticks: never sinks by more than 1e-6, x and z within 1e-3, ends above .5 m; then on the floor to .05."
        [walls::two_walls_through_the_body_lift_it_out_and_let_it_go];
    11 "Jolt TestCharacterVsCharacter" Mover
        "10 m in a tick, at a box .1 m thick, and at a capsule that is a rapier body instead of a second character."
        "Stops at contact to 1e-6, without velocity."
        [
            walls::six_hundred_metres_a_second_stop_at_a_box,
            walls::six_hundred_metres_a_second_stop_at_a_capsule,
        ];
    12 "Jolt DiscreteCubeSlideMesh" Mover
        "Slides across 7 by 7 quadrilaterals, and along their edges, on a slope of 60 degrees (on level ground it \
         would stand)."
        "The slide on a plane, to 1e-3 m and 2e-3 m/s, for 110 ticks; after that the mesh ends."
        [edges::edges_within_a_slope_are_not_felt];
    13 "Jolt LinearCastCubeSlideMesh" Mover
        "The same at 360 m/s in one tick, on edges, beside them, and mirrored."
        "1e-4 m and 1e-4 m/s."
        [edges::edges_within_a_slope_are_not_felt_at_360_metres_a_second];
    14 "Jolt TestNonManifoldMesh" Mover
        "A floor and a fin: three triangles share an edge. Walks into the fin, with either winding."
        "Stops at it, and stays on the floor, to 1e-4."
        [edges::a_fin_on_an_edge_of_the_floor_blocks];
    15 "Jolt TestCastSphereVsDegenerateTriangle" Query
        "300 slivers 5 m long and .4 mm wide; a ball of .2 cast past and at them. Random vertices instead of Jolt's."
        "Hit if and only if an f64 search says so; stops at .2 to 1.1e-4, the tolerance of a cast."
        [queries::a_sliver_is_hit_exactly_where_it_is];
    16 "Jolt TestCollideParallelTriangleVsCapsule" Query
        "Capsule axis parallel to a triangle: above it, across and along its edge, beside it, in its plane."
        "One contact; distance to 1e-6; a unit separation normal."
        [queries::a_capsule_parallel_to_a_triangle_has_the_exact_distance];
    17 "Jolt TestCastShapeInitiallyIntersecting" Query
        "Casts that start in contact with a face: from either side, towards it and away."
        "Time 0, started inside, the face's own normal."
        [queries::a_cast_that_starts_inside_hits_at_time_0];
    18 "rapier character_controller_climb_test" Climber
        "A slope of .6 rad with a limit .001 above it; and with one .001 below it, less the 2 degrees of hysteresis."
        "200 steps of .1 m: climbs beyond x 6, y 3, or stays before x 4.5, y 2; at most 3 ticks in the air, no two in \
         a row."
        [ground::a_slope_is_climbed_just_below_the_limit_and_not_just_above];
    19 "rapier character_controller_ground_detection" Climber
        "10,000 steps of (.1, 0, .1) m on a box of 2002 m."
        "Stands in each step; 999 m of 1000 both ways (rapier's 960)."
        [ground::ten_thousand_steps_stay_on_the_ground];
    20 "rapier character_controller_negative_up_axis" Climber
        "Up is -Y, X and two skew directions: falls, stands, walks 3 m."
        "Stands; 1e-4."
        [ground::any_direction_is_up];
    21 "rapier issue_485 kinematic_platform_pushes_idle_character" Climber
        "A wall at 2 m/s for 240 ticks and at 30 m/s for 120 against an idle climber on a floor; and slow walls that \
         push it off the floor's edge."
        "Never deeper than 2e-2 in the wall; on the floor to 1e-3; falls from the edge."
        [
            walls::a_wall_pushes_an_idle_climber,
            walls::a_slow_wall_pushes_off_an_edge,
            walls::ground_moves_on_below_a_climber_held_back_by_a_wall,
        ];
    22 "rapier issue_485 overlapping_character_is_depenetrated" Mover
        "A ball of .5 with its centre inside a cube of half side 1. Only on a body: a skin is not solid, and a ball \
         inside it is in a hollow (28)."
        "Out through +X within 20 ticks, at (1.5, .3, 0) to 1e-3."
        [walls::a_ball_within_a_solid_box_comes_out_of_its_nearest_face];
    23 "rapier issue_182_heightfield_seam" Climber
        "Over the seam of two flush fields of 16 m at 2 m/s for 480 ticks; and from a body's field onto a skin's."
        "Never .05 below its rest height, gets beyond 12 m; skin and body: 16 m to 1e-3."
        [
            edges::the_seam_of_two_fields_is_not_felt,
            edges::the_seam_between_terrain_and_a_foot_is_not_felt,
        ];
    24 "rapier #809" Climber
        "30 Hz, gravity 30, radius .36 with a margin of .01, 9 m/s on a box of 30 m, with two turns."
        "Height changes by at most 1e-4 a tick."
        [ground::a_walk_on_a_flat_box_keeps_its_height];
    25 "rapier #488, #747" Climber
        "Idle on a lift of 6 m/s; a walk over movable hills at rest, compared with fixed ones."
        "1e-4; 1e-5."
        [
            platforms::a_movable_platform_at_rest_is_like_ground,
            platforms::an_idle_rider_of_a_lift_stays_on_it,
        ];
    26 "Jolt's sample platforms" Climber
        "A minute idle on each: turning back and forth, in a circle while turning, up and down, reversing; and beside \
         a wall that comes and goes."
        "Drift 1e-3; never 1e-3 in the wall, and never farther than the wall came."
        [
            platforms::a_minute_on_each_of_jolts_platforms,
            platforms::a_wall_that_comes_and_goes_pushes_but_does_not_pull,
        ];
    27 "Jolt's sample conveyor" Climber
        "A belt of 2 m/s as an obstacle around another one, with material points in coordinates that move, as the \
         trait allows."
        "Distance, velocity, and a walk across it, to 1e-4."
        [platforms::a_belt_carries_at_its_speed];
    28 "Jolt's sample obstacles" Climber
        "Bumps of .05 x .01 and .3 x .1 m, steps .3 high and .05 deep, walls of 30 pillars and of 25 segments 1 m \
         high, a funnel of 65 degrees, a floor and ceiling that meet, a hollow box; added by us: a wall of tiles along \
         a drop."
        "Walks over the bumps; does not climb the steps; slides along the walls to 1e-3; falls down the drop; stands \
         still in the funnel; does not jump by 1e-3 in the corner; stays in the box, at 300 m/s too."
        [
            stairs::bumps_are_walked_over,
            stairs::stairs_with_too_narrow_treads_are_a_wall,
            stairs::walls_of_pillars_and_of_segments_do_not_snag,
            stairs::a_wall_along_a_drop_is_no_ground,
            stairs::a_funnel_holds_a_climber_that_falls_into_it,
            stairs::an_acute_corner_below_a_ceiling_stops_gently,
            stairs::a_hollow_box_is_solid_from_within,
        ];
    29 "Jolt #1514" Climber
        "A platform that goes (0, -3, -3) m/s, for 5 s."
        "1e-3."
        [platforms::a_diagonally_descending_platform_does_not_jitter];
    30 "Jolt #1988" Climber
        "A jump of 3 m/s off a lift that goes down at 3 m/s."
        "Leaves the lift, and lands after the time of the same jump on a lift at rest, to a tick."
        [platforms::a_jump_off_a_lift_that_goes_down_leaves_it];
    31 "Jolt #530" Climber
        "From 2.4 to -2.4 m/s in a tick, with feet that stick and with feet that are thrown at 20 m/s2."
        "Stays to 1e-4; or flies as a projectile, to 1e-4, and lands when that does."
        [platforms::a_reversal_throws_a_free_rider_and_keeps_one_with_sticky_feet];
    32 "Godot #46604, #42765" Climber
        "Before, on and beyond the edge of a lift at 10 and 30 m/s. The drift of #46604 is in 06 and among the \
         failures."
        "No drift beyond 1e-3."
        [platforms::the_edge_of_a_fast_lift_does_not_push_sideways];
    33 "tnua #13, #28" Climber
        "A platform from 0 to 4 m/s in a tick."
        "1e-5 from its material point."
        [platforms::a_platform_that_starts_in_one_tick_takes_its_rider_along];
    34 "box3d MoverSphereDeepOverlap" Query
        "The centre of a ball, or the axis of a capsule through, along or ending on a face, an edge or a corner; \
         inside a cube."
        "Distance 0 to 1e-5 and a unit separation normal, for overlaps and casts."
        [
            queries::a_core_on_a_feature_has_a_unit_separation_normal,
            queries::a_solid_around_the_core_reports_the_way_out,
        ];
    35 "box3d LargeWorld" Climber
        "A tour of turning and rising hills with a wall, with the world's origin 17,000 km away."
        "The same within 1e-3."
        [frames::a_run_far_from_the_origin_matches_one_at_the_origin];
    36 "avian check_agreement" Mover
        "1 to 17 walls that touch a ball, 60 velocities each; the whole climber, since its solver of planes is \
         private; and a corner at 243 m/s."
        "At most .005 into any wall, and not backwards; into the corner to 1e-6, and at rest there."
        [skins::no_velocity_enters_any_of_seventeen_planes, walls::a_corner_takes_all_velocity];
    37 "box3d SphereHullSeam, CapsuleHullSeam, EdgeAxisRandomOracle" Query
        "400 random pairs of triangles with a common edge, and capsules around it."
        "Contact if and only if an f64 search finds one, with its distance to 2e-6."
        [queries::capsules_near_seams_and_edges_have_the_distance_of_brute_force];
    38 "parry ball_triangle_toi_infinite_loop_issue" Query
        "Motions of 6.9e-39, 5e-324, 1e-45 and 1e-20 m."
        "No hit, and the query terminates."
        [queries::tiny_motions_hit_nothing_and_end];
    39 "parry still_objects_toi" Query
        "A ball that moves with a moving box, faster, or not at all; both at rest."
        "Only the box that approaches is hit, a tenth into the tick."
        [queries::obstacles_that_do_not_approach_are_not_hit];
    40 "PhysX test_cct_velocity" Climber
        "1 m/s for 1 s at 24, 30, 50 and 60 Hz."
        "1 m to 1e-3 (PhysX .05)."
        [ground::a_walk_of_a_metre_a_second_is_exact_at_any_tick_rate];
    41 "rapier issue_217_ccd_large_dt_hitch" Mover
        "20 m/s at 4 Hz, without gravity, at a wall after 17 m."
        "Keeps its velocity, and stops at the wall to 1e-6."
        [ground::a_long_tick_keeps_the_velocity_up_to_the_obstacle];
    42 "bevy_ahoy validate_velocity, rapier quarantine" Climber
        "Obstacles that answer NaN, infinities and 1e308; states, inputs and ticks that are not finite; a velocity of \
         1e308. A NaN velocity cannot be injected: restoring it is refused."
        "Finite in each tick and within 100 m; typed errors, nothing changed; an event."
        [
            nonsense::not_finite_answers_of_an_obstacle_do_not_spread,
            nonsense::not_finite_arguments_are_refused,
            nonsense::an_overflowing_velocity_is_reported,
        ];
    43 "ours: breathing" Climber
        "Ground that rises and sinks by .5 m once a second, evenly and as a hump, for a minute."
        "Gap within the margin; the material point is the same in each tick."
        [skins::breathing_ground_carries_for_a_minute];
    44 "ours: stretch" Climber
        "Triangles stretch to twice their length and back, twice a second."
        "The same barycentric coordinates; 1e-3 from the material point."
        [skins::feet_keep_their_barycentric_point_on_a_stretching_triangle];
    45 "ours: shear" Climber
        "A slope that trembles by .1 degrees around the limit, and one that passes the limit and comes back, twice."
        "No change of mode; one change for each passage."
        [skins::ground_that_trembles_about_the_limit_is_lost_once_at_most];
    46 "ours: closing" Climber
        "Two sheets of one skin that close and open: on a ball to .2 m, on a capsule to 1.5 m, more than its axis."
        "Stays between them, not squeezed aside by 1e-3; reported as crushed once the room is less than the body; \
         stands again."
        [skins::closing_sheets_crush_the_climber_but_do_not_let_it_through];
    47 "ours: no area" Climber
        "Skin that collapses to a plane, a line or a point for a tick, under feet and under hands."
        "Finite, the same mode, and 1e-3 from where it was."
        [skins::a_triangle_without_area_for_a_tick_keeps_the_climber];
    48 "ours: rigid equivalence" Climber
        "A motion in six degrees of freedom of a root, a joint and a body: idle, on a tour, and with a jump. All \
         scenarios of moving ground are played in these three ways."
        "Root and joint 1e-4; root and body 1e-4 plus the distance of a chord from its arc; modes within a tick."
        [
            frames::root_joint_and_body_carry_alike_through_a_storm,
            frames::root_and_joint_carry_a_walker_alike_through_a_storm,
        ];
    49 "ours: frames" Climber
        "A tour in a world that moves steadily; stairs that do; a tour in a world that is turned with its gravity by \
         eighths about a skew axis; jumps at 30 m/s; a full turn."
        "1e-4."
        [
            frames::motion_of_the_whole_world_changes_nothing,
            frames::stairs_in_steady_motion_are_walked_like_stairs_at_rest,
            frames::a_world_turned_by_any_angle_changes_nothing,
            frames::a_jump_on_steadily_moving_ground_lands_where_it_began,
            frames::a_full_turn_of_the_ground_ends_where_it_began,
        ];
    50 "ours: numbering" Climber
        "A tour on hills whose vertices and triangles are reordered, or whose triangles are split into four."
        "Skin 1e-6; a body 1e-4, since its casts may stop that early."
        [frames::the_numbering_of_triangles_and_vertices_does_not_matter];
    51 "ours: rates" Climber
        "Jumps at 5 m/s at 30, 60, 120 and 240 Hz; the apex is that of a parabola through the highest three positions."
        "1e-3 of v^2 / 2g."
        [ground::a_jump_is_as_high_at_any_rate];
    52 "ours: wedge" Climber
        "Two walls 1 to 26 degrees from opposite close on a ball at .4 and 2 m/s each, to .5 m of room."
        "Up to 2 degrees a side reported as crushed; no tick moves it farther than four times the missing room."
        [
            wedges::a_closing_wedge_crushes_alike_in_every_frame,
            wedges::a_closing_wedge_does_not_fling_the_climber_out,
        ];
    53 "ours: hands" Climber
        "Catches a ledge, goes along it and climbs over it; climbs fur and around its corner; hangs from fur that \
         shakes; is knocked down and gets up."
        "Positions 1e-3."
        [
            hands::a_ledge_is_caught_hung_from_and_climbed_over,
            hands::fur_is_climbed_and_its_corner_turned,
            hands::a_hold_that_shakes_is_hung_from_until_it_is_calm,
            hands::a_knocked_down_climber_bounces_slides_and_gets_up,
        ];
    54 "ours: pull-ups without room" Climber
        "Pulls itself up below ceilings and eaves and against crates, from all sides, at 30 to 240 Hz; with the stick \
         held, released and turned round; a ceiling that rises; and with room."
        "Given up after .3 s without progress, and tried again only after the stick was released; back in place, to \
         5e-3, at the speed of arms, and at rest there, to 1e-3; obeys meanwhile."
        [
            pull_ups::a_pull_up_without_room_is_given_up_after_a_while,
            pull_ups::a_pull_up_without_room_obeys_the_stick_at_once,
            pull_ups::a_climber_that_gives_up_a_pull_up_goes_aside_lets_go_and_jumps,
            pull_ups::a_climber_that_gives_up_a_pull_up_climbs_down,
            pull_ups::a_pull_up_goes_on_once_there_is_room,
            pull_ups::a_pull_up_with_room_goes_on_by_itself,
        ];
    55 "ours: along ledges" Climber
        "Goes along ledges with the stick kept, at 30 to 240 Hz, from all sides and both ways: to their end, over steps \
         up, down, back and forward, across gaps, around outer and inner corners of 45 to 135 degrees."
        "Steps no longer than arms draw; no reversal; the velocity is how it moves, to 5 %; at an end it rests, to 1e-4; \
         faces the wall where it ends, to 1e-3."
        [
            along_ledges::a_climber_rests_at_the_end_of_a_ledge_with_the_stick_kept,
            along_ledges::a_ledge_is_followed_over_steps_and_across_gaps,
            along_ledges::a_ledge_is_followed_around_corners,
        ];
    56 "ours: drops to hang" Climber
        "Walks off an edge with the grip held, straight and obliquely, at 30 to 240 Hz, as a ball and as a capsule, on a \
         block and a plate; and without the grip, onto steps and onto ground that it could not hang above."
        "Hangs from the edge to 2e-3, faces the wall to 1e-3, steps no longer than arms draw; otherwise steps down or \
         falls."
        [
            drops::a_climber_that_steps_off_an_edge_hangs_from_it,
            drops::a_climber_that_can_step_down_or_has_no_room_does_not_hang,
        ];
}

#[test]
fn every_open_entry_names_a_test_and_has_a_reason() {
    for (test, setting) in crate::scenarios::open::all() {
        let known = ROWS.iter().any(|row| row.tests.contains(&test)) || FAILURES.contains(&test);
        assert!(
            known,
            "open.txt names {test} ({setting}), which is not a scenario"
        );
        let why = crate::scenarios::open::reason(test);
        assert!(
            why.is_some(),
            "open.rs does not say why {test} ({setting}) is open"
        );
    }
    for test in crate::scenarios::open::explained() {
        let is_open = crate::scenarios::open::all().any(|(open, _)| open == test);
        assert!(is_open, "open.rs explains {test}, which is not open");
    }
}

#[test]
fn the_table_has_every_scenario_once_with_its_tests() {
    let numbers: Vec<u32> = ROWS.iter().map(|row| row.number).collect();
    assert_eq!(numbers, (1..=56).collect::<Vec<_>>());
    for row in ROWS {
        let texts = [row.source, row.scene, row.demand];
        assert!(texts.iter().all(|text| !text.is_empty()), "{}", row.number);
        assert!(!row.tests.is_empty(), "{}", row.number);
    }
}

#[test]
fn the_table_in_markdown() {
    let mut table = String::from("| | source | level | scene | demand | tests |\n|-|-|-|-|-|-|\n");
    for row in ROWS {
        let tests: Vec<String> = row.tests.iter().map(|test| format!("`{test}`")).collect();
        let line = format!(
            "| {:02} | {} | {:?} | {} | {} | {} |\n",
            row.number,
            row.source,
            row.level,
            row.scene,
            row.demand,
            tests.join(", ")
        );
        assert_eq!(
            line.matches('|').count(),
            7,
            "a cell with a bar of its own: {line}"
        );
        table.push_str(&line);
    }
    println!("{table}");
}

/// Declares the tests that are played in every setting, but have no other controller as their source: known failures of
/// other engines, and everything that this crate adds.
macro_rules! own {
    ($($group:ident::$test:ident),+ $(,)?) => {
        $(
            #[test]
            fn $test() {
                crate::scenarios::plays::in_every_setting(stringify!($test), crate::scenarios::$group::$test);
            }
        )+

        /// Names of these tests.
        const FAILURES: &[&str] = &[$(stringify!($test)),+];
    };
}

own! {
    failures::rapier_488_falling_through_a_rising_lift,
    failures::shock2quest_666_dragged_along_a_brushed_wall,
    failures::godot_46604_drift_on_a_rotating_platform,
    failures::godot_101253_one_frame_behind_the_platform,
    failures::jolt_1988_a_jump_eaten_by_stick_to_floor_on_a_descending_lift,
    failures::jolt_1514_jitter_on_a_diagonally_descending_platform,
    failures::tnua_13_pushed_when_the_platform_reverses,
    failures::unity_875257_no_velocities_of_a_mesh_that_is_posed,
    air::a_notch_stops_a_climber_that_left_a_train,
    air::a_wall_that_squeezes_a_falling_climber_does_not_lift_it,
    air::steering_away_from_a_cliff_counts_from_the_cliff,
    air::the_frame_of_a_fall_becomes_that_of_the_air,
    air::steering_in_the_air_climbs_no_steep_slope,
    ground::who_stands_above_its_point_goes_down_to_it,
    crouching::a_climber_crouches_under_a_ceiling,
    crouching::who_has_no_room_does_not_stand_up,
    crouching::a_body_grows_only_where_it_has_room,
    holds::a_held_stick_crosses_a_belly_as_a_direction_does,
    holds::a_held_stick_goes_round_the_edges_of_a_box,
    holds::a_held_stick_leads_from_a_wall_onto_its_ceiling,
    holds::a_stick_that_turns_far_enough_leads_anew,
    rules::a_one_way_platform_is_jumped_through_stood_on_and_dropped_through,
    rules::a_one_way_platform_that_moves_is_boarded_from_below,
    rules::ice_accelerates_and_brakes_slowly,
    rules::ice_that_moves_takes_along_by_friction_alone,
    rules::an_icy_slope_pulls_down,
    rules::mud_slows_a_walk,
    rules::a_friction_out_of_range_counts_as_0_or_as_usual,
    rules::the_stickiest_mud_holds_fast,
    rules::armour_stops_hands,
    rules::a_hold_that_is_refused_lets_go,
    rules::wet_fur_slips_through_hands,
    rules::a_friend_is_neither_hung_from_nor_gripped_unless_the_rule_says_so,
    rules::a_door_lets_one_pass_and_not_another,
    rules::a_door_that_closes_on_a_climber_pushes_it_out,
    rules::a_ledge_that_is_refused_is_let_go_and_one_without_footing_is_only_hung_from,
    rules::hands_stop_where_a_ledge_may_not_be_held,
    rules::ground_that_may_not_be_stood_on_is_slid_off,
    rules::a_curb_that_may_not_be_stepped_onto_blocks,
}
