#include "engine/simulation/imc/imc_response.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/propagator.h"
#include "engine/simulation/run/stopping_rule.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kStepsPerLambda = 16, kStepsPerDeadTime = 10;
constexpr double kUsualTolerance = 1e-6;    // the tolerance for which these values hold
constexpr double kStepsPerResonance = 4;    // per 1/|p| of a complex pole
constexpr double kInstantTolerance = 1e-9;  // of a step: closer times, and shorter parts of steps, are rounding
constexpr int kCorrections = 6;             // iterations for a step that is longer than a dead time and depends on its
                                            // own end

/// The outputs without their dead times, stored until the dead times have passed.
struct Memory {
    double t = 0;
    Signal y, y_model;  ///< slopes just after t
    double integral_y = 0;
};

double cubic(double h, double s, double a, double slope_a, double b, double slope_b) {
    return value_at(hermite_taylor(h, {a, slope_a}, {b, slope_b}), s);
}

Signal cubic(double h, double s, Signal a, Signal b) {
    const auto c = hermite_taylor(h, a, b);
    return {value_at(c, s), slope_at(c, s)};
}

/// x' = F x + G e + b, u = M x + N e: plant states, the model's, Q's two, the integral of y without dead time. e is the
/// input of Q; without a dead time of the plant, that input without -y.
struct ImcSystem {
    int n = 0, plant_states = 0;
    std::vector<double> F, G, b, M;
    double N = 0;
    std::vector<double> output;       // of y without dead time
    std::vector<double> output_rate;  // rows of its slope: from x, from e, and constant
    double output_rate_e = 0, output_rate_1 = 0;
    std::vector<double> slope;  // of u's slope, in the same way; N e' is added
    double slope_e = 0, slope_1 = 0;
};

ImcSystem make_system(const LinearPlant& plant, const ImcController& c, double load) {
    const Realisation& P = plant.realisation();
    ImcSystem s;
    s.plant_states = P.n;
    s.n = P.n + 4;
    const int model = P.n, z1 = P.n + 1, z2 = P.n + 2, integral = P.n + 3;
    s.F.assign(Index(s.n * s.n), 0);
    s.G.assign(Index(s.n), 0);
    s.b.assign(Index(s.n), 0);
    s.M.assign(Index(s.n), 0);
    s.output.assign(Index(s.n), 0);
    const int n = P.n;
    Eigen::Map<Matrix> F(s.F.data(), s.n, s.n);
    Eigen::Map<Eigen::VectorXd> G(s.G.data(), s.n);
    Eigen::Map<Eigen::RowVectorXd> M(s.M.data(), s.n);
    const Eigen::Map<const Eigen::VectorXd> B(P.B.data(), n);
    const Eigen::Map<const Eigen::RowVectorXd> C(P.C.data(), n);
    // Q as two leads over lags: (beta s + 1)/(lambda s + 1), then (tau s + 1)/(lambda s + 1), then 1/kp.
    const double lambda = c.lambda, first = c.beta / lambda, second = c.tau / lambda;
    s.N = second * first / c.kp;
    s.M[Index(z1)] = second * (1 - first) / c.kp;
    s.M[Index(z2)] = (1 - second) / c.kp;
    F(z1, z1) = -1 / lambda;
    s.G[Index(z1)] = 1 / lambda;
    F(z2, z1) = (1 - first) / lambda;
    F(z2, z2) = -1 / lambda;
    s.G[Index(z2)] = first / lambda;
    F(model, model) = -1 / c.tau;
    F.topLeftCorner(n, n) = Eigen::Map<const Matrix>(P.A.data(), n, n);
    F.row(integral).head(n) = C;
    std::copy(P.C.begin(), P.C.end(), s.output.begin());
    Eigen::Map<Eigen::VectorXd>(s.b.data(), n) = load * B;
    // u drives plant and model.
    F.topRows(n) += B * M;
    F.row(model) += c.kp / c.tau * M;
    G.head(n) += s.N * B;
    G[model] += s.N * c.kp / c.tau;
    if (plant.dead_time() == 0) {
        F.leftCols(n) -= G * C;
        M.head(n) -= s.N * C;
    }
    s.output_rate = row_times(s.output, s.F);
    s.output_rate_e = dot(s.output, s.G);
    s.output_rate_1 = dot(s.output, s.b);
    s.slope = row_times(s.M, s.F);
    s.slope_e = dot(s.M, s.G);
    s.slope_1 = dot(s.M, s.b);
    return s;
}

