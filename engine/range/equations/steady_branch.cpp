#include "engine/range/equations/steady_branch.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/number_text.h"
#include "engine/range/equations/steady_curve.h"

namespace tunewright::range {

namespace {

constexpr int kMaxSteps = 2000;
constexpr double kFirstLength = 0.02, kMinLength = 1e-7, kMaxLength = 0.2;  // relative to the unknowns' sizes
constexpr double kMaxTurn = 0.25;                                           // rad by which the tangent may turn in one
                                                                            // step
constexpr double kMaxRangeStep = 0.04;                                      // share of the range in one step
constexpr int kQuickNewton = 4;       // iterations: after at most this number the next step is longer
constexpr double kFoldExact = 1e-10;  // relative to the unknowns' sizes: accuracy of a fold
constexpr int kFoldBisections = 40;

std::string where_word(const EquationsRange& range) {
    return range.along == Along::input ? "input" : range.along == Along::output ? "output" : "parameter";
}

}  // namespace

/// Follows the curve from the operating point to one end of the range.
class BranchWalk {
public:
    BranchWalk(const SteadyBranch& branch, const SteadyCurve& curve)
        : branch_(branch), range_(branch.range_), curve_(curve) {}

    struct Result {
        std::vector<SteadyState> states;  ///< from the start of the walk
        std::vector<Fold> folds;          ///< folds of the scheduling variable
        std::vector<Fold> input_folds;
        std::optional<Error> ended;  ///< the error, if the walk ended before the end of the range
    };

    /// `up`: initially towards larger values. Ends when the value passes `end` on that side.
    Result run(const SteadyState& start, bool up, double end) {
        Result result;
        z_ = curve_.z(start);
        sizes_ = curve_.sizes(z_, largest_);
        const auto first = first_tangent(up);
        result.states.push_back(start);
        if (!first) {
            result.ended = no_way(start);
            return result;
        }
        tangent_ = *first;
        double length = kFirstLength;
        for (int step = 0; step < kMaxSteps; ++step) {
            const double place = curve_.place(z_);
            if (up ? place >= end : place <= end) return result;
            if (!advance(length, result)) {
                result.ended = no_way(result.states.back());
                return result;
            }
        }
        result.ended =
            Error{ErrorKind::invalid_argument, "range",
                  "The steady states were followed for " + std::to_string(kMaxSteps) + " steps without reaching " +
                      text(end) + "; they end at " + described(result.states.back()) + ". Give a shorter range."};
        return result;
    }

private:
    std::optional<std::vector<double>> first_tangent(bool up) const {
        // The tangent is the same for every choice of this row, unless the row is orthogonal to it.
        for (std::size_t i = 0; i < curve_.unknowns(); ++i) {
            std::vector<double> row(curve_.unknowns(), 0.0);
            row[curve_.unknowns() - 1 - i] = 1;
            auto t = curve_.tangent(z_, sizes_, row);
            if (!t) continue;
            const double slope = place_slope(z_, *t);
            if (slope == 0) continue;
            if ((slope > 0) != up)
                for (double& component : *t) component = -component;
            return t;
        }
        return std::nullopt;
    }

    double place_slope(std::span<const double> z, std::span<const double> t) const {
        const auto gradient = curve_.place_gradient(z);
        double slope = 0;
        for (std::size_t i = 0; i < gradient.size(); ++i) slope += gradient[i] * t[i] * sizes_[i];
        return slope;
    }

    double input_slope(std::span<const double> t) const {
        return t[curve_.unknowns() - (range_.along == Along::parameter ? 2 : 1)];
    }

    /// The point of the curve at a distance along the tangent, and the tangent there.
    bool step_to(double length, std::vector<double>& z, std::vector<double>& t, int& iterations) const {
        z = z_;
        for (std::size_t i = 0; i < z.size(); ++i) z[i] += length * tangent_[i] * sizes_[i];
        const auto count = curve_.correct_across(z, sizes_, tangent_, std::vector<double>(z));
        if (!count) return false;
        const auto next = curve_.tangent(z, sizes_, tangent_);
        if (!next) return false;
        t = *next;
        iterations = *count;
        return true;
    }

