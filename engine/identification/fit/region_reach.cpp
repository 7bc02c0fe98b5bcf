#include "engine/identification/fit/uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/polynomial_roots.h"
#include "engine/plant/plant_family.h"

namespace tunewright {
namespace {

/// A plant of the fit's structure as the fit would have it, dimensionless.
struct PlantShape {
    ModelShape shape;
    double gain = 0, zero = 0;  ///< the linear coefficients of K and K b
};

/// ln a1 and ln rho of a quadratic factor; false where it has no positive coefficients.
bool set_quadratic(ModelShape& shape, double a1, double a2) {
    if (!(a1 > 0) || !(a2 > 0)) return false;
    shape.p[1] = std::log(a1);
    shape.p[2] = std::log(a2 / (a1 * a1));
    return true;
}

/// (T3 s + 1)(q2 s^2 + q1 s + 1) of three coefficients.
bool set_third(ModelShape& shape, double a1, double a2, double a3) {
    for (const std::complex<double> root : polynomial_roots(std::array{a3, a2, a1, 1.0})) {
        if (root.imag() != 0 || !(root.real() < 0)) continue;
        const double T3 = -1 / root.real();
        if (!set_quadratic(shape, a1 - T3, a3 / T3)) continue;
        shape.p[kThirdLag] = std::log(T3);
        return true;
    }
    return false;
}

std::optional<PlantShape> shape_of(const CleanRecord& r, const Fit& fit, const Plant& plant) {
    const auto at = [&](const char* name) { return parameter(plant, name); };
    const double t = r.scale.t_scale;
    const Structure structure = fit.form.structure;
    PlantShape found{fit.shape};
    found.shape.p[0] = at("L") / t;
    found.gain = at("K") * r.scale.u_scale / r.scale.y_scale * (is_integrating(structure) ? t : 1);
    bool whole = true;
    switch (structure) {
        case Structure::ipdt: break;
        case Structure::fopdt:
        case Structure::unstable:
        case Structure::ipdt_lag: {
            const double T = std::abs(at("T")) / t;
            whole = T > 0;
            found.shape.p[1] = std::log(T);
            break;
        }
        case Structure::sopdt:
            if (const double T1 = at("T1"); T1 > 0) {
                whole = set_quadratic(found.shape, (T1 + at("T2")) / t, T1 * at("T2") / (t * t));
            } else {
                const double T = at("T") / t;
                whole = set_quadratic(found.shape, 2 * at("zeta") * T, T * T);
            }
            break;
        case Structure::sopdt_zero: found.zero = found.gain * at("b") / t; [[fallthrough]];
        case Structure::ipdt_second: whole = set_quadratic(found.shape, at("a1") / t, at("a2") / (t * t)); break;
        case Structure::third:
            whole = set_third(found.shape, at("a1") / t, at("a2") / (t * t), at("a3") / (t * t * t));
            break;
    }
    return whole ? std::optional(found) : std::nullopt;
}

/// The sum of squares that a plant leaves, what else moved y fitted anew.
class Misfit {
public:
    Misfit(const CleanRecord& record, const Fit& fit) : fit_(fit), stride_(std::max(1, record.samples() / kRows)) {
        for (int i = 0; i < record.samples(); i += stride_) {
            t_.push_back(record.t[static_cast<std::size_t>(i)]);
            rest_.push_back(fit.residual[static_cast<std::size_t>(i)]);
        }
        input_ = {record.v_time, record.v_level};
        const auto rows = static_cast<Eigen::Index>(t_.size());
        // J's columns of what is no parameter of the plant, and the times of moves.
        std::vector<const std::vector<double>*> columns;
        const int first = static_cast<int>(fit.form.searched().size()) + fit.form.gains();
        for (int k = first; k < fit.form.parameters(); ++k) columns.push_back(&fit.J[static_cast<std::size_t>(k)]);
        for (const auto& column : fit.nuisance) columns.push_back(&column);
        others_.resize(rows, static_cast<Eigen::Index>(columns.size()));
        for (Eigen::Index k = 0; k < others_.cols(); ++k)
            for (Eigen::Index i = 0; i < rows; ++i)
                others_(i, k) = (*columns[static_cast<std::size_t>(k)])[static_cast<std::size_t>(i * stride_)];
        constexpr double kRidge = 1e-9;  // of the longest column: those of moves after the last row are 0
        Eigen::MatrixXd normal = gram(others_, others_);
        normal.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
        inverse_ = inverse_of(normal);
        model_ = run({fit.shape, fit.linear[0], fit.form.gains() == 2 ? fit.linear[1] : 0});
        least_ = left(Eigen::VectorXd::Zero(rows));
    }

