// One step of a pass of sampling to a goal, chosen when the pipeline is built.
#include "state.glsl"
#include "statistics.glsl"
#include "unseen.glsl"
#include "sums.glsl"
#include "raise.glsl"
#include "allocation.glsl"
#include "draws.glsl"

layout(constant_id = ID_GOAL_STEP) const uint GOAL_STEP = 0u;

void main() {
    if (GOAL_STEP == STEP_TAKE_COUNTS) take_counts();
    if (GOAL_STEP == STEP_REPLACE) replace();
    if (GOAL_STEP == STEP_SEE) see();
    if (GOAL_STEP == STEP_SUM_ROWS) sum_rows();
    if (GOAL_STEP == STEP_FIND_VARIANCES) find_variances();
    if (GOAL_STEP == STEP_FIND_UNSEEN) find_unseen();
    if (GOAL_STEP == STEP_SUM_PARTIALS) sum_partials();
    if (GOAL_STEP == STEP_SPREAD_DISCOVERIES) spread_discoveries();
    if (GOAL_STEP == STEP_RAISE_LISTED) raise_listed();
    if (GOAL_STEP == STEP_RAISE_TO_FLOORS) raise_to_floors();
    if (GOAL_STEP == STEP_FILL_BINS) fill_bins();
    if (GOAL_STEP == STEP_SOLVE) solve();
    if (GOAL_STEP == STEP_CHOOSE_COUNTS) choose_counts();
    if (GOAL_STEP == STEP_LIST_BATCHES) list_batches();
    if (GOAL_STEP == STEP_LIST_PARTS) list_parts();
    if (GOAL_STEP == STEP_END_PARTS) end_parts();
    if (GOAL_STEP == STEP_ADD_PARTS) add_parts();
    if (GOAL_STEP == STEP_PLAN_ALL) plan_all();
    if (GOAL_STEP == STEP_SUM_CAPPED) sum_capped();
    if (GOAL_STEP == STEP_WEIGH_CELLS) weigh_cells();
    if (GOAL_STEP == STEP_SUM_MASSES) sum_masses();
    if (GOAL_STEP == STEP_DRAW_PIXELS) draw_pixels();
    if (GOAL_STEP == STEP_DRAW_PARTS) draw_parts();
    if (GOAL_STEP == STEP_SUM_DRAWS) sum_draws();
    if (GOAL_STEP == STEP_FIND_MEANS) find_means();
}
