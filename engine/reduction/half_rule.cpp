#include "engine/reduction/half_rule.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "engine/number_text.h"
#include "engine/reduction/step_reading.h"

namespace tunewright {
namespace {

constexpr double kMinDamping = 0.5;      // below it a pair oscillates and cannot be replaced by lags
constexpr double kCloseTo = 1.6 - 1e-9;  // the source's own example has a ratio of 1.6 and does not count it as close
constexpr double kNearlyReal = 0.99;     // computed repeated real poles of a polynomial are such pairs

constexpr double kOfDeadTime = 5;       // T2 and T3: lags and leads longer than 5 theta are equivalent for the loop
constexpr int kMaxRounds = 20;          // rounds of the fixed point; two or three are usual
constexpr double kSameDeadTime = 1e-9;  // relative difference between two rounds

struct TimeConstants {
    std::vector<double> lags;   // falling
    std::vector<double> leads;  // of left-half-plane zeros, in descending order
    double delay = 0;           // dead time and right-half-plane zeros
    std::vector<Warning> warnings;
};

Expected<TimeConstants> time_constants(const LinearPlant& plant) {
    TimeConstants found;
    found.delay = plant.dead_time();
    for (const auto pole : plant.poles()) {
        const double zeta = -pole.real() / std::abs(pole);
        if (zeta < kMinDamping)
            return reduction_fails("the plant has poles with damping " + text(zeta) + " (below 0.5).");
        if (zeta < kNearlyReal && pole.imag() > 0)
            found.warnings.push_back({"complex-poles-as-lags", "A pole pair with damping " + text(zeta) + " at " +
                                                                   text(std::abs(pole)) +
                                                                   " rad per time unit was taken as two equal lags."});
        // Each lag of the pair is zeta T with T = 1/|p|, which keeps the sum 2 zeta T.
        found.lags.push_back(zeta / std::abs(pole));
    }
    for (const auto zero : plant.zeros()) {
        if (zero.imag() != 0) return reduction_fails("the plant has complex zeros.");
        if (zero.real() > 0)
            found.delay += 1 / zero.real();
        else
            found.leads.push_back(-1 / zero.real());
    }
    std::ranges::sort(found.lags, std::greater{});
    std::ranges::sort(found.leads, std::greater{});
    return found;
}

// The lag that a lead is cancelled against: the closest larger one, or the closest smaller one if that is nearer and
// within 1.6.
size_t partner(const std::vector<double>& lags, double lead) {
    const auto smaller = std::ranges::find_if(lags, [&](double lag) { return lag < lead; });
    const size_t at_smaller = static_cast<size_t>(smaller - lags.begin());
    if (at_smaller == 0) return 0;
    if (smaller == lags.end()) return at_smaller - 1;
    const double to_smaller = lead / *smaller, to_larger = lags[at_smaller - 1] / lead;
    return to_smaller < to_larger && to_smaller < kCloseTo ? at_smaller : at_smaller - 1;
}

// Replaces (lead s + 1)/(lag s + 1) by a gain and a remaining lag: rules T1 to T3; theta is the effective dead time.
struct Cancelled {
    double factor = 1, lag = 0;
};

Cancelled cancel(double lead, double lag, double theta) {
    if (lag <= lead) {
        if (lag >= theta) return {lead / lag, 0};     // T1
        if (lead >= theta) return {lead / theta, 0};  // T1a
        return {1, 0};                                // T1b
    }
    if (lead >= kOfDeadTime * theta) return {lead / lag, 0};  // T2
    const double shortened = std::min(lag, kOfDeadTime * theta);
    return {shortened / lag, shortened - lead};  // T3
}

struct WithoutLeads {
    double factor = 1;
    std::vector<double> lags;
};

std::optional<WithoutLeads> cancel_leads(const TimeConstants& found, double theta) {
    WithoutLeads left{1, found.lags};
    for (const double lead : found.leads) {
        if (left.lags.empty()) return std::nullopt;
        const size_t at = partner(left.lags, lead);
        const Cancelled cancelled = cancel(lead, left.lags[at], theta);
        left.factor *= cancelled.factor;
        left.lags.erase(left.lags.begin() + static_cast<std::ptrdiff_t>(at));
        if (cancelled.lag > 0) left.lags.push_back(cancelled.lag);
        std::ranges::sort(left.lags, std::greater{});
    }
    return left;
}

// Eqs. 10 and 11. An integrator is an infinite lag: adding half of a neglected lag does not change it, so the whole lag
// becomes dead time.
ReducedModel share_out(const TimeConstants& found, const WithoutLeads& left, const LinearPlant& plant,
                       ReducedOrder order) {
    ReducedModel model;
    model.integrators = plant.integrators();
    model.K = plant.low_frequency_gain() * left.factor;
    model.L = found.delay;
    const size_t slots = order == ReducedOrder::first ? 1 : 2;
    const size_t kept =
        slots > static_cast<size_t>(model.integrators) ? slots - static_cast<size_t>(model.integrators) : 0;
    std::vector<double> T(2, 0.0);
    for (size_t i = 0; i < left.lags.size(); ++i) {
        if (i < kept) {
            T[i] = left.lags[i];
        } else if (i == kept && kept > 0) {
            T[kept - 1] += left.lags[i] / 2;
            model.L += left.lags[i] / 2;
        } else {
            model.L += left.lags[i];
        }
    }
    model.T1 = std::max(T[0], T[1]);
    model.T2 = std::min(T[0], T[1]);
    return model;
}

}  // namespace

Expected<ReducedModel> half_rule(const LinearPlant& plant, ReducedOrder order) {
    const auto found = time_constants(plant);
    if (!found) return found.error();
    // The rules for leads need the effective dead time that results from them: a short fixed-point iteration (Section
    // 2.2). It starts from that of the plant without its leads, because with a smaller value it would cancel leads that
    // the result keeps.
    ReducedModel model = share_out(*found, {1, found->lags}, plant, order);
    double theta = model.L;
    for (int round = 0; round < kMaxRounds; ++round) {
        const auto left = cancel_leads(*found, theta);
        if (!left) return reduction_fails("a zero in the left half-plane has no lag that could cancel it.");
        model = share_out(*found, *left, plant, order);
        if (std::abs(model.L - theta) <= kSameDeadTime * model.L) break;
        theta = model.L;
    }
    model.exact = found->leads.empty() && found->warnings.empty() && model.L == plant.dead_time();
    model.warnings = found->warnings;
    return model;
}

}  // namespace tunewright