class ImcRun {
public:
    ImcRun(const LinearPlant& plant, const ImcController& c, const StepInputs& in, const ResponseOptions& options)
        : system_(make_system(plant, c, in.d)),
          c_(c),
          in_(in),
          options_(options),
          L_(plant.dead_time()),
          theta_(c.theta),
          stopping_(options.settled, L_ + theta_) {
        response_.y_final = in.r;
        response_.u_final = in.r / plant.low_frequency_gain() - in.d;
        // C = 1/(kp d0 s) + ...: gives the final integral of the error.
        const double x = c.lambda / c.tau - 1;
        const double d0 = c.lambda * c.lambda / c.tau + c.theta + c.tau * x * x * std::expm1(-c.theta / c.tau);
        response_.error_integral_final = response_.u_final * c.kp * d0;
        // Once the delayed signals are smooth, only lambda and resonances limit the length of a cubic, whose error is
        // of order 4.
        const double shorter = std::pow(options.tolerance / kUsualTolerance, 0.25);
        long_step_ = c.lambda / kStepsPerLambda;
        for (const auto pole : plant.poles())
            if (pole.imag() != 0) long_step_ = std::min(long_step_, 1 / (kStepsPerResonance * std::abs(pole)));
        step_ = shorter * std::min(long_step_, (L_ + theta_) / kStepsPerDeadTime);
        long_step_ *= shorter;
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; i + j <= 3; ++j) events_.push_back(i * L_ + j * theta_);
        std::ranges::sort(events_);
        if (const auto end = options.horizon.value_or(events_.back()); end < events_.back()) {
            std::erase_if(events_, [end](double t) { return t >= end; });
            events_.push_back(end);
        }
        slack_ = kInstantTolerance * step_;
    }

    StepResponse run() {
        std::vector<double> x(Index(system_.n), 0.0);
        remember(0, x, seen(0, true));
        push(0, x, seen(0, true));
        for (Index i = 1; i < events_.size(); ++i) {
            const double from = memory_.back().t, length = events_[i] - from;
            if (length <= slack_) continue;
            const int parts = static_cast<int>(std::ceil(length / step_ - kInstantTolerance));
            for (int k = 1; k <= parts; ++k) {
                const double t = k == parts ? events_[i] : from + length * k / parts;
                take_step(x, length / parts, t);
                if (finished()) return std::move(response_);
            }
            push(memory_.back().t, x, seen(memory_.back().t, true));  // u's slope may jump here
        }
        while (static_cast<int>(response_.nodes.size()) < options_.max_steps) {
            const double now = memory_.back().t, left = options_.horizon.value_or(now + 2 * long_step_) - now;
            const bool last = left <= long_step_ * (1 + kInstantTolerance);
            take_step(x, last ? left : long_step_, last ? *options_.horizon : now + long_step_);
            if (finished()) return std::move(response_);
        }
        response_.settles = false;
        return std::move(response_);
    }

