#include "engine/numerics/matrix/resolvent.h"

#include <Eigen/LU>
#include <cstddef>

namespace tunewright {
namespace {

using Complex = std::complex<double>;

/// Solves (sI - A)' x = C'. With at most kMaxStates states it allocates nothing, because most plants are small and a
/// loop is evaluated at hundreds of frequencies.
template <int kStates, int kMaxStates>
std::vector<Complex> row_of(std::span<const double> A, std::span<const double> C, int n, Complex s) {
    // A in rows is A' in columns.
    Eigen::Matrix<Complex, kStates, kStates, Eigen::ColMajor, kMaxStates, kMaxStates> pencil =
        (-Eigen::Map<const Eigen::MatrixXd>(A.data(), n, n)).cast<Complex>();
    pencil.diagonal().array() += s;
    const Eigen::Matrix<Complex, kStates, 1, Eigen::ColMajor, kMaxStates, 1> row =
        pencil.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(C.data(), n).cast<Complex>());
    return {row.data(), row.data() + n};
}

}  // namespace

std::vector<Complex> resolvent_row(std::span<const double> A, std::span<const double> C, int n, Complex s) {
    constexpr int kAnyNumber = Eigen::Dynamic, kMaxStatesOnStack = 4;
    if (n == 1) return {C[0] / (s - A[0])};
    if (n == 2) return row_of<2, 2>(A, C, n, s);
    if (n <= kMaxStatesOnStack) return row_of<kAnyNumber, kMaxStatesOnStack>(A, C, n, s);
    return row_of<kAnyNumber, kAnyNumber>(A, C, n, s);
}

Complex resolvent_response(std::span<const double> A, std::span<const double> B, std::span<const double> C, double D,
                           int n, Complex s) {
    if (n == 0) return D;
    const std::vector<Complex> row = resolvent_row(A, C, n, s);
    Complex response = D;
    for (std::size_t i = 0; i < row.size(); ++i) response += row[i] * B[i];
    return response;
}

}  // namespace tunewright
