#include "engine/plant/nonlinear/nonlinear_steady_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/number_text.h"
#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

constexpr int kMaxIterations = 100, kMaxHalvings = 40;
constexpr double kRounding = 1e-16;  // of the largest state: what a state at 0 may be off by
constexpr double kSingularCutoff = 1e-11, kMaxStep = 0.1, kConvergedStep = 1e-9, kConvergedRates = 1e-10;

/// Seven digits: a steady state is meant to be copied into a request.
std::string precise(double x) { return text(x, 7); }

/// States and their rates.
struct Iterate {
    std::vector<double> x, rates;
};

class SteadyStateSearch {
public:
    SteadyStateSearch(const NonlinearSystem& system, std::span<const double> start)
        : system_(system), n_(start.size()), u_(system.u_nominal()), start_(start.begin(), start.end()) {
        for (double& x : start_)
            if (std::abs(x) <= kRounding * largest(start)) x = 0;
    }

    Expected<std::vector<double>> run() {
        Iterate now{start_, std::vector<double>(n_)};
        if (!system_.rates(now.x, u_, now.rates)) return fault_at_start();
        double step_size = std::numeric_limits<double>::infinity();
        for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
            std::vector<double> A(n_ * n_), B(n_);
            if (!system_.jacobian(now.x, u_, A, B)) return iteration == 0 ? fault_at_start() : none_near(now);
            measure(now.x, A, B);
            const std::vector<double> step = newton_step(A, now.rates);
            step_size = largest(step);
            if (step_size == 0 || !advance(now, step, step_size)) break;
        }
        if (!(step_size < kConvergedStep) || !(norm(now.rates) < kConvergedRates)) return none_near(now);
        if (!is_near(now.x)) return too_far(now);
        return now.x;
    }

private:
    static double largest(std::span<const double> values) {
        double result = 0;
        for (const double value : values) result = std::max(result, std::abs(value));
        return result;
    }

    // The sizes of the states and of the terms of each rate.
    void measure(const std::vector<double>& x, const std::vector<double>& A, const std::vector<double>& B) {
        state_size_.assign(n_, 0);
        for (std::size_t i = 0; i < n_; ++i)
            if (start_[i] != 0) state_size_[i] = std::max(std::abs(x[i]), std::abs(start_[i]));
        const std::vector<double> others = terms(A, B);
        for (std::size_t j = 0; j < n_; ++j)
            if (start_[j] == 0) state_size_[j] = std::max(size_beside(others, A, j), std::abs(x[j]));
        rate_size_ = terms(A, B);
        for (double& size : rate_size_)
            if (!(size > 0)) size = 1;
    }

    // The largest term of each rate.
    std::vector<double> terms(const std::vector<double>& A, const std::vector<double>& B) const {
        std::vector<double> result(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            result[i] = std::abs(B[i] * u_);
            for (std::size_t j = 0; j < n_; ++j)
                result[i] = std::max(result[i], std::abs(A[i * n_ + j]) * state_size_[j]);
        }
        return result;
    }

    // A state that is 0, such as a speed, has no size of its own: it is what would weigh as much as the others do in
    // one of the rates; 1 where there is none.
    double size_beside(const std::vector<double>& others, const std::vector<double>& A, std::size_t j) const {
        double size = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < n_; ++i)
            if (A[i * n_ + j] != 0 && others[i] > 0) size = std::min(size, others[i] / std::abs(A[i * n_ + j]));
        return std::isfinite(size) ? size : 1;
    }

    double norm(const std::vector<double>& rates) const {
        double result = 0;
        for (std::size_t i = 0; i < n_; ++i) result = std::max(result, std::abs(rates[i] / rate_size_[i]));
        return result;
    }

    // In sizes of the states.
    std::vector<double> newton_step(std::vector<double> A, const std::vector<double>& rates) const {
        std::vector<double> right(n_);
        for (std::size_t i = 0; i < n_; ++i) {
            for (std::size_t j = 0; j < n_; ++j) A[i * n_ + j] *= state_size_[j] / rate_size_[i];
            right[i] = -rates[i] / rate_size_[i];
        }
        return least_norm_solution(A, right, static_cast<int>(n_), kSingularCutoff);
    }

    // Along the step as far as the rates fall; false where they do not.
    bool advance(Iterate& now, const std::vector<double>& step, double step_size) const {
        const double before = norm(now.rates);
        double length = std::min(1.0, kMaxStep / step_size);
        for (int halving = 0; halving < kMaxHalvings; ++halving, length /= 2) {
            Iterate next{now.x, std::vector<double>(n_)};
            for (std::size_t i = 0; i < n_; ++i) next.x[i] += length * step[i] * state_size_[i];
            if (next.x == now.x) return false;
            if (system_.rates(next.x, u_, next.rates) && norm(next.rates) < (1 - 1e-4 * length) * before) {
                now = std::move(next);
                return true;
            }
        }
        return false;
    }

    bool is_near(const std::vector<double>& x) const {
        const double floor = 1e-6 * largest(start_);
        for (std::size_t i = 0; i < n_; ++i) {
            const double size = start_[i] == 0 ? 2 : std::max(std::abs(start_[i]), std::abs(x[i]));
            if (std::abs(x[i] - start_[i]) > std::max(0.5 * size, floor)) return false;
        }
        return true;
    }

    std::string states(const std::vector<double>& x) const {
        std::string result;
        for (std::size_t i = 0; i < n_; ++i)
            result += (i == 0 ? "" : ", ") + system_.description().states[i].name + " = " + precise(x[i]);
        return result;
    }

    static Error invalid(const std::string& message) { return {ErrorKind::invalid_argument, "plant/states", message}; }

    Error fault_at_start() const {
        return invalid("The equations cannot be evaluated at the operating point (" + states(start_) + ", " +
                       system_.description().input.name + " = " + precise(u_) +
                       "): " + system_.derivative_fault(start_, u_) + ".");
    }

    Error none_near(const Iterate& stuck) const {
        std::size_t worst = 0;
        for (std::size_t i = 1; i < n_; ++i)
            if (std::abs(stuck.rates[i] / rate_size_[i]) > std::abs(stuck.rates[worst] / rate_size_[worst])) worst = i;
        return invalid("There is no steady state near these states for " + system_.description().input.name + " = " +
                       precise(u_) + ": the search ended at " + states(stuck.x) + ", where d" +
                       system_.description().states[worst].name + "/dt is still " + precise(stuck.rates[worst]) +
                       ". Change input.nominal or the states.");
    }

    Error too_far(const Iterate& found) const {
        return invalid("There is no steady state near these states for " + system_.description().input.name + " = " +
                       precise(u_) + ": the next one found is " + states(found.x) +
                       ". Give these states if it is meant, or change input.nominal.");
    }

    const NonlinearSystem& system_;
    std::size_t n_;
    double u_;
    std::vector<double> start_, state_size_, rate_size_;
};

}  // namespace

Expected<std::vector<double>> steady_state_near(const NonlinearSystem& system, std::span<const double> start) {
    return SteadyStateSearch(system, start).run();
}

}  // namespace tunewright
