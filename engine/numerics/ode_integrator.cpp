#include "engine/numerics/ode_integrator.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/rosenbrock_stepper.h"

namespace tunewright {
namespace {

using Index = std::size_t;
using Vector = std::vector<double>;
using Explicit = boost::numeric::odeint::runge_kutta_dopri5<Vector>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMinRelativeStep = 16 * kEpsilon;  // of a step, relative to the time
constexpr double kFirstStep = 0.02;                 // in units of the fastest time constant
constexpr double kSafety = 0.9, kMaxGrowth = 5, kMaxShrinking = 0.2;
constexpr double kExplicitPower = 1.0 / 5, kImplicitPower = 1.0 / 4;
constexpr double kStateRounding = 20 * kEpsilon;  // of a state: smaller errors count as 0
constexpr double kMinDivisor = 1e-290;            // stands for 0 as a divisor
constexpr double kLargestSize = 1e280;            // of a state (sizes may be infinite): steps from it stay finite
constexpr double kMinShift = 1e-6;                // shift for differences of a state that is 0 and has no size
constexpr double kLaterShare = 1e-3;              // of a step: the interval of the difference for df/dt
constexpr double kUnknownStep = 1e-3;             // of the time to the stop, while no time constant is known
constexpr double kMinError = 1e-12;               // in tolerances: a smaller error does not lengthen the next step
                                                  // further
constexpr double kExpected = 1e-2;                // of the expected movement: least size for relative errors
constexpr int kStiffnessInterval = 20;            // steps between two estimates of the spectrum
constexpr double kMinStiffProduct = 2.5,
                 kMaxNonstiffProduct = 0.5;  // step times spectral radius; the explicit method is stable up to 3.3

}  // namespace

struct OdeIntegrator::Work {
    OdeSystem system;
    double tolerance;
    Index n;

    Explicit explicit_stepper;
    RosenbrockStepper implicit_stepper;
    bool implicit = false, last_implicit = false, fault = false;

    double t = 0, t_before = 0, h = 0;
    Vector x, dx, x_before, dx_before, error, trial, trial_dx, min, expected, first, moved;
    Vector jacobian, ft, shifted, rates_shifted;
    bool started = false;
    int steps_since_look = 0;

    Work(OdeSystem s, double tol)
        : system(std::move(s)), tolerance(tol), n(Index(system.order)), implicit_stepper(system.order) {
        for (Vector* v : {&x, &dx, &x_before, &dx_before, &error, &trial, &trial_dx, &min, &expected, &first, &moved,
                          &ft, &shifted, &rates_shifted})
            v->assign(n, 0.0);
        jacobian.assign(n * n, 0.0);
    }

    double size(Index i) const {
        return std::max({min[i], expected[i], moved[i], kStateRounding / tolerance * std::abs(x[i]), kMinDivisor});
    }

    /// Evaluates f and remembers if it does not exist: then the rest of the step is skipped.
    void evaluate(double time, const double* at, double* out) {
        if (!fault) fault = !system.rates(time, {at, n}, {out, n});
        if (fault) std::fill_n(out, n, 0.0);
    }

    bool differentiate(double time, std::span<const double> at) {
        if (system.jacobian) return system.jacobian(time, at, jacobian, ft);
        Vector base(n);
        if (!system.rates(time, at, base)) return false;
        std::copy(at.begin(), at.end(), shifted.begin());
        for (Index j = 0; j < n; ++j) {
            const double step =
                std::sqrt(kEpsilon) * std::max({std::abs(at[j]), std::min(size(j), kLargestSize), kMinShift});
            shifted[j] = at[j] + step;
            if (!system.rates(time, shifted, rates_shifted)) return false;
            for (Index i = 0; i < n; ++i) jacobian[i * n + j] = (rates_shifted[i] - base[i]) / (shifted[j] - at[j]);
            shifted[j] = at[j];
        }
        const double later = time + std::max(kLaterShare * h, 64 * kEpsilon * std::abs(time));
        if (!system.rates(later, at, rates_shifted)) return false;
        for (Index i = 0; i < n; ++i) ft[i] = later > time ? (rates_shifted[i] - base[i]) / (later - time) : 0;
        return true;
    }

