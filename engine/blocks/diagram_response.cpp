#include "engine/blocks/diagram_response.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/blocks/diagram_steps.h"
#include "engine/blocks/within_step.h"
#include "engine/numerics/cubic.h"
#include "engine/simulation/run/delayed_input.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSameInstant = 1e-9;  // of the shortest step
constexpr double kOfDeadTime = 0.25;   // first step over the shortest dead time
constexpr double kOfRate = 0.1;        // first step times the fastest rate
// Passages through dead times after which a jump no longer counts: it has become a change of a higher derivative, which
// shorter steps follow. Several dead times have hundreds of sums.
constexpr int kEchoes = 4, kEchoesOfMany = 3, kEchoesAtLowAccuracy = 2;
constexpr std::size_t kMany = 4;  // delayed signals
constexpr double kLowAccuracy = 1e-5;
// Frequencies, of 1/time_scale, from which the values at 0 are extrapolated. A lower one is taken where its error is
// this much less: the slope's rounding grows as 1/h.
constexpr std::array<double, 3> kNearZero = {4e-5, 1e-6, 2e-8};
constexpr double kMuchLess = 1e-3;
constexpr double kManyRates = 2;         // of a step that is used once: a longer one is put together of usual ones
constexpr double kFinalErrors = 2;       // the final value's rounding is up to twice the third difference's
constexpr double kMaxFinalError = 1e-8;  // of the signal's largest value
constexpr double kLongestRun = 1e6;      // of time_scale: what has not come to rest by then stays near its rounding
constexpr double kNoError = 1e-9;        // of the step: the error's final value
constexpr double kNoErrorOfPeak = 1e-7;  // the same, of the largest value of y
constexpr double kOneLevel = 16;         // by which half the step lowers the error
constexpr double kUnbounded = 1e6;
constexpr int kLookAtRounding = 16;  // steps between two looks at the parts of signals
constexpr double kRounding = 1e-8;   // of those parts: a signal that is smaller counts as that large

/// The signal's value before t = 0 and after, on either side of a jump.
struct Sides {
    Signal before, after;
};

}  // namespace

class DiagramRun {
public:
    DiagramRun(const BlockDiagram& diagram, const DiagramSystem& system, const std::vector<DiagramStep>& steps,
               const DiagramResponseOptions& options)
        : system_(system),
          options_(options),
          w_(VectorXd::Zero(system.signals())),
          z_(VectorXd::Zero(system.states())),
          cursor_(system.delayed.size(), 0),
          v_(VectorXd::Zero(Index(system.delayed.size()))),
          v_slope_(v_),
          end_(v_),
          end_slope_(v_),
          echoes_(echoes_that_count(largest_direct(system), options.tolerance, smoothing(system, options))),
          stopping_(options.settled, diagram.total_dead_time()) {
        for (const DiagramStep& step : steps) w_[step.signal] += step.size;
        input_ = system.H * w_;
        const Index n = system.states(), inputs = v_.size(), count = system.signals();
        to_node_ = Eigen::MatrixXd::Zero(2 * count, n + 2 * inputs);
        to_node_.topLeftCorner(count, n) = system.M;
        to_node_.block(0, n, count, inputs) = system.N;
        to_node_.bottomLeftCorner(count, n) = system.M * system.F;
        to_node_.block(count, n, count, inputs) = system.M * system.G;
        to_node_.bottomRightCorner(count, inputs) = system.N;
        of_inputs_.resize(2 * count);
        of_inputs_ << system.R * w_, system.M * input_;
        at_node_.resize(n + 2 * inputs);
        in_step_.resize(n + 4 * inputs);
        out_.signals_ = static_cast<int>(system.signals());
        out_.inputs_.assign(w_.data(), w_.data() + w_.size());
        largest_ = VectorXd::Zero(system.signals());
        final_error_ = largest_;
        if (!options.horizon) {
            set_final(diagram);
            longest_ = kLongestRun * diagram.time_scale();
        }
        steps_.emplace(system.F, system.G, input_, 1);
        double h0 = kOfRate / std::max(steps_->rate(), 1e-300);
        for (const auto& delayed : system.delayed) h0 = std::min(h0, kOfDeadTime * delayed.L);
        if (options.horizon) h0 = std::min(h0, *options.horizon);
        steps_.emplace(system.F, system.G, input_, h0);
        slack_ = kSameInstant * h0;
    }

