// Structures call by call: against their continuous figures, an independent transform, and with limits.
#include "engine/structure/program/sampled_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "engine/loop/sampled/sampled_loop.h"
#include "engine/simulation/linear/indices.h"
#include "engine/simulation/sampled/sampled_response.h"
#include "engine/structure/interaction.h"
#include "engine/structure/program/loop_programs.h"
#include "engine/structure/program/predictor_program.h"
#include "tests/engine/structure/plants.h"

namespace tunewright::structure {
namespace {

SampledPid sampled_pi(double Kp, double Ti, double Ts) { return {.gains = to_parallel(pi(Kp, Ti)), .Ts = Ts}; }

SampledAnswer answer(const Expected<code::Program>& program, const SampledScene& scene,
                     const std::map<std::string, double>& sizes = {}) {
    EXPECT_TRUE(program) << program.error().message;
    const auto out = run_sampled(*program, scene, sizes, {});
    EXPECT_TRUE(out) << out.error().message;
    return *out;
}

const StepFigures& figures(const SampledAnswer& answer, const std::string& name, std::size_t y = 0) {
    return std::ranges::find(answer.responses, name, &SampledResponse::name)->figures.at(y);
}

/// True if a figure approaches its limit as Ts does 0, in proportion to Ts, and is near it for the shorter Ts.
void expect_first_order(double coarse, double fine, double limit, double near, const std::string& what) {
    EXPECT_NEAR(fine, limit, near * std::abs(limit)) << what;
    const double ratio = (coarse - limit) / (fine - limit);
    if (std::abs(fine - limit) > 1e-3 * std::abs(limit)) {
        EXPECT_NEAR(ratio, 4, 1.6) << what << " " << coarse << " " << fine << " " << limit;
    }
}

TEST(SampledStructure, ASingleControllerIsTheSampledLoopOfItsOwnRoom) {
    // Peaks by the pulse transfer function, figures by the response of another simulation.
    const LinearPlant plant = first_order(2, 10, 3.7);  // 3.7 is no multiple of 0.5
    SampledPid law{.gains = to_parallel(
                       IdealPid{.Kp = 0.9, .Ti = 9, .Td = 1.2, .filter = {FilterType::measurement_second_order, 0.6}}),
                   .Ts = 0.5};
    const SampledAnswer own = answer(code::pid_algorithm(law, {}), loop_scene(plant));
    EXPECT_NEAR(*own.Ms.at("loop"), SampledLoop(plant, law).sensitivity_peak().value, 1e-6);
    const StepResponse load = simulate_sampled(plant, law, {}, {.d = 1}, {.tolerance = 1e-8});
    const StepFigures expected = figures_of(load, 0);
    EXPECT_NEAR(*figures(own, "load").IAE, *expected.IAE, 1e-4 * *expected.IAE);
    EXPECT_NEAR(*figures(own, "load").IE, *expected.IE, 1e-6 * *expected.IAE);
    EXPECT_NEAR(figures(own, "load").peak, expected.peak, 1e-4);
    EXPECT_NEAR(figures(own, "load").TV, expected.TV, 1e-5);

    const StepResponse limited = simulate_sampled(plant, law, {.output = ActuatorLimits{-0.3, 0.7}}, {.r = 1}, {});
    const SampledAnswer held =
        answer(code::pid_algorithm(law, {.anti_windup = code::AntiWindup::clamping, .u_min = -0.3, .u_max = 0.7}),
               loop_scene(plant));
    const double IAE = integral_of_absolute_error(limited.nodes, 1, limited.error_integral_final);
    EXPECT_NEAR(*figures(held, "setpoint").IAE, IAE, 1e-3 * IAE);
}

TEST(SampledStructure, ACascadeBecomesTheContinuousOne) {
    for (const Arrangement arrangement : {Arrangement::series, Arrangement::parallel}) {
        const CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20), arrangement};
        const auto limit = judge_cascade(plants, {pi(0.8, 6), pi(0.6, 70)});
        ASSERT_TRUE(limit && limit->stable);
        const auto run = [&](double Ts) {
            return answer(cascade_program(sampled_pi(0.8, 6, Ts), sampled_pi(0.6, 70, Ts), {}, {}),
                          *cascade_scene(plants));
        };
        const SampledAnswer coarse = run(0.6), fine = run(0.15);
        expect_first_order(*coarse.Ms.at("inner"), *fine.Ms.at("inner"), limit->Ms_inner, 0.02, "Ms inner");
        expect_first_order(*coarse.Ms.at("outer"), *fine.Ms.at("outer"), limit->Ms_outer, 0.02, "Ms outer");
        expect_first_order(*coarse.Ms.at("valve"), *fine.Ms.at("valve"), limit->Ms_valve, 0.02, "Ms valve");
        for (const auto& [name, load] : {std::pair{"inner_load", &limit->inner_load},
                                         {"outer_load", &limit->outer_load},
                                         {"setpoint", &limit->setpoint}}) {
            expect_first_order(*figures(coarse, name).IAE, *figures(fine, name).IAE, *load->IAE, 0.02, name);
            EXPECT_TRUE(figures(fine, name).settles) << name;
        }
        // The sum of backward Euler has the integral of the law.
        EXPECT_NEAR(*figures(coarse, "outer_load").IE, *limit->outer_load.IE, 1e-5 * *limit->outer_load.IAE);
    }
}

