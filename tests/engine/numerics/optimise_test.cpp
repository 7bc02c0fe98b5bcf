// The optimisers compared with other methods for the same minimum: enumeration of active sets, optimality conditions,
// closed forms.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "engine/numerics/optimise/levenberg_marquardt.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/numerics/optimise/sqp.h"

namespace tunewright {
namespace {

using namespace optimise;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The minimum by trying every set of active constraints: the only stationary point that is feasible with multipliers
/// of the right sign.
template <class Program>
std::optional<VectorXd> by_enumeration(const Program& p) {
    const Eigen::Index n = p.g.size(), m = p.constraints;
    for (unsigned set = 0; set < 1U << m; ++set) {
        std::vector<Eigen::Index> active;
        for (Eigen::Index i = 0; i < m; ++i)
            if (set >> i & 1U) active.push_back(i);
        const auto q = Eigen::Index(active.size());
        if (q > n) continue;
        MatrixXd K = MatrixXd::Zero(n + q, n + q);
        VectorXd right(n + q);
        K.topLeftCorner(n, n) = p.H;
        right.head(n) = -p.g;
        for (Eigen::Index k = 0; k < q; ++k) {
            K.col(n + k).head(n) = p.A.col(active[std::size_t(k)]);
            K.row(n + k).head(n) = p.A.col(active[std::size_t(k)]).transpose();
            right[n + k] = p.b[active[std::size_t(k)]];
        }
        const Eigen::FullPivLU<MatrixXd> factored(K);
        if (!factored.isInvertible()) continue;
        const VectorXd z = factored.solve(right);
        if (q > 0 && z.tail(q).minCoeff() < -1e-10) continue;
        bool feasible = true;
        for (Eigen::Index i = 0; i < m; ++i) feasible = feasible && p.A.col(i).dot(z.head(n)) <= p.b[i] + 1e-10;
        if (feasible) return z.head(n);
    }
    return std::nullopt;
}

template <class Program, class Minimum>
void expect_optimal(const Program& p, const Minimum& minimum, double tolerance) {
    VectorXd gradient = p.g + p.H * minimum.x;
    for (Eigen::Index i = 0; i < p.constraints; ++i) {
        const double slack = p.b[i] - p.A.col(i).dot(minimum.x);
        EXPECT_GE(minimum.multipliers[i], 0);
        EXPECT_GE(slack, -tolerance * (1 + std::abs(p.b[i])));
        EXPECT_NEAR(slack * minimum.multipliers[i], 0, tolerance * (1 + minimum.multipliers[i]));
        gradient += minimum.multipliers[i] * p.A.col(i);
    }
    EXPECT_NEAR(gradient.norm(), 0, tolerance * (1 + p.g.norm()));
}

TEST(QuadraticProgram, IsTheOneFeasibleStationaryPoint) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    int without = 0;
    for (int trial = 0; trial < 600; ++trial) {
        const Eigen::Index n = 1 + trial % 4, m = 1 + trial % 10;
        SmallProgram program(n, m);
        const MatrixXd root = MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
        program.H = root * root.transpose() + 0.01 * MatrixXd::Identity(n, n);
        program.g = VectorXd::NullaryExpr(n, [&] { return 3 * normal(random); });
        // Every third program has its first constraint twice, like two plants with the same peak.
        for (Eigen::Index i = 0; i < m; ++i) {
            const bool again = trial % 3 == 0 && i == 1;
            const VectorXd a =
                again ? VectorXd(program.A.col(0)) : VectorXd::NullaryExpr(n, [&] { return normal(random); });
            program.add(a, again ? program.b[0] : normal(random) + 0.3);
        }
        const auto expected = by_enumeration(program);
        const auto minimum = solve(program);
        without += !expected;
        ASSERT_EQ(minimum.has_value(), expected.has_value()) << trial;
        if (!minimum) continue;
        EXPECT_NEAR((minimum->x - *expected).norm(), 0, 1e-8 * (1 + expected->norm())) << trial;
        expect_optimal(program, *minimum, 1e-9);
    }
    EXPECT_GT(without, 20);
    EXPECT_LT(without, 300);
}

TEST(QuadraticProgram, RefusesAMatrixThatIsNotPositiveDefinite) {
    SmallProgram program(2, 1);
    program.H = Eigen::Matrix2d{{1, 2}, {2, 1}};
    EXPECT_FALSE(solve(program).has_value());
}

// Like a step of the joint search: unknowns t and s that enter linearly, almost no curvature in them, a large penalty.
TEST(QuadraticProgram, ALargeOneMeetsItsOptimalityConditionsBesideALargePenalty) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    for (const double penalty : {40.0, 4e4}) {
        for (int trial = 0; trial < 20; ++trial) {
            const Eigen::Index n = 30, size = n + 2;
            LargeProgram program(size, 3 + 2 * n + 80);
            program.H.setZero();
            program.H.topLeftCorner(n, n) = 0.3 * MatrixXd::Identity(n, n);
            program.H(n, n) = program.H(n + 1, n + 1) = 1e-6;
            program.g[n] = 1;
            program.g[n + 1] = penalty;
            const auto add = [&](double by_t, double by_s, double bound) {
                VectorXd a = VectorXd::NullaryExpr(size, [&] { return normal(random); });
                a.tail(2) << by_t, by_s;
                program.add(a, bound);
            };
            for (int i = 0; i < 20; ++i) add(-1, 0, std::abs(normal(random)));
            for (int i = 0; i < 60; ++i) add(0, -1, normal(random));
            program.add(-VectorXd::Unit(size, n + 1), 0);
            program.add(VectorXd::Unit(size, n + 1), 60);
            program.add(-VectorXd::Unit(size, n), 60);
            for (Eigen::Index i = 0; i < n; ++i) {
                program.add(VectorXd::Unit(size, i), 1);
                program.add(-VectorXd::Unit(size, i), 1);
            }
            const auto minimum = solve(program);
            ASSERT_TRUE(minimum.has_value());
            expect_optimal(program, *minimum, 1e-9);
        }
    }
}

