#include "engine/identification/fit/response.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

namespace tunewright {
namespace {

/// Evenly spaced times differ by their rounding; steps this close share their exponentials. Over a million samples that
/// amounts to 1e-9 of the record's length.
constexpr double kSameStep = 1e-15;

bool same_step(double a, double b) { return std::abs(a - b) <= kSameStep; }

/// The transition over two step lengths: the usual one, and what a change of the input between samples leaves.
template <class Transition>
class TwoSteps {
public:
    template <class Make>
    const Transition& over(double dt, const Make& make) {
        if (same_step(dt, usual_dt_)) [[likely]]
            return usual_;
        return unusual(dt, make);
    }

private:
    template <class Make>
    [[gnu::noinline]] const Transition& unusual(double dt, const Make& make) {
        if (same_step(dt, other_dt_)) {
            std::swap(usual_dt_, other_dt_);
            std::swap(usual_, other_);
            return usual_;
        }
        other_dt_ = dt;
        other_ = make(dt);
        return other_;
    }

    double usual_dt_ = -1, other_dt_ = -1;
    Transition usual_{}, other_{};
};

// Each system keeps how far its state is from the rest under the input: a step is then a product alone, which the next
// one waits for. `enter` gives the input that holds from now on.

/// Of a state: smaller than this it is at rest. Left to decay it would end among denormal numbers, a hundred times as
/// slow, and never leave them.
constexpr double kAtRest = 1e-250;

/// T x' + x = v; e = x - v.
struct Lag {
    double T, v = 0, e = 0;
    TwoSteps<double> decay = {};

    void enter(double input) {
        e += v - input;
        v = input;
    }
    void advance(double dt) {
        e *= decay.over(dt, [&](double step) { return std::exp(-step / T); });
        if (std::abs(e) < kAtRest) e = 0;
    }
    double value() const { return v + e; }
    double slope() const { return -e / T; }
    double curvature() const { return -slope() / T; }
};

/// x' = v.
struct Integrator {
    double v = 0, x = 0;

    void enter(double input) { v = input; }
    void advance(double dt) { x += v * dt; }
    double value() const { return x; }
    double slope() const { return v; }
    double curvature() const { return 0; }
};

/// x' = l, T l' + l = v; e = l - v.
struct LaggedIntegrator {
    double T, v = 0, x = 0, e = 0;
    TwoSteps<double> changes = {};

    void enter(double input) {
        e += v - input;
        v = input;
    }
    void advance(double dt) {
        const double change = e * changes.over(dt, [&](double step) { return std::expm1(-step / T); });
        x += v * dt - T * change;
        e += change;
        if (std::abs(e) < kAtRest) e = 0;
    }
    double value() const { return x; }
    double slope() const { return v + e; }
    double curvature() const { return -e / T; }
};

/// a2 x'' + a1 x' + x = v; e = x - v. The transition matrix over dt in closed form, through the roots -sigma +- w
/// (real) or -sigma +- i w.
class SecondOrder {
public:
    SecondOrder(double a1, double a2) : a1_(a1), a2_(a2), sigma_(a1 / (2 * a2)) {
        const double square = sigma_ * sigma_ - 1 / a2;
        // Nearly equal roots are taken as equal: the relative error of the response is below 1e-12.
        constexpr double kEqual = 1e-13;
        const double w2 = std::abs(square) < kEqual * sigma_ * sigma_ ? 0 : square;
        w_ = std::sqrt(std::abs(w2));
        kind_ = w2 == 0 ? Kind::equal : w2 > 0 ? Kind::real : Kind::complex;
        fast_ = sigma_ + w_;
        slow_ = 1 / (a2 * fast_);
    }

    void enter(double input) {
        e_ += v_ - input;
        v_ = input;
    }
    void advance(double dt) {
        const Turn& turn = turns_.over(dt, [&](double step) { return turn_over(step); });
        const double e = e_, e1 = x1_;
        e_ = turn.xx * e + turn.sine * e1;
        x1_ = turn.dx * e + turn.dd * e1;
        if (std::abs(e_) < kAtRest && std::abs(x1_) < kAtRest) e_ = x1_ = 0;
    }
    double value() const { return v_ + e_; }
    double slope() const { return x1_; }
    double curvature() const { return -(e_ + a1_ * x1_) / a2_; }

private:
    enum class Kind { real, equal, complex };