    bool advance(double& length, BranchWalk::Result& result) {
        const double span = range_.to - range_.from;
        for (; length >= kMinLength; length *= 0.5) {
            std::vector<double> z, t;
            int iterations = 0;
            if (!step_to(length, z, t, iterations)) continue;
            double cosine = 0;
            for (std::size_t i = 0; i < t.size(); ++i) cosine += t[i] * tangent_[i];
            if (cosine < std::cos(kMaxTurn)) continue;
            if (std::abs(curve_.place(z) - curve_.place(z_)) > kMaxRangeStep * span) continue;
            if (place_slope(z, t) * place_slope(z_, tangent_) < 0)
                result.folds.push_back(fold(length, [&](auto at, auto along) { return place_slope(at, along); }));
            if (input_slope(t) * input_slope(tangent_) < 0)
                result.input_folds.push_back(fold(length, [&](auto, auto along) { return input_slope(along); }));
            take(z, t);
            result.states.push_back(curve_.state(z_));
            if (iterations <= kQuickNewton) length = std::min(1.5 * length, kMaxLength);
            return true;
        }
        return false;
    }

    void take(const std::vector<double>& z, std::vector<double> t) {
        const auto fresh = curve_.sizes(z, largest_);
        double norm = 0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            t[i] *= sizes_[i] / fresh[i];
            norm += t[i] * t[i];
        }
        for (double& component : t) component /= std::sqrt(norm);
        z_ = z;
        sizes_ = fresh;
        tangent_ = std::move(t);
    }

    /// Finds the point between the present one and one further on at which the slope changes its sign.
    template <class Slope>
    Fold fold(double length, const Slope& slope) const {
        const double before = slope(z_, tangent_);
        double low = 0, high = length;
        std::vector<double> z = z_, t = tangent_;
        for (int k = 0; k < kFoldBisections && high - low > kFoldExact; ++k) {
            const double middle = 0.5 * (low + high);
            int iterations = 0;
            if (!step_to(middle, z, t, iterations)) break;
            (slope(z, t) * before > 0 ? low : high) = middle;
        }
        return {.state = curve_.state(z), .upper = before > 0, .jumps = {}};
    }

    std::string described(const SteadyState& state) const {
        const auto& plant = range_.plant;
        std::string result = branch_.scheduling_name() + " = " + text(state.at, 6) + " (";
        for (std::size_t i = 0; i < state.x.size(); ++i)
            result += (i > 0 ? ", " : "") + plant.states[i].name + " = " + text(state.x[i], 6);
        return result + ", " + plant.input.name + " = " + text(state.u, 6) + ")";
    }

    Error no_way(const SteadyState& last) const {
        const NonlinearSystem& system = branch_.system();
        std::vector<double> x = last.x;
        if (range_.along == Along::parameter) x.push_back(last.p);
        const std::string fault = system.derivative_fault(x, last.u);
        return {ErrorKind::invalid_argument, "range",
                "The steady states cannot be followed beyond " + described(last) +
                    (fault.empty() ? ": the equations are not defined beyond it, or the input does not move the output "
                                     "there."
                                   : ": " + fault + ".") +
                    " Give a range that ends before that point."};
    }

    const SteadyBranch& branch_;
    const EquationsRange& range_;
    const SteadyCurve& curve_;
    std::vector<double> z_, tangent_, sizes_, largest_;
};