/// Minimum of x1 + x2 on the disc of radius sqrt 2: at (-1, -1), multiplier 1/2.
struct Disc {
    struct State {
        Eigen::Vector2d x;
    };
    struct Step {
        SmallProgram::Vector p;
        double predicted = 0, multiplier = 0;
    };
    static constexpr bool kElastic = false;
    SmallProgram::Matrix H = SmallProgram::Matrix::Identity(2, 2);

    std::optional<Step> step(const State& here, double radius) const {
        SmallProgram program(2, 5);
        program.H = H;
        program.g = Eigen::Vector2d(1, 1);
        program.add(2 * here.x, 2 - here.x.squaredNorm());
        for (const int i : {0, 1})
            for (const int sign : {-1, 1}) program.add(sign * Eigen::Vector2d::Unit(i), radius);
        const auto minimum = solve(program);
        if (!minimum) return std::nullopt;
        const SmallProgram::Vector& p = minimum->x;
        return Step{p, -(p.sum() + 0.5 * p.dot(H * p)), minimum->multipliers[0]};
    }
    double length(const Step& step) const { return step.p.cwiseAbs().maxCoeff(); }
    bool worth_trying(const State&, const Step&, double) const { return true; }
    std::optional<State> candidate(const State& here, const Step& step, double) const {
        Eigen::Vector2d x = here.x + step.p;
        if (x.squaredNorm() > 2) x *= std::numbers::sqrt2 / x.norm();
        return State{x};
    }
    double merit(const State& state) const { return state.x.sum(); }
    bool accepted(const State&, double) const { return true; }
    void differentiate(State&) const {}
    void learn(const State& before, const State& here, const Step& step) {
        const SmallProgram::Vector s = here.x - before.x;
        update_curvature(H, s, SmallProgram::Vector(step.multiplier * 2 * s));
    }
};

TEST(Sqp, EndsAtTheConstrainedMinimum) {
    for (const Eigen::Vector2d& start :
         {Eigen::Vector2d(0.5, -0.2), Eigen::Vector2d(1, -1), Eigen::Vector2d(-1.2, 0.3)}) {
        Disc disc;
        Disc::State state{start};
        const SqpEnd end = minimise(disc, state, {}, 60, 1e-14);
        EXPECT_TRUE(end.converged);
        EXPECT_NEAR((state.x - Eigen::Vector2d(-1, -1)).norm(), 0, 1e-6);
    }
}

TEST(Sqp, CurvatureStaysPositiveDefiniteWhereTheLagrangianBendsDown) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const Eigen::Vector3d curvatures(1, 0.4, -0.3);
    for (int trial = 0; trial < 20; ++trial) {
        MatrixXd H = 0.3 * MatrixXd::Identity(3, 3);
        for (int i = 0; i < 8; ++i) {
            const VectorXd s = VectorXd::NullaryExpr(3, [&] { return normal(random); });
            const VectorXd y = curvatures.cwiseProduct(s);
            const double before = s.dot(H * s);
            update_curvature(H, s, y);
            ASSERT_EQ(H.llt().info(), Eigen::Success) << trial << " " << i;
            // The secant condition with damping: s'Hs keeps a fifth of its value, and H s is y if y has more.
            EXPECT_GE(s.dot(H * s), 0.2 * before * (1 - 1e-9));
            if (s.dot(y) > 0.2 * before) {
                EXPECT_NEAR((H * s - y).norm(), 0, 1e-9 * (1 + y.norm()));
            }
        }
    }
}

/// Rosenbrock's residuals, 10 (y - x^2) and 1 - x.
struct Valley {
    Eigen::Vector2d x{-1.2, 1};
    Eigen::Vector2d residual() const { return {10 * (x[1] - x[0] * x[0]), 1 - x[0]}; }
    Eigen::Matrix2d J = Eigen::Matrix2d::Zero(), H = J;
    Eigen::Vector2d g = Eigen::Vector2d::Zero();

