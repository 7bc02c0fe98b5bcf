#include "engine/code/experiment/relay_test.h"

namespace tunewright::code {
namespace {

constexpr double kSteady = 0.02;      // largest change of period and amplitude from cycle to cycle
constexpr double kSteadyCycles = 2;   // in a row, without noise
constexpr double kNoiseCycles = 100;  // more of them, times the noise by the amplitude
constexpr double kUsualCycles = 30;   // at most, until they are steady
constexpr double kStuck = 10;         // times the longest half cycle so far
constexpr double kWrongSign = 5;      // the same, in the first half cycle after the sign was found
constexpr double kSureCycles = 3;     // after which the found sign is right
constexpr double kSignCalls = 5;      // with y on one side of the band, to find the sign
constexpr double kPatience = 20;      // more calls before either
constexpr double kLeastLevel = 0.1;   // of u_step, to either side of u0

}  // namespace

RelayTest::RelayTest(const ExperimentOptions& options) : ExperimentFrame("relay", "relay test", options) {
    asymmetry_ =
        setting("asymmetry", options.asymmetry, "levels: u0 + u_step (1 + asymmetry) and u0 - u_step (1 - asymmetry)");
    cycles_wanted_ = setting("cycles", options.cycles, "exactly so many; 0: until the cycle is steady");
    const double sign = options.action == Action::reverse ? 1 : options.action == Action::direct ? -1 : 0;
    sign_ = setting("sign", sign, "of the plant's gain, 1 or -1; 0: found from the first move");
    declare_states();
}

void RelayTest::declare_states() {
    sign_found_ = state("sign_found", "the sign in use; 0: not yet known");
    turned_ = state("turned", "true: the found sign was wrong and has been turned", Type::boolean);
    up_ = state("up", "true: u is at its upper level", Type::boolean);
    u_up_ = state("u_up", "upper level");
    u_down_ = state("u_down", "lower level");
    y_high_ = state("y_high", "largest y - y0 of this cycle");
    y_low_ = state("y_low", "least y - y0 of this cycle");
    cycles_ = state("cycles_done", "complete cycles");
    period_ = state("period", "of the last cycle, in s");
    amplitude_ = state("amplitude", "half the range of y in the last cycle");
    steady_ = state("steady", "cycles in a row that were like the one before");
    t_cycle_ = state("t_cycle", "time at which this cycle began; 0: none yet");
    beyond_ = state("beyond", "calls in a row with y outside the band, until the sign is known");
    longest_half_ = state("longest_half", "longest time between two moves of u");
    half_ = local("half", "time since the last move of u");
    deviation_ = local("deviation", "y - y0");
    error_ = local("error", "the same, with the sign of the gain");
    size_ = local("size", "the same, without a sign");
    period_now_ = local("period_now", "period of the cycle that ends");
    amplitude_now_ = local("amplitude_now", "its amplitude");
    period_change_ = local("period_change", "how much they differ from those before");
    amplitude_change_ = local("amplitude_change", "the same");
}

Block RelayTest::begin() {
    Block block{assign(sign_found_, sign_), assign(turned_, truth(false)), assign(up_, truth(true)),
                assign(u_up_, u0_ + u_step_ * (1 + asymmetry_)), assign(u_down_, u0_ - u_step_ * (1 - asymmetry_))};
    keep_within(block, u_up_, u_min_, u_max_);
    keep_within(block, u_down_, u_min_, u_max_);
    for (const Expr& x : {y_high_, y_low_, cycles_, period_, amplitude_, steady_, t_cycle_, beyond_, longest_half_})
        block.push_back(assign(x, 0.0));
    return block;
}

Expr RelayTest::impossible() {
    const Expr least = kLeastLevel * u_step_;
    return either(inverse(u_up_ - u0_ > least), inverse(u0_ - u_down_ > least));
}

Block RelayTest::first() { return {assign(target_, u_up_)}; }

Block RelayTest::move() {
    return {assign(deviation_, y_ - y0_), assign(half_, t_ - t_phase_), when(sign_found_ != 0.0, relay(), find_sign()),
            when(both(is(ExperimentMode::first_move), half_ > max_time_ / 2), fault(ExperimentReason::no_response))};
}

// At once, because a plant that is unstable leaves no time; one that first moves the wrong way may be misjudged, which
// stuck() mends.
Block RelayTest::find_sign() {
    Block block = take_size(size_, deviation_);
    block.push_back(when(size_ > hysteresis_, {assign(beyond_, beyond_ + 1)}, {assign(beyond_, 0.0)}));
    block.push_back(when(beyond_ > kSignCalls - 1, {assign(longest_half_, half_), assign(sign_found_, 1.0),
                                                    when(deviation_ < 0, {assign(sign_found_, -1.0)})}));
    return block;
}

Block RelayTest::relay() {
    const Expr crosses = either(both(up_, error_ > hysteresis_), both(inverse(up_), error_ < -hysteresis_));
    Block block{assign(error_, sign_found_ * deviation_), when(deviation_ > y_high_, {assign(y_high_, deviation_)}),
                when(deviation_ < y_low_, {assign(y_low_, deviation_)}), when(crosses, switched(), stuck())};
    return block;
}

Block RelayTest::switched() {
    return {when(half_ > longest_half_, {assign(longest_half_, half_)}),
            assign(t_phase_, t_),
            set(ExperimentMode::test),
            assign(up_, inverse(up_)),
            assign(target_, u_down_),
            when(up_, end_of_cycle())};
}

Block RelayTest::end_of_cycle() {
    return {assign(target_, u_up_), when(t_cycle_ > 0, compare()), assign(t_cycle_, t_), assign(y_high_, deviation_),
            assign(y_low_, deviation_)};
}

// Two switches, each late by up to a sample time, and the noise of y as they are timed change a period and an
// amplitude.
Block RelayTest::compare() {
    Block block{assign(period_now_, t_ - t_cycle_), assign(amplitude_now_, (y_high_ - y_low_) / 2)};
    block += take_size(period_change_, period_now_ - period_);
    block += take_size(amplitude_change_, amplitude_now_ - amplitude_);
    const Expr spread = hysteresis_ / 3, part = kSteady * period_now_ + 2 * Ts_;
    const Expr like_period =
        inverse(period_change_ * amplitude_now_ > part * amplitude_now_ + spread * period_now_ / 2);
    const Expr like_amplitude = inverse(amplitude_change_ * period_now_ > part * amplitude_now_ + spread * period_now_);
    block.push_back(when(both(like_period, like_amplitude), {assign(steady_, steady_ + 1)}, {assign(steady_, 0.0)}));
    block.push_back(assign(period_, period_now_));
    block.push_back(assign(amplitude_, amplitude_now_));
    block.push_back(assign(cycles_, cycles_ + 1));
    const Expr settled = steady_ * amplitude_ >= kSteadyCycles * amplitude_ + kNoiseCycles * noise_;
    block.push_back(when(cycles_wanted_ > 0, {when(cycles_ >= cycles_wanted_, end(ExperimentReason::cycles))},
                         {when(settled, end(ExperimentReason::settled),
                               {when(cycles_ >= kUsualCycles, end(ExperimentReason::cycles))})}));
    return block;
}

// With the wrong sign, the move that should bring y back drives it further away.
Block RelayTest::stuck() {
    const Expr far = either(both(up_, error_ < -hysteresis_), both(inverse(up_), error_ > hysteresis_));
    const Expr unsure = both(sign_ == 0.0, both(inverse(turned_), cycles_ < kSureCycles));
    const auto longer_than = [&](double times) { return half_ > times * longest_half_ + kPatience * Ts_; };
    return {when(both(unsure, both(far, longer_than(kWrongSign))),
                 {assign(sign_found_, -sign_found_), assign(turned_, truth(true))},
                 {when(both(is(ExperimentMode::test), longer_than(kStuck)), fault(ExperimentReason::no_response))})};
}

std::vector<std::string> RelayTest::notes() {
    return with_common_notes(
        {"Relay test: u moves between u0 + u_step (1 + asymmetry) and u0 - u_step (1 - asymmetry), each within u_min "
         "and u_max, "
         "whenever y has left a band about y0; u0 and y0 are u and y before the test. The band's half width, the "
         "hysteresis, is three standard deviations of the noise, and more than the sensor's resolution.",
         "It ends when period and amplitude have changed by less than 2 % (and by no more than noise and sample time "
         "explain) in two cycles in a row, with noise in more; or after the cycles that are asked for, at most 30.",
         "sign: that of the plant's gain. 1: y rises with u, the loop's controller is reverse acting; -1: direct "
         "acting; "
         "0: found from the first move. Give it for a plant that is unstable or that first moves the wrong way."});
}

}  // namespace tunewright::code