namespace {

/// Error of a fold inside the range: its meaning and how to avoid it.
Error folded(const SteadyBranch& branch, Fold fold) {
    const auto& range = branch.range();
    const std::string name = branch.scheduling_name();
    std::string message = "The branch of steady states turns back at " + name + " = " + text(fold.state.at, 6) +
                          " (y = " + text(fold.state.y, 6) + ", " + range.plant.input.name + " = " +
                          text(fold.state.u, 6) + "): with a " + (fold.upper ? "larger " : "smaller ") + name +
                          " there is none near";
    message += fold.jumps.empty() ? ", and the plant leaves this branch. "
                                  : ", and the plant jumps to y = " + text(fold.jumps.front(), 6) + ". ";
    message += range.along == Along::output
                   ? "The output has a maximum or a minimum there, so the gain changes its sign. Give a range on one "
                     "side of it."
                   : "Give a range that ends before that point, or choose a range along the output, which the loop "
                     "controls.";
    return {ErrorKind::invalid_argument, "range/" + std::string(fold.upper ? "to" : "from"), message};
}

/// Finds the other points at which the walk passes the value of a fold.
void find_jumps(Fold& fold, const std::vector<SteadyState>& walk) {
    const double size = std::abs(walk.back().y - walk.front().y);
    for (std::size_t i = 1; i < walk.size(); ++i) {
        const double a = walk[i - 1].at - fold.state.at, b = walk[i].at - fold.state.at;
        if (a * b > 0 || a == b) continue;
        const double y = walk[i - 1].y + (walk[i].y - walk[i - 1].y) * a / (a - b);
        if (std::abs(y - fold.state.y) > 0.02 * size) fold.jumps.push_back(y);
    }
}

std::optional<Error> fault_of(const EquationsRange& range) {
    const auto invalid = [](std::string where, std::string message) {
        return Error{ErrorKind::invalid_argument, std::move(where), std::move(message)};
    };
    if (!std::isfinite(range.from) || !std::isfinite(range.to) || !(range.from < range.to))
        return invalid("range/from", "The range goes from " + text(range.from) + " to " + text(range.to) +
                                         "; from must be less than to.");
    if (range.along != Along::parameter) return std::nullopt;
    for (const Parameter& parameter : range.plant.parameters)
        if (parameter.name == range.parameter) {
            if (std::holds_alternative<double>(parameter.value)) return std::nullopt;
            return invalid("range/parameter", "Parameter " + range.parameter +
                                                  " is an expression; only a parameter given as a number can vary over "
                                                  "the range.");
        }
    return invalid("range/parameter", "\"" + range.parameter + "\" is not a parameter of this plant.");
}

/// The plant with its parameter as an additional last state, whose rate is 0.
NonlinearPlant with_parameter_state(NonlinearPlant plant, const std::string& name) {
    const auto found = std::ranges::find(plant.parameters, name, &Parameter::name);
    plant.states.push_back({name, std::get<double>(found->value)});
    plant.parameters.erase(found);
    plant.equations.push_back({name, "0"});
    return plant;
}

}  // namespace

std::optional<Error> SteadyBranch::prepare() {
    if (auto fault = fault_of(range_)) return fault;
    auto system = NonlinearSystem::make(range_.plant);
    if (!system) return system.error();
    NonlinearPlant plant = range_.plant;
    for (std::size_t i = 0; i < plant.states.size(); ++i) plant.states[i].value = system->x_steady()[i];
    if (range_.along == Along::parameter) {
        plant = with_parameter_state(plant, range_.parameter);
        auto extended = NonlinearSystem::make(plant);
        if (!extended)
            return Error{ErrorKind::invalid_argument, "range/parameter",
                         "Parameter " + range_.parameter + " cannot vary: " + extended.error().message +
                             " If other parameters depend on it, write their expressions into the equations."};
        start_.p = plant.states.back().value;
        system = std::move(extended);
    }
    system_ = std::make_shared<const NonlinearSystem>(std::move(*system));
    const auto x = system_->x_steady();
    start_.x.assign(x.begin(), x.begin() + std::ptrdiff_t(range_.plant.states.size()));
    start_.u = system_->u_nominal();
    start_.y = system_->y_steady();
    start_.at = range_.along == Along::input ? start_.u : range_.along == Along::output ? start_.y : start_.p;
    low_ = range_.from;
    high_ = range_.to;
    return std::nullopt;
}