    DiagramResponse run() {
        add_node(0);
        for (const auto& delayed : system_.delayed) echoes_.add(delayed.L, 1, slack_);
        for (int step = 0; step < options_.max_steps; ++step) {
            const double t = out_.t_.back();
            if (options_.horizon ? t >= *options_.horizon - slack_ : stopping_.has_settled(t)) return std::move(out_);
            if (t > longest_) break;
            if (largest_.maxCoeff() > kUnbounded * (1 + w_.cwiseAbs().maxCoeff()) && !options_.horizon) break;
            choose_level();
            take_step(t);
            if (!node_.allFinite()) {
                drop_overflow();
                break;
            }
        }
        out_.settles_ = false;
        return std::move(out_);
    }

private:
    struct Step {
        double h;
        const ManyInputsStep* of_level;  ///< null: used once
    };

    static int smoothing(const DiagramSystem& system, const DiagramResponseOptions& options) {
        if (options.tolerance > kLowAccuracy) return kEchoesAtLowAccuracy;
        return system.delayed.size() > kMany ? kEchoesOfMany : kEchoes;
    }
    static double largest_direct(const DiagramSystem& system) {
        return system.N.size() > 0 ? std::min(0.99, system.N.cwiseAbs().maxCoeff()) : 0;
    }

    /// The signals' transforms times s at s = 0 and their slope there. A loop that is far slower than its parts needs
    /// lower frequencies, large values near 0 need higher ones: for each signal those whose values fit a cubic best.
    void set_final(const BlockDiagram& diagram) {
        const auto count = static_cast<std::size_t>(system_.signals());
        final_error_ = VectorXd::Constant(system_.signals(), std::numeric_limits<double>::infinity());
        out_.final_.assign(count, 0);
        out_.slope_.assign(count, 0);
        for (const double near : kNearZero) extrapolate(diagram, near / diagram.time_scale());
    }

    /// From the cubic through h to 4 h.
    void extrapolate(const BlockDiagram& diagram, double h) {
        std::array<VectorXd, 4> at;
        for (std::size_t i = 0; i < at.size(); ++i) {
            at[i] = VectorXd::Zero(system_.signals());
            for (Index k = 0; k < w_.size(); ++k)
                if (w_[k] != 0) at[i] += w_[k] * diagram.response(double(i + 1) * h, int(k)).real();
        }
        const VectorXd value = 4 * at[0] - 6 * at[1] + 4 * at[2] - at[3],
                       slope = (-26 * at[0] + 57 * at[1] - 42 * at[2] + 11 * at[3]) / (6 * h);
        // The third difference is the rounding of the four values, and what a parabola through three of them misses.
        const VectorXd error = (at[0] - 3 * at[1] + 3 * at[2] - at[3]).cwiseAbs();
        for (Index i = 0; i < error.size(); ++i) {
            if (!(error[i] < kMuchLess * final_error_[i])) continue;
            final_error_[i] = error[i];
            out_.final_[std::size_t(i)] = value[i];
            out_.slope_[std::size_t(i)] = slope[i];
        }
    }

    /// The values of all signals, then their slopes.
    void compute_node(const VectorXd& z, const VectorXd& v, const VectorXd& v_slope) {
        at_node_ << z, v, v_slope;
        node_.noalias() = to_node_ * at_node_;
        node_ += of_inputs_;
    }

    void add_node(double t) {
        compute_node(z_, v_, v_slope_);
        const auto x = node_.head(out_.signals_);
        out_.t_.push_back(t);
        out_.values_.insert(out_.values_.end(), node_.data(), node_.data() + node_.size());
        largest_ = largest_.cwiseMax(x.cwiseAbs());
        if (out_.t_.size() % kLookAtRounding == 0)
            // Signals that are differences of larger parts, such as after an exact feedforward, are not followed into
            // their rounding.
            largest_ = largest_.cwiseMax(kRounding * (to_node_.topRows(x.size()).cwiseAbs() * at_node_.cwiseAbs() +
                                                      of_inputs_.head(x.size()).cwiseAbs()));
        if (options_.horizon) return;
        double worst = 0;
        for (Index i = 0; i < x.size(); ++i) {
            const double unknown = std::min(kFinalErrors * final_error_[i], kMaxFinalError * largest_[i]),
                         from_rest = std::abs(x[i] - out_.final_[std::size_t(i)]) - unknown;
            if (largest_[i] > 0) worst = std::max(worst, from_rest / largest_[i]);
        }
        stopping_.note(t, worst, 1, 0, 1);
    }

