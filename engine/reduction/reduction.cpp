#include "engine/reduction/reduction.h"

#include <cmath>
#include <optional>

#include "engine/number_text.h"
#include "engine/reduction/half_rule.h"
#include "engine/reduction/min_error.h"
#include "engine/reduction/step_reading.h"

namespace tunewright {
namespace {

constexpr double kUndamped = 1e-9;  // damping below which a mode counts as lying on the axis

Error no_rule(const std::string& reason) {
    return {ErrorKind::unsupported, "plant",
            reason + " Rules that need a reduced model do not support this plant; use the method robust."};
}

// Error of a plant that no reduction here can represent.
std::optional<Error> beyond_reduction(const LinearPlant& plant, ReducedOrder order) {
    for (const auto pole : plant.poles()) {
        if (pole.real() > kUndamped * std::abs(pole))
            return no_rule("The plant is unstable (a pole at " + text(pole.real()) +
                           (pole.imag() != 0 ? " with imaginary part" : "") + ").");
        if (pole.real() > -kUndamped * std::abs(pole))
            return no_rule("The plant has an undamped oscillation at " + text(std::abs(pole)) + " rad per time unit.");
    }
    if (plant.integrators() < 0)
        return no_rule("The plant has a zero at s = 0: it has no static gain, so integral action cannot hold it.");
    const int max = order == ReducedOrder::first ? 1 : 2;
    if (plant.integrators() > max)
        return no_rule("The plant has " + std::to_string(plant.integrators()) +
                       " integrators; the model can have at "
                       "most " +
                       std::to_string(max) + ".");
    return std::nullopt;
}

bool has_horizon(ReductionMethod method) {
    return method == ReductionMethod::min_ise || method == ReductionMethod::min_iae ||
           method == ReductionMethod::min_itae;
}

Expected<ReducedModel> reduce_by(ReductionMethod method, const LinearPlant& plant, const ReductionRequest& request) {
    if (method == ReductionMethod::half_rule || plant.integrators() > 1) return half_rule(plant, request.order);
    if (method == ReductionMethod::two_point_123c) return two_point_123c(plant, request.order);
    if (has_horizon(method)) return min_error(plant, request);
    return tangent(plant, request.tangent_time);
}

const char* kCure = "the method robust, which needs no reduction.";

ReductionMethod other_than(ReductionMethod method) {
    return method == ReductionMethod::half_rule ? ReductionMethod::tangent : ReductionMethod::half_rule;
}

Error named_method_fails(ReductionMethod method, const Error& reason) {
    return {ErrorKind::unsupported, reason.where,
            std::string(to_string(method)) + " does not apply: " + reason.message + " Choose the reduction " +
                to_string(other_than(method)) + ", or " + kCure};
}

Error horizon_unused(ReductionMethod method) {
    return {ErrorKind::invalid_argument, "reduction/horizon",
            std::string("horizon is given, but the reduction ") + to_string(method) +
                " has none: omit it, or choose min_ise, min_iae or min_itae."};
}

Error both_fail(ReductionMethod preferred, const Error& first, const Error& second) {
    return {ErrorKind::unsupported, "plant",
            std::string("The plant has no simple model. ") + to_string(preferred) + ": " + first.message + " " +
                to_string(other_than(preferred)) + ": " + second.message + " Use " + kCure};
}

// A plant that already has the requested form is not changed, whatever the method.
bool has_form(const LinearPlant& plant, ReducedOrder order) {
    if (!plant.zeros().empty()) return false;
    for (const auto pole : plant.poles())
        if (pole.imag() != 0) return false;
    const int lags = static_cast<int>(plant.poles().size()) + plant.integrators();
    return lags <= (order == ReducedOrder::first ? 1 : 2);
}

}  // namespace

const char* to_string(ReductionMethod method) {
    switch (method) {
        case ReductionMethod::automatic: return "auto";
        case ReductionMethod::half_rule: return "half_rule";
        case ReductionMethod::tangent: return "tangent";
        case ReductionMethod::two_point_123c: return "123c";
        case ReductionMethod::min_ise: return "min_ise";
        case ReductionMethod::min_iae: return "min_iae";
        case ReductionMethod::min_itae: return "min_itae";
    }
    return "auto";
}

ReductionMethod reduction_method(const std::string& word) {
    for (const auto method : {ReductionMethod::half_rule, ReductionMethod::tangent, ReductionMethod::two_point_123c,
                              ReductionMethod::min_ise, ReductionMethod::min_iae, ReductionMethod::min_itae})
        if (word == to_string(method)) return method;
    return ReductionMethod::automatic;
}

Plant ReducedModel::plant() const {
    if (integrators == 2) return TransferFunction{.num = {K}, .den = {1, 0, 0}, .L = L};
    if (integrators == 1) return Ipdt{.K = K, .L = L, .T = T1};
    if (T2 > 0) return Sopdt{.K = K, .T1 = T1, .T2 = T2, .L = L};
    return Fopdt{.K = K, .T = T1, .L = L};
}

Expected<ReducedModel> reduce(const LinearPlant& plant, const ReductionRequest& request) {
    if (const auto error = beyond_reduction(plant, request.order)) return *error;
    if (request.horizon && !has_horizon(request.method)) return horizon_unused(request.method);
    if (has_form(plant, request.order)) return half_rule(plant, request.order);
    if (request.method != ReductionMethod::automatic) {
        auto model = reduce_by(request.method, plant, request);
        if (!model && model.error().kind == ErrorKind::invalid_argument) return model;
        return model ? model : named_method_fails(request.method, model.error());
    }
    auto first = reduce_by(request.preferred, plant, request);
    if (first) return first;
    auto second = reduce_by(other_than(request.preferred), plant, request);
    return second ? second : both_fail(request.preferred, first.error(), second.error());
}

}  // namespace tunewright
