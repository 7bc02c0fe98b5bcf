#include "engine/identification/controller_law/law_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/identification/controller_law/law_uncertainty.h"

namespace tunewright {
namespace {

bool same_terms(const FoundLaw& a, const FoundLaw& b) {
    return a.has(kLawI) == b.has(kLawI) && a.has(kLawD) == b.has(kLawD);
}

/// Moves the best of the laws that `is_wanted` accepts to the front; false if there is none.
template <class Wanted>
bool put_first(FoundLaws& laws, const Wanted& is_wanted) {
    auto best = laws.end();
    for (auto law = laws.begin() + 1; law != laws.end(); ++law)
        if (is_wanted(*law) && (best == laws.end() || law->criterion < best->criterion)) best = law;
    if (best == laws.end()) return false;
    std::rotate(laws.begin(), best, best + 1);
    return true;
}

/// True if a zero of I/s + P + D s is the filter's pole within its error: the law without derivative and filter.
bool cancels_filter(const LawSamples& s, const FoundLaw& law, const LawCovariance& error) {
    if (!law.has(kLawD) || law.shape.filter != LawFilter::measurement) return false;
    const double f = 1 / law.shape.ratio;  // of the sample spacing, in which I and D are given too
    const auto& v = law.fit.value;
    const double I = v[kLawI] * s.period, P = v[kLawP], D = v[kLawD] / s.period;
    const double at_pole = I - P * f + D * f * f;
    const std::array<std::pair<LawColumn, double>, 4> slopes = {
        {{kLawI, s.period}, {kLawP, -f}, {kLawD, f * f / s.period}, {kLawFilter, P * f - 2 * D * f * f}}};
    double square = 0;
    for (const auto& [a, da] : slopes)
        for (const auto& [b, db] : slopes) square += da * db * error[a][b];
    return !(at_pole * at_pole > kZeroDeviations * kZeroDeviations * square);
}

}  // namespace

double as_good(const FoundLaw& law) { return std::max(8.0, 0.05 * law.samples); }

void leave_zero_terms_out(const LawSamples& s, const std::vector<char>& used, FoundLaws& laws) {
    for (bool left_out = true; left_out;) {
        const FoundLaw now = laws.front();
        const LawCovariance error = law_covariance(s, used, now);
        const bool no_derivative =
            now.has(kLawD) && !(std::abs(now.fit.value[kLawD]) > kZeroDeviations * std::sqrt(error[kLawD][kLawD]));
        const bool no_filter = now.shape.filter != LawFilter::none &&
                               !(kZeroDeviations * std::sqrt(error[kLawFilter][kLawFilter]) < 1);  // of ln Tf
        const bool cancel = cancels_filter(s, now, error);
        left_out = (no_derivative || no_filter || cancel) && put_first(laws, [&](const FoundLaw& other) {
                       return no_derivative || cancel ? other.has(kLawI) == now.has(kLawI) && !other.has(kLawD)
                                                      : same_terms(other, now) && other.shape.filter == LawFilter::none;
                   });
    }
}

void prefer_filter(LawFilter filter, FoundLaws& laws) {
    if (laws.front().shape.filter == filter) return;
    put_first(laws, [now = laws.front(), filter](const FoundLaw& other) {
        return other.shape.filter == filter && same_terms(other, now) && other.criterion - now.criterion < as_good(now);
    });
}

}  // namespace tunewright