    /// Drops the last nodes whose values left the numbers.
    void drop_overflow() {
        const auto size = static_cast<std::size_t>(node_.size());
        const auto is_finite = [](double value) { return std::isfinite(value); };
        while (out_.t_.size() > 1 && !std::all_of(out_.values_.end() - node_.size(), out_.values_.end(), is_finite)) {
            out_.t_.pop_back();
            out_.values_.resize(out_.values_.size() - size);
        }
    }

    /// Delayed signal k on either side of a time that is not after the last node.
    Sides delayed_at(std::size_t k, double t) {
        const auto& [from, L] = system_.delayed[k];
        const double then = t - L;
        if (then < -slack_) return {};
        auto& i = cursor_[k];
        const auto& times = out_.t_;
        while (i + 1 < times.size() && times[i + 1] < then - slack_) ++i;
        while (i > 0 && times[i] >= then - slack_) --i;
        // times[i] lies before, or i is 0.
        std::size_t last = i;
        while (last + 1 < times.size() && times[last + 1] <= then + slack_) ++last;
        const bool at_first = std::abs(times[i] - then) <= slack_;
        if (last > i || at_first) {
            const std::size_t first = at_first ? i : i + 1;
            const bool start = first == 0;
            return {start ? Signal{} : out_.at(first, from), out_.at(last, from)};
        }
        const double h = times[i + 1] - times[i], s = then - times[i];
        const Cubic c = hermite_taylor(h, out_.at(i, from), out_.at(i + 1, from));
        const Signal here{value_at(c, s), slope_at(c, s)};
        return {here, here};
    }

    void choose_level() {
        if (equal_steps_ < 2) return;
        const std::size_t last = out_.t_.size() - 1;
        const double h = out_.t_[last] - out_.t_[last - 2];
        double worst = worst_within_;
        for (int i = 0; i < out_.signals_; ++i) {
            if (!(largest_[i] > 0)) continue;
            const double middle = hermite_midpoint(h, out_.at(last - 2, i), out_.at(last, i));
            worst = std::max(worst, std::abs(out_.at(last - 1, i).value - middle) / largest_[i]);
        }
        if (worst <= options_.tolerance) {
            ++level_;
            equal_steps_ = 0;
        } else if (worst > kOneLevel * options_.tolerance && level_ > 0) {
            --level_;
            equal_steps_ = 0;
        }
    }

    void take_step(double t) {
        double h = std::ldexp(steps_->h0(), level_);
        double until = t + h;
        const auto echo = echoes_.next();
        bool odd = false;
        if (echo && *echo <= until + slack_) {
            odd = std::abs(*echo - until) > slack_;
            until = *echo;
        }
        if (options_.horizon && *options_.horizon <= until + slack_) {
            odd = odd || std::abs(*options_.horizon - until) > slack_;
            until = *options_.horizon;
        }
        int level = level_;
        const bool approaches = odd && (until - t) * steps_->rate() > kManyRates;
        if (approaches) {
            level = std::min(level_, static_cast<int>(std::log2((until - t) / steps_->h0())));
            until = t + std::ldexp(steps_->h0(), level);
            odd = false;
        }
        if (until - t > steps_->h0() + slack_ && !follows_inputs(t, until)) return shorten(level);
        if (!(odd ? odd_step(until - t, until) : usual_step(level, until))) return shorten(level);
        equal_steps_ = odd || approaches ? 0 : equal_steps_ + 1;
        if (const auto passages = echoes_.pass(until + slack_)) pass_echo(until, *passages);
    }

    void shorten(int level) {
        level_ = level - 1;
        equal_steps_ = 0;
    }

