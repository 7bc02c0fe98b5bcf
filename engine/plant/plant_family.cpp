#include "engine/plant/plant_family.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

using Point = PlantRegion::Point;

// The 95 % point of chi-square with 1 to 8 degrees of freedom (Abramowitz and Stegun 1964, table 26.8). Boost.Math's
// quantile has the same seven digits; its further digits would move the ends of every region by up to 1.2e-7 of their
// distance from the centre, and would change stored answers that are compared.
constexpr std::array<double, 8> kChiSquare95 = {3.841459, 5.991465, 7.814728, 9.487729,
                                                11.07050, 12.59159, 14.06714, 15.50731};
constexpr double kMinLength = 1e-300;
constexpr double kMinShare = 0.05;  // of a time constant: its least value, before its sign would change

/// The members of a plant type, by name; transfer functions and state spaces have only K and L here.
template <class T>
double* member(T& plant, const std::string& name) {
    if (name == "L") return &plant.L;
    if constexpr (requires { plant.K; })
        if (name == "K") return &plant.K;
    if constexpr (requires { plant.T; })
        if (name == "T") return &plant.T;
    if constexpr (requires { plant.T1; }) {
        if (name == "T1") return &plant.T1;
        if (name == "T2") return &plant.T2;
    }
    if constexpr (requires { plant.zeta; })
        if (name == "zeta") return &plant.zeta;
    return nullptr;
}

/// a1, a2, a3 of den [a3, a2, a1, 1], perhaps times s: indexed from the last coefficient other than 0.
double* denominator_coefficient(TransferFunction& plant, const std::string& name) {
    if (name != "a1" && name != "a2" && name != "a3") return nullptr;
    const auto last = std::find_if(plant.den.rbegin(), plant.den.rend(), [](double c) { return c != 0; });
    const auto place = static_cast<std::ptrdiff_t>(name[1] - '0');
    return plant.den.rend() - last > place ? &*(last + place) : nullptr;
}

double scale(const TransferFunction& plant) {
    const auto last = std::find_if(plant.num.rbegin(), plant.num.rend(), [](double c) { return c != 0; });
    return last == plant.num.rend() ? 0 : *last;
}

bool has(TransferFunction& plant, const std::string& name) {
    if (name == "K") return scale(plant) != 0;
    if (name == "b") return plant.num.size() >= 2 && plant.num.back() != 0;
    return name == "L" || denominator_coefficient(plant, name) != nullptr;
}

bool has(StateSpace&, const std::string& name) { return name == "K" || name == "L"; }

template <class T>
bool has(T& plant, const std::string& name) {
    return member(plant, name) != nullptr;
}

double value_of(TransferFunction& plant, const std::string& name) {
    if (name == "K") return scale(plant);
    if (name == "b" && plant.num.size() >= 2) return plant.num[plant.num.size() - 2] / plant.num.back();
    if (const double* at = denominator_coefficient(plant, name)) return *at;
    return name == "L" ? plant.L : 0;
}

void set_value(TransferFunction& plant, const std::string& name, double value) {
    if (name == "K") {
        const double factor = value / scale(plant);
        for (double& c : plant.num) c *= factor;
    } else if (name == "b" && plant.num.size() >= 2) {
        plant.num[plant.num.size() - 2] = value * plant.num.back();
    } else if (double* at = denominator_coefficient(plant, name)) {
        *at = value;
    } else if (name == "L") {
        plant.L = value;
    }
}

double value_of(StateSpace& plant, const std::string& name) { return name == "K" ? 1 : name == "L" ? plant.L : 0; }

void set_value(StateSpace& plant, const std::string& name, double value) {
    if (name == "L") plant.L = value;
    if (name != "K") return;
    for (double& c : plant.C) c *= value;
    plant.D *= value;
}

template <class T>
double value_of(T& plant, const std::string& name) {
    const double* at = member(plant, name);
    return at ? *at : 0;
}

template <class T>
void set_value(T& plant, const std::string& name, double value) {
    if (double* at = member(plant, name)) *at = value;
}

bool keeps_sign(const std::string& name) { return name != "K" && name != "L" && name != "zeta" && name != "b"; }

double length(const Point& z) { return std::sqrt(dot(z, z)); }

