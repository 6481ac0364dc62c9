// Every number that was chosen: what for, in which unit, and why so.
//
// Three kinds, kept apart.  `answer`: changes the motion that is computed, so it is part of what a
// scene means.  `guard`: where a method would not end or not converge; what is cut short there is
// counted in the statistics or raised, never silent.  `cost`: decides only where to look, when, or
// how large a window is; the same bits come out whatever it is.
//
// `patch` and `seam`, which points of two surfaces are contacts, belong to the first kind.
//
// Not here: limits of what users may set (limits.h); rounding of one algorithm, which stands with
// it; what follows from `accuracy` (groups/regroup/step-tolerances.h).  Shares of speed are of
// sqrt(g size), with size the least width of a body; g the scale of gravity.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace tw::answer {

// ---- the contact law ----
// Static depth over size, and depth of doubled stiffness over static depth: columns of 20 stand.
inline constexpr double depth_share = 2.5e-4, hardening_depths = 2;
// Gaps are measured by the static depth, but of a contact that was made as soft as a cushion by no
// more than this share of the size: else the far side of a body counts as about to touch.
inline constexpr double widest_gap_scale = 0.125;
// The same in groups of unequal masses: 1000 : 1 stands on nine cubes.
inline constexpr double unequal_depth_share = 0.2 * depth_share, unequal_hardening_depths = 1;
// Masses are unequal from this ratio on.
inline constexpr double unequal_masses = 100;
// The heaviest may lie on any contact of its group: none is softer than for a thousandth of it (the
// law hardens by no more), nor stiffer than for a thousand times the pair's own: a bead on a lorry
// must not stop the clock.
inline constexpr double most_unequal = 1000;
// Of the small oscillation about the static depth; 0.3 to 0.7 serve.
inline constexpr double damping_ratio = 0.5;
// Depth beyond which a contact hardens no more, over its hardening depth; its square.
inline constexpr double hardest_ratio = 10, hardening_cap = hardest_ratio * hardest_ratio;
// What is far above the weight is borne by a second hardening (dynamics/second-hardening.h): so
// many weights at its limit; it begins at this share of that, where no weight and few blows come
// to.  The limit of contacts and holds by default, share of the size.
inline constexpr double firm_weights = 4e6, firm_from = 0.6, firm_share = 0.01;
// A gap of this share of the hardening depth is none to the derivatives: whether what just touches
// presses already is rounding.
inline constexpr double just_touching = 1e-9;
// Smooth friction reaches three quarters of the cone at about this speed, m/s.
inline constexpr double smooth_speed = 1e-4;
// Tangential over normal stiffness (Mindlin: 2 (1 - nu) / (2 - nu), 2/3 to 1).
inline constexpr double tangential_share = 0.8;
// m/s^2: stands in for gravity where there is none.
inline constexpr double standard_gravity = 9.81;
// Fusion speed, share of sqrt(g size): a ball of restitution 0.5 that comes down at it bounces up
// by a tenth of a percent of its size.  The least that is taken by default, and that may be set,
// m/s.
inline constexpr double fusion_share = 0.07, least_default_speed = 1e-4, least_fusion_speed = 1e-9;
// A new contact that slides is given this many times the stretch of the cone: more than 1, so that
// it slides at once, but little more: what a spring holds beyond its cone does work where the load
// rises.
inline constexpr double preload_beyond = 1.5;