    void pass_echo(double t, int passages) {
        bool jumps = false;
        for (std::size_t k = 0; k < system_.delayed.size(); ++k) {
            const Sides sides = delayed_at(k, t);
            jumps = jumps || sides.before.value != sides.after.value || sides.before.slope != sides.after.slope;
            v_[Index(k)] = sides.after.value;
            v_slope_[Index(k)] = sides.after.slope;
            echoes_.add(t + system_.delayed[k].L, passages + 1, slack_);
        }
        if (!jumps) return;
        add_node(t);
        level_ = 0;
        equal_steps_ = 0;
    }

    /// True if cubics follow the delayed signals that are known: what was short when it left may arrive in a long step.
    bool follows_inputs(double t, double until) {
        const double h = until - t;
        for (std::size_t k = 0; k < system_.delayed.size(); ++k) {
            const double largest = largest_[system_.delayed[k].from];
            if (system_.delayed[k].L < h - slack_ || !(largest > 0)) continue;
            const Signal middle = delayed_at(k, t + 0.5 * h).before, end = delayed_at(k, until).before;
            const double expected = hermite_midpoint(h, {v_[Index(k)], v_slope_[Index(k)]}, end);
            if (std::abs(middle.value - expected) > kOneLevel * options_.tolerance * largest) return false;
        }
        return true;
    }

    /// False: what enters and leaves within the step is not determined.
    bool advance(const Step& step, const WithinStep& within, double until) {
        const std::size_t now = out_.t_.size() - 1;
        if (!within.solvable()) return false;
        for (std::size_t k = 0; k < system_.delayed.size(); ++k) {
            const bool known = system_.delayed[k].L >= step.h - slack_;
            const Signal end = known ? delayed_at(k, until).before : Signal{};
            end_[Index(k)] = end.value;
            end_slope_[Index(k)] = end.slope;
        }
        step_to_end(step);
        worst_within_ = 0;
        if (!within.empty()) {
            compute_node(next_, end_, end_slope_);
            const auto& unknown = within.signals();
            const Index count = Index(unknown.size());
            left_.resize(2 * count);
            for (Index k = 0; k < count; ++k) {
                const int from = system_.delayed[unknown[std::size_t(k)]].from;
                const Signal left =
                    within.left(std::size_t(k), out_.at(now, from).value, {node_[from], node_[out_.signals_ + from]});
                left_[k] = left.value;
                left_[count + k] = left.slope;
            }
            const VectorXd ends = within.solve(left_);
            for (Index k = 0; k < count; ++k) {
                const Index signal = Index(unknown[std::size_t(k)]);
                const Signal end{ends[k], ends[count + k]};
                end_[signal] = end.value;
                end_slope_[signal] = end.slope;
                note_parabola(step.h, signal, end);
            }
            step_to_end(step);
        }
        z_.swap(next_);
        v_.swap(end_);
        v_slope_.swap(end_slope_);
        add_node(until);
        return true;
    }

    /// The error of a parabola in the middle of the step, from the slope at its start.
    void note_parabola(double h, Index signal, const Signal& end) {
        const double largest = largest_[system_.delayed[std::size_t(signal)].from];
        if (!(largest > 0)) return;
        const double error =
            value_at(parabola(h, v_[signal], end), 0.5 * h) - hermite_midpoint(h, {v_[signal], v_slope_[signal]}, end);
        worst_within_ = std::max(worst_within_, std::abs(error) / largest);
    }

    /// The states at the end of a step, from cubics through both ends of the delayed signals.
    void step_to_end(const Step& step) {
        const Index n = z_.size(), inputs = v_.size();
        in_step_.head(n) = z_;
        for (Index k = 0; k < inputs; ++k) {
            const Signal end{end_[k], end_slope_[k]};
            const Cubic c = system_.delayed[std::size_t(k)].L < step.h - slack_
                                ? parabola(step.h, v_[k], end)
                                : hermite_taylor(step.h, {v_[k], v_slope_[k]}, end);
            for (std::size_t j = 0; j < c.size(); ++j) in_step_[n + Index(j) * inputs + k] = c[j];
        }
        if (step.of_level == nullptr) {
            next_ = steps_->after(step.h, in_step_, true);
            return;
        }
        next_.noalias() = step.of_level->all * in_step_;
        next_ += step.of_level->constant;
    }

