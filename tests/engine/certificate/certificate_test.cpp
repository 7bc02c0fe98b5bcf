// The certified bound against designs that an independent solver found, and against random controllers: no feasible one
// may be better, and what a leaf says about a controller in its box must be true of it.
#include "engine/certificate/certificate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "engine/certificate/design_response.h"
#include "engine/certificate/leaf_check.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"
#include "tests/engine/tuning/reference_batch.h"

namespace tunewright {
namespace {

constexpr double kM = 1.4;

/// The reference design of a plant, with its IAE, which is given to seven digits.
CertificateProblem certificate_case(const std::string& id, const std::string& which) {
    for (const auto& row : test::reference_rows()) {
        if (row.at("id") != id) continue;
        const auto& given = row.at("plant");
        const auto& best = row.at(which);
        const auto plant = LinearPlant::make(TransferFunction{given.at("num").get<std::vector<double>>(),
                                                              given.at("den").get<std::vector<double>>(),
                                                              given.at("delay").get<double>(),
                                                              {}});
        IdealPid pid{.Kp = best.at("K"), .Ti = best.at("Ti"), .Td = best.at("Td"), .filter = {}};
        if (pid.Td > 0) pid.filter = {FilterType::measurement_second_order, best.at("Tf")};
        if (which == "pid_M1.4_td10") pid.filter.Tf = pid.Td / 10;
        return *certificate_problem(*plant, pid, kM, kM, best.at("IAE"), pid.Td > 0);
    }
    ADD_FAILURE() << id << " is not in the batch";
    return {};
}

Certificate with_leaves(const CertificateProblem& problem, double gap) {
    CertifyOptions options;
    options.gap = gap;
    options.keep_leaves = true;
    return *certify(problem, options, {});
}

bool box_holds(const CertifiedBox& box, const std::array<double, 3>& x) {
    for (std::size_t i = 0; i < 3; ++i)
        if (x[i] < box.low[i] || x[i] > box.high[i]) return false;
    return true;
}

double volume(const CertifiedBox& box, int unknowns) {
    double product = 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(unknowns); ++i) product *= box.high[i] - box.low[i];
    return product;
}

/// Every leaf proves the bound, and their volumes add up to the root's.
void expect_strict(const Certificate& proof, double gap) {
    ASSERT_TRUE(proof.complete);
    EXPECT_NEAR(proof.lower, (1 - gap) * proof.problem.upper, 1e-12 * proof.lower);
    const auto plant = LinearPlant::make(
        TransferFunction{proof.problem.plant.num, proof.problem.plant.den, proof.problem.plant.L, {}});
    const double scale = certificate::frequency_scale(proof.problem, plant->time_scale());
    certificate::LeafCheck check(proof.problem, proof.w0, proof.harmonics, certificate::axis_edges(scale));
    for (const SignFunction& sign : proof.phis) check.add(sign);
    const int unknowns = proof.problem.structure == CertifiedStructure::pi ? 2 : 3;
    double sum = 0;
    for (const CertificateLeaf& leaf : proof.leaves) {
        sum += volume(leaf.box, unknowns);
        EXPECT_GE(check.proven_bound(leaf), proof.lower) << to_string(leaf.reason);
    }
    EXPECT_NEAR(sum / volume(proof.root, unknowns), 1, 1e-9);
}

/// What a leaf says about a controller in its box, by the loop's own peaks, stability and response.
void expect_true_of(const CertificateLeaf& leaf, const Certificate& proof, const LinearPlant& plant,
                    const std::array<double, 3>& x) {
    const auto loop = Loop::make(plant, certificate::controller_at(proof.problem, x));
    ASSERT_TRUE(loop);
    const bool stable = count_unstable_poles(*loop).stable();
    switch (leaf.reason) {
        case LeafReason::sensitivity: EXPECT_GT(std::abs(loop->at(leaf.omega).S), kM * (1 - 1e-12)); break;
        case LeafReason::complementary: EXPECT_GT(std::abs(loop->at(leaf.omega).T), kM * (1 - 1e-12)); break;
        case LeafReason::unstable: EXPECT_FALSE(stable); break;
        default: {
            if (!stable) break;
            const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
            if (leaf.reason != LeafReason::error && std::max(peaks.S.value, peaks.T.value) > kM) break;
            EXPECT_NE(leaf.reason, LeafReason::empty);
            const auto response = certificate::load_response(proof.problem, plant, x, 0);
            if (response) {
                EXPECT_GE(response->IAE, proof.lower * (1 - 1e-5));
            }
        }
    }
}

void expect_true_of_random_controllers(const Certificate& proof, int count) {
    const auto& given = proof.problem.plant;
    const auto plant = LinearPlant::make(TransferFunction{given.num, given.den, given.L, {}});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(0, 1), near(0.7, 1.4), slower(0.3, 1);
    int feasible = 0;
    for (int i = 0; i < count; ++i) {
        std::array<double, 3> x{};
        const double less = i % 3 == 1 ? slower(random) : 1;  // slower than the design: mostly within the limits
        for (std::size_t k = 0; k < 3; ++k)
            x[k] = i % 3 == 0   ? proof.root.low[k] + part(random) * (proof.root.high[k] - proof.root.low[k])
                   : i % 3 == 1 ? proof.problem.design[k] * (k == 1 ? less * less : less)
                                : proof.problem.design[k] * near(random);
        for (const CertificateLeaf& leaf : proof.leaves)
            if (box_holds(leaf.box, x)) expect_true_of(leaf, proof, *plant, x);
        // Also outside the root, below its least ki.
        const auto loop = Loop::make(*plant, certificate::controller_at(proof.problem, x));
        if (!loop || !count_unstable_poles(*loop).stable()) continue;
        const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
        if (std::max(peaks.S.value, peaks.T.value) > kM) continue;
        ++feasible;
        const auto response = certificate::load_response(proof.problem, *plant, x, 0);
        if (response) {
            EXPECT_GE(response->IAE, proof.lower * (1 - 1e-5));
        }
    }
    EXPECT_GT(feasible, count / 20);
}

TEST(Certificate, ProvesTheReferenceOptimaOfPiToOnePercentAndEveryLeafHolds) {
    for (const char* id :
         {"P1_T0.02", "P1_T100", "P2_T1.5", "P3_T0.5", "P4_n8", "P6_L0.5", "P7_T2_L1", "P8_a0.9", "P9_T0.5"}) {
        SCOPED_TRACE(id);
        const Certificate proof = with_leaves(certificate_case(id, "pi_M1.4"), 0.01);
        expect_strict(proof, 0.01);
        expect_true_of_random_controllers(proof, 60);
    }
}

TEST(Certificate, ProvesTheOptimaOfPidWithTiedFilterToOnePercent) {
    for (const char* id : {"P1_T1", "P7_T5_L1"}) {
        SCOPED_TRACE(id);
        const Certificate proof = with_leaves(certificate_case(id, "pid_M1.4_td10"), 0.01);
        expect_strict(proof, 0.01);
        expect_true_of_random_controllers(proof, 90);
    }
}

TEST(Certificate, ProvesTheOptimumOfPidWithFixedFilterToOnePercent) {
    const Certificate proof = with_leaves(certificate_case("P6_L0.5", "pid_M1.4_fixedTf"), 0.01);
    expect_strict(proof, 0.01);
    expect_true_of_random_controllers(proof, 90);
}

TEST(Certificate, DoesNotProveAGoalAboveTheOptimum) {
    for (const auto& [id, which] :
         {std::pair{"P7_T2_L1", "pi_M1.4"}, std::pair{"P8_a0.9", "pi_M1.4"}, std::pair{"P1_T1", "pid_M1.4_td10"}}) {
        SCOPED_TRACE(id);
        CertificateProblem problem = certificate_case(id, which);
        const double optimum = problem.upper;
        problem.upper *= 1.01;
        CertifyOptions options;
        options.gap = 0.005;
        options.max_boxes = 800;
        const auto proof = certify(problem, options, {});
        ASSERT_TRUE(proof);
        EXPECT_FALSE(proof->complete);
        EXPECT_LE(proof->lower, optimum * (1 + 1e-5));
        EXPECT_GT(proof->lower, 0.9 * optimum);
    }
}

TEST(Certificate, AStoppedSearchStillProvesABound) {
    const CertificateProblem problem = certificate_case("P1_T1", "pid_M1.4_td10");
    CertifyOptions options;
    options.keep_leaves = true;
    options.max_boxes = 60;
    const auto proof = certify(problem, options, {});
    ASSERT_TRUE(proof);
    EXPECT_FALSE(proof->complete);
    EXPECT_LT(proof->lower, proof->goal);
    // Every ki of the root is at most four times the design's.
    EXPECT_GE(proof->lower, 0.99 / proof->root.high[1]);
    expect_true_of_random_controllers(*proof, 60);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_EQ(certify(problem, options, {.stop = stop.get_token(), .progress = {}, .now_ms = {}})->boxes, 0);
}

/// The best PI of a coarse grid within Ms = Mt = 2.
IdealPid best_of_grid(const LinearPlant& plant, double& IAE) {
    IdealPid best;
    IAE = 1e300;
    for (double K = 1; K < 40; K *= 1.08)
        for (double Ti = 0.3; Ti < 10; Ti *= 1.1) {
            const ParallelPid pid = to_parallel(IdealPid{.Kp = K, .Ti = Ti, .filter = {}});
            const auto loop = Loop::make(plant, pid);
            if (Ti / K > IAE || !count_unstable_poles(*loop).stable()) continue;
            const Peaks peaks = find_peaks(*loop, make_peak_grid(*loop));
            if (std::max(peaks.S.value, peaks.T.value) > 2) continue;
            CertificateProblem problem;
            const auto response = certificate::load_response(problem, plant, {K, K / Ti, 0}, 0);
            if (!response || response->IAE > IAE) continue;
            IAE = response->IAE;
            best = {.Kp = K, .Ti = Ti, .filter = {}};
        }
    return best;
}

TEST(Certificate, AnUnstablePlantAndAPlantOfNegativeGainAreProved) {
    const auto plant = LinearPlant::make(Fopdt{.K = -1, .T = -4, .L = 0.2, .uncertainty = {}});
    ASSERT_TRUE(plant);
    double IAE = 0;
    const IdealPid pid = best_of_grid(*plant, IAE);
    ASSERT_LT(IAE, 10);
    const auto problem = certificate_problem(*plant, pid, 2, 2, IAE, false);
    ASSERT_TRUE(problem);
    CertifyOptions options;
    options.gap = 0.15;  // the grid's steps cost about a tenth
    options.max_boxes = 3000;
    options.keep_leaves = true;
    const auto proof = certify(*problem, options, {});
    ASSERT_TRUE(proof);
    EXPECT_TRUE(proof->complete) << proof->gap;

    const auto mirrored = LinearPlant::make(Fopdt{.K = 1, .T = -4, .L = 0.2, .uncertainty = {}});
    const auto same = certificate_problem(*mirrored, {.Kp = -pid.Kp, .Ti = pid.Ti, .filter = {}}, 2, 2, IAE, false);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->design, problem->design);
    EXPECT_EQ(certify(*same, options, {})->boxes, proof->boxes);
}