// ---- multibodies ----
// A stop at a joint's limit yields so far under the weight beyond it, rad or share of its reach.
inline constexpr double stop_depth = 1e-4;
// The limit of its second hardening.
inline constexpr double stop_limit = 1e-3;
// Speed at which a joint strikes its stop no more but leans on it, of sqrt(g/reach) rad/s or
// sqrt(g reach) m/s with the reach of what it moves; it bounds what the stop damps.  1 cm/s at 1 m.
inline constexpr double stop_speed = 3e-3;
// A joint is at its stop from this far on: rad, or of the reach of what it moves; and as a share of
// the limit.
inline constexpr double stop_tolerance = 1e-12;
// A multibody alone is followed by an explicit method while nothing at its joints is faster than so
// many times its own motion: beyond, stability would set the steps.
inline constexpr double stiff_ratio = 8;
// Of its steps, share of the accuracy asked for: their errors add up (multibodies-bench).
inline constexpr double joint_step_share = 0.05;
// Of a step of bodies that springs alone tie together: ten swings of two err by about the accuracy.
inline constexpr double spring_step_share = 0.1;
// They are followed by an explicit method while the other's steps would be shorter than this,
// radians of the fastest swing there is, and damping is slower than so many times that; asked again
// after so many steps.  Each step in no more than so many cubics, and with this share of the error:
// then what is read errs by no more than by the other's.
inline constexpr double explicit_swing = 1, most_explicit_damping = 3, most_parts = 1000;
inline constexpr double explicit_share = 0.2;
inline constexpr std::uint64_t steps_between_choices = 16;
// Looser steps than this are made by a method of order 5.
inline constexpr double loose_steps = 1e-5;
// Coulomb friction of a joint is smooth below about this speed, in the units of stop_speed: 10 um/s
// at 1 m, by which what it holds creeps.
inline constexpr double joint_friction_speed = 3e-6;
// What a step is cut by in which it lets go, and does more than its derivative and tolerance allow.
inline constexpr double break_away_cut = 0.25;
// Tolerances by which velocities may change in a step in which a contact that is pressed into its
// second hardening lets go.
inline constexpr double let_go_change = 100;

// ---- where bodies meet ----
// Pairs that are not predicted exactly are looked at at multiples of this, s; an overlap that no
// such time sees does not exist, unless it gets deeper than this share of the thinner one
// (detect/dip.h).
inline constexpr double check_grid = 0x1p-20, dip_share = 0x1p-10;
// Two are apart over a whole piece, which is not looked at on the grid then, if so many times what
// rounding may make of no distance is left: a root's bracket ends within a few of these, and where
// it does must not depend on where a piece happens to be cut.
inline constexpr double apart_in_roundings = 16;
// Depth that does not count as penetration is so many times that at least: where the two get deeper
// than is surely apart, and not yet too deep, each point of the grid is looked at; a small part of
// the way to there.
inline constexpr double slack_in_roundings = 64;
// When contacts stop telling the truth is known to this share of the depth that they may miss.
inline constexpr double end_resolution = 1e-6;
// Depth that does not count as penetration, share of the smaller size: above the rounding of a
// distance query (3e-15) and of positions after many impacts, far below any accuracy asked for.
inline constexpr double depth_slack = 1e-12;
// The same where both are integrated: steps err by far more (groups/regroup/step-tolerances.h).
inline constexpr double stepped_slack = 1e-10;
// Bodies that come into the world touch if they overlap by no more than this share of the smaller
// size.
inline constexpr double start_depth = 1e-6;
// What came to rest can be a start: they may overlap by this share of the thinner one's thickness,
// as deep as where springs are hardest.  And what is so little apart beside others that touch, a
// fifth of what weight presses in, touches as well: files have six decimals, a right angle 1.5708.
inline constexpr double start_overlap = hardest_ratio * hardening_depths * depth_share;
inline constexpr double start_gap = 0.2 * depth_share;
// What overlaps and is to be pushed apart goes by this share of sqrt(g size), and at a check by no
// more than so many static depths.
inline constexpr double push_share = fusion_share, most_pushed = 3;
// What is placed touching starts loaded in groups of at most so many members: to find the forces
// takes about as long as a hundred steps of theirs.
inline constexpr std::size_t most_placed = 4096;
// A pair that carries less in their balance than this share of the lighter one's weight carries
// nothing.
inline constexpr double carried_share = 1e-6;
// A body is squeezed from this overlap on, over the thickness of it or of who pushes it, the
// thinner one: heaps stay below a tenth of it.
// The lesser of the forces on its two sides is at least this share of the other.
inline constexpr double squeezed_share = 0.02, squeezed_force_share = 0.1;