/// Error if they are not different parameters of the plant.
std::optional<Error> fault_of_names(const Plant& plant, const std::vector<std::string>& names) {
    const auto fault = [](const std::string& name, const std::string& what) {
        return Error{ErrorKind::invalid_argument, "plant",
                     "covariance names \"" + name + "\"" + what + " Send it unchanged from the answer, or omit it."};
    };
    Plant copy = plant;
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (!std::visit([&](auto& p) { return has(p, *name); }, copy))
            return fault(*name, ", which is not a parameter of this plant.");
        if (std::find(names.begin(), name, *name) != name)
            return fault(*name, " twice; each parameter has one row and one column.");
    }
    return std::nullopt;
}

/// The i-th number of the van der Corput sequence in a base.
double radical_inverse(int i, int base) {
    double value = 0, share = 1;
    for (; i > 0; i /= base) {
        share /= base;
        value += share * (i % base);
    }
    return value;
}

/// All combinations of -1 and 1.
std::vector<Point> diagonals(int n) {
    std::vector<Point> points;
    for (int bits = 0; bits < 1 << n; ++bits) {
        Point z;
        for (int i = 0; i < n; ++i) z.push_back(bits >> i & 1 ? 1 : -1);
        points.push_back(z);
    }
    return points;
}

}  // namespace

double parameter(const Plant& plant, const std::string& name) {
    Plant copy = plant;
    return std::visit([&](auto& p) { return value_of(p, name); }, copy);
}

void set_parameter(Plant& plant, const std::string& name, double value) {
    std::visit([&](auto& p) { set_value(p, name, value); }, plant);
}

PlantRegion PlantRegion::of_ranges(const Plant& plant) {
    PlantRegion region;
    region.plant_ = plant;
    const Uncertainty given = std::visit([](const auto& p) { return p.uncertainty; }, plant);
    std::visit([](auto& p) { p.uncertainty = {}; }, region.plant_);
    const auto add = [&](const char* name, const std::optional<FactorRange>& range) {
        const double value = parameter(plant, name);
        if (!range || range->low == range->high || value == 0) return;
        region.names_.emplace_back(name);
        region.centre_.push_back(value * 0.5 * (range->low + range->high));
        region.axes_.emplace_back(region.names_.size(), 0.0);
        region.axes_.back().back() = value * 0.5 * (range->high - range->low);
    };
    add("K", given.K);
    add("T", given.T);
    add("T1", given.T1);
    add("T2", given.T2);
    add("L", given.L);
    for (auto& axis : region.axes_) axis.resize(region.names_.size(), 0.0);
    return region;
}

Expected<PlantRegion> PlantRegion::of_covariance(const Plant& plant, const std::vector<std::string>& names,
                                                 const std::vector<std::vector<double>>& covariance) {
    const std::size_t n = names.size();
    const Error unusable{ErrorKind::numerical_failure, "plant",
                         "The model's covariance cannot be used as a region of plants. Use uncertainty \"none\"."};
    if (n == 0)
        return Error{ErrorKind::unsupported, "plant",
                     "The model has no covariance of its parameters, so it has no confidence region. Use uncertainty "
                     "\"none\", or identify the record with method auto."};
    if (n > kChiSquare95.size() || covariance.size() != n) return unusable;
    if (auto fault = fault_of_names(plant, names)) return *fault;
    std::vector<double> spread;
    for (std::size_t i = 0; i < n; ++i) {
        if (covariance[i].size() != n || !(covariance[i][i] >= 0) || !std::isfinite(covariance[i][i])) return unusable;
        spread.push_back(std::sqrt(covariance[i][i]));
    }
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index i = 0; i < size; ++i)
        for (Eigen::Index j = 0; j < size; ++j) {
            const double scales = spread[std::size_t(i)] * spread[std::size_t(j)];
            if (i != j) correlation(i, j) = scales > 0 ? covariance[std::size_t(i)][std::size_t(j)] / scales : 0;
            if (!std::isfinite(correlation(i, j))) return unusable;
        }
    PlantRegion region;
    region.plant_ = plant;
    region.ball_ = true;
    region.names_ = names;
    for (const auto& name : names) region.centre_.push_back(parameter(plant, name));
    const PrincipalAxes principal = principal_axes(correlation);
    for (Eigen::Index k = 0; k < size; ++k) {
        const double reach = std::sqrt(kChiSquare95[n - 1] * std::max(0.0, principal.values(k)));
        std::vector<double> axis;
        for (std::size_t i = 0; i < n; ++i)
            axis.push_back(reach * spread[i] * principal.vectors(static_cast<Eigen::Index>(i), k));
        region.axes_.push_back(std::move(axis));
    }
    return region;
}