TEST(SampledStructure, PredictorsBecomeTheContinuousOnesWhateverTheModelIs) {
    struct Case {
        PredictorModel model;
        LinearPlant plant;
        PredictorKind kind;
        double Ms;
    };
    for (const Case& c :
         {Case{{.K = 5.6, .T = 40.2, .L = 93.9}, first_order(5.6, 40.2, 93.9), PredictorKind::smith, 1.6},
          {{.K = 5.6, .T = 40.2, .L = 93.9}, first_order(5, 38, 97), PredictorKind::filtered_smith, 1.6},
          {{.K = 0.2, .L = 5, .integrating = true}, transfer({0.2}, {1, 0}, 5), PredictorKind::filtered_smith, 1.7}}) {
        const auto design = design_predictor(c.model, c.plant, {.kind = c.kind, .Ms = c.Ms}, {});
        ASSERT_TRUE(design) << design.error().message;
        const PredictorFigures& limit = design->figures;
        const auto run = [&](double share) {
            return answer(usual_program(design->controller, share * c.model.L, {}), loop_scene(c.plant));
        };
        const SampledAnswer coarse = run(0.0531), fine = run(0.0531 / 4);
        expect_first_order(*coarse.Ms.at("loop"), *fine.Ms.at("loop"), limit.Ms, 0.02, "Ms");
        expect_first_order(*figures(coarse, "load").IAE, *figures(fine, "load").IAE, *limit.load->IAE, 0.02, "load");
        expect_first_order(*figures(coarse, "setpoint").IAE, *figures(fine, "setpoint").IAE, *limit.setpoint->IAE, 0.02,
                           "setpoint");
    }
}

TEST(SampledStructure, APredictorOnAnUnstableModelRunsWithoutDrift) {
    // The continuous responses are not simulated; |S| and the set point's integral error follow from the loop.
    const PredictorModel model{.K = 2, .T = -20, .L = 3};
    const LinearPlant plant = first_order(2, -20, 3);
    const auto design = design_predictor(model, plant, {.kind = PredictorKind::filtered_smith, .Ms = 1.9}, {});
    ASSERT_TRUE(design) << design.error().message;
    const auto run = [&](double Ts) {
        return answer(usual_program(design->controller, Ts, {.u_min = -30, .u_max = 30}), loop_scene(plant),
                      {{"setpoint", 2}});
    };
    const SampledAnswer coarse = run(0.4), fine = run(0.1);
    expect_first_order(*coarse.Ms.at("loop"), *fine.Ms.at("loop"), design->figures.Ms, 0.05, "Ms");
    EXPECT_TRUE(figures(fine, "load").settles);
    EXPECT_TRUE(figures(fine, "setpoint").settles);
    const auto& y = fine.responses[1].y[0];
    EXPECT_NEAR(y.back(), 2, 1e-5);
}

