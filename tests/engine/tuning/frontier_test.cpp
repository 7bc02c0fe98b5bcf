// The frontier of robust optima over the AMIGO batch, compared with the method robust alone.
#include "engine/tuning/robust/frontier.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/evaluation/evaluate.h"
#include "tests/engine/plant/subject_of.h"
#include "tests/engine/tuning/reference_batch.h"

namespace tunewright {
namespace {

TuningProblem problem_of(const Plant& plant) { return {plant, *LinearPlant::make(plant), {}, {}}; }

void expect_front(const Frontier& front, const FrontierOptions& options) {
    const double step = (options.Ms.to - options.Ms.from) / (options.Ms.points - 1);
    for (std::size_t i = 0; i < front.points.size(); ++i) {
        const FrontierPoint& point = front.points[i];
        EXPECT_LE(*point.achieved_Ms, point.Ms * (1 + 2e-5)) << point.Ms;
        EXPECT_LE(*point.achieved_Mt, options.Mt.value_or(point.Ms) * (1 + 2e-5)) << point.Ms;
        EXPECT_GT(*point.load_IAE, 0);
        if (i == 0) continue;
        EXPECT_NEAR(point.Ms - front.points[i - 1].Ms, step, 1e-9);
        EXPECT_LE(*point.load_IAE, *front.points[i - 1].load_IAE * (1 + 2e-4)) << point.Ms;
    }
}

double alone(const TuningProblem& problem, double M, const char* controller) {
    MethodOptions options;
    options.set("Ms", M);
    options.set("Mt", M);
    options.set("controller", std::string(controller));
    const auto tuned = robust_method().tune(problem, options, {});
    EvaluateOptions figures;
    figures.points = 0;
    return *evaluate(PlantModel(problem.plant), tuned->controller, figures)->performance.load.IAE;
}

TEST(Frontier, HoldsItsLimitsAndItsOrderOverTheAmigoBatch) {
    for (const auto& row : test::reference_rows()) {
        SCOPED_TRACE(row.at("id").get<std::string>());
        const TuningProblem problem = problem_of(test::plant_of(row));
        FrontierOptions options;
        const auto front = frontier(problem, options, {});
        if (!front) {
            // A plant without dead time may have no optimum at all, as the method robust says too.
            EXPECT_EQ(front.error().kind, ErrorKind::unbounded_optimum) << front.error().message;
            continue;
        }
        ASSERT_EQ(front->points.size(), 30u);
        EXPECT_FALSE(front->infeasible_below);
        expect_front(*front, options);
    }
}

// The derivative action has no effect, and the dead time repeats its output until the lag, at a much larger time, ends
// that.
TEST(Frontier, UnderADeadTimeAloneAPidIsNoWorseThanAPi) {
    for (const double T : {1e-3, 1e-4, 1e-6, 1e-9, 1e-12}) {
        SCOPED_TRACE(T);
        const TuningProblem problem = problem_of(Fopdt{.K = 1, .T = T, .L = 10});
        const FrontierOptions options{.Ms = {.points = 5}};
        const auto pid = frontier(problem, options, {});
        const auto pi = frontier(problem, {.controller = ControllerKind::PI, .Ms = {.points = 5}}, {});
        ASSERT_TRUE(pid && pi) << (pid ? "" : pid.error().message);
        ASSERT_EQ(pid->points.size(), 5u);
        expect_front(*pid, options);
        for (std::size_t i = 0; i < 5; ++i)
            EXPECT_LE(*pid->points[i].load_IAE, *pi->points[i].load_IAE * (1 + 1e-5)) << pid->points[i].Ms;
    }
}

TEST(Frontier, EachPointIsTheOptimumAlone) {
    std::size_t index = 0;
    for (const auto& row : test::reference_rows()) {
        if (++index % 9 != 0) continue;
        SCOPED_TRACE(row.at("id").get<std::string>());
        const TuningProblem problem = problem_of(test::plant_of(row));
        for (const auto& [kind, word] : {std::pair{ControllerKind::PID, "PID"}, {ControllerKind::PI, "PI"}}) {
            const auto front = frontier(problem, {.controller = kind, .Ms = {.points = 9}}, {});
            if (!front) continue;
            for (const FrontierPoint& point : front->points)
                EXPECT_LE(*point.load_IAE, alone(problem, point.Ms, word) * (1 + 1e-3)) << word << " " << point.Ms;
        }
    }
}

TEST(Frontier, LeavesOutWhatAnUnstablePlantDoesNotAllow) {
    const TuningProblem problem = problem_of(Fopdt{.K = 1, .T = -1, .L = 0.2});
    const auto front = frontier(problem, {}, {});
    ASSERT_TRUE(front) << front.error().message;
    ASSERT_TRUE(front->infeasible_below);
    EXPECT_GT(*front->infeasible_below, 1.2);
    EXPECT_EQ(front->points.front().Ms, *front->infeasible_below);
    EXPECT_LT(front->points.size(), 30u);
    expect_front(*front, {});
    MethodOptions below;
    below.set("Ms", *front->infeasible_below - 1.4 / 29);
    below.set("Mt", *front->infeasible_below - 1.4 / 29);
    EXPECT_FALSE(robust_method().tune(problem, below, {}));
}

TEST(Frontier, KeepsAGivenMt) {
    const TuningProblem problem = problem_of(Ipdt{.K = 0.5, .L = 2});
    const FrontierOptions options{.Ms = {.from = 1.3, .to = 2, .points = 8}, .Mt = 1.5};
    const auto front = frontier(problem, options, {});
    ASSERT_TRUE(front) << front.error().message;
    expect_front(*front, options);
}

TEST(Frontier, HoldsOnEveryPlantOfAFamily) {
    const AnalysedPlant subject =
        test::subject_of(Plant(Fopdt{.K = 2, .T = 10, .L = 3, .uncertainty = {.K = FactorRange{0.8, 1.25}}}));
    const FrontierOptions options{.Ms = {.from = 1.4, .to = 2, .points = 4}};
    const auto front = frontier(subject, options, {});
    ASSERT_TRUE(front) << front.error().message;
    for (const FrontierPoint& point : front->points) {
        EvaluateOptions figures;
        figures.points = 0;
        const auto evaluation = evaluate(subject, point.controller, figures);
        EXPECT_LE(*evaluation->region->worst_Ms, point.Ms * (1 + 1e-4));
    }
}

TEST(Frontier, AsAMethodTakesThePointNearestToItsTake) {
    MethodOptions options;
    options.set("take", 2.0);
    const auto tuned = frontier_method().tune(problem_of(Fopdt{.K = 2, .T = 10, .L = 3}), options, {});
    ASSERT_TRUE(tuned);
    const auto* report = tuned->report_as<Frontier>();
    ASSERT_NE(report, nullptr);
    EXPECT_NEAR(*tuned->Ms_limit, 2, 0.025);
    EXPECT_EQ(report->points.size(), 30u);
}

TEST(Frontier, RefusesARangeThatRunsBackwardsAndStopsWhenAsked) {
    const TuningProblem problem = problem_of(Fopdt{.K = 2, .T = 10, .L = 3});
    const auto backwards = frontier(problem, {.Ms = {.from = 2, .to = 1.5}}, {});
    ASSERT_FALSE(backwards);
    EXPECT_EQ(backwards.error().where, "Ms/to");
    std::stop_source stop;
    stop.request_stop();
    const auto stopped = frontier(problem, {}, {stop.get_token(), nullptr, nullptr});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace tunewright