    double spectral_radius() {
        if (!differentiate(t, x)) return 0;
        double radius = 0;
        for (const double a : jacobian)
            if (!std::isfinite(a)) return 0;
        for (const auto value : eigenvalues(jacobian, int(n))) radius = std::max(radius, std::abs(value));
        return radius;
    }

    /// Estimates the movement of each state within the fastest time constant from the rates here, through chains of
    /// states: the error of a state that moves with a high power of time would otherwise be compared with nearly 0.
    void expect_movement(double time_constant) {
        for (Index i = 0; i < n; ++i) shifted[i] = time_constant * std::abs(dx[i]);
        for (Index k = 0; k < n; ++k) {
            for (Index i = 0; i < n; ++i) {
                rates_shifted[i] = shifted[i];
                for (Index j = 0; j < n; ++j)
                    rates_shifted[i] =
                        std::max(rates_shifted[i], time_constant * std::abs(jacobian[i * n + j]) * shifted[j]);
            }
            shifted.swap(rates_shifted);
        }
        for (Index i = 0; i < n; ++i)
            if (std::isfinite(shifted[i])) expected[i] = std::max(expected[i], kExpected * shifted[i]);
    }

    bool start(double time, std::span<const double> at) {
        if (!started) std::copy(at.begin(), at.end(), first.begin());
        t = t_before = time;
        x.assign(at.begin(), at.end());
        x_before = x;
        note_movement();
        fault = false;
        evaluate(t, x.data(), dx.data());
        dx_before = dx;
        const double radius = fault ? 0 : spectral_radius();
        if (radius > 0) expect_movement(1 / radius);
        if (!started || !(h > 0)) {
            h = radius > 0 ? kFirstStep / radius : kInfinity;
            started = true;
        }
        return !fault;
    }

    void note_movement() {
        for (Index i = 0; i < n; ++i) moved[i] = std::max(moved[i], std::abs(x[i] - first[i]));
    }

    /// From the step's beginning; the results are trial, trial_dx and error. Returns the largest error in tolerances.
    double attempt(double length) {
        fault = false;
        if (implicit) {
            const auto rates = [this](double time, const double* at, double* out) { evaluate(time, at, out); };
            const auto derivatives = [this](double time, const double* at, double* J, double* slope) {
                if (!fault) fault = !differentiate(time, {at, n});
                std::copy(jacobian.begin(), jacobian.end(), J);
                std::copy(ft.begin(), ft.end(), slope);
            };
            implicit_stepper.step(rates, derivatives, x.data(), t, length, trial.data(), error.data());
            evaluate(t + length, trial.data(), trial_dx.data());
        } else {
            const auto rates = [this](const Vector& at, Vector& out, double time) {
                evaluate(time, at.data(), out.data());
            };
            explicit_stepper.do_step(rates, x, dx, t, trial, trial_dx, length, error);
        }
        if (fault) return kInfinity;
        double worst = 0;
        for (Index i = 0; i < n; ++i) {
            if (!std::isfinite(trial[i]) || !std::isfinite(trial_dx[i])) return kInfinity;
            const double scale = std::max(size(i), std::abs(trial[i] - first[i]));
            const double relative = std::abs(error[i]) / (tolerance * scale);
            if (!(relative <= worst)) worst = relative;
        }
        return worst;
    }

    void accept(double t_new) {
        x_before.swap(x);
        dx_before.swap(dx);
        x.swap(trial);
        dx.swap(trial_dx);
        t_before = t;
        t = t_new;
        last_implicit = implicit;
        if (implicit) implicit_stepper.keep();
        note_movement();
    }

    void back() {
        x = x_before;
        dx = dx_before;
        t = t_before;
    }