    /// The transition matrix [xx, sine; dx, dd] of (e, x').
    struct Turn {
        double xx = 1, sine = 0, dx = 0, dd = 1;
    };

    /// From e^(-sigma dt) times cosh(w dt) and sinh(w dt)/w, or their trigonometric twins.
    Turn turn_over(double dt) const {
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
        return {cosine + sigma_ * sine, sine, -sine / a2_, cosine - sigma_ * sine};
    }

    double a1_, a2_, sigma_, w_ = 0, fast_ = 0, slow_ = 0;
    Kind kind_ = Kind::real;
    TwoSteps<Turn> turns_;
    double v_ = 0, e_ = 0, x1_ = 0;
};

/// x' = l, a2 l'' + a1 l' + l = v, so that x is the integral of v less a1 l + a2 l'.
class IntegratedSecondOrder {
public:
    IntegratedSecondOrder(double a1, double a2) : a1_(a1), a2_(a2), l_(a1, a2) {}

    void enter(double input) {
        l_.enter(input);
        v_ = input;
    }
    void advance(double dt) {
        l_.advance(dt);
        area_ += v_ * dt;
    }
    double value() const { return area_ - a1_ * l_.value() - a2_ * l_.slope(); }
    double slope() const { return l_.value(); }
    double curvature() const { return l_.slope(); }

private:
    double a1_, a2_;
    SecondOrder l_;
    double v_ = 0, area_ = 0;
};

/// T3 x' + x = l, a2 l'' + a1 l' + l = v. The state is (l, l' sqrt(a2), x) less its rest under v.
class ThirdOrder {
public:
    ThirdOrder(double T3, double a1, double a2) : T3_(T3) {
        const double w = 1 / std::sqrt(a2);
        A_ << 0, w, 0, -w, -a1 / a2, 0, 1 / T3, 0, -1 / T3;
    }

    void enter(double input) {
        state_ += Eigen::Vector3d(v_ - input, 0, v_ - input);
        v_ = input;
    }
    void advance(double dt) {
        state_ = turns_.over(dt, [&](double step) { return exponential(A_ * step); }) * state_;
        if (state_.cwiseAbs().maxCoeff() < kAtRest) state_.setZero();
    }
    double value() const { return v_ + state_[2]; }
    double slope() const { return (state_[0] - state_[2]) / T3_; }
    double curvature() const { return (A_(0, 1) * state_[1] - slope()) / T3_; }

private:
    /// By Taylor's series of a part so short that its norm is below 1/2, squared back; the terms end below 1e-17.
    static Eigen::Matrix3d exponential(Eigen::Matrix3d M) {
        const double norm = M.cwiseAbs().rowwise().sum().maxCoeff();
        int halvings = 0;
        std::frexp(norm, &halvings);
        halvings = std::max(0, halvings + 1);
        M *= std::ldexp(1.0, -halvings);
        Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
        for (int k = 14; k > 0; --k) sum = Eigen::Matrix3d::Identity() + M * sum / k;
        for (; halvings > 0; --halvings) sum = (sum * sum).eval();
        return sum;
    }

    double T3_, v_ = 0;
    Eigen::Matrix3d A_;
    TwoSteps<Eigen::Matrix3d> turns_;
    Eigen::Vector3d state_ = Eigen::Vector3d::Zero();
};

template <int kDerivatives, class System>
void run(std::span<const double> times, const InputSteps& input, double L, System system, UnitResponse& out) {
    double now = 0;
    std::size_t j = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double t = times[i];
        for (; j < input.time.size() && input.time[j] + L <= t; ++j) {
            const double event = input.time[j] + L;
            if (event > now) system.advance(event - now);
            now = event;
            system.enter(input.level[j]);
        }
        if (t > now) system.advance(t - now);
        now = t;
        out.x[i] = system.value();
        if constexpr (kDerivatives > 0) out.x1[i] = system.slope();
        if constexpr (kDerivatives > 1) out.x2[i] = system.curvature();
    }
}

template <int kDerivatives>
void run(std::span<const double> t, const InputSteps& input, const ModelShape& shape, UnitResponse& out) {
    switch (shape.structure) {
        case Structure::fopdt: return run<kDerivatives>(t, input, shape.L(), Lag{shape.T()}, out);
        case Structure::unstable: return run<kDerivatives>(t, input, shape.L(), Lag{-shape.T()}, out);
        case Structure::ipdt: return run<kDerivatives>(t, input, shape.L(), Integrator{}, out);
        case Structure::ipdt_lag: return run<kDerivatives>(t, input, shape.L(), LaggedIntegrator{shape.T()}, out);
        case Structure::sopdt:
        case Structure::sopdt_zero:
            return run<kDerivatives>(t, input, shape.L(), SecondOrder(shape.a1(), shape.a2()), out);
        case Structure::third:
            return run<kDerivatives>(t, input, shape.L(), ThirdOrder(shape.T3(), shape.a1(), shape.a2()), out);
        case Structure::ipdt_second:
            return run<kDerivatives>(t, input, shape.L(), IntegratedSecondOrder(shape.a1(), shape.a2()), out);
    }
}

}  // namespace

