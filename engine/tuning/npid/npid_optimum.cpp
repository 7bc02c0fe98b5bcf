#include "engine/tuning/npid/npid_optimum.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "engine/loop/margins.h"
#include "engine/loop/stability.h"
#include "engine/number_text.h"
#include "engine/numerics/optimise/direct_search.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/linear/linear_response.h"

namespace tunewright {
namespace {

constexpr double kLogCostOfNoLoop = 50;       // ln(cost/scale) without a stable loop
constexpr double kMaxNeutralModulus = 0.98;   // of |L(infinity)|: for larger values echoes hardly fade
constexpr int kExploredPoints = 500;          // points of the global search
constexpr int kStarts = 3;                    // local searches from the best of these points
constexpr double kMinLogStartDistance = 0.5;  // of two starts, in ln
constexpr int kLocalEvaluations = 260;
constexpr int kPolishes = 8;
constexpr double kMinLogPolishGain = 2e-5;  // decrease in ln at which they end
constexpr int kExpected = kExploredPoints + (kStarts + 2) * kLocalEvaluations;
constexpr int kReportEvery = 50;
// The search region, in Ku, Pu and the sum of the lags: larger than the distance of any optimum found by unbounded
// searches.
constexpr double kMinGain = 0.02, kMaxGain = 10;
constexpr double kMinTi = 0.05, kMaxTi = 20;
constexpr double kMinTd = 2e-3;
constexpr double kWideStep = 0.15, kWideTolerance = 1e-5;      // of the local searches, in ln
constexpr double kNarrowStep = 0.03, kNarrowTolerance = 1e-7;  // of the refinement
constexpr double kLogBoundTolerance = 1e-9;                    // in ln: a point closer to the edge of the region is on
                                                               // it
// Tolerances of the responses: the coarser ones distinguish local minima, the finer ones show what a refinement gains.
constexpr double kRoughTolerance = 1e-4, kFineTolerance = 1e-6;
constexpr double kSettledOfTolerance = 0.01;
constexpr double kMaxLogBoundDistance = 1e-3;  // in ln
constexpr int kMaxSteps = 4000;                // of a response; one that has not settled by then is not a candidate

class NpidSearch {
public:
    NpidSearch(const NpidProblem& problem, const UltimatePoint& ultimate, const RunControl& control)
        : problem_(problem), control_(control), sign_(ultimate.Ku < 0 ? -1 : 1) {
        const double Ku = std::abs(ultimate.Ku), Pu = ultimate.Pu;
        double lags = 0;
        for (const auto pole : problem.plant.poles()) lags += 1 / std::abs(pole);
        with_derivative_ = problem.plant.pole_excess() > 0 || problem.Tf_over_Td > 0 || problem.Tf;
        box_.low = {std::log(kMinGain * Ku), std::log(kMinTi * Pu)};
        box_.high = {std::log(kMaxGain * Ku), std::log(kMaxTi * (Pu + lags))};
        if (with_derivative_) {
            box_.low.push_back(std::log(kMinTd * Pu));
            box_.high.push_back(std::log(Pu + lags));
        }
        time_ = Pu;
    }

    Expected<NpidOptimum> run() {
        const auto f = [this](const std::vector<double>& x, bool& stop) { return log_cost(x, stop); };
        std::vector<LocalMinimum> starts = apart(explore(f, box_, kExploredPoints));
        if (problem_.start) starts.push_back({logs(*problem_.start), 0});
        const LocalOptions wide{std::vector<double>(box_.low.size(), kWideStep), kWideTolerance, kLocalEvaluations};
        for (const auto& start : starts)
            if (!stopped_) find_local_minimum(LocalSearch::subplex, f, start.x, wide);
        if (!(best_.value < kLogCostOfNoLoop)) return nothing_found();
        fine_ = true;
        polish(f);
        return answer();
    }

private:
    /// Repeats the search from the best point with finer responses: the minima are narrow, curved valleys if the
    /// plant's lag is long compared with its dead time.
    void polish(const std::function<double(const std::vector<double>&, bool&)>& f) {
        const LocalOptions narrow{std::vector<double>(box_.low.size(), kNarrowStep), kNarrowTolerance,
                                  kLocalEvaluations};
        best_.value = kLogCostOfNoLoop;  // cost with the coarser responses
        for (int i = 0; i < kPolishes && !stopped_; ++i) {
            const double before = best_.value;
            find_local_minimum(i % 2 == 0 ? LocalSearch::subplex : LocalSearch::nelder_mead, f,
                               std::vector<double>(best_.x), narrow);
            if (i > 0 && before - best_.value < kMinLogPolishGain) break;
        }
    }

    IdealPid controller(const std::vector<double>& x) const {
        IdealPid pid{.Kp = sign_ * std::exp(x[0]), .Ti = std::exp(x[1])};
        if (!with_derivative_) return pid;
        pid.Td = std::exp(x[2]);
        const double Tf = problem_.Tf.value_or(problem_.Tf_over_Td * pid.Td);
        if (Tf > 0) pid.filter = {FilterType::derivative, Tf};
        return pid;
    }

    std::vector<double> logs(const IdealPid& pid) const {
        std::vector<double> x = {std::log(std::abs(pid.Kp)), std::log(pid.Ti)};
        if (with_derivative_) x.push_back(std::log(pid.Td > 0 ? pid.Td : std::exp(box_.low[2])));
        return x;
    }

