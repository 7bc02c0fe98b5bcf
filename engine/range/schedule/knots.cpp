#include "engine/range/schedule/knots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/range/one_setting.h"

namespace tunewright::range {
namespace {

constexpr double kFirstStep = 0.25;  // of a logarithm
constexpr double kUnbounded = 700;   // of a logarithm: the range of a double
constexpr double kPiTdFactor = 1.01;

}  // namespace

using Eigen::Index;

Knots::Knots(const PointDesigns& places, Interpolation interpolation, std::vector<double> at)
    : interpolation_(interpolation),
      at_(std::move(at)),
      PI_(at_.size(), false),
      slowest_(std::numeric_limits<double>::infinity()),
      dimension_(places.rules().pid ? 3 : 2) {
    for (const PointDesign* place : places.known()) {
        fastest_ = std::max(fastest_, place->sweep().reference());
        slowest_ = std::min(slowest_, place->sweep().reference());
    }
}

void Knots::leave_out_derivative(double at) {
    const auto row = std::ranges::find(at_, at);
    if (dimension_ > 2 && row != at_.end()) PI_[std::size_t(row - at_.begin())] = true;
}

Eigen::VectorXd Knots::constant(const robust::DesignPoint& x) const {
    const double min = std::log(kPiTdFactor * robust::kMinTd / fastest_);
    Eigen::VectorXd v(unknowns());
    for (Index row = 0; row < rows(); ++row)
        for (Index i = 0; i < dimension_; ++i)
            v[dimension_ * row + i] = i == 2 ? std::max(x[2], min) : x[std::size_t(i)];
    return v;
}

Eigen::VectorXd Knots::start(const OwnOptima& own) const {
    Eigen::VectorXd v(unknowns());
    for (Index row = 0; row < rows(); ++row) {
        const auto x = own.optimum(at_[std::size_t(row)]);
        for (Index i = 0; i < dimension_; ++i) v[dimension_ * row + i] = x[std::size_t(i)];
    }
    return v;
}

robust::DesignPoint Knots::settings(const Eigen::VectorXd& v, double at, SettingsSlope* slope) const {
    Index left = 0;
    while (left + 2 < rows() && at >= at_[std::size_t(left + 1)]) ++left;
    const double from = at_[std::size_t(left)], width = at_[std::size_t(left + 1)] - from;
    const double share = std::clamp((at - from) / width, 0.0, 1.0);
    if (slope != nullptr) slope->setZero(3, unknowns());
    robust::DesignPoint x{};
    for (Index i = 0; i < dimension_; ++i) {
        // `linear_in_gains` interpolates 1/Ti, whose logarithm is the negative of that of Ti.
        const double sign = i == 1 && interpolation_ == Interpolation::linear_in_gains ? -1 : 1;
        const auto end = [&](Index row) { return absent(row, i) ? 0 : std::exp(sign * v[dimension_ * row + i]); };
        const double a = end(left), b = end(left + 1);
        const double mixed = a + share * (b - a);
        x[std::size_t(i)] = sign * std::log(mixed);
        if (slope == nullptr || !(mixed > 0)) continue;
        (*slope)(i, dimension_ * left + i) = (1 - share) * a / mixed;
        (*slope)(i, dimension_ * (left + 1) + i) = share * b / mixed;
    }
    return x;
}

JointProblem Knots::problem() const {
    JointProblem joint;
    joint.low = Eigen::VectorXd::Constant(unknowns(), -kUnbounded);
    joint.high = Eigen::VectorXd::Constant(unknowns(), kUnbounded);
    joint.step = Eigen::VectorXd::Constant(unknowns(), kFirstStep);
    for (Index row = 0; row < rows(); ++row) {
        joint.low[dimension_ * row + 1] = std::log(robust::kMinTi / fastest_);
        if (dimension_ > 2) joint.low[dimension_ * row + 2] = std::log(robust::kMinTd / fastest_);
        if (dimension_ > 2) joint.high[dimension_ * row + 2] = std::log(robust::kMaxTd / slowest_);
    }
    joint.settings = [this](const Eigen::VectorXd& v, double at, SettingsSlope* slope) {
        return settings(v, at, slope);
    };
    return joint;
}

Schedule Knots::schedule(const Eigen::VectorXd& v, const DesignRules& rules, double b) const {
    Schedule schedule{.interpolation = interpolation_, .hysteresis = 0, .rows = {}};
    for (Index row = 0; row < rows(); ++row) {
        const Index k = dimension_ * row;
        const double Td = absent(row, 2) ? -std::numeric_limits<double>::infinity() : dimension_ > 2 ? v[k + 2] : 0;
        const IdealPid pid = setting_at(rules, {v[k], v[k + 1], Td}, b);
        schedule.rows.push_back(
            {.at = at_[std::size_t(row)], .Kp = pid.Kp, .Ti = pid.Ti, .Td = pid.Td, .Tf = pid.filter.Tf, .b = b});
    }
    return schedule;
}

}  // namespace tunewright::range