void PlantRegion::cut(std::vector<double> shares) {
    cut_ends_ = ends();
    for (Point& end : cut_ends_) {
        const double size = length(end);
        for (double& x : end) x /= std::max(size, kMinLength);
    }
    shares_ = std::move(shares);
}

double PlantRegion::share_towards(const Point& z) const {
    constexpr double kAngleTolerance = 1e-6;  // of 1 - cos of the angle to an end
    const double size = length(z);
    if (cut_ends_.empty() || size == 0) return 1;
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < cut_ends_.size(); ++i) {
        const double apart = 1 - dot(cut_ends_[i], z) / size + kAngleTolerance, weight = 1 / (apart * apart);
        sum += weight * shares_[i];
        weights += weight;
    }
    return sum / weights;
}

Plant PlantRegion::at(const Point& z) const {
    const std::size_t n = names_.size();
    std::vector<double> moved(n, 0.0);
    const double inside = share_towards(z);
    double share = 1;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < axes_.size(); ++k) moved[i] += inside * axes_[k][i] * z[k];
        const double min = kMinShare * centre_[i];
        if (!ball_ || !keeps_sign(names_[i]) || centre_[i] == 0) continue;
        if ((centre_[i] + moved[i] - min) * centre_[i] < 0) share = std::min(share, (min - centre_[i]) / moved[i]);
    }
    Plant plant = plant_;
    for (std::size_t i = 0; i < n; ++i) {
        const double value = centre_[i] + share * moved[i];
        set_parameter(plant, names_[i], names_[i] == "L" ? std::max(0.0, value) : value);
    }
    return plant;
}

Point PlantRegion::inside(Point z) const {
    if (ball_) {
        const double size = length(z);
        for (double& x : z) x /= std::max(1.0, size);
    } else {
        for (double& x : z) x = std::clamp(x, -1.0, 1.0);
    }
    return z;
}

std::vector<Point> PlantRegion::ends() const {
    std::vector<Point> points;
    for (const auto& corner : diagonals(dimension())) points.push_back(inside(corner));
    if (!ball_ && dimension() > 0) points.emplace_back(axes_.size(), 0.0);
    for (std::size_t k = 0; ball_ && axes_.size() > 1 && k < axes_.size(); ++k)
        for (const double side : {-1.0, 1.0}) {
            Point z(axes_.size(), 0.0);
            z[k] = side;
            points.push_back(z);
        }
    return points;
}

std::vector<Point> PlantRegion::spread(int count) const {
    constexpr std::array<int, 8> kBases = {2, 3, 5, 7, 11, 13, 17, 19};
    if (dimension() == 0) return {Point{}};
    std::vector<Point> points;
    for (int i = 1; static_cast<int>(points.size()) < count; ++i) {
        Point z;
        for (std::size_t k = 0; k < axes_.size(); ++k) z.push_back(2 * radical_inverse(i, kBases[k]) - 1);
        if (!ball_ || length(z) <= 1) points.push_back(std::move(z));
    }
    return points;
}

PlantFamily family_of(const Plant& plant) { return {{PlantRegion::of_ranges(plant)}}; }

PlantFamily family_of(const PlantSet& set) {
    PlantFamily family;
    for (const auto& plant : set.plants) family.regions.push_back(PlantRegion::of_ranges(plant));
    return family;
}

std::vector<Plant> members_without_nominal(const PlantFamily& family) {
    std::vector<Plant> members;
    for (std::size_t i = 0; i < family.regions.size(); ++i) {
        const PlantRegion& region = family.regions[i];
        if (i > 0 && region.dimension() > 0) members.push_back(region.nominal());
        if (i == 0 && region.dimension() == 0) continue;
        for (const auto& end : region.ends()) members.push_back(region.at(end));
    }
    return members;
}

}  // namespace tunewright
