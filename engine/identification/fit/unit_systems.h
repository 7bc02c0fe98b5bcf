// The linear systems of the model structures under an input that is constant piece by piece: steps of any length by the
// exact exponential, and several steps of one length at once.
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

/// Evenly spaced times differ by their rounding; steps this close share their exponentials. Over a million samples that
/// amounts to 1e-9 of the record's length.
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

/// How the response x, its slope and its curvature (0, 1, 2) follow from the input v and from e, the state less its
/// rest under v.
template <std::size_t kOrder>
struct Readings {
    StateRow<kOrder> jump;                     ///< of e, for each unit by which v falls
    std::array<StateRow<kOrder>, 3> of_state;  ///< e's part
    std::array<double, 3> of_input;            ///< v's part
    bool integrates = false;                   ///< x has the integral of v besides
};

/// One step. Of two lengths, the usual one and what a change of the input between samples leaves, each is kept.
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

/// kMarch steps of one length: what is read after each of them, and the last state.
template <std::size_t kOrder>
struct March {
    double dt = -1;
    std::array<std::array<std::array<Pair, kMarch / 2>, kOrder>, 3> read{};  ///< reading d of e_j
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

/// What moves: at rest under v = 0 first. Steps and March are other objects, whose functions out of line would keep
/// this one in memory.
template <std::size_t kOrder>
class DrivenState {
public:
    explicit DrivenState(const Readings<kOrder>& readings) : readings_(readings) {}

    /// v from now on.
    void enter(double input) {
        for (std::size_t j = 0; j < kOrder; ++j) e_[j] += readings_.jump[j] * (v_ - input);
        v_ = input;
    }

    /// A product alone, which the next step waits for. `over` is the transition over dt.
    void advance(double dt, const StateMatrix<kOrder>& over) {
        step(over);
        area_ += v_ * dt;
    }

    /// x to to[0][i], its derivatives up to kDerivatives to to[1][i] and to[2][i].
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

    /// kMarch steps, read from place i on: each state is this one times a power of the transition, so none waits for
    /// the one before, and the processor computes two in one instruction. `took` is their time from sample to sample: a
    /// sum of rounded lengths would drift from it, and an integral with it.
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
        // Smaller than this it is at rest. Left to decay it would end among denormal numbers, a hundred times as slow,
        // and never leave them.
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

/// x' = l, T l' + l = v: x is the integral of v less T l.
inline DrivenSystem<1, Decay> lagged_integrator(double T) {
    return {{{1}, {{{-T}, {1}, {-1 / T}}}, {-T, 1, 0}, true}, {T}};
}

/// a2 e'' + a1 e' + e = 0, of (e, e'): in closed form, through the roots -sigma +- w (real) or -sigma +- i w.
class QuadraticDecay {
public:
    QuadraticDecay(double a1, double a2);
    StateMatrix<2> over(double dt) const;

private:
    enum class Kind { real, equal, complex };

    double a2_, sigma_, w_ = 0, slow_ = 0;
    Kind kind_ = Kind::real;
};

/// From e^(-sigma dt) times cosh(w dt) and sinh(w dt)/w, or their trigonometric twins.
inline StateMatrix<2> QuadraticDecay::over(double dt) const {
    double cosine = 0, sine = 0;
    if (kind_ == Kind::real) {
        const double apart = 2 * w_ * dt, slow = std::exp(-slow_ * dt);
        constexpr double kNoCancellation = 0.3;  // e^(-x) - 1 keeps its digits from there on, and is faster
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

/// x' = l, a2 l'' + a1 l' + l = v: x is the integral of v less a1 l + a2 l'.
inline DrivenSystem<2, QuadraticDecay> integrated_second_order(double a1, double a2) {
    return {{{1, 0}, {{{-a1, -a2}, {1, 0}, {0, 1}}}, {-a1, 1, 0}, true}, {a1, a2}};
}

/// T3 e' + e = l, a2 l'' + a1 l' + l = 0, of (l, l' sqrt(a2), e).
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