TEST(Certificate, DoesNotDependOnTheOrderOfItsThreads) {
    const CertificateProblem problem = certificate_case("P7_T5_L1", "pi_M1.4");
    RunControl backwards;
    backwards.spread = [](int n, const std::function<void(int)>& f) {
        for (int i = n - 1; i >= 0; --i) f(i);
    };
    const auto one = certify(problem, {}, {}), two = certify(problem, {}, backwards);
    EXPECT_EQ(one->boxes, two->boxes);
    EXPECT_EQ(one->leaves_by_reason, two->leaves_by_reason);
}

TEST(Certificate, RefusesWhatItCannotProve) {
    const auto plant = LinearPlant::make(Fopdt{.K = 1, .T = 1, .L = 1, .uncertainty = {}});
    EXPECT_EQ(certificate_problem(*plant, {.Kp = 1, .filter = {}}, kM, kM, 1, false).error().kind,
              ErrorKind::unsupported);
    EXPECT_EQ(certificate_problem(*plant, {.Kp = 1, .Ti = 1, .filter = {FilterType::derivative, 1}}, kM, kM, 1, false)
                  .error()
                  .kind,
              ErrorKind::unsupported);
    const auto unstable = certificate_problem(*plant, {.Kp = 5, .Ti = 1, .filter = {}}, kM, kM, 1, false);
    ASSERT_TRUE(unstable);
    EXPECT_EQ(certify(*unstable, {}, {}).error().kind, ErrorKind::invalid_argument);
}

}  // namespace
}  // namespace tunewright
