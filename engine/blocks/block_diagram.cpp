#include "engine/blocks/block_diagram.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

LinearPlant transfer_function(std::vector<double> num, std::vector<double> den) {
    return std::move(*LinearPlant::make(Plant(TransferFunction{.num = std::move(num), .den = std::move(den)})));
}

/// Coefficients of 1/F(s) in descending powers.
std::vector<double> filter_denominator(const Filter& filter) {
    switch (filter.type) {
        case FilterType::none: return {1};
        case FilterType::measurement_second_order: return {filter.Tf * filter.Tf / 2, filter.Tf, 1};
        default: return {filter.Tf, 1};
    }
}

std::complex<double> denominator(const LinearPlant& plant, std::complex<double> s) {
    std::complex<double> value = 1;
    for (int i = 0; i < plant.integrators(); ++i) value = product(value, s);
    for (const auto pole : plant.poles()) value = product(value, s - pole);
    return value;
}

double size(std::complex<double> z) { return std::abs(z.real()) + std::abs(z.imag()); }

/// Gaussian elimination with pivots by column, without the many zeros; `b` becomes what belongs to the triangle.
/// Eigen's own takes several times as long on these small matrices. The determinant.
std::complex<double> eliminate(SignalMatrix& A, SignalVector* b) {
    const Eigen::Index n = A.rows();
    std::complex<double> determinant = 1;
    std::array<Eigen::Index, kMaxSignals> columns{};
    for (Eigen::Index k = 0; k < n; ++k) {
        Eigen::Index pivot = k;
        for (Eigen::Index i = k + 1; i < n; ++i)
            if (size(A(i, k)) > size(A(pivot, k))) pivot = i;
        if (pivot != k) {
            for (Eigen::Index j = k; j < n; ++j) std::swap(A(k, j), A(pivot, j));
            if (b != nullptr) std::swap((*b)[k], (*b)[pivot]);
            determinant = -determinant;
        }
        determinant = product(determinant, A(k, k));
        std::size_t count = 0;
        for (Eigen::Index j = k + 1; j < n; ++j)
            if (size(A(k, j)) != 0) columns[count++] = j;
        for (Eigen::Index i = k + 1; i < n; ++i) {
            if (size(A(i, k)) == 0) continue;
            const std::complex<double> factor = quotient(A(i, k), A(k, k));
            for (std::size_t c = 0; c < count; ++c) A(i, columns[c]) -= product(factor, A(k, columns[c]));
            if (b != nullptr) (*b)[i] -= product(factor, (*b)[k]);
        }
    }
    return determinant;
}

}  // namespace

int BlockDiagram::add_signal() {
    if (signals_ == kMaxSignals) throw std::length_error("A block diagram has too many signals.");
    return signals_++;
}

void BlockDiagram::add(int from, int to, double gain, double L) {
    if (gain == 0) return;
    add(from, to, std::move(*LinearPlant::make(Plant(Fopdt{.K = gain, .T = 0, .L = L}))));
}

int BlockDiagram::order() const {
    int sum = 0;
    for (const Block& block : blocks_) sum += block.cancelled ? 0 : block.plant.order();
    return sum;
}

double BlockDiagram::total_dead_time() const {
    double sum = 0;
    for (const Block& block : blocks_) sum += block.plant.dead_time();
    return sum;
}

double BlockDiagram::time_scale() const {
    double sum = 0;
    for (const Block& block : blocks_) sum += block.plant.time_scale();
    if (sum > 0) return sum;
    // Integrators and gains alone, such as a level with a proportional controller: 1/(k s^n) has the time k^(-1/n).
    int integrators = 0;
    double gain = 1;
    for (const Block& block : blocks_) {
        integrators += block.plant.integrators();
        gain *= std::abs(block.plant.low_frequency_gain());
    }
    return integrators > 0 ? std::pow(gain, -1.0 / integrators) : 0;
}

SignalMatrix BlockDiagram::connections(std::complex<double> s) const {
    SignalMatrix M = SignalMatrix::Zero(signals_, signals_);
    for (const Block& block : blocks_) M(block.to, block.from) += block.plant.at(s);
    return M;
}

SignalVector BlockDiagram::response(std::complex<double> s, int input) const {
    SignalMatrix A = SignalMatrix::Identity(signals_, signals_) - connections(s);
    SignalVector x = SignalVector::Unit(signals_, input);
    eliminate(A, &x);
    for (Eigen::Index k = signals_ - 1; k >= 0; --k) {
        for (Eigen::Index j = k + 1; j < signals_; ++j) x[k] -= product(A(k, j), x[j]);
        x[k] = quotient(x[k], A(k, k));
    }
    return x;
}

std::complex<double> BlockDiagram::characteristic(std::complex<double> s) const {
    SignalMatrix A = SignalMatrix::Identity(signals_, signals_) - connections(s);
    std::complex<double> value = eliminate(A, nullptr);
    for (const Block& block : blocks_)
        if (!block.cancelled) value = product(value, denominator(block.plant, s));
    return value;
}

Expected<PidSignals> add_pid(BlockDiagram& diagram, const ParallelPid& pid, int y) {
    const bool derivative = pid.Kd != 0;
    if (derivative && pid.filter.type == FilterType::none)
        return Error{ErrorKind::invalid_argument, "controller",
                     "A derivative without a filter cannot be part of several loops; give Tf."};
    const bool on_measurement = pid.filter.type == FilterType::measurement_first_order ||
                                pid.filter.type == FilterType::measurement_second_order;
    const auto filter = filter_denominator(pid.filter);
    PidSignals signals{diagram.add_signal(), diagram.add_signal()};
    if (on_measurement)
        diagram.add(y, signals.error, transfer_function({-1}, filter));
    else
        diagram.add(y, signals.error, -1);
    if (pid.Ki != 0)
        diagram.add(signals.error, signals.output, transfer_function({pid.Kp, pid.Ki}, {1, 0}));
    else
        diagram.add(signals.error, signals.output, pid.Kp);
    if (derivative) diagram.add(y, signals.output, transfer_function({-pid.Kd, 0}, filter));
    return signals;
}

}  // namespace tunewright