// ---- motion by a procedure ----
// It is sampled in spans of this length on a grid from time 0, s: so far ahead of what is asked it
// may be called, and what lasts shorter than a tenth of this may be missed.
inline constexpr double motion_span = 0x1p-4;
// Samples that judge a piece miss it by no more than this share of the least width (orientations by
// as much at the farthest point): a millionth of the default accuracy.
inline constexpr double motion_error = 1e-12;
// Where halving a piece does not halve its error twice in a row, the procedure's own noise (what
// solves equations to a tolerance), this error will do.
inline constexpr double motion_noise = 1e-9;
// A piece turns no farther than this from its middle, rad.
inline constexpr double motion_turn = 1;
// A kink is followed to within a piece of this length, s, or of so many spacings of the times
// there.
inline constexpr double shortest_motion_piece = 0x1p-24, shortest_motion_spacings = 1024;

// Its velocity jumps where one piece ends at more than this share from where the next one begins:
// well above what fitting leaves, well below what anybody sees.
inline constexpr double motion_jump = 1e-6;

// ---- which contacts are the same ----
// A contact after a refresh is one before it if they are not farther apart, share of the smaller
// size.
inline constexpr double same_point = 0.1;
// Contacts of one body with several fixed ones share a stiffness where their normals agree so far,
// rad.
inline constexpr double coplanar = 1e-3;
// An edge or corner of the ground whose normal is that of a face but for this, rad, is met as the
// face: beyond a seam the neighbour goes on with it.
inline constexpr double flat_angle = coplanar;
// Where a corner crosses the edge between two faces at a small angle, both hold it for a moment: as
// far as they are at one place (share of the size) with one normal (cosine), they hold it together.
inline constexpr double same_place = 1e-2, same_normal = 0.95;

// ---- steps of a group's arc ----
// The next step is h clamp(safety err^(-1/4), least, most), after a second rejection h
// clamp(safety err^(-1/p), least repeated, 0.9); the first aims at this error, in tolerances, for
// it is tried without knowing.
inline constexpr double step_safety = 0.9, least_step_change = 0.2, most_step_change = 5;
inline constexpr double least_repeated_change = 0.05;
inline constexpr double first_step_error = 50;
// A member turns no further in a step, rad: rotation vectors are a chart up to 2 pi.
inline constexpr double most_step_turn = 2;
// Slow groups are followed more closely: down to this part of the tolerances, and not beyond those
// of this accuracy (groups/regroup/step-tolerances.h).
inline constexpr double closest_steps = 0.1, finest_accuracy = 1e-6;
// Of the tolerance of velocities where a circle or an ellipsoid rolls.  A coin of 24 mm that
// wobbles without slipping (6 s) gained 0.13 % more than at the finest accuracy at 1, 1e-5 at 0.5
// and less at 0.3, for 1.34 times the steps.
inline constexpr double closer_rolling = 0.3;
// The same where bodies are held, or a multibody on a free base flies, and nothing is touched:
// stops and friction of a chain of three broke its momentum by 7e-5 at 1, by 5e-6 at 0.1.  Two
// boxes that spin about their hold at 4 rad/s lost 2.4e-3 of their angular momentum a second at 1,
// 1.4e-3 at 0.3, 1.8e-5 at 0.1, for 4 times the steps.
inline constexpr double closer_spinning = 0.1;
// Of a circle that rolls the derivatives end at this sine of its slope.
inline constexpr double level_circle = 1e-5;
// Driven bodies: the error of a step, share of the accuracy (the polynomial through it errs by up
// to 13 times as much); by Tsitouras' method where the accuracy is looser than this.
inline constexpr double driven_share = 0.05, loose_accuracy = 1e-5;
// Such a body turns no further in a step, rad; where nothing happens to it a step lasts no longer
// than so many times of sqrt(size / g).
inline constexpr double most_driven_turn = 2, longest_driven_step = 1024;
// Steps of groups follow the accuracy as far as to the first of these, from ten times as much on
// they are a tenth of it, and never looser than the second.  Steps of 1e-4 let a cylinder that
// whirled on its rim gain 4 % of its energy a second, a heap without friction 2 %, those of 1e-5
// nothing.  Looser ones were as many, and a cube that slid down a slope was 20 % off.
inline constexpr double true_steps = 1e-5;
inline constexpr double loosest_steps = 1e-4;