    WithinStep within(const ManyInputsStep& map) const {
        return {system_, map.h, [&map](const VectorXd& input) { return VectorXd(map.all * input); }, to_node_, slack_};
    }

    bool usual_step(int level, double until) {
        const ManyInputsStep& map = steps_->level(level);
        while (within_.size() <= std::size_t(level)) within_.emplace_back();
        auto& own = within_[std::size_t(level)];
        if (!own) own.emplace(within(map));
        return advance({map.h, &map}, *own, until);
    }

    bool odd_step(double h, double until) {
        const auto after = [&](const VectorXd& input) { return steps_->after(h, input, false); };
        return advance({h, nullptr}, WithinStep(system_, h, after, to_node_, slack_), until);
    }

    const DiagramSystem& system_;
    const DiagramResponseOptions& options_;
    VectorXd w_, input_, z_;
    std::vector<std::size_t> cursor_;  // of each delayed signal: a node before it
    VectorXd v_, v_slope_;             // now, after a jump
    VectorXd end_, end_slope_, next_;  // the same and the states, at the end of a step
    Eigen::MatrixXd to_node_;          // from states, delayed signals and their slopes to all signals and slopes
    VectorXd of_inputs_, at_node_, in_step_, node_, left_;
    Echoes echoes_;
    StoppingRule stopping_;
    DiagramResponse out_;
    VectorXd largest_;      // of each signal so far
    VectorXd final_error_;  // of final_, which is not known better
    double longest_ = std::numeric_limits<double>::infinity();
    std::optional<ManyInputsPropagator> steps_;
    std::vector<std::optional<WithinStep>> within_;  // of each level
    double slack_ = 0;
    double worst_within_ = 0;  // error of the parabolas of the last step, over each signal's largest value
    int level_ = 0, equal_steps_ = 0;
};

Expected<DiagramResponse> DiagramResponse::of(const BlockDiagram& diagram, const std::vector<DiagramStep>& steps,
                                              const DiagramResponseOptions& options) {
    const auto system = make_system(diagram);
    if (!system) return system.error();
    return DiagramRun(diagram, *system, steps, options).run();
}

StepResponse DiagramResponse::pair(int y, int u, double r) const {
    StepResponse out;
    out.settles = settles_;
    if (!final_.empty()) {
        out.y_final = final_[std::size_t(y)];
        out.u_final = final_[std::size_t(u)] - inputs_[std::size_t(u)];
        double largest = 0;
        for (std::size_t i = 0; i < t_.size(); ++i) largest = std::max(largest, std::abs(at(i, y).value));
        if (std::abs(r - out.y_final) <= std::max(kNoError * std::max(1.0, std::abs(r)), kNoErrorOfPeak * largest))
            out.error_integral_final = -slope_[std::size_t(y)];
    }
    out.nodes.reserve(t_.size());
    double integral = 0;
    for (std::size_t i = 0; i < t_.size(); ++i) {
        const Signal own = at(i, y), output = at(i, u);
        if (i > 0) {
            const double h = t_[i] - t_[i - 1];
            integral += h * r - hermite_integral(h, at(i - 1, y), own);
        }
        out.nodes.push_back(
            {t_[i], own.value, own.slope, output.value - inputs_[std::size_t(u)], output.slope, integral});
    }
    return out;
}

std::vector<double> DiagramResponse::sampled(int signal, const std::vector<double>& t) const {
    std::vector<double> out;
    const double input = inputs_[std::size_t(signal)];
    std::size_t next = 0;  // the first node after t
    for (const double time : t) {
        while (next < t_.size() && t_[next] <= time) ++next;
        if (next == t_.size()) {
            out.push_back((final_.empty() ? at(next - 1, signal).value : final_[std::size_t(signal)]) - input);
            continue;
        }
        const double start = t_[next - 1];
        out.push_back(value_at(hermite_taylor(t_[next] - start, at(next - 1, signal), at(next, signal)), time - start) -
                      input);
    }
    return out;
}

}  // namespace tunewright
