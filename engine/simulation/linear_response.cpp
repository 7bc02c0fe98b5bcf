#include "engine/simulation/linear_response.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/loop/delay_system.h"
#include "engine/plant/linear_algebra.h"
#include "engine/simulation/propagator.h"
#include "engine/simulation/steady_state.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr int kFirstEchoes = 2;     // the kinks at L and 2L are always met with the shortest step
constexpr int kRetardedEchoes = 4;  // jumps at 0, L, 2L, ...: smoothed by the plant at each passage
constexpr int kMaxEchoes = 2000;

/// The delay system with one more state, the integral of y, and without the constant inputs.
struct System {
    DelaySystem s;
    int n = 0;
    std::vector<double> F, G, b;
    // u = Mu x + N v + u0, u' = Mdu x + Ndu v + N v' + du0, the same for y.
    std::vector<double> MF, YF;
    double MG = 0, YG = 0, MH = 0, YH = 0;
    StepInputs in;
    bool delayed = false;
};

System make_system(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in) {
    System system;
    system.s = make_delay_system(plant, controller);
    system.delayed = system.s.L > 0;
    if (!system.delayed) system.s = close_without_delay(system.s);
    const DelaySystem& s = system.s;
    system.in = in;
    const int n = s.n;
    system.n = n + 1;
    system.F.assign(Index(system.n * system.n), 0);
    system.G = s.G;
    system.G.push_back(s.Z);
    system.b.assign(Index(system.n), 0);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) system.F[Index(i * system.n + j)] = s.F[Index(i * n + j)];
        system.F[Index(n * system.n + i)] = s.Y[Index(i)];
        system.b[Index(i)] = s.H[Index(i)] * in.r;
    }
    system.MF.assign(Index(n), 0);
    system.YF.assign(Index(n), 0);
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            system.MF[Index(j)] += s.M[Index(i)] * s.F[Index(i * n + j)];
            system.YF[Index(j)] += s.Y[Index(i)] * s.F[Index(i * n + j)];
        }
        system.MG += s.M[Index(i)] * s.G[Index(i)];
        system.YG += s.Y[Index(i)] * s.G[Index(i)];
        system.MH += s.M[Index(i)] * s.H[Index(i)] * in.r;
        system.YH += s.Y[Index(i)] * s.H[Index(i)] * in.r;
    }
    if (!system.delayed) {
        // v is the load alone here, with the algebraic loop solved.
        for (int i = 0; i < system.n; ++i) system.b[Index(i)] += system.G[Index(i)] * in.d;
        // The integral of y also sees what the set point feeds through the plant's direct term.
        system.b[Index(n)] = s.Z * (s.R * in.r + in.d);
    }
    return system;
}

struct Signal {
    double value = 0, slope = 0;
};

ResponseNode node_at(const System& system, double t, const std::vector<double>& x, Signal v) {
    const DelaySystem& s = system.s;
    if (!system.delayed) v = {system.in.d, 0};
    ResponseNode node;
    node.t = t;
    node.u = s.N * v.value + s.R * system.in.r;
    node.u_slope = system.MG * v.value + system.MH + s.N * v.slope;
    node.y = s.Z * v.value;
    node.y_slope = system.YG * v.value + system.YH + s.Z * v.slope;
    if (!system.delayed) node.y += s.Z * s.R * system.in.r;
    for (int i = 0; i < s.n; ++i) {
        const double xi = x[Index(i)];
        node.u += s.M[Index(i)] * xi;
        node.u_slope += system.MF[Index(i)] * xi;
        node.y += s.Y[Index(i)] * xi;
        node.y_slope += system.YF[Index(i)] * xi;
    }
    node.error_integral = system.in.r * t - x[Index(s.n)];
    return node;
}

/// w = u + d as it was: nodes in time order, cubic in between, 0 before t = 0.
class History {
public:
    History(const std::vector<ResponseNode>& nodes, double d) : nodes_(nodes), d_(d) {}