// A hold gives way by this share of the size of the lesser of the two where it carries the weight
// of the lighter, and is damped by this share of critical.
inline constexpr double hold_sag = 2.5e-5, hold_damping = 0.7;

// ---- groups ----
// Boxes of members reach this share of their size farther: a check finds in them whom a member may
// touch before the next one.  What comes from farther in that time is left to collision checks.
inline constexpr double contact_margin = 0.1;
// Between two checks a surface point moves at most this share of its body's size, unless that were
// more often than after this multiple of sqrt(size / g), or 2^most_halvings times as rare; rounded
// to this times a power of two, s, so that the checks of all groups meet.
inline constexpr double most_travel = 0.05, finest_check_times = 0.0175, check_unit = 1.0 / 480;
inline constexpr int most_halvings = 5;
// A check finds a contact as foreseen whose gap differs by at most this share of the static depth
// from that which was followed, and that is at most this share of its size, or as much of a radian,
// elsewhere.
inline constexpr double foreseen_gap = 1e-3, foreseen_way = 1e-4;
// Where all goes on as foreseen a surface point moves at most this share of its body's least width
// between two checks; of what is thin no farther than else.  (A rod of 1:700 among coins took 17
// times as long.)
inline constexpr double most_foreseen = 1;
// Of what is more than this share^-2 times as wide as thick that size is this share of the
// geometric mean of both.  (A coin of 1:150 had five times as many checks, and no smaller errors.)
inline constexpr double thin_check_share = 0.5;
// A body that reaches no farther from its axis of least moment than this share of its radius is
// slender: what spins about such an axis hardly moves.
inline constexpr double slender = 0.25;
// The end test looks so often that what a pair may travel between two looks is at most this share
// of the smaller one; at most so many times, and no arc ends before this share of the finest
// interval.
inline constexpr double travel_unlooked = 0.25, least_arc = 0x1p-11;
inline constexpr int most_looks = 4096;
// At least so often where a contact's point runs along a line or a rim.
inline constexpr double running_looks = 4;
// Where blows follow each other an arc lasts no longer than so many times what the one before did,
// and after the check that ends it so many times that.
inline constexpr double patience_growth = 16;
// Depth that may stay unrepresented to the end of an arc, share of the contact's static depth.
inline constexpr double unseen_depth = 0.5;
// A contact that is new and deeper than so many static depths starts without a load.
inline constexpr double born_depth = 4;
// An arc ends where a contact is deeper than so many times what there is, and so many static depths
// more (of 120 thin scenes none was slow; 4 at 1.5 and 2, 6 at 1.2 and 1).
inline constexpr double phantom_share = 2, phantom_depth = 4;
// And after so many steps: where they are small, contacts are soon other ones.
inline constexpr int most_arc_steps = 64;
// A gap below this share of the static depth counts as touch when impulses are passed on: found at
// the touch, up to rounding.
inline constexpr double touching = 1e-3;

// ---- regions ----
// A group of fewer members always gets new arcs whole.
inline constexpr std::size_t least_divided = 8;
// A region whose border notices becomes so many times as large at once, if so many touch it.
// Without (two more at each end of a chain) an arch of 201 stones that is struck integrates ten
// times what is kept; 1.5 was no better in a broken wall, a net of rings, a card house and an
// arch.
inline constexpr std::size_t region_growth = 2;
// What rests at a border wakes where the force on it changes by this share of its weight.
inline constexpr double wake_share = 0.02;
// What moves there may miss this share of a step's velocity tolerance, for what is missed is lost
// to the body's momentum.  Where the tolerance was 0.01 sqrt(g size) a row of 16 cubes ended
// with 2.8 times its momentum with all of it, with 0.9 % too much with this share (with a tenth 1.0
// %, at 1.3 times the cost).
inline constexpr double missed_share = 0.3;

