#include "engine/structure/interaction_gains.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <string>

#include "engine/loop/margins.h"
#include "engine/number_text.h"

namespace tunewright::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kSingular = 1e-10;  // smallest over largest singular value of the scaled gains

std::optional<Error> refused(const PlantMatrix& plants) {
    const std::size_t n = plants.size();
    if (n < 2 || n > 3)
        return Error{ErrorKind::invalid_argument, "plant",
                     "The plant has " + std::to_string(n) + " outputs; give two or three."};
    for (std::size_t i = 0; i < n; ++i) {
        if (plants[i].size() != n)
            return Error{ErrorKind::invalid_argument, "plant/" + std::to_string(i),
                         "Row " + std::to_string(i + 1) + " has " + std::to_string(plants[i].size()) +
                             " plants; give as many as there are outputs, with 0 for a path that is not there."};
    }
    return std::nullopt;
}

/// Gains at steady state. Where a plant of a row integrates, the row's slopes: others do not count there.
MatrixXd steady_gains(const PlantMatrix& plants) {
    const auto n = Index(plants.size());
    MatrixXd K = MatrixXd::Zero(n, n);
    for (Index i = 0; i < n; ++i) {
        int integrators = -100;
        for (const auto& plant : plants[std::size_t(i)])
            if (plant) integrators = std::max(integrators, plant->integrators());
        for (Index j = 0; j < n; ++j)
            if (const auto& plant = plants[std::size_t(i)][std::size_t(j)];
                plant && plant->integrators() == integrators)
                K(i, j) = plant->low_frequency_gain();
    }
    return K;
}

template <class Matrix>
Matrix relative_gains(const Matrix& K) {
    const Matrix inverse = K.inverse();
    return K.cwiseProduct(inverse.transpose());
}

/// The mean of the logarithms of the diagonal's crossover frequencies, as exp.
double crossover(const PlantMatrix& plants) {
    double sum = 0;
    int count = 0;
    for (const auto& row : plants)
        for (const auto& plant : row) {
            if (!plant) continue;
            if (const auto point = ultimate_point(*plant)) {
                sum += std::log(2 * std::numbers::pi / point->Pu);
                ++count;
            }
        }
    return count > 0 ? std::exp(sum / count) : 0;
}

Table table_of(const MatrixXd& matrix) {
    Table out(std::size_t(matrix.rows()));
    for (Index i = 0; i < matrix.rows(); ++i)
        for (Index j = 0; j < matrix.cols(); ++j) out[std::size_t(i)].push_back(matrix(i, j));
    return out;
}

/// With integral action in all loops a negative index means instability (Niederlinski 1971); so does a negative
/// relative gain, in the loop alone or when it is opened.
bool is_possible(const Pairing& pairing) {
    if (pairing.niederlinski && *pairing.niederlinski < 0) return false;
    return std::ranges::all_of(pairing.relative, [](double gain) { return gain > 0; });
}

}  // namespace

std::optional<Error> without_diagonal(const PlantMatrix& plants) {
    for (std::size_t i = 0; i < plants.size(); ++i)
        if (!plants[i][i])
            return Error{ErrorKind::invalid_argument, "pairing",
                         "The pairing gives output " + std::to_string(i + 1) +
                             " an input that does not move it. Choose another pairing, or leave it out: the best one "
                             "is then chosen."};
    return std::nullopt;
}

Expected<GainAnalysis> analyse_gains(const PlantMatrix& plants) {
    if (auto error = refused(plants)) return *error;
    GainAnalysis out;
    const MatrixXd gain = steady_gains(plants);
    const MatrixXd rows = gain.cwiseAbs().rowwise().maxCoeff();
    const MatrixXd scaled = rows.cwiseMax(1e-300).cwiseInverse().asDiagonal() * gain;
    const Eigen::VectorXd sizes = Eigen::JacobiSVD<MatrixXd>(scaled).singularValues();
    if (!(sizes.minCoeff() > kSingular * sizes.maxCoeff()))
        return Error{ErrorKind::invalid_argument, "plant",
                     "The gains at steady state do not determine the inputs: their matrix is singular. No controllers "
                     "hold all outputs at once."};
    const MatrixXd relative = relative_gains(gain);
    out.gain = table_of(gain);
    out.relative = table_of(relative);
    const Eigen::JacobiSVD<MatrixXd> svd(gain);
    out.condition = svd.singularValues()(0) / svd.singularValues()(gain.rows() - 1);
    const double omega = crossover(plants);
    MatrixXcd at(gain.rows(), gain.cols());
    for (Index i = 0; i < at.rows(); ++i)
        for (Index j = 0; j < at.cols(); ++j) {
            const auto& plant = plants[std::size_t(i)][std::size_t(j)];
            at(i, j) = plant ? plant->at(std::complex<double>(0, omega)) : 0;
        }
    const MatrixXcd dynamic = omega > 0 ? relative_gains(at) : MatrixXcd(relative.cast<std::complex<double>>());
    std::vector<int> inputs(plants.size());
    std::iota(inputs.begin(), inputs.end(), 0);
    do {
        Pairing pairing;
        pairing.input_of = inputs;
        double product = 1;
        MatrixXd paired(gain.rows(), gain.cols());
        for (Index i = 0; i < paired.rows(); ++i) {
            const Index j = inputs[std::size_t(i)];
            paired.col(i) = gain.col(j);
            product *= gain(i, j);
            pairing.relative.push_back(relative(i, j));
            pairing.at_crossover.push_back(std::abs(dynamic(i, j)));
            pairing.distance += std::abs(relative(i, j) - 1) + std::abs(dynamic(i, j) - 1.0);
        }
        pairing.niederlinski =
            product != 0 ? Figure(paired.determinant() / product) : no_figure("A pair has no gain at steady state.");
        pairing.possible = product != 0 && is_possible(pairing);
        out.pairings.push_back(std::move(pairing));
    } while (std::next_permutation(inputs.begin(), inputs.end()));
    std::ranges::stable_sort(out.pairings, [](const Pairing& a, const Pairing& b) {
        return a.possible != b.possible ? a.possible : a.distance < b.distance;
    });
    return out;
}

std::optional<Error> impossible_pairing(const PlantMatrix& plants, const GainAnalysis& gains) {
    for (const auto& row : plants)
        for (const auto& plant : row)
            if (plant && plant->unstable_poles() > 0) return std::nullopt;
    const auto own =
        std::ranges::find_if(gains.pairings, [](const Pairing& one) { return std::ranges::is_sorted(one.input_of); });
    if (own->possible) return std::nullopt;
    const std::string why = own->niederlinski && *own->niederlinski < 0
                                ? "its Niederlinski index is " + text(*own->niederlinski, 3)
                                : "its lowest relative gain is " + text(std::ranges::min(own->relative), 3);
    return Error{ErrorKind::no_feasible_controller, "pairing",
                 "With this pairing no controllers with integral action are stable both together and with one loop in "
                 "manual: " +
                     why + (gains.pairings.front().possible ? ". Choose another pairing." : ". No pairing is better.")};
}

}  // namespace tunewright::structure