    bool linearise() {
        J << -20 * x[0], 10, -1, 0;
        H = J.transpose() * J;
        g = J.transpose() * residual();
        return g.norm() > 0;
    }
    Trial try_step(double damping) {
        Valley next = *this;
        next.x -= damped(H, damping).ldlt().solve(g);
        if ((next.x - x).norm() < 1e-12) return Trial::end;
        if (!(next.residual().norm() < residual().norm())) return Trial::worse;
        x = next.x;
        return Trial::better;
    }
};

TEST(LevenbergMarquardt, FindsTheEndOfRosenbrocksValley) {
    Valley valley;
    EXPECT_LE(levenberg_marquardt(valley, 100), 60);
    EXPECT_NEAR(valley.x[0], 1, 1e-9);
    EXPECT_NEAR(valley.x[1], 1, 1e-9);
}

/// Takes so many steps, then finds none that is better.
struct FiniteSteps {
    int left = 0, linearised = 0, tries = 0;
    bool linearise() { return ++linearised, true; }
    Trial try_step(double) { return ++tries, left-- > 0 ? Trial::better : Trial::worse; }
};

TEST(LevenbergMarquardt, CountsTheStepsThatWereTaken) {
    for (const int steps : {0, 1, 7}) {
        FiniteSteps problem{.left = steps};
        EXPECT_EQ(levenberg_marquardt(problem, 50), steps);
        EXPECT_EQ(problem.linearised, steps + 1) << "from the last one no step is better, whatever the damping";
    }
    FiniteSteps endless{.left = 1000};
    EXPECT_EQ(levenberg_marquardt(endless, 50), 50);
    // From 1e-3 on the damping rises tenfold: the largest that is tried lies below `max`.
    FiniteSteps none;
    EXPECT_EQ(levenberg_marquardt(none, 50, {.max = 2e3, .tighten = 10}), 0);
    EXPECT_EQ(none.tries, 7);
}

TEST(LevenbergMarquardt, DampsWhatNothingDependsOn) {
    const Eigen::Matrix2d H{{4, 0}, {0, 0}};
    EXPECT_EQ(damped(H, 0.5)(0, 0), 6);
    EXPECT_GT(damped(H, 0.5)(1, 1), 0);
}

TEST(GoldenSection, IsWithinItsIntervalsShareOfTheMinimum) {
    for (const double at : {0.0, 0.1, 0.5, 0.77, 1.0}) {
        int calls = 0;
        const auto f = [&](double x) { return ++calls, std::abs(x - at); };
        EXPECT_NEAR(golden_section(f, 0, 1, 26), at, std::pow(std::numbers::phi, -26));
        EXPECT_EQ(calls, 28);
    }
}

TEST(Bisect, KeepsThePropertyInsideAndItsEndBetween) {
    for (const double end : {0.1, 1 / 3.0, 0.9}) {
        const auto below = [&](double x) { return x <= end; };
        const auto above = [&](double x) { return x >= end; };
        const Bracket up = bisect({0, 1}, below, 20), down = bisect({1, 0}, above, 20);
        EXPECT_TRUE(below(up.inside) && !below(up.outside));
        EXPECT_TRUE(above(down.inside) && !above(down.outside));
        EXPECT_EQ(up.outside - up.inside, std::pow(2, -20));
        const Bracket log = log_bisect({1e-3, 10}, below, 1e-9);
        EXPECT_TRUE(below(log.inside) && !below(log.outside));
        EXPECT_NEAR(log.inside / log.outside, 1, 1e-9);
    }
}

TEST(LogMaximum, FindsASharpResonance) {
    // |1/(1 - w^2 + 2 j zeta w)| is largest at sqrt(1 - 2 zeta^2).
    const double zeta = 1e-3;
    const auto gain = [&](double w) { return 1 / std::hypot(1 - w * w, 2 * zeta * w); };
    const auto peak = log_maximum(gain, 0.9, {0.99, gain(0.99)}, 1.05);
    EXPECT_NEAR(peak.value * 2 * zeta * std::sqrt(1 - zeta * zeta), 1, 1e-11);
    EXPECT_NEAR(peak.x, std::sqrt(1 - 2 * zeta * zeta), 1e-7);
}

TEST(LogMaximum, NeverAnswersLessThanWhatIsKnown) {
    // Two peaks: the known point is on the higher, narrow one.
    const auto f = [](double x) { return std::exp(-1e8 * std::pow(x - 1.5, 2)) + 0.5 * std::exp(-std::pow(x - 3, 2)); };
    const auto peak = log_maximum(f, 1, {1.5, f(1.5)}, 4);
    EXPECT_GE(peak.value, f(1.5));
}

}  // namespace
}  // namespace tunewright