// ---- rest ----
// A member is slow below this share.  The least watch over it, in times of sqrt(radius / g): what
// falls over gets e times faster in about one of them.
inline constexpr double slow_share = 2e-3, watch_times = 2;
// It settles if its peak in the second half is at most this part of that in the first.  What rolls
// up a slope and turns back is nowhere slower than a third: 1 - t/2 and t - 1 meet at t = 4/3.
inline constexpr double settling = 0.25;
// It trembles in its place if the second peak exceeds the first by no more, and the way made is at
// most this share of peak times time.
inline constexpr double growth = 1.1, drift = 0.1;
// What was always slower than this share has stopped, up to rounding.
inline constexpr double rounding_share = 1e-7;
// What touches nothing has stopped below this one, or where it settles below that.
inline constexpr double stopped_share = 1e-12;
// Where others go on, fewer that could rest are not worth a group of their own: a number, and a
// share of those that hang together.
inline constexpr std::size_t least_resting = 8;
inline constexpr double least_resting_share = 0.25;

// ---- impacts ----
// What still approaches after an impulse with less than this share of what did before is rounding;
// an approach slower than this share of the speeds involved is what an impact before left of them.
inline constexpr double residual_approach = 1e-12, speed_noise = 1e-13;
// Points this close take part in an impact, share of the smaller size over accuracy.
inline constexpr double touch_per_accuracy = 0.1;
// So many impacts in quick succession fuse a pair; the interval that makes them quick is that of
// the contact (soft-impact rule in kernel/loop/impact.cc), or this share of it where nothing
// presses the pair together: such a pair may knock about in a corner for a while, a true collapse
// goes on to ever shorter intervals.
inline constexpr std::uint32_t soft_run = 8;
inline constexpr double free_run_share = 1e-2;
// A body that a kinematic one strikes more often than this at one instant, each time at no less
// than this share of the speed before, is pinned: a contact.  A wall that strikes the first of a
// row of balls that touch strikes it once for each of them.
inline constexpr std::uint32_t pinned_strikes = 32;
inline constexpr double undiminished = 0.99;
// What many impulses leave over is settled at once, to this share of it.
inline constexpr double settled_share = 1e-6;
// A contact carries that presses with this share of the lighter one's weight before the blow: what
// touches without a load, up to rounding and to what swings in a spring, takes a blow of its own.
inline constexpr double carrying_share = 1e-2;
// Ground whose normals are as near as this, by their cosine, carries as one: what lies on many
// pieces lies on all of them.
inline constexpr double one_ground = 0.99;
// What carries takes up a blow where it would be approached by this share of the blow's speed, or
// by what its spring does not bear.
inline constexpr double taken_up_share = 1e-3;
// A pair that takes more blows at one instant has something else to and fro on its other side: that
// carries then.  A cradle's balls strike each other once or twice.
inline constexpr int most_to_and_fro = 8;

}  // namespace tw::answer

