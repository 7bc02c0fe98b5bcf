#include "engine/identification/controller_law/law_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr double kOddDeviations = 6;   // off the law: rounding and white noise reach 4 in a thousand rows
constexpr std::size_t kOddShare = 50;  // at most one row in so many at a time, the farthest first
constexpr double kHiddenSteps = 1.3;   // of u's rounding: the law may move u by one step without its being seen

double robust_deviation(std::vector<double> e) {
    for (double& value : e) value = std::abs(value);
    return 1.4826 * median(std::move(e));
}

}  // namespace

LawResiduals law_residuals(const LawSamples& s, const std::vector<char>& used, const FoundLaw& law) {
    LawResiduals out;
    out.white = whitened(law_columns(s, law.shape), used, law.theta, s.r.empty());
    out.increment = increments_of(used, s.r.empty());
    out.e = out.white[kLawTarget];
    for (const int column : law.columns) {
        const auto c = static_cast<std::size_t>(column);
        for (std::size_t k = 0; k < out.e.size(); ++k) out.e[k] -= law.fit.value[c] * out.white[c][k];
    }
    return out;
}

int leave_odd_out(const LawSamples& s, std::vector<char>& used, const FoundLaw& law, double least) {
    const LawResiduals r = law_residuals(s, used, law);
    const double limit = kOddDeviations * std::max(robust_deviation(r.e), 1.5 * least);
    std::vector<std::pair<double, int>> odd;
    for (std::size_t k = 0; k < r.e.size(); ++k)
        if (std::abs(r.e[k]) > limit && r.increment[k] >= 0) odd.emplace_back(-std::abs(r.e[k]), r.increment[k]);
    std::ranges::sort(odd);
    const std::size_t most = std::max<std::size_t>(2, r.e.size() / kOddShare);
    if (odd.size() > most) odd.resize(most);
    for (const auto& [size, j] : odd) used[static_cast<std::size_t>(j)] = 0;
    return static_cast<int>(odd.size());
}

void take_still_in(LawSamples& s, const FoundLaw& law, double hidden) {
    const LawColumns columns = law_columns(s, law.shape);
    const std::size_t n = s.t.size();
    for (std::size_t j = 0; j < n;) {
        // A loop at rest before its first move stands at an end of u's range too.
        const auto stands = [&](std::size_t k) { return s.still[k] && (!s.limited[k] || j == 0); };
        if (!stands(j)) {
            ++j;
            continue;
        }
        std::size_t to = j;
        while (to < n && stands(to) && s.u[to] == s.u[j]) ++to;
        double at = 0, low = 0, high = 0;
        for (std::size_t k = j + 1; k < to; ++k) {
            for (const int column : law.columns) {
                const auto c = static_cast<std::size_t>(column);
                at += law.fit.value[c] * columns[c][k];
            }
            low = std::min(low, at);
            high = std::max(high, at);
        }
        if (high - low <= kHiddenSteps * s.u_step + hidden)
            for (std::size_t k = j; k < to; ++k) s.still[k] = s.limited[k] = 0;
        j = to;
    }
}

}  // namespace tunewright