Expected<SteadyBranch> SteadyBranch::follow(const EquationsRange& range) {
    SteadyBranch branch(range);
    if (auto error = branch.prepare()) return *error;
    const SteadyCurve curve(*branch.system_, range, branch.start_);
    const double start = branch.start_.at;
    std::vector<SteadyState> all = {branch.start_};
    for (const bool up : {false, true}) {
        const double end = up ? range.to : range.from;
        if (up ? start >= end : start <= end) continue;
        auto walk = BranchWalk(branch, curve).run(branch.start_, up, end);
        for (Fold& fold : walk.folds) {
            find_jumps(fold, walk.states);
            return folded(branch, fold);
        }
        if (walk.ended) return *walk.ended;
        branch.input_folds_.insert(branch.input_folds_.end(), walk.input_folds.begin(), walk.input_folds.end());
        all.insert(all.end(), walk.states.begin() + 1, walk.states.end());
    }
    std::ranges::sort(all, {}, &SteadyState::at);
    branch.states_ = std::move(all);
    if (range.along == Along::input) branch.input_folds_.clear();
    std::erase_if(branch.input_folds_,
                  [&](const Fold& fold) { return fold.state.at < range.from || fold.state.at > range.to; });
    for (const SteadyState& state : branch.states_) {
        if (state.at < range.from || state.at > range.to) continue;
        const double low = branch.system_->u_min(), high = branch.system_->u_max();
        if (state.u >= low && state.u <= high) continue;
        return Error{ErrorKind::invalid_argument, "range/" + std::string(state.at > start ? "to" : "from"),
                     "Resting at " + branch.scheduling_name() + " = " + text(state.at, 6) + " takes " +
                         range.plant.input.name + " = " + text(state.u, 6) + ", beyond its limits of " + text(low) +
                         " to " + text(high) + ". Narrow the range along the " + where_word(range) +
                         ", or widen the limits."};
    }
    return branch;
}

Expected<SteadyState> SteadyBranch::at(double place) const {
    const SteadyCurve curve(*system_, range_, start_);
    if (states_.size() < 2) return start_;
    const auto after = std::ranges::upper_bound(states_.begin() + 1, states_.end() - 1, place, {}, &SteadyState::at);
    const SteadyState &left = *(after - 1), &right = *after;
    const double share = std::clamp((place - left.at) / (right.at - left.at), 0.0, 1.0);
    const auto a = curve.z(left), b = curve.z(right);
    std::vector<double> z(a.size()), largest;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = a[i] + share * (b[i] - a[i]);
    const auto sizes = curve.sizes(z, largest);
    if (curve.correct_to_place(z, sizes, place)) return curve.state(z);
    // Near one of the neighbours, that neighbour is a good start.
    z = share < 0.5 ? a : b;
    if (curve.correct_to_place(z, sizes, place)) return curve.state(z);
    return Error{ErrorKind::numerical_failure, "range",
                 "The steady state at " + scheduling_name() + " = " + text(place, 6) +
                     " could not be computed between those at " + text(left.at, 6) + " and " + text(right.at, 6) +
                     ". Scale the equations so that their states are of similar size."};
}

StateSpace SteadyBranch::linearised(const SteadyState& state) const {
    std::vector<double> x = state.x;
    if (range_.along == Along::parameter) x.push_back(state.p);
    const std::size_t order = x.size(), n = state.x.size();
    std::vector<double> A(order * order), B(order), C(order);
    system_->jacobian(x, state.u, A, B);
    system_->output_gradient(x, C);
    StateSpace model{.A = {}, .B = {}, .C = {}, .D = 0, .L = system_->dead_time(), .uncertainty = {}};
    for (std::size_t i = 0; i < n; ++i) {
        model.A.emplace_back(&A[i * order], &A[i * order] + n);
        model.B.push_back(B[i]);
        model.C.push_back(C[i]);
    }
    return model;
}

NonlinearPlant SteadyBranch::plant_at(const SteadyState& state) const {
    NonlinearPlant plant = range_.plant;
    for (std::size_t i = 0; i < state.x.size(); ++i) plant.states[i].value = state.x[i];
    plant.input.nominal = state.u;
    if (range_.along == Along::parameter)
        std::ranges::find(plant.parameters, range_.parameter, &Parameter::name)->value = state.p;
    return plant;
}

std::string SteadyBranch::scheduling_name() const {
    if (range_.along == Along::input) return range_.plant.input.name;
    return range_.along == Along::output ? "y" : range_.parameter;
}

}  // namespace tunewright::range
