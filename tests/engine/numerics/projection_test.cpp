// Projections on a few long columns: compared with exact combinations, and Eigen's own decompositions.
#include "engine/numerics/matrix/projection.h"

#include <gtest/gtest.h>

#include <Eigen/QR>

#include "tests/engine/tuning/random_plants.h"

namespace tunewright {
namespace {

Eigen::MatrixXd random_matrix(test::Random& random, Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random.uniform(-1, 1); });
}

Projection projected(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
    Projection result;
    project_on(columns, y, square_of(y), result);
    return result;
}

TEST(Projection, IsTheLeastSquaresSolutionOfColumnsOfAnyCount) {
    test::Random random(21);
    for (Eigen::Index columns = 1; columns <= 5; ++columns) {
        const Eigen::MatrixXd A = random_matrix(random, 203, columns);
        const Eigen::VectorXd y = random_matrix(random, 203, 1), x = A.colPivHouseholderQr().solve(y);
        const Projection p = projected(A, y);
        EXPECT_TRUE(p.determined);
        EXPECT_LT((p.linear - x).norm(), 1e-12);
        EXPECT_LT((p.residual - (y - A * x)).norm(), 1e-12);
        EXPECT_NEAR(p.sse, (y - A * x).squaredNorm(), 1e-12);
        EXPECT_NEAR(rough_rest(A, y, square_of(y)), p.sse, 1e-8);
        EXPECT_LT((p.basis.transpose() * p.basis - Eigen::MatrixXd::Identity(columns, columns)).norm(), 1e-13);
    }
}

// For nearly dependent columns nine digits of their angle remain, and the basis is orthogonal.
TEST(Projection, StaysOrthogonalOnColumnsThatAreNearlyTheSame) {
    test::Random random(22);
    Eigen::MatrixXd A = random_matrix(random, 500, 3);
    A.col(1) = A.col(2) + 1e-7 * A.col(1);
    const Projection p = projected(A, random_matrix(random, 500, 1));
    EXPECT_TRUE(p.determined);
    EXPECT_LT((p.basis.transpose() * p.basis - Eigen::MatrixXd::Identity(3, 3)).norm(), 1e-9);
    EXPECT_LT((A.transpose() * p.residual).norm(), 1e-6);
}

TEST(Projection, TheFirstColumnIsNotDeterminedWhereItDependsOnTheOthers) {
    test::Random random(23);
    Eigen::MatrixXd A = random_matrix(random, 100, 3);
    const Eigen::VectorXd y = random_matrix(random, 100, 1);
    A.col(0) = 2 * A.col(1) - A.col(2);
    const Projection dependent = projected(A, y);
    EXPECT_FALSE(dependent.determined);
    EXPECT_EQ(dependent.linear[0], 0);

    // A column of zeros in another place has no effect.
    A.col(0) = random_matrix(random, 100, 1);
    A.col(2).setZero();
    const Projection p = projected(A, y);
    EXPECT_TRUE(p.determined);
    EXPECT_EQ(p.linear[2], 0);
    EXPECT_LT(A.leftCols(2).transpose().lazyProduct(p.residual).norm(), 1e-12);
}

TEST(Projection, TakesOutOfOtherColumnsWhatTheBasisReaches) {
    test::Random random(24);
    const Eigen::MatrixXd A = random_matrix(random, 301, 2);
    Eigen::MatrixXd D = random_matrix(random, 301, 3);
    const Eigen::VectorXd e = random_matrix(random, 301, 1);
    const Projection p = projected(A, e);
    take_out(p.basis, D);
    EXPECT_LT((A.transpose() * D).norm(), 1e-11);
    const NormalEquations equations = normal_equations(D, e);
    EXPECT_LT((equations.matrix - D.transpose() * D).norm(), 1e-11);
    EXPECT_LT((equations.right - D.transpose() * e).norm(), 1e-11);
}

}  // namespace
}  // namespace tunewright