TEST(SampledStructure, FeedforwardBecomesTheContinuousOne) {
    const LinearPlant plant = first_order(1.5, 60, 15), disturbance = first_order(1, 15, 4);
    const Feedforward part{.Kf = 0.6, .Tz = 50, .Tp = 12, .Lf = 1.3};
    const auto limit = judge_feedforward({.plant = plant, .disturbance = disturbance, .feedback = pi(1.2, 60)}, part);
    ASSERT_TRUE(limit);
    const auto run = [&](double Ts) {
        return answer(feedforward_program(sampled_pi(1.2, 60, Ts), part, {}), feedforward_scene(plant, disturbance));
    };
    const SampledAnswer coarse = run(1.2), fine = run(0.3);
    expect_first_order(*figures(coarse, "disturbance").IAE, *figures(fine, "disturbance").IAE, *limit->figures.IAE,
                       0.02, "IAE");
    // With integral action the integral error hardly depends on Ts: (K Kf - Kd) Ti/(K Kp).
    constexpr double kIE = (1.5 * 0.6 - 1) * 60 / (1.5 * 1.2);
    EXPECT_NEAR(*figures(coarse, "disturbance").IE, kIE, 1e-3 * std::abs(kIE));
}

TEST(SampledStructure, InteractingLoopsBecomeTheContinuousOnes) {
    const PlantMatrix plants = wood_berry();
    const auto limit = judge_interaction(plants, {pi(0.375, 8.29), pi(-0.075, 23.6)});
    ASSERT_TRUE(limit);
    const auto run = [&](double Ts) {
        return answer(interaction_program({sampled_pi(0.375, 8.29, Ts), sampled_pi(-0.075, 23.6, Ts)}, {{}, {}}),
                      interaction_scene(plants));
    };
    const SampledAnswer coarse = run(0.4), fine = run(0.1);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string s = "_" + std::to_string(i + 1);
        expect_first_order(*coarse.Ms.at("loop" + s), *fine.Ms.at("loop" + s), limit->Ms_others_closed[i], 0.03, s);
        for (std::size_t j = 0; j < 2; ++j) {
            const std::string load = "load_" + std::to_string(j + 1);
            expect_first_order(*figures(coarse, load, i).IAE, *figures(fine, load, i).IAE, limit->IAE_load[j][i], 0.02,
                               load + s);
        }
    }
}

TEST(SampledStructure, DecouplingRemovesWhatALoopDoesToTheOther) {
    // D12 = -g12/g11 by its lead-lag and dead time; the rest is that of the last call.
    const PlantMatrix plants = vinante_luyben();
    Decoupling elements(2, std::vector<std::optional<Feedforward>>(2));
    elements[1][0] = Feedforward{.Kf = 2.8 / 4.3, .Tz = 9.2, .Tp = 9.5, .Lf = 1.45};
    const auto run = [&](const Decoupling& used) {
        return answer(interaction_program({sampled_pi(-1.07, 7.1, 0.05), sampled_pi(1.97, 2.58, 0.05)}, {{}, {}}, used),
                      interaction_scene(plants));
    };
    EXPECT_LT(*figures(run(elements), "setpoint_1", 1).IAE, 0.05 * *figures(run({}), "setpoint_1", 1).IAE);
}

TEST(SampledStructure, TheFiguresOfADecouplerBecomeThoseWithoutSampling) {
    const PlantMatrix plants = wood_berry();
    const auto decoupler = design_decoupler(plants, DecouplerKind::simplified);
    ASSERT_TRUE(decoupler);
    const auto limit = judge_interaction(plants, {pi(0.4, 8), pi(-0.08, 12)}, decoupler->elements);
    ASSERT_TRUE(limit);
    const auto run = [&](double Ts) {
        return answer(
            interaction_program({sampled_pi(0.4, 8, Ts), sampled_pi(-0.08, 12, Ts)}, {{}, {}}, decoupler->elements),
            interaction_scene(plants));
    };
    const SampledAnswer coarse = run(0.4), fine = run(0.1);
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string s = "_" + std::to_string(i + 1);
        expect_first_order(*coarse.Ms.at("loop" + s), *fine.Ms.at("loop" + s), limit->Ms_others_closed[i], 0.03, s);
        for (std::size_t j = 0; j < 2; ++j) {
            const std::string load = "load_" + std::to_string(j + 1);
            expect_first_order(*figures(coarse, load, i).IAE, *figures(fine, load, i).IAE, limit->IAE_load[j][i], 0.03,
                               load + s);
        }
    }
}