    /// Limit from the right (`after`) or left at time t; t never falls from call to call by more than one step.
    Signal at(double t, bool after, double slack) {
        if (t < -slack || (t <= slack && !after)) return {};
        while (cursor_ + 1 < nodes_.size() && nodes_[cursor_ + 1].t < t - slack) ++cursor_;
        while (cursor_ > 0 && nodes_[cursor_].t > t + slack) --cursor_;
        // Exactly on a node: the last of equal times after a jump, the first before it.
        for (Index i = cursor_; i < nodes_.size() && nodes_[i].t <= t + slack; ++i) {
            if (std::abs(nodes_[i].t - t) > slack) continue;
            Index hit = i;
            if (after)
                while (hit + 1 < nodes_.size() && std::abs(nodes_[hit + 1].t - t) <= slack) ++hit;
            else
                while (hit > 0 && std::abs(nodes_[hit - 1].t - t) <= slack) --hit;
            return {nodes_[hit].u + d_, nodes_[hit].u_slope};
        }
        Index left = cursor_;
        while (left + 1 < nodes_.size() && nodes_[left + 1].t <= t) ++left;
        if (left + 1 >= nodes_.size()) return {nodes_.back().u + d_, nodes_.back().u_slope};
        const ResponseNode &a = nodes_[left], &b = nodes_[left + 1];
        const double h = b.t - a.t, s = t - a.t;
        const auto c = hermite_taylor(h, a.u, a.u_slope, b.u, b.u_slope);
        return {c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] / 6)) + d_, c[1] + s * (c[2] + s * c[3] / 2)};
    }

private:
    const std::vector<ResponseNode>& nodes_;
    double d_;
    Index cursor_ = 0;
};

/// A step longer than the dead time: its last part sees the step's own, still unknown output. Linear in value and slope
/// at the end.
class LongStep {
public:
    LongStep(const System& system, Propagator& propagator, int level, int level_of_L)
        : system_(system), propagator_(propagator) {
        over_L_ = propagator.level(level_of_L);
        rest_ = over_L_;  // (2^k - 1) L = 2 (2^(k-1) - 1) L + L
        for (int k = level_of_L + 2; k <= level; ++k)
            rest_ = propagator.compose(propagator.compose(rest_, rest_), over_L_);
        h_ = over_L_.h + rest_.h;
        end_value_ = effect({0, 0, 1, 0});
        end_slope_ = effect({0, 0, 0, 1});
    }

    double h() const { return h_; }

    /// Advances x; gives the delayed signal at the step's end.
    Signal advance(Signal v0, Signal w0, std::vector<double>& x, std::vector<double>& scratch) const {
        propagator_.advance(over_L_, hermite_taylor(over_L_.h, v0.value, v0.slope, w0.value, w0.slope), x, scratch);
        const std::array<double, 4> known = {w0.value, w0.slope, 0, 0};
        propagator_.advance(rest_, taylor(known), x, scratch);
        const Signal v_known = at_end(known);
        // Solve (w1, w1') = known part + effects.
        const Signal base = output(x, v_known, true);
        const double a = 1 - end_value_.out.value, b = -end_slope_.out.value, c = -end_value_.out.slope,
                     d = 1 - end_slope_.out.slope;
        const double determinant = a * d - b * c;
        const double w1 = (d * base.value - b * base.slope) / determinant,
                     dw1 = (a * base.slope - c * base.value) / determinant;
        for (Index i = 0; i < x.size(); ++i) x[i] += end_value_.x[i] * w1 + end_slope_.x[i] * dw1;
        return {v_known.value + end_value_.v.value * w1 + end_slope_.v.value * dw1,
                v_known.slope + end_value_.v.slope * w1 + end_slope_.v.slope * dw1};
    }

private:
    struct Effect {
        std::vector<double> x;
        Signal v, out;
    };

    std::array<double, 4> taylor(const std::array<double, 4>& ends) const {
        return hermite_taylor(h_, ends[0], ends[1], ends[2], ends[3]);
    }

