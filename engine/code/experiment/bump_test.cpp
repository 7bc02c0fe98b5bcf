#include "engine/code/experiment/bump_test.h"

namespace tunewright::code {
namespace {

constexpr double kGrowth = 1.25;      // from the end of a window of time to that of the next
constexpr double kFirstWindow = 10;   // calls
constexpr double kSteady = 0.02;      // largest change of the mean of y from window to window, by its whole change
constexpr double kSteadyWindows = 2;  // in a row
constexpr double kLeastLevel = 0.1;   // of u_step

}  // namespace

BumpTest::BumpTest(const ExperimentOptions& options) : ExperimentFrame("bump", "step test", options) {
    y_move_ = setting("y_move", options.y_move, "the step ends when y has moved so far; 0: when y has settled");
    level_ = state("level", "u of the step");
    window_end_ = state("window_end", "time since the move at which this window ends");
    window_sum_ = state("window_sum", "sum of y - y0 in it");
    window_calls_ = state("window_calls", "calls in it");
    windows_ = state("windows", "complete windows since the move");
    mean_ = state("mean", "mean of y - y0 in the last window");
    steady_ = state("steady", "windows in a row that were like the one before");
    moved_ = state("moved", "true: y has left the band", Type::boolean);
    up_time_ = state("up_time", "how long u was at its level, in s");
    deviation_ = local("deviation", "y - y0");
    size_ = local("size", "a size without its sign");
    elapsed_ = local("elapsed", "time since the last move of u");
    mean_now_ = local("mean_now", "mean of the window that ends");
    mean_change_ = local("mean_change", "how much it differs from the one before");
}

Block BumpTest::begin() {
    Block block{assign(level_, u0_ + u_step_), assign(moved_, truth(false))};
    keep_within(block, level_, u_min_, u_max_);
    for (const Expr& x : {window_end_, window_sum_, window_calls_, windows_, mean_, steady_, up_time_})
        block.push_back(assign(x, 0.0));
    return block;
}

Expr BumpTest::impossible() {
    const Expr way = (level_ - u0_) / u_step_;
    return inverse(way > kLeastLevel);
}

Block BumpTest::first() { return {assign(target_, level_), assign(window_end_, kFirstWindow * Ts_)}; }

Block BumpTest::move() {
    Block block{assign(deviation_, y_ - y0_), assign(elapsed_, t_ - t_phase_),
                assign(window_sum_, window_sum_ + deviation_), assign(window_calls_, window_calls_ + 1)};
    block += take_size(size_, deviation_);
    block.push_back(when(size_ > 2 * hysteresis_, {assign(moved_, truth(true))}));
    const Expr far = both(y_move_ > 0, size_ >= y_move_);
    block.push_back(
        when(is(ExperimentMode::first_move),
             {when(far, go_back(),
                   {when(elapsed_ > max_time_ / 2, {when(moved_, go_back(), fault(ExperimentReason::no_response))})})},
             {when(elapsed_ > up_time_, end(ExperimentReason::settled))}));
    block.push_back(when(both(is(ExperimentMode::first_move), elapsed_ >= window_end_), window()));
    return block;
}

Block BumpTest::window() {
    Block block{assign(mean_now_, window_sum_ / window_calls_)};
    block += take_size(mean_change_, mean_now_ - mean_);
    block.push_back(when(both(windows_ > 0, moved_), compare()));
    block.push_back(when(steady_ >= kSteadyWindows, go_back()));
    block.push_back(assign(mean_, mean_now_));
    block.push_back(assign(windows_, windows_ + 1));
    block.push_back(assign(window_sum_, 0.0));
    block.push_back(assign(window_calls_, 0.0));
    block.push_back(assign(window_end_, kGrowth * window_end_ + Ts_));
    return block;
}

// Each of two means of at least ten values has a third of the noise.
Block BumpTest::compare() {
    Block block = take_size(size_, mean_now_);
    block.push_back(
        when(mean_change_ > kSteady * size_ + noise_ / 2, {assign(steady_, 0.0)}, {assign(steady_, steady_ + 1)}));
    return block;
}

Block BumpTest::go_back() {
    return {set(ExperimentMode::test), assign(up_time_, elapsed_), assign(t_phase_, t_), assign(target_, u0_)};
}

std::vector<std::string> BumpTest::notes() {
    return with_common_notes(
        {"Step test: u moves by u_step, within u_min and u_max, until y has settled, and back for as long. y has "
         "settled "
         "when two means in a row, each over the last fifth of the time since the step, differ by less than 2 % of the "
         "whole change and no more than the noise explains. y_move ends the step earlier: needed for a plant that "
         "integrates; a plant that is unstable needs the relay test."});
}

}  // namespace tunewright::code
