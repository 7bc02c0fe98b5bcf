// The linear systems of the model structures with a piecewise constant input: steps of any length by the exact
// exponential, and several steps of the same length at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "engine/numerics/pair.h"

namespace tunewright::unit_systems {

/// Steps of DrivenState::march: two pairs.
inline constexpr std::size_t kMarch = 4;

/// Evenly spaced times differ by their rounding; steps this close share their exponentials. Over a million samples the
/// error is 1e-9 of the record's length.
inline constexpr double kSameStep = 1e-15;

template <std::size_t kOrder>
using StateRow = std::array<double, kOrder>;
template <std::size_t kOrder>
using StateMatrix = std::array<StateRow<kOrder>, kOrder>;

template <std::size_t kOrder>
StateMatrix<kOrder> product(const StateMatrix<kOrder>& a, const StateMatrix<kOrder>& b) {
    StateMatrix<kOrder> out{};
    for (std::size_t i = 0; i < kOrder; ++i)
        for (std::size_t j = 0; j < kOrder; ++j)
            for (std::size_t k = 0; k < kOrder; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// The response x, its slope and its curvature (0, 1, 2) as functions of the input v and of e, the state minus its
/// steady state for v.
template <std::size_t kOrder>
struct Readings {
    StateRow<kOrder> jump;                     ///< change of e for each unit by which v falls
    std::array<StateRow<kOrder>, 3> of_state;  ///< e's part
    std::array<double, 3> of_input;            ///< v's part
    bool integrates = false;                   ///< x also contains the integral of v
};

/// One step. The transitions of two lengths are stored: the usual one, and the remainder after a change of the input
/// between samples.
template <std::size_t kOrder, class Transition>
class Steps {
public:
    explicit Steps(const Transition& transition) : transition_(transition) {}

    const StateMatrix<kOrder>& over(double dt) {
        if (kOrder == 0 || std::abs(dt - usual_.dt) <= kSameStep) [[likely]]
            return usual_.by;
        return unusual(dt);
    }

private:
    struct Kept {
        double dt = -1;
        StateMatrix<kOrder> by{};
    };

    [[gnu::noinline]] const StateMatrix<kOrder>& unusual(double dt) {
        if (std::abs(dt - other_.dt) <= kSameStep) {
            std::swap(usual_, other_);
            return usual_.by;
        }
        other_.dt = dt;
        return other_.by = transition_.over(dt);
    }

    Transition transition_;
    Kept usual_, other_;
};

/// kMarch steps of the same length: the outputs after each of them, and the last state.
template <std::size_t kOrder>
struct March {
    double dt = -1;
    std::array<std::array<std::array<Pair, kMarch / 2>, kOrder>, 3> read{};  ///< weight of e_j in output d
    StateMatrix<kOrder> last{};

    void prepare(double step, const StateMatrix<kOrder>& once, const Readings<kOrder>& readings) {
        dt = step;
        last = once;
        for (std::size_t k = 0; k < kMarch; ++k) {
            if (k > 0) last = product(last, once);
            for (std::size_t d = 0; d < 3; ++d) {
                for (std::size_t j = 0; j < kOrder; ++j) {
                    double part = 0;
                    for (std::size_t l = 0; l < kOrder; ++l) part += readings.of_state[d][l] * last[l][j];
                    read[d][j][k / 2][static_cast<int>(k % 2)] = part;
                }
            }
        }
    }
};

/// The state: initially at rest with v = 0. Steps and March are separate objects, because their non-inlined functions
/// would keep this one in memory.
template <std::size_t kOrder>
class DrivenState {
public:
    explicit DrivenState(const Readings<kOrder>& readings) : readings_(readings) {}

    /// Sets v from now on.
    void enter(double input) {
        for (std::size_t j = 0; j < kOrder; ++j) e_[j] += readings_.jump[j] * (v_ - input);
        v_ = input;
    }

    /// Only a product, because the next step depends on it. `over` is the transition over dt.
    void advance(double dt, const StateMatrix<kOrder>& over) {
        step(over);
        area_ += v_ * dt;
    }

    /// Writes x to to[0][i], and its derivatives up to kDerivatives to to[1][i] and to[2][i].
    template <int kDerivatives>
    void read(const std::array<double*, 3>& to, std::size_t i) const {
#pragma GCC unroll 3
        for (int d = 0; d <= kDerivatives; ++d) {
            double sum = rest(d);
#pragma GCC unroll 3
            for (std::size_t j = 0; j < kOrder; ++j) sum += readings_.of_state[d][j] * e_[j];
            to[d][i] = sum;
        }
    }

    /// Takes kMarch steps and writes their outputs from index i on: each state is this one times a power of the
    /// transition, so no step depends on the previous one, and the processor computes two in one instruction. `took` is
    /// their total time: a sum of rounded lengths would drift from it, and so would an integral.
    template <int kDerivatives>
    void march(const March<kOrder>& march, double took, const std::array<double*, 3>& to, std::size_t i) {
        read_march<0>(march, to[0] + i);
        if constexpr (kDerivatives > 0) read_march<1>(march, to[1] + i);
        if constexpr (kDerivatives > 1) read_march<2>(march, to[2] + i);
        step(march.last);
        area_ += v_ * took;
    }

private:
    double rest(int d) const { return readings_.of_input[d] * v_ + (d == 0 && readings_.integrates ? area_ : 0); }

    template <int d>
    void read_march(const March<kOrder>& march, double* to) const {
        const double base = rest(d), rise = d == 0 && readings_.integrates ? v_ * march.dt : 0;
        Pair first = Pair{1, 2} * rise + base, second = Pair{3, 4} * rise + base;
#pragma GCC unroll 3
        for (std::size_t j = 0; j < kOrder; ++j) {
            first += march.read[d][j][0] * e_[j];
            second += march.read[d][j][1] * e_[j];
        }
        store(to, first);
        store(to + 2, second);
    }

    [[gnu::always_inline]] void step(const StateMatrix<kOrder>& by) {
        if constexpr (kOrder == 0) return;
        StateRow<kOrder> next{};
#pragma GCC unroll 3
        for (std::size_t j = 0; j < kOrder; ++j)
#pragma GCC unroll 3
            for (std::size_t k = 0; k < kOrder; ++k) next[j] += by[j][k] * e_[k];
        // A smaller state is set to 0: it would decay to denormal numbers, which are a hundred times slower, and stay
        // there.
        constexpr double kAtRest = 1e-250;
        if (std::all_of(next.begin(), next.end(), [](double e) { return std::abs(e) < kAtRest; })) next.fill(0);
        e_ = next;
    }

    Readings<kOrder> readings_;
    double v_ = 0, area_ = 0;
    StateRow<kOrder> e_{};
};

/// A system whose e decays by `transition.over(dt)`, a StateMatrix.
template <std::size_t kOrder, class Transition>
struct DrivenSystem {
    Readings<kOrder> readings;
    Transition transition;
};

/// x' = v.
struct Integration {
    StateMatrix<0> over(double) const { return {}; }
};
inline DrivenSystem<0, Integration> integrator() { return {{{}, {}, {0, 1, 0}, true}, {}}; }

/// T e' = -e.
struct Decay {
    double T;
    StateMatrix<1> over(double dt) const { return {{{std::exp(-dt / T)}}}; }
};

/// T x' + x = v. T < 0: unstable.
inline DrivenSystem<1, Decay> lag(double T) { return {{{1}, {{{1}, {-1 / T}, {1 / (T * T)}}}, {1, 0, 0}}, {T}}; }

/// x' = l, T l' + l = v: x is the integral of v minus T l.
inline DrivenSystem<1, Decay> lagged_integrator(double T) {
    return {{{1}, {{{-T}, {1}, {-1 / T}}}, {-T, 1, 0}, true}, {T}};
}

/// a2 e'' + a1 e' + e = 0, for (e, e'): in closed form by the roots -sigma +- w (real) or -sigma +- i w.
class QuadraticDecay {
public:
    QuadraticDecay(double a1, double a2);
    StateMatrix<2> over(double dt) const;

private:
    enum class Kind { real, equal, complex };

    double a2_, sigma_, w_ = 0, slow_ = 0;
    Kind kind_ = Kind::real;
};

/// From e^(-sigma dt) times cosh(w dt) and sinh(w dt)/w, or the corresponding cos and sin.
inline StateMatrix<2> QuadraticDecay::over(double dt) const {
    double cosine = 0, sine = 0;
    if (kind_ == Kind::real) {
        const double apart = 2 * w_ * dt, slow = std::exp(-slow_ * dt);
        constexpr double kNoCancellation = 0.3;  // above it e^(-x) - 1 is accurate, and faster
        const double ratio = apart > kNoCancellation ? std::exp(-apart) - 1 : std::expm1(-apart);
        cosine = slow * (1 + 0.5 * ratio);
        sine = -slow * ratio / (2 * w_);
    } else if (kind_ == Kind::equal) {
        cosine = std::exp(-sigma_ * dt);
        sine = cosine * dt;
    } else {
        const double decay = std::exp(-sigma_ * dt);
        cosine = decay * std::cos(w_ * dt);
        sine = decay * std::sin(w_ * dt) / w_;
    }
    return {{{cosine + sigma_ * sine, sine}, {-sine / a2_, cosine - sigma_ * sine}}};
}

/// a2 x'' + a1 x' + x = v.
inline DrivenSystem<2, QuadraticDecay> second_order(double a1, double a2) {
    return {{{1, 0}, {{{1, 0}, {0, 1}, {-1 / a2, -a1 / a2}}}, {1, 0, 0}}, {a1, a2}};
}

/// x' = l, a2 l'' + a1 l' + l = v: x is the integral of v minus a1 l + a2 l'.
inline DrivenSystem<2, QuadraticDecay> integrated_second_order(double a1, double a2) {
    return {{{1, 0}, {{{-a1, -a2}, {1, 0}, {0, 1}}}, {-a1, 1, 0}, true}, {a1, a2}};
}

/// T3 e' + e = l, a2 l'' + a1 l' + l = 0, for (l, l' sqrt(a2), e).
struct CubicDecay {
    double T3, a1, a2;
    StateMatrix<3> over(double dt) const;
};

/// T3 x' + x = l, a2 l'' + a1 l' + l = v.
inline DrivenSystem<3, CubicDecay> third_order(double T3, double a1, double a2) {
    const double w = 1 / std::sqrt(a2), f = 1 / T3;
    return {{{1, 0, 1}, {{{0, 0, 1}, {f, 0, -f}, {-f * f, w * f, f * f}}}, {1, 0, 0}}, {T3, a1, a2}};
}

}  // namespace tunewright::unit_systems