double ModelShape::T() const { return std::exp(p[1]); }
double ModelShape::a1() const { return std::exp(p[1]); }
double ModelShape::a2() const { return std::exp(2 * p[1] + p[2]); }

double ModelShape::T3() const { return std::exp(p[kThirdLag]); }

double ModelShape::slowest_lag() const {
    if (!has_quadratic(structure)) return T();
    const double ratio = a2() / (a1() * a1());
    const double of_two = ratio < 0.25 ? 0.5 * a1() * (1 + std::sqrt(1 - 4 * ratio)) : std::sqrt(a2());
    return structure == Structure::third ? std::max(of_two, T3()) : of_two;
}

std::vector<int> shape_places(Structure structure) {
    switch (structure) {
        case Structure::ipdt: return {0};
        case Structure::fopdt:
        case Structure::unstable:
        case Structure::ipdt_lag: return {0, 1};
        case Structure::sopdt:
        case Structure::sopdt_zero:
        case Structure::ipdt_second: return {0, 1, 2};
        case Structure::third: return {0, 1, 2, kThirdLag};
    }
    return {};
}

int shape_size(Structure structure) { return static_cast<int>(shape_places(structure).size()); }

bool is_integrating(Structure structure) {
    return structure == Structure::ipdt || structure == Structure::ipdt_lag || structure == Structure::ipdt_second;
}

bool has_quadratic(Structure structure) {
    return structure == Structure::sopdt || structure == Structure::sopdt_zero || structure == Structure::third ||
           structure == Structure::ipdt_second;
}

const char* name_of(Structure structure) {
    switch (structure) {
        case Structure::fopdt: return "fopdt";
        case Structure::unstable: return "unstable fopdt";
        case Structure::sopdt: return "sopdt";
        case Structure::sopdt_zero: return "sopdt_zero";
        case Structure::ipdt: return "ipdt";
        case Structure::ipdt_lag: return "ipdt_lag";
        case Structure::third: return "third order";
        case Structure::ipdt_second: return "ipdt with two lags";
    }
    return "";
}

std::complex<double> unit_transfer(const ModelShape& shape, std::complex<double> s) {
    const std::complex<double> delay = std::exp(-shape.L() * s);
    switch (shape.structure) {
        case Structure::fopdt: return delay / (1.0 + shape.T() * s);
        case Structure::unstable: return delay / (1.0 - shape.T() * s);
        case Structure::ipdt: return delay / s;
        case Structure::ipdt_lag: return delay / (s * (1.0 + shape.T() * s));
        case Structure::sopdt:
        case Structure::sopdt_zero: return delay / (1.0 + s * (shape.a1() + s * shape.a2()));
        case Structure::third: return delay / ((1.0 + s * shape.T3()) * (1.0 + s * (shape.a1() + s * shape.a2())));
        case Structure::ipdt_second: return delay / (s * (1.0 + s * (shape.a1() + s * shape.a2())));
    }
    return 0;
}

void unit_response(std::span<const double> t, const InputSteps& input, const ModelShape& shape, int derivatives,
                   UnitResponse& response) {
    response.x.resize(t.size());
    if (derivatives > 0) response.x1.resize(t.size());
    if (derivatives > 1) response.x2.resize(t.size());
    if (derivatives == 0) return run<0>(t, input, shape, response);
    if (derivatives == 1) return run<1>(t, input, shape, response);
    return run<2>(t, input, shape, response);
}

}  // namespace tunewright