    OdeStep step(double t_stop) {
        bool rejected = false;
        while (true) {
            const double left = t_stop - t;
            if (!(h > 0)) h = kInfinity;
            double length = std::isfinite(h) ? h : (std::isfinite(left) ? kUnknownStep * left : 1.0);
            const bool onto_stop = length >= left;
            if (onto_stop)
                length = left;
            else if (2 * length > left)
                length = 0.5 * left;  // two equal steps rather than a long one and a very short one
            const double worst = attempt(length);
            const double power = implicit ? kImplicitPower : kExplicitPower;
            double factor =
                std::isfinite(worst) ? kSafety * std::pow(std::max(worst, kMinError), -power) : kMaxShrinking;
            if (!(factor >= kMaxShrinking)) factor = kMaxShrinking;
            if (worst <= 1) {
                factor = std::min(factor, rejected ? 1.0 : kMaxGrowth);
                h = length < h && std::isfinite(h) ? std::max(length * factor, std::min(h, kMaxGrowth * length))
                                                   : length * factor;
                accept(onto_stop ? t_stop : t + length);
                look_for_stiffness();
                return OdeStep::made;
            }
            rejected = true;
            h = length * std::min(factor, kSafety);
            if (h <= kMinRelativeStep * std::max(std::abs(t), kMinDivisor))
                return fault ? OdeStep::left_domain : OdeStep::stalled;
        }
    }

    OdeStep shorten(double t_end) {
        const bool chosen = implicit;
        back();
        implicit = last_implicit;
        const double worst = attempt(t_end - t);
        implicit = chosen;
        if (fault) return OdeStep::left_domain;
        if (!std::isfinite(worst)) return OdeStep::stalled;
        implicit = last_implicit;
        accept(t_end);
        implicit = chosen;
        return OdeStep::made;
    }

    void look_for_stiffness() {
        if (++steps_since_look < kStiffnessInterval) return;
        steps_since_look = 0;
        const double reach = std::min(h, t - t_before) * spectral_radius();
        if (!implicit && reach > kMinStiffProduct) implicit = true;
        if (implicit && reach < kMaxNonstiffProduct) implicit = false;
    }

    void at(double time, std::span<double> out) {
        if (time >= t || !(t > t_before)) {
            std::copy(x.begin(), x.end(), out.begin());
        } else if (time <= t_before) {
            std::copy(x_before.begin(), x_before.end(), out.begin());
        } else if (last_implicit) {
            implicit_stepper.at((time - t_before) / (t - t_before), out.data());
        } else {
            explicit_stepper.calc_state(time, trial, x_before, dx_before, t_before, x, dx, t);
            std::copy(trial.begin(), trial.end(), out.begin());
        }
    }
};

OdeIntegrator::OdeIntegrator(OdeSystem system, double tolerance)
    : work_(std::make_unique<Work>(std::move(system), tolerance)) {}
OdeIntegrator::~OdeIntegrator() = default;
OdeIntegrator::OdeIntegrator(OdeIntegrator&&) noexcept = default;
OdeIntegrator& OdeIntegrator::operator=(OdeIntegrator&&) noexcept = default;

void OdeIntegrator::set_least_size(int i, double size) { work_->min[Index(i)] = size; }
bool OdeIntegrator::start(double t, std::span<const double> x) { return work_->start(t, x); }
OdeStep OdeIntegrator::step(double t_stop) { return work_->step(t_stop); }
OdeStep OdeIntegrator::shorten(double t_end) { return work_->shorten(t_end); }
double OdeIntegrator::t() const { return work_->t; }
double OdeIntegrator::t_before() const { return work_->t_before; }
std::span<const double> OdeIntegrator::x() const { return work_->x; }
std::span<const double> OdeIntegrator::x_before() const { return work_->x_before; }
std::span<const double> OdeIntegrator::dx() const { return work_->dx; }
double OdeIntegrator::size(int i) const { return work_->size(Index(i)); }
double OdeIntegrator::next_length() const { return work_->h; }
bool OdeIntegrator::stiff() const { return work_->last_implicit; }
void OdeIntegrator::at(double t, std::span<double> x) const { work_->at(t, x); }

}  // namespace tunewright