private:
    const ExactStep& exact(double h) {
        auto at = steps_.find(h);
        if (at == steps_.end()) {
            Propagator propagator(system_.n, system_.F, system_.G, system_.b, h);
            at = steps_.emplace(h, propagator.level(0)).first;
        }
        return at->second;
    }

    /// y or y_m without dead time, `t` after the start; 0 before.
    Memory past(double t, bool after) {
        if (memory_.empty() || t < -slack_ || (t <= slack_ && !after)) return {};
        const auto right = std::ranges::upper_bound(memory_, t + slack_, {}, &Memory::t);
        if (right == memory_.begin()) return memory_.front();
        const Memory& a = *(right - 1);
        if (std::abs(a.t - t) <= slack_) return a;
        const Memory& b = right == memory_.end() ? a : *right;
        if (right == memory_.end()) return ahead(t);
        const double h = b.t - a.t, s = t - a.t;
        return {t, cubic(h, s, a.y, b.y), cubic(h, s, a.y_model, b.y_model),
                cubic(h, s, a.integral_y, a.y.value, b.integral_y, b.y.value)};
    }

    /// Beyond the known part: along the last slope, to be corrected.
    Memory ahead(double t) const {
        const Memory& a = memory_.back();
        const double s = t - a.t;
        return {t,
                {a.y.value + s * a.y.slope, a.y.slope},
                {a.y_model.value + s * a.y_model.slope, a.y_model.slope},
                a.integral_y + s * a.y.value};
    }

    /// The input of Q at t; if the plant has no dead time, without -y.
    Signal seen(double t, bool after) {
        const Signal model = past(t - theta_, after).y_model;
        const Signal plant = L_ > 0 ? past(t - L_, after).y : Signal{};
        return {in_.r - plant.value + model.value, model.slope - plant.slope};
    }

    void take_step(std::vector<double>& x, double h, double t) {
        const double from = memory_.back().t;
        const Signal e0 = seen(from, true);
        const bool reaches_delayed = h > theta_ + slack_ || (L_ > 0 && h > L_ + slack_);
        const ExactStep& step = exact(h);
        std::vector<double> next;
        for (int i = 0; i < (reaches_delayed ? kCorrections : 1); ++i) {
            const Signal e1 = seen(t, false);
            if (i > 0) memory_.pop_back();
            next = x;
            advance(step, hermite_taylor(h, e0, e1), next);
            remember(t, next, e1);
        }
        x = next;
        push(t, x, seen(t, false));
    }

    void remember(double t, const std::vector<double>& x, Signal e) {
        const double u = dot(system_.M, x) + system_.N * e.value;
        const double y_model = x[Index(system_.plant_states)];
        memory_.push_back({t,
                           {dot(system_.output, x),
                            dot(system_.output_rate, x) + system_.output_rate_e * e.value + system_.output_rate_1},
                           {y_model, (c_.kp * u - y_model) / c_.tau},
                           x.back()});
    }

    void push(double t, const std::vector<double>& x, Signal e) {
        ResponseNode node;
        node.t = t;
        node.u = dot(system_.M, x) + system_.N * e.value;
        node.u_slope = dot(system_.slope, x) + system_.slope_e * e.value + system_.slope_1 + system_.N * e.slope;
        const Memory delayed = past(t - L_, response_.nodes.empty() || response_.nodes.back().t == t);
        node.y = delayed.y.value;
        node.y_slope = delayed.y.slope;
        node.error_integral = in_.r * t - delayed.integral_y;
        response_.nodes.push_back(node);
        const double y = std::abs(node.y - response_.y_final), u = std::abs(node.u - response_.u_final);
        largest_y_ = std::max(largest_y_, y);
        largest_u_ = std::max(largest_u_, u);
        stopping_.note(t, y, largest_y_, u, largest_u_);
    }

    bool finished() const {
        const double t = response_.nodes.back().t;
        if (options_.horizon) return t >= *options_.horizon;
        return stopping_.has_settled(t);
    }

    ImcSystem system_;
    ImcController c_;
    StepInputs in_;
    ResponseOptions options_;
    double L_, theta_, step_ = 0, long_step_ = 0, slack_ = 0;
    std::vector<double> events_;
    std::map<double, ExactStep> steps_;
    std::vector<Memory> memory_;
    StepResponse response_;
    double largest_y_ = 0, largest_u_ = 0;
    StoppingRule stopping_;
};

}  // namespace

StepResponse simulate_imc(const LinearPlant& plant, const ImcController& controller, const StepInputs& inputs,
                          const ResponseOptions& options) {
    return ImcRun(plant, controller, inputs, options).run();
}

}  // namespace tunewright