    Signal at_end(const std::array<double, 4>& ends) const {
        const auto c = taylor(ends);
        const double s = rest_.h;
        return {c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] / 6)), c[1] + s * (c[2] + s * c[3] / 2)};
    }

    /// w and its slope from states and delayed signal; the constant inputs only where asked.
    Signal output(const std::vector<double>& x, Signal v, bool with_inputs) const {
        const DelaySystem& s = system_.s;
        Signal w{s.N * v.value, system_.MG * v.value + s.N * v.slope};
        if (with_inputs) w = {w.value + s.R * system_.in.r + system_.in.d, w.slope + system_.MH};
        for (int i = 0; i < s.n; ++i) {
            w.value += s.M[Index(i)] * x[Index(i)];
            w.slope += system_.MF[Index(i)] * x[Index(i)];
        }
        return w;
    }

    Effect effect(const std::array<double, 4>& ends) const {
        Effect e;
        const auto c = taylor(ends);
        e.x.assign(Index(system_.n), 0);
        for (int j = 0; j < 4; ++j)
            for (Index i = 0; i < e.x.size(); ++i) e.x[i] += rest_.Gamma[Index(j)][i] * c[Index(j)];
        e.v = at_end(ends);
        e.out = output(e.x, e.v, false);
        return e;
    }

    const System& system_;
    Propagator& propagator_;
    ExactStep over_L_, rest_;
    double h_ = 0;
    Effect end_value_, end_slope_;
};

double hermite_midpoint(double h, double a, double slope_a, double b, double slope_b) {
    return 0.5 * (a + b) + h * (slope_a - slope_b) / 8;
}

/// The run itself: chooses step lengths, keeps the nodes, knows when to stop.
class Run {
public:
    Run(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& in, const ResponseOptions& options)
        : system_(make_system(plant, controller, in)),
          options_(options),
          steady_(steady_state(plant, controller, in)),
          propagator_(system_.n, system_.F, system_.G, system_.b, choose_h0(plant, controller)),
          history_(response_.nodes, in.d) {
        const double q = std::abs(system_.s.N);
        echoes_ = kRetardedEchoes;
        if (system_.delayed && q > 0)
            echoes_ = std::min(
                kMaxEchoes,
                static_cast<int>(std::log(1e-3 * options.tolerance) / std::log(std::min(q, 0.999))) + kRetardedEchoes);
        // An unstable plant's own modes amplify what a step gets wrong: no step may be long for them.
        for (const auto pole : plant.poles())
            if (pole.real() > 0) longest_step_ = std::min(longest_step_, 0.25 / pole.real());
        response_.y_final = steady_.y;
        response_.u_final = steady_.u;
        response_.error_integral_final = steady_.error_integral;
    }

    LinearResponse run() {
        std::vector<double> x(Index(system_.n), 0.0), scratch(Index(system_.n));
        push(node_at(system_, 0, x, {}));
        response_.schedule.h0 = propagator_.h0();
        for (int step = 0; step < options_.max_steps; ++step) {
            const bool more = options_.repeat == nullptr || step < static_cast<int>(options_.repeat->level.size());
            if (!more || finished()) return std::move(response_);
            choose_level(step);
            response_.schedule.level.push_back(static_cast<signed char>(level_));
            take_step(x, scratch);
        }
        response_.settles = false;
        return std::move(response_);
    }

private:
    double choose_h0(const LinearPlant& plant, const ParallelPid& controller) {
        if (options_.repeat != nullptr) {
            level_of_L_ =
                system_.delayed ? static_cast<int>(std::lround(std::log2(system_.s.L / options_.repeat->h0))) : 0;
            return options_.repeat->h0;
        }
        double fastest = 0;
        for (const auto pole : plant.poles()) fastest = std::max(fastest, std::abs(pole));
        if (controller.filter.type != FilterType::none) fastest = std::max(fastest, 1 / controller.filter.Tf);
        if (!system_.delayed) {
            // The closed loop's own speed: bounded by the norm of its matrix.
            for (int i = 0; i < system_.s.n; ++i)
                fastest = std::max(fastest, std::abs(system_.s.F[Index(i * system_.s.n + i)]));
            for (const auto pole : eigenvalues(system_.s.F, system_.s.n)) fastest = std::max(fastest, std::abs(pole));
            return 0.25 / std::max(fastest, 1e-300);
        }
        const double wanted = fastest > 0 ? std::min(system_.s.L / 8, 0.25 / fastest) : system_.s.L / 8;
        level_of_L_ = std::clamp(static_cast<int>(std::ceil(std::log2(system_.s.L / wanted))), 3, 30);
        return std::ldexp(system_.s.L, -level_of_L_);
    }

