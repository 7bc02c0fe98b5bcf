#include "engine/structure/decoupling/decoupler.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <utility>

#include "engine/blocks/diagram_stability.h"
#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/structure/decoupling/decoupler_blocks.h"

namespace tunewright::structure {
namespace {

using Complex = std::complex<double>;

constexpr double kSame = 1e-6;   // relative distance of a pole from the zero that it cancels
constexpr double kMaxJump = 10;  // first move of an element over its last
// Largest eigenvalue of E for s -> infinity: of gains alone any below 1 settles from call to call; with dead times
// those nearer to 1 echo for hundreds of passages.
constexpr double kMaxStaticLoop = 1, kMaxDynamicLoop = 0.95;

Error refused(std::string message) { return {ErrorKind::invalid_argument, "decoupler", std::move(message)}; }

std::string path(std::size_t i, std::size_t j) {
    return "from input " + std::to_string(j + 1) + " to output " + std::to_string(i + 1);
}

/// Removes what stands in both lists.
void cancel(std::vector<Complex>& a, std::vector<Complex>& b) {
    for (std::size_t i = 0; i < a.size();) {
        const auto same =
            std::ranges::find_if(b, [&](Complex other) { return std::abs(other - a[i]) <= kSame * std::abs(a[i]); });
        if (same == b.end()) {
            ++i;
            continue;
        }
        b.erase(same);
        a.erase(a.begin() + std::ptrdiff_t(i));
    }
}

double time_of(const std::vector<Complex>& roots) {
    double sum = 0;
    for (const Complex root : roots) sum += (-1.0 / root).real();
    return sum;
}

/// -cross/own by its lead, lag and dead time; of higher orders by the sums of the lags, which have its slope at s = 0.
Expected<Feedforward> ratio(const LinearPlant& cross, const LinearPlant& own, std::size_t i, std::size_t j) {
    if (cross.integrators() != own.integrators())
        return refused("The plants " + path(i, j) + " and " + path(i, i) +
                       " differ in their integrators: their ratio is no lead-lag.");
    if (cross.unstable_poles() + own.unstable_poles() > 0)
        return refused("The plant " + path(i, cross.unstable_poles() > 0 ? j : i) +
                       " is not stable: a simplified decoupler would cancel its poles.");
    std::vector<Complex> zeros(cross.zeros().begin(), cross.zeros().end()),
        poles(cross.poles().begin(), cross.poles().end());
    zeros.insert(zeros.end(), own.poles().begin(), own.poles().end());
    poles.insert(poles.end(), own.zeros().begin(), own.zeros().end());
    cancel(zeros, poles);
    Feedforward out{.Kf = -cross.low_frequency_gain() / own.low_frequency_gain(),
                    .Tz = time_of(zeros),
                    .Tp = time_of(poles),
                    .Lf = std::max(0.0, cross.dead_time() - own.dead_time())};
    if (out.Tz < 0 || out.Tp < 0)
        return refused("The ratio of the plants " + path(i, j) + " and " + path(i, i) +
                       " has no stable lead-lag near it: a zero lies in the right half-plane.");
    out.Tp = std::max(out.Tp, out.Tz / kMaxJump);
    return out;
}

Expected<Decoupler> static_decoupler(const PlantMatrix& plants) {
    const auto gains = analyse_gains(plants);
    if (!gains) return gains.error();
    Decoupler out{.kind = DecouplerKind::static_gains, .elements = {}, .unrealised = {}};
    for (std::size_t i = 0; i < plants.size(); ++i) {
        out.elements.emplace_back(plants.size());
        out.unrealised.emplace_back(plants.size(), 0.0);
        const double own = gains->gain[i][i];
        if (own == 0)
            return refused("The plant " + path(i, i) +
                           " has no gain at steady state next to the others of its row: no gains decouple the output.");
        for (std::size_t j = 0; j < plants.size(); ++j)
            if (j != i && gains->gain[i][j] != 0) out.elements[i][j] = Feedforward{.Kf = -gains->gain[i][j] / own};
    }
    return out;
}

Expected<Decoupler> simplified_decoupler(const PlantMatrix& plants) {
    Decoupler out{.kind = DecouplerKind::simplified, .elements = {}, .unrealised = {}};
    for (std::size_t i = 0; i < plants.size(); ++i) {
        out.elements.emplace_back(plants.size());
        out.unrealised.emplace_back(plants.size(), 0.0);
        for (std::size_t j = 0; j < plants.size(); ++j) {
            if (j == i || !plants[i][j]) continue;
            const auto element = ratio(*plants[i][j], *plants[i][i], i, j);
            if (!element) return element.error();
            out.elements[i][j] = *element;
            out.unrealised[i][j] = std::max(0.0, plants[i][i]->dead_time() - plants[i][j]->dead_time());
        }
    }
    return out;
}

/// Why the decoupler cannot run. Gains alone settle from call to call if their matrix has eigenvalues below 1; with
/// different dead times the signs say nothing, and those of the magnitudes must be.
std::optional<Error> unstable_by_itself(const Decoupling& elements) {
    const std::size_t n = elements.size();
    const bool of_gains = has_gains_alone(elements);
    std::vector<double> direct(n * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            if (const auto& one = elements[i][j]) direct[i * n + j] = of_gains ? one->Kf : std::abs(one->jump());
    double loop = 0;
    for (const Complex value : eigenvalues(direct, int(n))) loop = std::max(loop, std::abs(value));
    bool stable = loop < (of_gains ? kMaxStaticLoop : kMaxDynamicLoop);
    if (stable && !of_gains) {
        BlockDiagram alone;
        std::vector<int> from, to;
        for (std::size_t i = 0; i < n; ++i) from.push_back(alone.add_signal());
        for (std::size_t i = 0; i < n; ++i) to.push_back(alone.add_signal());
        add_decoupler(alone, elements, (1u << n) - 1, from, to);
        stable = count_unstable_poles(alone).stable();
    }
    if (stable) return std::nullopt;
    return refused(
        "The decoupler is not stable by itself: its elements feed each other with too much gain. Another pairing may "
        "do, or none.");
}

}  // namespace

const char* name_of(DecouplerKind kind) {
    switch (kind) {
        case DecouplerKind::static_gains: return "static";
        case DecouplerKind::simplified: return "simplified";
        default: return "none";
    }
}

Expected<Decoupler> design_decoupler(const PlantMatrix& plants, DecouplerKind kind) {
    if (kind == DecouplerKind::none) return Decoupler{};
    if (auto error = without_diagonal(plants)) return *error;
    auto out = kind == DecouplerKind::static_gains ? static_decoupler(plants) : simplified_decoupler(plants);
    if (!out) return out;
    if (auto error = unstable_by_itself(out->elements)) return *error;
    return out;
}

}  // namespace tunewright::structure