    /// Beyond the model's own, at least 0; infinite for a plant that the structure cannot be.
    double growth(const std::optional<PlantShape>& plant) const {
        if (!plant) return INFINITY;
        return std::max(0.0, left(run(*plant) - model_) - least_);
    }

private:
    static constexpr int kRows = 600;

    Eigen::VectorXd run(const PlantShape& plant) const {
        UnitResponse response;
        const bool zero = fit_.form.gains() == 2;
        unit_response(t_, input_, plant.shape, zero ? 1 : 0, response);
        const auto rows = static_cast<Eigen::Index>(t_.size());
        Eigen::VectorXd y = plant.gain * Eigen::Map<const Eigen::VectorXd>(response.x.data(), rows);
        if (zero) y += plant.zero * Eigen::Map<const Eigen::VectorXd>(response.x1.data(), rows);
        return y;
    }
    double left(const Eigen::VectorXd& moved) const {
        const Eigen::VectorXd e =
            Eigen::Map<const Eigen::VectorXd>(rest_.data(), static_cast<Eigen::Index>(rest_.size())) - moved;
        const Eigen::VectorXd pull = transpose_times(others_, e);
        return e.squaredNorm() - pull.dot(inverse_ * pull);
    }

    const Fit& fit_;
    int stride_;
    std::vector<double> t_, rest_;
    InputSteps input_;
    Eigen::MatrixXd others_, inverse_;
    Eigen::VectorXd model_;
    double least_ = 0;
};

/// True if the standard errors are so small that the sum of squares is a quadratic over the whole region.
bool is_linear(const FittedPlant& plant) {
    constexpr double kSmall = 0.05;
    double lags = plant.values.at("L");
    for (const auto& [name, value] : plant.values)
        if (name == "T" || name == "T1" || name == "T2" || name == "a1") lags += std::abs(value);
    return std::ranges::all_of(plant.standard_errors, [&](const auto& error) {
        const auto& [name, size] = error;
        if (name == "K") return true;
        return size <= kSmall * (name == "L" ? lags : std::abs(plant.values.at(name)));
    });
}

}  // namespace

std::vector<double> region_reach(const CleanRecord& record, const Fit& fit, const FittedPlant& plant) {
    constexpr double kPlainly = 1.5, kNear = 0.02;  // times the curvature's; of the axis, where it is measured
    constexpr int kHalvings = 7;
    if (is_linear(plant) || !fit.deviations.empty()) return {};
    const auto region = PlantRegion::of_covariance(plant.plant, plant.covariance.names, plant.covariance.matrix);
    if (!region) return {};
    const Misfit misfit(record, fit);
    const auto growth = [&](PlantRegion::Point z, double share) {
        for (double& x : z) x *= share;
        return misfit.growth(shape_of(record, fit, region->at(z)));
    };
    std::vector<double> reach;
    bool cut = false;
    for (const PlantRegion::Point& end : region->ends()) {
        const double curvature = 0.5 * (growth(end, kNear) + growth(end, -kNear)) / (kNear * kNear);
        const auto linear = [&](double share) { return !(growth(end, share) > kPlainly * curvature); };
        reach.push_back(linear(1) ? 1 : bisect({kNear, 1}, linear, kHalvings).inside);
        cut |= reach.back() < 1;
    }
    return cut ? reach : std::vector<double>{};
}

}  // namespace tunewright