    void push(const ResponseNode& node) {
        response_.nodes.push_back(node);
        largest_y_ = std::max(largest_y_, std::abs(node.y - steady_.y));
        largest_u_ = std::max(largest_u_, std::abs(node.u - steady_.u));
        if (std::abs(node.y - steady_.y) > options_.settled * largest_y_ ||
            std::abs(node.u - steady_.u) > options_.settled * largest_u_)
            last_unsettled_ = node.t;
    }

    bool finished() const {
        const double t = response_.nodes.back().t;
        if (options_.horizon) return t >= *options_.horizon;
        if (t < last_unsettled_ + std::max(2 * system_.s.L, 0.25 * last_unsettled_) || t <= 0) return false;
        // A slow tail that still has integral to add must at least have the sign to add it.
        if (!steady_.error_integral) return true;
        const double rest = *steady_.error_integral - response_.nodes.back().error_integral;
        const double error = system_.in.r - response_.nodes.back().y;
        return rest * error >= 0 || std::abs(rest) <= options_.settled * std::abs(*steady_.error_integral);
    }

    bool echoes_are_over() const {
        return !system_.delayed || (segment_ >= echoes_ && restart_level_ >= std::min(level_, level_of_L_));
    }

    void choose_level(int step) {
        if (options_.repeat != nullptr) {
            level_ = options_.repeat->level[Index(step)];
            return;
        }
        if (segment_started_ && !echoes_are_over()) restart();
        const Smoothness smooth = smoothness();
        if (smooth == Smoothness::rough && level_ > 0) {
            if (level_ <= restart_level_) restart_level_ = std::max(0, restart_level_ - 2);
            --level_;
        }
        if (smooth == Smoothness::fine && may_double()) ++level_;
        if (level_ < top_level_ && (smooth == Smoothness::rough || smooth == Smoothness::enough)) climb_blocked_ = true;
        // Never across the end of a segment while jumps come with it.
        if (!echoes_are_over() || (system_.delayed && level_ <= level_of_L_))
            while (level_ > 0 && (offset_ & ((1L << level_) - 1)) != 0) --level_;
    }

    /// A segment starts short, at the scale of the kink that its start may bring. Where the way up to the former length
    /// was free, the kink has faded: the next one starts longer.
    void restart() {
        if (segment_ > kFirstEchoes && !climb_blocked_) restart_level_ += 2;
        climb_blocked_ = false;
        top_level_ = level_;
        level_ = std::min(level_, restart_level_);
    }

    bool may_double() const {
        if (level_ >= 60) return false;
        if (!system_.delayed) return true;
        if (std::ldexp(propagator_.h0(), level_ + 1) > longest_step_) return false;
        if (level_ + 1 > level_of_L_ && (!echoes_are_over() || equal_steps_ < 4)) return false;
        return true;
    }

    enum class Smoothness { unknown, rough, enough, fine };