namespace tw::guard {
// Impulses at the stops of one multibody at one instant.
inline constexpr int most_stop_impulses = 200;

// Impulses of one impact between two bodies, and of those that a check of a group finds.  What
// approaches still in a group then is settled at once, or, where it cannot be, counted
// (impulses_given_up).
inline constexpr int most_impulses = 200, most_passed_on = 700;
// Contacts that take up a blow together (the work goes with the third power), blows that follow
// from one, and the steps that friction in them may take by Newton's method, sweeps where that
// fails, and how often both begin.
inline constexpr std::size_t most_together = 64;
inline constexpr int most_blows = 1000, most_friction_rounds = 24, most_friction_sweeps = 200;
inline constexpr int most_friction_starts = 3;
// Contacts that are settled at once: the work goes with the fourth power.
inline constexpr std::size_t most_settled = 128;
// Impacts of a pair at one instant, slower than this share of the fusion speed: rounding, they
// fuse.
inline constexpr double grazing = 1e-5;
// More impacts at one instant are a heavy body that comes down on a light one, which impulses would
// stop too slowly: they fuse.  Counted.
inline constexpr std::uint32_t most_repeated = 2000;
// More microsteps at one instant are an error that stops the two, or the group.
inline constexpr std::uint32_t most_microsteps = 1 << 14;

// Loads at the start: inertia is so many times softer than the springs; Newton's steps at most, how
// far each is cut, and what they leave, share of the weight; rounds.
inline constexpr double balance_softness = 1e6, balance_residual = 1e-9;
inline constexpr double least_balance_step = 0x1p-10;
// A contact slides if it gets faster by more than this share of gravity.
inline constexpr double balance_slide = 1e-6;
// What gets faster by less than this share of gravity is in balance.
inline constexpr double balance_stands = 1e-3;
// So many times the load of its spring a contact may bear that was placed as deep as that.
inline constexpr double balance_most_pressed = 8;
inline constexpr int balance_steps = 60, balance_rounds = 4;

// Numbers in the record of one arc (half a gigabyte); more are an error that stops the group.
inline constexpr std::size_t most_arc_numbers = std::size_t{1} << 26;

// Pieces of one span of a motion by a procedure; more are an error: it is rough everywhere.
inline constexpr std::size_t most_motion_pieces = 4096;

}  // namespace tw::guard

namespace tw::cost {

// ---- claims ----
// Boxes are grown by this share of their coordinates: rounding in arcs must not part what touches.
inline constexpr double box_inflation = 1e-9;
// A body that claims and finds nobody several times in a row claims longer windows, each twice the
// one before.  In a gas a single lonely claim says little, and long boxes are looked at by many.
inline constexpr int patience = 3, most_doublings = 20;
// The longest window, s: a body that hardly moves need not claim again for long.
inline constexpr double longest_window = 8;
// A member of a group that turns by less, rad, is worth a box that fits.  What flies turns by more,
// or hardly ever asks: its ball at once.
inline constexpr double hardly_turns = 0.5;

// ---- threads ----
// A helper that finds nothing to do looks on for so long, s, before it sleeps.
inline constexpr double helper_patience = 300e-6;
// Impacts that are decided ahead: how many at once, how many of these are waiting or under way, how
// long before they are due, s, and of how many members their groups may be.
inline constexpr std::size_t most_ahead = 4;
inline constexpr int most_undecided = 2;
inline constexpr double look_ahead = 1e-3;
inline constexpr std::size_t largest_ahead = 16;

// ---- broad phase ----
// A zone reaches beyond its box by this share of the longest edge.
inline constexpr double zone_margin = 0.5;
// A box moves to the next finer level when its longest edge is below this share of that level's
// cells.
inline constexpr double stays_above = 0.75;
// A table has at least this many buckets for each box.
inline constexpr std::size_t buckets_per_box = 2;

// ---- groups with multibodies ----
// Up to so many unknowns are solved for by dense LU.
inline constexpr int most_dense_unknowns = 64;

// ---- certificates ----
// Bounding balls this many radii apart need no distance query.
inline constexpr double far_in_radii = 0.25;
// A certificate shorter than this is worth a second look, s; with a plane that turns along with the
// two, which is followed no longer than this, s.
inline constexpr double soon = 1e-3, longest_turn = 2e-3;
// Which way a turn changes is asked over so many steps of an integrator.
inline constexpr int turning_steps = 16;
// How far ahead the speed of a kinematic body is bounded, s.
inline constexpr double kinematic_horizon = 0.5;

// ---- motion by a procedure ----
// Pieces that are kept; of more the earliest spans are sampled again when they are asked for.
inline constexpr std::size_t kept_motion_pieces = 8192;

// ---- frames ----
// They are written in batches of so many, or when so many states wait for theirs.
inline constexpr std::size_t frame_batch = 512, most_waiting_states = 20000;

}  // namespace tw::cost