TEST(SampledStructure, ALevelRisesAsInItsClosedForm) {
    const LevelProblem problem{.area = 12, .step = 4, .allowed = 1.8};
    const auto design = design_level(problem);
    ASSERT_TRUE(design);
    const auto run = [&](double Ts) {
        const SampledPid law{.gains = {.Kp = -design->design.Kc, .Ki = -design->design.Kc / design->design.Ti},
                             .Ts = Ts};
        return answer(level_program(law, {.bias = 50, .y0 = 40}), level_scene(12, {}), {{"load", 4}});
    };
    const SampledAnswer coarse = run(0.2), fine = run(0.05);
    expect_first_order(figures(coarse, "load").peak, figures(fine, "load").peak, 1.8, 0.01, "highest");
    expect_first_order(coarse.responses[0].largest_rate, fine.responses[0].largest_rate, design->design.largest_rate,
                       0.03, "rate of the outflow");
}

TEST(SampledStructure, LimitsActAndTheOperatingPointMovesNothing) {
    const CascadePlants plants{first_order(1, 5, 2), first_order(1.2, 60, 20)};
    const auto run = [&](double u, double y2, double y1) {
        return answer(cascade_program(sampled_pi(0.8, 6, 0.5), sampled_pi(1.2, 70, 0.5),
                                      {.u_min = u - 2, .u_max = u + 1.5, .rate_limit = 0.4, .bias = u},
                                      {.u_min = y2 - 3, .u_max = y2 + 3, .bias = y2, .y0 = y1}),
                      *cascade_scene(plants), {{"setpoint", 1.5}});
    };
    const SampledAnswer at_zero = run(0, 0, 0), moved = run(40, 20, 90);
    const SampledResponse &a = at_zero.responses[2], &b = moved.responses[2];
    ASSERT_EQ(a.u[0].size(), b.u[0].size());
    for (std::size_t k = 0; k < a.u[0].size(); ++k) {
        ASSERT_NEAR(a.u[0][k], b.u[0][k], 1e-9) << k;
        ASSERT_NEAR(a.y[0][k], b.y[0][k], 1e-9) << k;
        ASSERT_LE(a.u[0][k], 1.5);
        ASSERT_LE(std::abs(a.u[0][k] - a.u[0][k > 0 ? k - 1 : 0]), 0.2 + 1e-12);
    }
    EXPECT_NEAR(a.y[0].back(), 1.5, 1e-5);
    EXPECT_EQ(*std::ranges::max_element(a.u[0]), 1.5);
    // Peaks are those without limits.
    const SampledAnswer free =
        answer(cascade_program(sampled_pi(0.8, 6, 0.5), sampled_pi(1.2, 70, 0.5), {}, {}), *cascade_scene(plants));
    EXPECT_NEAR(*at_zero.Ms.at("valve"), *free.Ms.at("valve"), 1e-9);
}

TEST(SampledStructure, ALoopThatIsNotStableHasNoPeak) {
    const LinearPlant plant = first_order(1, 10, 5);
    const SampledAnswer out = answer(code::pid_algorithm(sampled_pi(9, 10, 1), {}), loop_scene(plant));
    EXPECT_FALSE(out.Ms.at("loop"));
    EXPECT_FALSE(figures(out, "load").settles);
    const auto late = run_sampled(*code::pid_algorithm(sampled_pi(0.1, 10, 1e-5), {}), loop_scene(plant), {}, {});
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().kind, ErrorKind::invalid_argument);
}

TEST(SampledStructure, ARunThatIsStoppedBeforeItsFirstCallHasNoFigures) {
    const auto plant = first_order(2, 5, 1);
    const auto program = level_program(sampled_pi(0.5, 5, 0.5), {});
    ASSERT_TRUE(program);
    std::stop_source source;
    source.request_stop();
    RunControl control;
    control.stop = source.get_token();
    const auto out = run_sampled(*program, loop_scene(plant), {}, control);
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::cancelled);
}

}  // namespace
}  // namespace tunewright::structure
