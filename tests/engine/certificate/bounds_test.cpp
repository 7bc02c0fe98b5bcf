// The parts of a certificate's inequalities, each against direct computation at random points.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>

#include "engine/certificate/axis.h"
#include "engine/certificate/box_bounds.h"
#include "engine/certificate/sign_mean.h"
#include "engine/certificate/small_program.h"

namespace tunewright::certificate {
namespace {

using Complex = std::complex<double>;

Complex direct_F(Complex x) { return 1.0 / (1.0 + x + 0.5 * x * x); }

/// D as docs/proof.md defines it.
Complex direct_D(const CertificateProblem& problem, const std::array<double, 3>& x, Complex s) {
    Complex num = 0, den = 0;
    for (const double b : problem.plant.num) num = num * s + b;
    for (const double a : problem.plant.den) den = den * s + a;
    const Complex Q = s * den / num * std::exp(s * problem.plant.L);
    if (problem.structure == CertifiedStructure::pid_tied)
        return Q + direct_F(s * x[2] / 10.0) * (s * x[0] * (1.0 + s * x[2]) + x[1]);
    return Q + direct_F(s * problem.Tf) * (s * x[0] + x[1] + s * s * x[2]);
}

CertificateProblem lag_problem(CertifiedStructure structure) {
    CertificateProblem problem;
    problem.plant = {{2, 3}, {1, 2.5, 1.5, 1}, 0.7};
    problem.structure = structure;
    problem.Tf = structure == CertifiedStructure::pid_fixed ? 0.3 : 0;
    problem.Ms = problem.Mt = 1.4;
    return problem;
}

struct RandomBoxes {
    std::mt19937 random{3};
    double part() { return std::uniform_real_distribution<double>(0, 1)(random); }
    CertifiedBox box(bool third) {
        CertifiedBox made;
        made.low = {2 * part() - 1, part(), third ? 2 * part() : 0};
        const double wide = std::pow(10.0, -3 * part());
        made.high = {made.low[0] + wide * part(), made.low[1] + wide * part(), third ? made.low[2] + wide * part() : 0};
        return made;
    }
    std::array<double, 3> in(const CertifiedBox& box) {
        std::array<double, 3> x{};
        for (std::size_t i = 0; i < 3; ++i) x[i] = box.low[i] + part() * (box.high[i] - box.low[i]);
        return x;
    }
};

TEST(CertificateBounds, AnIntervalHoldsTheResultOfEachOperation) {
    RandomBoxes r;
    for (int i = 0; i < 20000; ++i) {
        const double x = std::ldexp(r.part() - 0.5, static_cast<int>(40 * r.part()) - 20);
        const double y = std::ldexp(r.part() - 0.5, static_cast<int>(40 * r.part()) - 20);
        const auto holds = [](Interval in, long double exact) {
            return static_cast<long double>(in.low()) <= exact && exact <= static_cast<long double>(in.high());
        };
        const long double a = x, b = y;
        EXPECT_TRUE(holds(Interval(x) + Interval(y), a + b));
        EXPECT_TRUE(holds(Interval(x) - Interval(y), a - b));
        EXPECT_TRUE(holds(Interval(x) * Interval(y), a * b));
        EXPECT_TRUE(holds(Interval(x) / Interval(y), a / b));
        EXPECT_TRUE(holds(square(Interval(x)), a * a));
        EXPECT_TRUE(holds(root(size(Interval(x))), std::sqrt(std::abs(a))));
        EXPECT_TRUE(holds(sine(Interval(x)), std::sin(a)));
        EXPECT_TRUE(holds(cosine(Interval(x)), std::cos(a)));
        EXPECT_TRUE(holds(exponential(Interval(y / 1e4)), std::exp(static_cast<long double>(y / 1e4))));
        // Narrow, or they would prove nothing.
        const Interval product = Interval(x) * Interval(y);
        EXPECT_LT(product.high() - product.low(), 1e-15 * std::abs(x * y) + 1e-299);
    }
    EXPECT_TRUE(std::isinf((Interval(1) / Interval::between(-1, 1)).high()));
    EXPECT_TRUE(std::isinf((Interval::everything() * Interval(0)).high()));
}

TEST(CertificateBounds, TheTermsHoldDOfEveryControllerOfABox) {
    for (const auto structure : {CertifiedStructure::pi, CertifiedStructure::pid_fixed, CertifiedStructure::pid_tied}) {
        const CertificateProblem problem = lag_problem(structure);
        RandomBoxes r;
        for (int i = 0; i < 4000; ++i) {
            const CertifiedBox box = r.box(structure != CertifiedStructure::pi);
            const Complex s = {i % 2 == 0 ? 0 : 3 * r.part(), std::pow(10.0, 4 * r.part() - 2)};
            const auto terms =
                terms_at(structure, GainsOf<Interval>(box), point_at(problem, ComplexOf<Interval>{s.real(), s.imag()}));
            const auto rough =
                terms_at(structure, GainsOf<double>(box), point_at(problem, ComplexOf<double>{s.real(), s.imag()}));
            const auto x = r.in(box);
            const Complex D = direct_D(problem, x, s), centre = {rough.centre.re, rough.centre.im};
            Complex left = D - centre;
            for (std::size_t k = 0; k < 3; ++k) {
                const double h = 0.5 * (box.high[k] - box.low[k]);
                if (h > 0)
                    left -= (x[k] - 0.5 * (box.low[k] + box.high[k])) / h * Complex(rough.g[k].re, rough.g[k].im);
            }
            const double rounding = 1e-12 * (1 + std::abs(D));
            EXPECT_LE(std::abs(left), rough.rest + rounding);
            EXPECT_LE(std::abs(D), largest_size(terms, ComplexOf<Interval>{}) + rounding);
            EXPECT_GE(1 / std::abs(D), error_bound(terms) * (1 - 1e-9));
            const auto harmonic = harmonic_of(terms);
            if (!harmonic.exists) continue;
            const double reach =
                size(harmonic.slope[0]).high() + size(harmonic.slope[1]).high() + size(harmonic.slope[2]).high();
            EXPECT_LE(std::abs((1.0 / D).real() - harmonic.value.low()),
                      reach + harmonic.rest.high() + 1e-9 * std::abs(1.0 / D));
        }
    }
}

TEST(CertificateBounds, AHalfPlaneKeepsEveryControllerWithinTheLimit) {
    const CertificateProblem problem = lag_problem(CertifiedStructure::pid_tied);
    RandomBoxes r;
    int cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const CertifiedBox box = r.box(true);
        const double w = std::pow(10.0, 2 * r.part() - 1);
        const auto point = point_at(problem, ComplexOf<double>{0.0, w});
        const bool complementary = i % 2 == 0;
        const auto terms = terms_at(problem.structure, GainsOf<double>(box), point);
        const auto disc = forbidden_disc(problem, point, complementary);
        const auto x = r.in(box);
        const Complex D = direct_D(problem, x, {0, w}), Q = {point.Q.re, point.Q.im};
        const double peak = complementary ? std::abs((D - Q) / D) : std::abs(Q / D);  // |T| or |S|
        if (exceeds_limit(terms, disc)) {
            EXPECT_GT(peak, 1.4);
        }
        const auto plane = half_plane(terms, disc);
        if (!plane.exists) continue;
        double left = -plane.least;
        for (std::size_t k = 0; k < 3; ++k) {
            const double h = 0.5 * (box.high[k] - box.low[k]);
            left += h > 0 ? plane.row[k] * (x[k] - 0.5 * (box.low[k] + box.high[k])) / h : 0;
        }
        if (peak <= 1.4) {
            EXPECT_GE(left, -1e-12 * (1 + std::abs(D)));
        }
        cut += left < 0 ? 1 : 0;
    }
    EXPECT_GT(cut, 100);
}

TEST(CertificateBounds, ThePiecesOfTheAxisHoldDBetweenTheirEnds) {
    for (const auto structure : {CertifiedStructure::pi, CertifiedStructure::pid_fixed, CertifiedStructure::pid_tied}) {
        const CertificateProblem problem = lag_problem(structure);
        RandomBoxes r;
        int useful = 0;
        for (int i = 0; i < 6000; ++i) {
            const CertifiedBox box = r.box(structure != CertifiedStructure::pi);
            const double w = std::pow(10.0, 4 * r.part() - 2), half = w * 0.02 * r.part();
            const auto piece = axis_piece<double>(problem, w, half);
            const GainsOf<double> gains(box);
            const double least = least_size(problem, gains, piece, terms_at(structure, gains, piece.point));
            const Complex s = {0, w + half * (2 * r.part() - 1)};
            EXPECT_GE(std::abs(direct_D(problem, r.in(box), s)), least - 1e-12);
            useful += least > 0 ? 1 : 0;
            const double beyond = least_size_beyond(problem, gains, w);
            const Complex far = std::polar(w * (1 + 9 * r.part()), std::numbers::pi * (r.part() - 0.5));
            if (far.real() * problem.plant.L < 300) {
                EXPECT_GE(std::abs(direct_D(problem, r.in(box), far)), beyond);
            }
        }
        EXPECT_GT(useful, 1000);
    }
}

TEST(CertificateBounds, TheMeanOfASignStaysWithinOneAndNearTheSign) {
    SignFunction sign;
    sign.first = -1;
    sign.changes = {0.3, 1.1, 2.4};
    const auto a = mean_coefficients(sign, jackson_factors(128));
    for (int i = 0; i <= 5000; ++i) {
        const double x = std::numbers::pi * i / 5000;
        double phi = 0;
        for (std::size_t m = 0; m < a.size(); ++m)
            phi += 0.5 * (a[m].low() + a[m].high()) * std::cos(static_cast<double>(m) * x);
        EXPECT_LE(std::abs(phi), 1 + 1e-12);
        if (std::abs(x - 0.7) < 0.2) {
            EXPECT_GT(phi, 0.99);
        }
        if (std::abs(x - 1.7) < 0.3) {
            EXPECT_LT(phi, -0.99);
        }
    }
}

/// The least of c x over the cube and the rows, by every vertex; +infinity if there is none.
double least_by_vertices(const std::array<double, 3>& c, std::vector<ProgramRow> rows) {
    for (std::size_t i = 0; i < 3; ++i)
        for (const double sign : {1.0, -1.0}) {
            ProgramRow bound;
            bound.a[i] = sign;
            bound.b = -1;
            rows.push_back(bound);
        }
    double least = std::numeric_limits<double>::infinity();
    const std::size_t n = rows.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            for (std::size_t k = j + 1; k < n; ++k) {
                const auto &u = rows[i].a, &v = rows[j].a, &w = rows[k].a;
                const auto det = [](const auto& p, const auto& q, const auto& t) {
                    return p[0] * (q[1] * t[2] - q[2] * t[1]) - p[1] * (q[0] * t[2] - q[2] * t[0]) +
                           p[2] * (q[0] * t[1] - q[1] * t[0]);
                };
                const double d = det(u, v, w);
                if (std::abs(d) < 1e-9) continue;
                std::array<double, 3> x{};
                for (std::size_t at = 0; at < 3; ++at) {  // Cramer's rule
                    auto p = u, q = v, t = w;
                    p[at] = rows[i].b;
                    q[at] = rows[j].b;
                    t[at] = rows[k].b;
                    x[at] = det(p, q, t) / d;
                }
                bool inside = true;
                for (const auto& row : rows)
                    inside &= row.a[0] * x[0] + row.a[1] * x[1] + row.a[2] * x[2] >= row.b - 1e-9;
                if (inside) least = std::min(least, c[0] * x[0] + c[1] * x[1] + c[2] * x[2]);
            }
    return least;
}

TEST(CertificateBounds, TheSmallProgramAgreesWithItsVerticesAndItsMultipliersProveIt) {
    RandomBoxes r;
    int empty = 0;
    for (int i = 0; i < 400; ++i) {
        std::vector<ProgramRow> rows(static_cast<std::size_t>(1 + i % 8));
        const auto signed_part = [&] { return 2 * r.part() - 1; };
        for (auto& row : rows) row = {{signed_part(), signed_part(), signed_part()}, signed_part() * 0.8};
        const std::array<double, 3> c = {signed_part(), signed_part(), signed_part()};
        const double least = least_by_vertices(c, rows);
        const auto result = solve_small_program(3, c, rows);
        double proven = 0;
        std::array<double, 3> left = result.kind == ProgramResult::Kind::empty ? std::array<double, 3>{} : c;
        for (const auto& [row, multiplier] : result.multipliers) {
            EXPECT_GE(multiplier, 0);
            proven += multiplier * rows[static_cast<std::size_t>(row)].b;
            for (std::size_t k = 0; k < 3; ++k) left[k] -= multiplier * rows[static_cast<std::size_t>(row)].a[k];
        }
        proven -= std::abs(left[0]) + std::abs(left[1]) + std::abs(left[2]);
        if (std::isinf(least)) {
            ++empty;
            EXPECT_EQ(result.kind, ProgramResult::Kind::empty);
            EXPECT_GT(proven, 0);
        } else {
            ASSERT_EQ(result.kind, ProgramResult::Kind::solved);
            EXPECT_NEAR(result.least, least, 1e-8);
            EXPECT_NEAR(proven, least, 1e-8);
        }
    }
    EXPECT_GT(empty, 20);
}

}  // namespace
}  // namespace tunewright::certificate
