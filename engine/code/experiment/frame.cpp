#include "engine/code/experiment/frame.h"

#include <cmath>
#include <numbers>

#include "engine/code/algorithm.h"

namespace tunewright::code {
namespace {

using Reason = ExperimentReason;

std::vector<std::pair<int, std::string>> sentences() {
    const std::pair<Reason, const char*> all[] = {
        {Reason::none, "no test has ended since the start"},
        {Reason::settled, "complete: the response is steady"},
        {Reason::cycles, "complete: the number of cycles is reached"},
        {Reason::by_operator, "ended by the operator"},
        {Reason::sensor, "the measurement is bad: check the sensor and its connection"},
        {Reason::frozen, "the measurement does not change any more: check the sensor"},
        {Reason::y_low, "y fell below y_min: take a smaller u_step, or a lower limit"},
        {Reason::y_high, "y rose above y_max: take a smaller u_step, or a higher limit"},
        {Reason::u_refused, "the actuator reads back another u: is it in automatic, and within its range?"},
        {Reason::clock, "the clock jumped, or a call came too late: call every Ts seconds"},
        {Reason::restarted,
         "start was true in the first call, as after a loss of power: set start to false, then to true"},
        {Reason::no_response, "y did not answer in time: take a larger u_step, check the actuator and the sign"},
        {Reason::time, "the longest time is over: take a longer max_time"},
        {Reason::settings, "the test cannot begin: u before the test is too near to a limit of u, or beyond it"},
    };
    std::vector<std::pair<int, std::string>> out;
    for (const auto& [reason, sentence] : all) out.emplace_back(static_cast<int>(reason), sentence);
    return out;
}

constexpr int kQuietCalls = 30;
constexpr int kLongestCalls = 5000;
constexpr double kStandardDeviations = 3;  // that a single sample exceeds once in 741
constexpr double kFalse = 8;               // standard deviations of the noise: no change of y by noise
constexpr double kLevels = 1.5;            // of the sensor's resolution
constexpr int kUnchangedCalls = 20;        // beyond five of the longest rest of y in the quiet time, it is frozen

Expr as_whole(ExperimentMode mode) { return whole(static_cast<int>(mode)); }

double limit(const std::optional<double>& given, double none) { return given.value_or(none); }

}  // namespace

ExperimentFrame::ExperimentFrame(const char* name, const char* title, const ExperimentOptions& options)
    : Composer(name, title), options_(options) {
    ok_ = optional_input("measurement_ok", "false: the sensor or the connection reports a fault", Type::boolean, 1);
    now_ = optional_input("now", "a clock in s, 0 or more, to notice calls that come late; -1: none", Type::real, -1);
    u_actual_ = optional_input("u_actual", "u that the actuator has accepted in the last call; 1e30: not read back",
                               Type::real, kNoLimit);
    declare_settings();
    declare_states();
}

void ExperimentFrame::declare_settings() {
    const ExperimentOptions& o = options_;
    Ts_ = setting("Ts", o.Ts, "sample time in s: the time from call to call");
    u_step_ = setting("u_step", o.u_step, "size of the moves of u");
    u_min_ = setting("u_min", limit(o.u_min, -kNoLimit), "least u");
    u_max_ = setting("u_max", limit(o.u_max, kNoLimit), "largest u");
    y_min_ = setting("y_min", limit(o.y_min, -kNoLimit), "y below it stops the test");
    y_max_ = setting("y_max", limit(o.y_max, kNoLimit), "y above it stops the test");
    u_safe_ = setting("u_safe", limit(o.u_safe, kNoLimit), "u after a fault; 1e30: as before the test");
    rate_limit_ = setting("rate_limit", o.rate_limit, "largest change of u per second, faults excepted; 0: no limit");
    quiet_time_ = setting("quiet_time", o.quiet_time > 0 ? o.quiet_time : kQuietCalls * o.Ts,
                          "time in s in which u is held and the noise measured");
    max_time_ = setting("max_time", o.max_time > 0 ? o.max_time : kLongestCalls * o.Ts, "longest test in s");
    hysteresis_min_ = setting("hysteresis_min", o.hysteresis, "least hysteresis, in y; more if the noise demands it");
    frozen_time_ = setting("frozen_time", o.frozen_time, "y unchanged for longer, in s, is a fault; 0: by itself");
    longest_gap_ = setting("longest_gap", 5 * o.Ts, "longest time in s between two calls by the clock");
    u_tolerance_ = setting("u_tolerance", std::abs(o.u_step) / 10, "largest difference of u_actual from u");
}

void ExperimentFrame::declare_states() {
    powered_ = state("powered", "false before the first call", Type::boolean);
    start_last_ = state("start_last", "start of the last call", Type::boolean);
    mode_now_ = state("mode_now", "mode of the last call", Type::integer);
    reason_now_ = state("reason_now", "reason of the last end", Type::integer);
    timed_ = state("timed", "true: a clock was given at the start", Type::boolean);
    now_last_ = state("now_last", "clock of the last call");
    t_ = state("t", "time since the start in s");
    t_phase_ = state("t_phase", "time of the last move of u");
    u0_ = state("u0", "u before the test");
    u_last_ = state("u_last", "u of the last call");
    target_ = state("target", "where u goes");
    y0_ = state("y0", "mean of y in the quiet time");
    y_last_ = state("y_last", "y of the last call");
    noise_ = state("noise", "standard deviation of the noise of y");
    hysteresis_ = state("hysteresis", "y must leave this band about y0, to either side");
    calls_ = state("calls", "calls of the quiet time");
    sum_ = state("sum", "sum of y - y_first in the quiet time");
    highest_ = state("highest", "largest y - y_first in the quiet time");
    lowest_ = state("lowest", "the least");
    largest_ = state("largest", "largest change of y in the quiet time");
    second_ = state("second", "the second largest");
    changes_ = state("changes", "sum of the sizes of the changes of y");
    least_change_ = state("least_change", "the smallest of them that is not 0");
    unchanged_ = state("unchanged", "calls in which y did not change");
    run_ = state("run", "calls in a row without a change");
    longest_run_ = state("longest_run", "the longest such run in the quiet time");
}

Expr ExperimentFrame::is(ExperimentMode mode) const { return inverse(mode_now_ != as_whole(mode)); }

Expr ExperimentFrame::runs() const {
    return either(is(ExperimentMode::quiet), either(is(ExperimentMode::first_move), is(ExperimentMode::test)));
}

Statement ExperimentFrame::set(ExperimentMode mode) const { return assign(mode_now_, as_whole(mode)); }

Block ExperimentFrame::end(ExperimentReason reason) const {
    return {set(ExperimentMode::done), assign(reason_now_, whole(static_cast<int>(reason))), assign(target_, u0_)};
}

Block ExperimentFrame::fault(ExperimentReason reason) const {
    return {set(ExperimentMode::stopped), assign(reason_now_, whole(static_cast<int>(reason)))};
}

Block ExperimentFrame::take_size(const Expr& to, const Expr& x) {
    return {assign(to, x), when(to < 0, {assign(to, -to)})};
}

Program ExperimentFrame::build() {
    add(remark("A u_controller that is not a number: the last u in its place."));
    given_ = let("u_given", "u of the controller", u_controller_);
    add(when(given_ != given_, {assign(given_, u_last_)}));
    add_start();
    add_stop();
    running_ = let("running", "true: the test runs", runs());
    add_faults();
    add_noise();
    add(remark("The test."));
    add(when(either(is(ExperimentMode::first_move), is(ExperimentMode::test)), move()));
    add_output();
    Program program = take(notes());
    program.coded_output = "reason";
    program.codes = sentences();
    program.row = {{"t", "t"}, {"u_last", "u"}, {"y_last", "y"}};
    return program;
}

// A first call with `start` true comes after a loss of power in the middle of a test, or of a controller that starts by
// itself: neither may begin one.
void ExperimentFrame::add_start() {
    add(remark("The start."));
    Block restarted = fault(ExperimentReason::restarted);
    restarted.push_back(assign(u0_, given_));
    add(when(both(start_, inverse(powered_)), std::move(restarted),
             {when(both(start_, both(inverse(start_last_), is(ExperimentMode::idle))), begin_all())}));
    add(assign(powered_, truth(true)));
    add(assign(start_last_, start_));
}

Block ExperimentFrame::begin_all() {
    Block block{set(ExperimentMode::quiet), assign(reason_now_, whole(0)), assign(u0_, given_),
                assign(target_, given_),    assign(u_last_, given_),       assign(timed_, now_ >= 0.0)};
    block.push_back(assign(now_last_, now_ - Ts_));
    block.push_back(assign(y_last_, y_));
    block.push_back(assign(y0_, y_));
    block.push_back(assign(t_, -Ts_));
    for (const Expr& x : {t_phase_, noise_, hysteresis_, calls_, sum_, highest_, lowest_, changes_, largest_, second_,
                          least_change_, unchanged_, run_, longest_run_})
        block.push_back(assign(x, 0.0));
    block += begin();
    const Expr outside = inverse(both(u0_ >= u_min_, inverse(u0_ > u_max_)));
    block.push_back(when(either(outside, impossible()), fault(ExperimentReason::settings)));
    return block;
}

// The controller follows u while mode is not 0: it has followed the last u when it takes over.
void ExperimentFrame::add_stop() {
    add(remark("The end by the operator: u goes back first, then the controller has it."));
    const Expr returns = both(is(ExperimentMode::done), u_last_ != target_);
    add(assign(u_, given_));
    add(assign(recording_, truth(false)));
    add(when(inverse(start_), {when(runs(), end(ExperimentReason::by_operator),
                                    {when(both(mode_now_ != whole(0), inverse(returns)),
                                          {assign(u_, u_last_), set(ExperimentMode::idle)})})}));
    add(when(is(ExperimentMode::idle), {assign(u_last_, u_)}));
}

void ExperimentFrame::check(const Expr& where, const Expr& wrong, ExperimentReason reason) {
    Block block = fault(reason);
    block.push_back(assign(running_, truth(false)));
    block.push_back(assign(watched_, truth(false)));
    add(when(both(where, wrong), std::move(block)));
}

void ExperimentFrame::add_faults() {
    add(remark("The faults, the gravest first. A value that is not a number equals nothing, itself included."));
    dt_ = let("elapsed_now", "time since the last call in s", Ts_);
    add(when(timed_, {assign(dt_, now_ - now_last_)}));
    difference_ = local("difference", "of u_actual from u");
    add(take_size(difference_, u_actual_ - u_last_));
    watched_ = let("watched", "true: u is the test's, also after its end", either(running_, is(ExperimentMode::done)));
    check(watched_, either(inverse(ok_), y_ != y_), ExperimentReason::sensor);
    check(running_, inverse(both(dt_ > 0, inverse(dt_ > longest_gap_))), ExperimentReason::clock);
    const Expr refused = either(u_actual_ != u_actual_, both(u_actual_<kNoLimit, difference_> u_tolerance_));
    check(running_, both(t_ >= 0.0, refused), ExperimentReason::u_refused);
    check(watched_, y_ < y_min_, ExperimentReason::y_low);
    check(watched_, y_ > y_max_, ExperimentReason::y_high);

    add(when(running_, {assign(t_, t_ + dt_), when(inverse(calls_ > 0), {assign(t_, 0.0)})}));
    add(assign(now_last_, now_));
    change_ = local("change", "size of the change of y");
    add(take_size(change_, y_ - y_last_));
    add(when(change_ > 0, {assign(run_, 0.0)}, {assign(run_, run_ + 1)}));
    const Expr after_quiet = inverse(is(ExperimentMode::quiet));
    const Expr by_time = both(frozen_time_ > 0, run_ * Ts_ > frozen_time_);
    const Expr by_itself = both(both(inverse(frozen_time_ > 0), after_quiet),
                                both(changes_ > 0, run_ > 5 * longest_run_ + kUnchangedCalls));
    check(running_, either(by_time, by_itself), ExperimentReason::frozen);
    check(running_, t_ > max_time_, ExperimentReason::time);
}

void ExperimentFrame::add_noise() {
    add(remark("The quiet time: the noise of y, from its changes from call to call."));
    const Expr beside = y_ - y0_;
    Block quiet{assign(calls_, calls_ + 1), assign(sum_, sum_ + beside),
                when(beside > highest_, {assign(highest_, beside)}), when(beside < lowest_, {assign(lowest_, beside)}),
                when(change_ > largest_, {assign(second_, largest_), assign(largest_, change_)},
                     {when(change_ > second_, {assign(second_, change_)})})};
    const Expr smallest = either(inverse(least_change_ > 0), change_ < least_change_);
    quiet.push_back(when(calls_ > 1, {assign(changes_, changes_ + change_),
                                      when(change_ > 0, {when(smallest, {assign(least_change_, change_)})},
                                           {assign(unchanged_, unchanged_ + 1)}),
                                      when(run_ > longest_run_, {assign(longest_run_, run_)})}));
    quiet.push_back(when(both(t_ >= quiet_time_, calls_ > 9), end_of_quiet()));
    add(when(both(running_, is(ExperimentMode::quiet)), std::move(quiet)));
}

// A single false value makes two large changes: both are left out if they stand far above the others, and so are the
// highest and the lowest value.
Block ExperimentFrame::end_of_quiet() {
    const double deviations = std::sqrt(std::numbers::pi) / 2;  // of a mean difference
    Block block{assign(noise_, deviations * (changes_ - largest_ - second_) / (calls_ - 3))};
    block.push_back(when(largest_ > kFalse * noise_, {assign(y0_, y0_ + (sum_ - highest_ - lowest_) / (calls_ - 2))},
                         {assign(noise_, deviations * changes_ / (calls_ - 1)), assign(y0_, y0_ + sum_ / calls_)}));
    block.push_back(assign(hysteresis_, kStandardDeviations * noise_));
    // If y often stays as it is, its smallest change is the sensor's resolution.
    block.push_back(when(both(5 * unchanged_ > calls_, kLevels * least_change_ > hysteresis_),
                         {assign(hysteresis_, kLevels * least_change_)}));
    block.push_back(when(hysteresis_min_ > hysteresis_, {assign(hysteresis_, hysteresis_min_)}));
    block.push_back(assign(t_phase_, t_));
    block.push_back(set(ExperimentMode::first_move));
    block += first();
    return block;
}

std::vector<std::string> ExperimentFrame::with_common_notes(std::vector<std::string> own) {
    own.insert(
        own.end(),
        {"Wiring: u_controller is the output of the loop's controller, u goes to the actuator. While mode is not 0, "
         "keep the controller in manual with u as its manual output; it then takes over without a jump.",
         "start: when it rises, u is held for quiet_time, in which the noise of y and its level y0 are measured; "
         "then the test begins. It ends by itself with u as before the test. When start falls, a running test ends "
         "at once in the same way. Each call with recording true gives one row t, u, y of the record.",
         "Faults: a bad measurement (measurement_ok false, or not a number), one that stays the same for too long, "
         "y beyond y_min or y_max, an actuator that reads back another u, a clock that jumps, a start that is true "
         "in the first call, as after a loss of power, no response, max_time. From that call on u is u_safe, or u "
         "as before the test, until start falls. reason says which fault it was."});
    return own;
}

void ExperimentFrame::add_output() {
    add(remark("u: towards its target within its rate; after a fault the safe value at once."));
    const Expr moves = inverse(either(is(ExperimentMode::idle), is(ExperimentMode::stopped)));
    const Expr low = local("low", "least u of this call"), high = local("high", "largest u of this call");
    Block to_target{
        assign(low, u_min_), assign(high, u_max_),
        when(rate_limit_ > 0, {assign(low, u_last_ - rate_limit_ * dt_), assign(high, u_last_ + rate_limit_ * dt_)}),
        assign(u_, target_)};
    keep_within(to_target, u_, low, high);
    keep_within(to_target, u_, u_min_, u_max_);
    add(when(moves, std::move(to_target)));
    add(when(is(ExperimentMode::stopped), {assign(u_, u0_), when(u_safe_ < kNoLimit, {assign(u_, u_safe_)})}));
    add(remark("For the next call, and the row of the record."));
    add(assign(recording_, running_));
    add(assign(u_last_, u_));
    add(assign(y_last_, y_));
    add(assign(mode_, mode_now_));
    add(assign(reason_, reason_now_));
}

}  // namespace tunewright::code