namespace tw::patch {

// Points a pair of parts has at most.
inline constexpr std::size_t most_points = 16;
// Of more those are taken that may come below the others by a turn of reach over extent and this
// much more, rad; differences of this share of the extent say nothing.
inline constexpr double least_slope = 1e-3, about_as_low = 1e-5;
// Pairs of faces that are clipped for them: of a fine mesh many are nearly parallel.
inline constexpr std::size_t most_face_pairs = 16;
// Normals this near to that of a face are taken for it: cos 2 degrees of polyhedra, cos 0.2 degrees
// of what is round, where a degree would make a depth wrong by r/6600.
inline constexpr double aligned = 0.99939082701909573, aligned_sine = 0.0348994967025;
inline constexpr double aligned_round = 0.99999390765779;
// Points that are higher than the lowest by no more than this share of what they extend over are
// about as low: which of them is the lowest changes nothing at once.
inline constexpr double as_low = 1e-3;
// Directions of a frustum this near to each other are parallel, this near to square are square:
// sin 0.2 degrees.
inline constexpr double level = 0.0034906514152237;
// Of two faces the one with this much more area is the reference; else that of A.  Areas do not
// depend on poses, so that bodies at rest keep their reference.
inline constexpr double clearly_larger = 1.01;
// What the points of a face may miss of the distance before the nearest features are added: of the
// distance (1 - cos 2 degrees, and as much again); of the size; of a radius.  Eight fixed points of
// a rim that stands flat miss r tilt (1 - cos(pi/8)) < 2.3e-5 r; the nearest point in the place of
// one of them would make it rock for ever.
inline constexpr double missed_ratio = 2e-3, missed_floor = 1e-6, missed_floor_round = 2.5e-5;
// What the two points of lines on a round side that are not parallel, nor cross, may miss of the
// depth between them, of the radius: what a body's own weight presses it in. With less the points
// lie so near to where the lines come nearest that they jump along with it as the body rocks, each
// time onto springs that are wound up.
inline constexpr double missed_along = 2e-4;
// The least part of what they share over which two points are taken: needles that cross have one.
inline constexpr double least_line = 0.1;
// A corner of a contact's polygon that sticks out by no more than this share of half its width, and
// is no deeper than the line between its neighbours, is none: where outlines are equal but for a
// little turn, their sides cross in the middle, or not, as rounding has it.
inline constexpr double straight = 4e-3;
// Sine of the angle between axis and normal below which a frustum stands, 20 degrees; and below
// which it stands flat, on points fixed in it: nearer to upright the lowest point is noise.
inline constexpr double standing = 0.342, standing_flat = 3e-4;
// Sine of the angle from which on two lines cross, 6 degrees: their nearest points run along them
// ten times as fast as the bodies slide.  Flatter ones are a line and two points (missed_along) or
// one, whose gap misses s^2 sine^2/2r when the bodies slide by s.
inline constexpr double crossing = 0.1;
// Points of a rim, and corners of a disc as an outline.
inline constexpr int rim_points = 8, disc_sides = 16;

}  // namespace tw::patch