    /// fine: a step twice as long would do; rough: even this one was too long; unknown: too few equal steps to tell.
    Smoothness smoothness() const {
        const auto& nodes = response_.nodes;
        if (equal_steps_ < 2 || nodes.size() < 3) return Smoothness::unknown;
        const ResponseNode &a = nodes[nodes.size() - 3], &b = nodes[nodes.size() - 2], &c = nodes.back();
        const double h = c.t - a.t;
        const auto error = [&](double va, double sa, double vb, double vc, double sc, double final_value,
                               double largest) {
            const double scale = std::max(
                {std::abs(va - final_value), std::abs(vb - final_value), std::abs(vc - final_value), 2e-3 * largest});
            return scale > 0 ? std::abs(vb - hermite_midpoint(h, va, sa, vc, sc)) / scale : 0;
        };
        const double worst = std::max(error(a.y, a.y_slope, b.y, c.y, c.y_slope, steady_.y, largest_y_),
                                      error(a.u, a.u_slope, b.u, c.u, c.u_slope, steady_.u, largest_u_));
        if (worst < options_.tolerance) return Smoothness::fine;
        return worst > 40 * options_.tolerance ? Smoothness::rough : Smoothness::enough;
    }

    void take_step(std::vector<double>& x, std::vector<double>& scratch) {
        equal_steps_ = level_ == last_level_ && !segment_started_ ? equal_steps_ + 1 : 1;
        last_level_ = level_;
        segment_started_ = false;
        const double t = time(), slack = 1e-9 * propagator_.h0();
        if (!system_.delayed) {
            propagator_.advance(propagator_.level(level_), {}, x, scratch);
            ticks_ += std::ldexp(1.0, level_);
            push(node_at(system_, time(), x, {}));
            return;
        }
        const double L = system_.s.L;
        if (level_ > level_of_L_) {
            const LongStep& step = long_step();
            const ResponseNode& now = response_.nodes.back();
            const Signal v1 =
                step.advance(history_.at(t - L, true, slack), {now.u + system_.in.d, now.u_slope}, x, scratch);
            ticks_ += std::ldexp(1.0, level_);
            push(node_at(system_, time(), x, v1));
            return;
        }
        const ExactStep& step = propagator_.level(level_);
        const Signal v0 = history_.at(t - L, true, slack), v1 = history_.at(t + step.h - L, false, slack);
        propagator_.advance(step, hermite_taylor(step.h, v0.value, v0.slope, v1.value, v1.slope), x, scratch);
        ticks_ += std::ldexp(1.0, level_);
        offset_ += 1L << level_;
        push(node_at(system_, time(), x, v1));
        if (offset_ < (1L << level_of_L_)) return;
        // End of a segment: the delayed signal may jump, and with it u.
        offset_ = 0;
        ++segment_;
        segment_started_ = true;
        if (!echoes_are_over()) {
            push(node_at(system_, time(), x, history_.at(time() - L, true, slack)));
            equal_steps_ = 0;
        }
        if (echoes_are_over()) segment_started_ = false;
    }

    const LongStep& long_step() {
        while (static_cast<int>(long_steps_.size()) < level_ - level_of_L_)
            long_steps_.emplace_back(system_, propagator_, level_of_L_ + 1 + static_cast<int>(long_steps_.size()),
                                     level_of_L_);
        return long_steps_[Index(level_ - level_of_L_ - 1)];
    }

    double time() const { return ticks_ * propagator_.h0(); }

    System system_;
    const ResponseOptions& options_;
    SteadyState steady_;
    int level_of_L_ = 0;
    Propagator propagator_;
    LinearResponse response_;
    History history_;
    std::vector<LongStep> long_steps_;
    int echoes_ = 0, segment_ = 0;
    int level_ = 0, last_level_ = -1, equal_steps_ = 0;
    bool segment_started_ = true, climb_blocked_ = false;
    int restart_level_ = 0, top_level_ = 0;
    long offset_ = 0;   // of the segment, in units of h0
    double ticks_ = 0;  // since t = 0, in units of h0: exact
    double longest_step_ = std::numeric_limits<double>::infinity();
    double largest_y_ = 0, largest_u_ = 0, last_unsettled_ = 0;
};

}  // namespace

LinearResponse simulate_linear(const LinearPlant& plant, const ParallelPid& controller, const StepInputs& inputs,
                               const ResponseOptions& options) {
    return Run(plant, controller, inputs, options).run();
}

}  // namespace tunewright