    double log_cost(const std::vector<double>& x, bool& stop) {
        ++evaluations_;
        if (control_.stop.stop_requested()) {
            stop = stopped_ = true;
            return kLogCostOfNoLoop;
        }
        if (control_.progress && evaluations_ % kReportEvery == 0)
            control_.progress({std::min(1.0, double(evaluations_) / kExpected), "tune",
                               "Searching the nonlinear PID's optimum.", nullptr});
        const double value = within(x) ? cost(controller(x)) : kLogCostOfNoLoop;
        if (value < best_.value) best_ = {x, value};
        return value;
    }

    bool within(const std::vector<double>& x) const {
        for (std::size_t i = 0; i < x.size(); ++i)
            if (!(x[i] >= box_.low[i] - kLogBoundTolerance && x[i] <= box_.high[i] + kLogBoundTolerance)) return false;
        return true;
    }

    /// ln of the criterion, time in periods; kLogCostOfNoLoop if the response does not settle.
    double cost(const IdealPid& pid) const {
        const auto loop = Loop::make(problem_.plant, to_parallel(pid));
        if (!loop) return kLogCostOfNoLoop;
        if (problem_.plant.dead_time() > 0 && loop->high_frequency_gain() > kMaxNeutralModulus) return kLogCostOfNoLoop;
        ResponseOptions options;
        options.tolerance = fine_ ? kFineTolerance : kRoughTolerance;
        options.settled = kSettledOfTolerance * options.tolerance;
        options.max_steps = kMaxSteps;
        const StepResponse response = simulate_npid(problem_.plant, loop->gains(), 1, {1, 0}, options);
        if (!response.settles) return kLogCostOfNoLoop;
        const auto e = error_integrals(response.nodes, 1, response.error_integral_final);
        const double value = problem_.criterion == ErrorCriterion::ISE   ? e.ISE / time_
                             : problem_.criterion == ErrorCriterion::IAE ? e.IAE / time_
                                                                         : e.ITAE / (time_ * time_);
        const double log_value = std::log(value);
        return std::isfinite(log_value) ? std::min(log_value, kLogCostOfNoLoop) : kLogCostOfNoLoop;
    }

    /// The best points, without those close to better ones.
    static std::vector<LocalMinimum> apart(std::vector<LocalMinimum> met) {
        std::ranges::stable_sort(met, {}, &LocalMinimum::value);
        std::vector<LocalMinimum> chosen;
        for (const auto& point : met) {
            if (point.value >= kLogCostOfNoLoop || chosen.size() == kStarts) break;
            const auto close = [&](const LocalMinimum& other) {
                double distance = 0;
                for (std::size_t i = 0; i < point.x.size(); ++i)
                    distance = std::max(distance, std::abs(point.x[i] - other.x[i]));
                return distance < kMinLogStartDistance;
            };
            if (std::ranges::none_of(chosen, close)) chosen.push_back(point);
        }
        return chosen;
    }

    Error nothing_found() const {
        if (stopped_) return {ErrorKind::cancelled, "", "The job was cancelled before a design was found."};
        return {ErrorKind::no_feasible_controller, "plant",
                "No nonlinear PID was found whose set-point response settles on this plant. Use robust."};
    }

    Expected<NpidOptimum> answer() const {
        NpidOptimum optimum;
        optimum.controller = controller(best_.x);
        const double scale = problem_.criterion == ErrorCriterion::ITAE ? time_ * time_ : time_;
        optimum.cost = scale * std::exp(best_.value);
        optimum.stopped = stopped_;
        // At the lower bound of Td it is a PI, which is a valid result.
        for (std::size_t i = 0; i < best_.x.size(); ++i)
            if ((i < 2 && best_.x[i] < box_.low[i] + kMaxLogBoundDistance) ||
                best_.x[i] > box_.high[i] - kMaxLogBoundDistance)
                optimum.at_bound = true;
        const auto loop = Loop::make(problem_.plant, to_parallel(optimum.controller));
        if (!loop || !count_unstable_poles(*loop).stable()) return nothing_found();
        return optimum;
    }

    const NpidProblem& problem_;
    const RunControl& control_;
    double sign_ = 1, time_ = 1;
    bool with_derivative_ = true, fine_ = false, stopped_ = false;
    Box box_;
    LocalMinimum best_{{}, kLogCostOfNoLoop};
    int evaluations_ = 0;
};

}  // namespace

Expected<NpidOptimum> find_npid_optimum(const NpidProblem& problem, const RunControl& control) {
    const LinearPlant& plant = problem.plant;
    if (plant.dead_time() == 0 && plant.pole_excess() <= 2)
        return Error{ErrorKind::unbounded_optimum, "plant/L",
                     "Without a dead time and with a pole excess of " + text(plant.pole_excess()) +
                         " a higher gain always gives a smaller error, so there is no optimum. Give the true dead time "
                         "of the loop, or use robust, which limits Ms."};
    const auto ultimate = ultimate_point(plant);
    if (!ultimate)
        return Error{ErrorKind::unsupported, "plant",
                     "The plant has no ultimate gain, which the search for the optimum needs as its unit: no "
                     "proportional gain makes the loop oscillate. Use robust."};
    return NpidSearch(problem, *ultimate, control).run();
}

}  // namespace tunewright