namespace tw::seam {

// Where pieces of the ground meet (collision/manifold/manifold.h).  Angles from small to large:
// normals that are one another's < what is a face's up to its nearest features < a face along an
// edge; lengths are shares of the size of the bodies in contact.  All change the answer.

// Normals that agree so far are the same, rad; as a cosine.
inline constexpr double same_angle = 1e-4, same_normal = 1 - 5e-9;
// A point over a round neighbour by h may have a normal that is off by this times sqrt(h/r), r its
// sharpest radius, at most half the size: flush with it, it is over it by r turn^2/2.
inline constexpr double flush_turn = 2.2;
// Points on a face of the other body have its normal, up to 2 degrees from that of the nearest
// features and a little more, rad.
inline constexpr double face_angle = 0.04;
// A face that slides along an edge of the ground takes its border along, up to this sine of the
// angle between the two: tilted faces touch it only in passing.
inline constexpr double along_edge = 0.05;
// What lies flat is off by what it is pressed in: such a lean of the normal at a border counts for
// nothing up to the first, for all from the second on, sines.
inline constexpr double least_lean = 1e-3, full_lean = 2e-3;
// Points closer than this are one, and a point so near to a part is held by it.
inline constexpr double same_point = 1e-5;
// What of an edge is so near to a neighbour counts as buried: more than same_point allows.
inline constexpr double buried_margin = 2e-5;
// How far from the surface normals are compared, and how far around a point a face is looked at.
inline constexpr double probe = 0.01;
// In a corner a wall is looked at as far around as this times what is sunk into it.
inline constexpr double corner = 20;
// Walls of the ground that are no farther apart, as a share of `probe`, are inner walls.
inline constexpr double crack = 0.05;
// How steeply a neighbour is looked for beyond a side of a face, rad.
inline constexpr double rises[] = {0, 0.5, 1, 1.4};
// Both ways along the side, as a share of `probe`, a neighbour has to be there.
inline constexpr double aside = 0.3;
// Where it is looked for between the border of a slit and what is in it.
inline constexpr double between[] = {0.25, 0.5, 0.75};
// Bodies may be sunk so deep: a check may find one that moved on into what no contact held, by as
// far as anything moves between two checks.  What is nearer than this to a piece may overlap its
// neighbours.
inline constexpr double sunk = answer::most_travel;
// Along a valley between round pieces: the least sine between their normals, the least cosine by
// which a normal may turn on the way out of the neighbours, and how many of them that may take.
inline constexpr double valley = 0.1, same_side = 0.95;
inline constexpr int most_around = 4;
// Faces of the ground whose heights differ by no more than this share of the size of what stands on
// one of them are one plane; an edge or side that a body meets no deeper below it than `low`, along
// a normal at least 8 degrees off the plane's (cosine), is none.
inline constexpr double flush = 1e-4, low = 2e-3, sideways = 0.99;
// How far a round part is scaled down to be apart from what it overlaps: one of these mostly does.
inline constexpr double shrinking[] = {0.98, 0.9};
// How far beyond the end of an edge, against its depth, the lowest point of a round part may be:
// that is beneath a neighbour, which stands there at up to 76 degrees.
inline constexpr double beyond_end = 4;

}  // namespace tw::seam

namespace tw::stepping {

// ---- what holds within one step of a cluster (integrate/stepped) ----
// Sunk points are pushed out by springs of this share of the substeps' frequency, those on what
// does not move twice as stiff, damped this much beyond critically, m/s at most.
inline constexpr double push_rate = 0.25, damping_ratio = 10, fastest_push = 4;
// Below this speed of approach nothing bounces, m/s.
inline constexpr double least_bounce = 0.1;
// Boxes have this share of the lesser of width and radius as room, and reach as far ahead as the
// body comes in this time, s.
inline constexpr double box_room = 0.2, box_ahead = 0.05;
// A face along which two polyhedra are sunk by no more than this share of the lesser radius is
// taken for the nearest as it was in the last look; what the points on a face may miss of the
// distance, over the size, before the nearest features are added.
inline constexpr double sunk_a_little = 0.01, missed_look = 1e-4;
// Features are sought in the middle of a step where the pair moves by more than this share of its
// size in it.
inline constexpr double look_ahead = 0.02;
// What is sunk deeper than this, m, is looked at after a tenth of the motion.
inline constexpr double deep = 5e-4;
// Lone points between two edges are kept for so many looks: of two axes about as good each look
// finds one.
inline constexpr int kept_looks = 4;
// A contact is the one of the look before if its core point is no farther away than this share of
// the lesser radius.
inline constexpr double same_point = 0.1;
// A pair is at fault where it is deeper than asked for, and than before by this share of that.
inline constexpr double grown = 0.1;

}  // namespace tw::stepping
