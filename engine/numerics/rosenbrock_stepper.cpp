#include "engine/numerics/rosenbrock_stepper.h"

// uBLAS's checks would throw for matrices that are merely ill-conditioned.
#define BOOST_UBLAS_NDEBUG 1

#include <algorithm>
#include <boost/numeric/odeint/stepper/rosenbrock4.hpp>
#include <boost/numeric/odeint/util/ublas_wrapper.hpp>
#include <utility>

namespace tunewright {
namespace {

using Vector = boost::numeric::ublas::vector<double>;
using Matrix = boost::numeric::ublas::matrix<double>;

}  // namespace

struct RosenbrockStepper::Work {
    explicit Work(std::size_t n) : x(n), x_new(n), error(n), between(n) {}

    boost::numeric::odeint::rosenbrock4<double> stepper;
    Vector x, x_new, error, between;
};

RosenbrockStepper::RosenbrockStepper(int n) : work_(std::make_unique<Work>(static_cast<std::size_t>(n))) {}
RosenbrockStepper::~RosenbrockStepper() = default;
RosenbrockStepper::RosenbrockStepper(RosenbrockStepper&&) noexcept = default;
RosenbrockStepper& RosenbrockStepper::operator=(RosenbrockStepper&&) noexcept = default;

void RosenbrockStepper::step(const Rates& rates, const Derivatives& derivatives, const double* x, double t, double h,
                             double* x_new, double* error) {
    Work& w = *work_;
    const auto f = [&rates](const Vector& at, Vector& dx, double time) { rates(time, &at[0], &dx[0]); };
    const auto J = [&derivatives](const Vector& at, Matrix& jacobian, double time, Vector& ft) {
        derivatives(time, &at[0], &jacobian.data()[0], &ft[0]);
    };
    std::copy(x, x + w.x.size(), w.x.begin());
    w.stepper.do_step(std::make_pair(f, J), w.x, t, w.x_new, h, w.error);
    std::copy(w.x_new.begin(), w.x_new.end(), x_new);
    std::copy(w.error.begin(), w.error.end(), error);
}

void RosenbrockStepper::keep() { work_->stepper.prepare_dense_output(); }

void RosenbrockStepper::at(double s, double* x) const {
    Work& w = *work_;
    w.stepper.calc_state(s, w.between, w.x, 0.0, w.x_new, 1.0);
    std::copy(w.between.begin(), w.between.end(), x);
}

}  // namespace tunewright
