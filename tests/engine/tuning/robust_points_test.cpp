// Measured points of a frequency response: their loop, and the design with the largest Kp/Ti.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/evaluation/evaluate.h"
#include "engine/loop/measured_loop.h"
#include "engine/request/tune.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright {
namespace {

FrequencyResponse points_of(const Plant& plant, double low, double high, int n) {
    const auto linear = LinearPlant::make(plant);
    FrequencyResponse points;
    for (int i = 0; i < n; ++i) {
        points.omega.push_back(low * std::pow(high / low, double(i) / (n - 1)));
        const auto P = linear->at({0, points.omega.back()});
        points.re.push_back(P.real());
        points.im.push_back(P.imag());
    }
    points.unstable_poles = linear->unstable_poles();
    points.integrators = linear->integrators();
    return points;
}

Expected<TuningResult> designed_on_points(const PlantModel& plant, double M) {
    TuningRequest request;
    request.subject = test::subject_of(plant);
    request.evaluate.points = 0;
    request.tune[0].options.set("objective", std::string("load_ie"));
    request.tune[0].options.set("filter/Tf_over_Td", 0.1);
    request.tune[0].options.set("Ms", M);
    request.tune[0].options.set("Mt", M);
    return tune(request, {});
}

struct Known {
    const char* name;
    Plant plant;
    double low, high, M;
};

const Known kKnown[] = {
    {"lag", Fopdt{.K = 2, .T = 10, .L = 3}, 0.005, 5, 1.4},
    {"integrator", Ipdt{.K = 0.05, .L = 4}, 0.005, 3, 1.4},
    {"unstable", Fopdt{.K = -1, .T = -10, .L = 1}, 0.005, 12, 1.8},
    {"negative", Sopdt{.K = -1, .T1 = 5, .T2 = 2, .L = 1}, 0.01, 6, 1.4},
    {"third order", TransferFunction{.num = {1}, .den = {1, 3, 3, 1}}, 0.02, 60, 1.4},
};

TEST(FrequencyResponse, DesignsAsTheKnownPlantDoes) {
    for (const auto& known : kKnown) {
        const auto exact = designed_on_points(known.plant, known.M);
        const auto measured = designed_on_points(points_of(known.plant, known.low, known.high, 60), known.M);
        ASSERT_TRUE(exact.has_value() && measured.has_value()) << known.name;
        const IdealPid& a = std::get<IdealPid>(exact->controllers[0].evaluation->controller);
        const IdealPid& b = std::get<IdealPid>(measured->controllers[0].evaluation->controller);
        EXPECT_NEAR(b.Kp / b.Ti / (a.Kp / a.Ti), 1, 1e-3) << known.name;
        // The design from the points also keeps its limits on the plant itself.
        EvaluateOptions options;
        options.points = 0;
        const auto judged = evaluate(known.plant, b, options);
        ASSERT_TRUE(judged->robustness.stable) << known.name;
        EXPECT_LE(std::max(*judged->robustness.Ms, *judged->robustness.Mt), known.M * (1 + 1e-3)) << known.name;
    }
}

TEST(FrequencyResponse, ItsFiguresAreThoseOfTheKnownPlant) {
    for (const auto& known : kKnown) {
        const auto exact = designed_on_points(known.plant, known.M);
        ASSERT_TRUE(exact.has_value()) << known.name;
        const auto& reference = exact->controllers[0].evaluation->robustness;
        EvaluateOptions options;
        options.points = 100;
        const auto judged = evaluate(points_of(known.plant, known.low, known.high, 80),
                                     exact->controllers[0].evaluation->controller, options);
        ASSERT_TRUE(judged.has_value()) << known.name;
        const auto& r = judged->robustness;
        ASSERT_TRUE(r.stable) << known.name;
        EXPECT_NEAR(*r.Ms, *reference.Ms, 1e-3) << known.name;
        EXPECT_NEAR(*r.Mt, *reference.Mt, 1e-3) << known.name;
        EXPECT_NEAR(*r.gain_margin / *reference.gain_margin, 1, 2e-3) << known.name;
        EXPECT_NEAR(*r.phase_margin_deg, *reference.phase_margin_deg, 0.1) << known.name;
        EXPECT_NEAR(*r.delay_margin / *reference.delay_margin, 1, 3e-3) << known.name;
        EXPECT_EQ(r.gain_margin_low.has_value(), reference.gain_margin_low.has_value()) << known.name;
        EXPECT_FALSE(judged->performance.load.IAE);
        EXPECT_NE(judged->performance.load.IAE.why.find("points"), std::string::npos);
        EXPECT_GT(judged->frequency->omega.size(), 50u);
    }
}

TEST(FrequencyResponse, CountsTheSameUnstablePolesAsTheKnownPlant) {
    for (const auto& known : kKnown) {
        const auto linear = LinearPlant::make(known.plant);
        const auto measured = MeasuredPlant::make(points_of(known.plant, known.low, known.high * 4, 200));
        ASSERT_TRUE(measured.has_value()) << known.name;
        const auto exact = designed_on_points(known.plant, known.M);
        IdealPid pid = std::get<IdealPid>(exact->controllers[0].evaluation->controller);
        const double nominal = pid.Kp;
        for (const double factor : {-1.0, 0.05, 0.3, 1.0, 2.0, 3.0, 5.0, 9.0, 14.0}) {
            pid.Kp = nominal * factor;
            const auto loop = Loop::make(*linear, to_parallel(pid));
            ASSERT_TRUE(loop);
            const auto points = MeasuredLoop::make(*measured, to_parallel(pid));
            if (!points) {  // its band is too short
                EXPECT_EQ(points.error().kind, ErrorKind::unsupported) << known.name << " " << factor;
                continue;
            }
            EXPECT_EQ(count_unstable_poles(*points).unstable_poles, count_unstable_poles(*loop).unstable_poles)
                << known.name << " " << factor;
        }
    }
}

TEST(FrequencyResponse, ABandThatEndsTooEarlyIsRefusedInWords) {
    const Plant plant = Fopdt{.K = 2, .T = 10, .L = 3};
    const auto design = designed_on_points(points_of(plant, 0.005, 0.3, 30), 1.4);
    ASSERT_FALSE(design.has_value());
    EXPECT_EQ(design.error().kind, ErrorKind::unsupported);
    EXPECT_NE(design.error().message.find("Measure higher frequencies"), std::string::npos);
    const auto judged = evaluate(points_of(plant, 0.005, 0.6, 30), IdealPid{.Kp = 4, .Ti = 6, .Td = 1}, {});
    ASSERT_FALSE(judged.has_value());
    EXPECT_NE(judged.error().message.find("|L| is still"), std::string::npos) << judged.error().message;
    const auto late = evaluate(points_of(plant, 0.2, 5, 30), IdealPid{.Kp = 0.5, .Ti = 6}, {});
    ASSERT_FALSE(late.has_value());
    EXPECT_NE(late.error().message.find("Measure lower frequencies"), std::string::npos) << late.error().message;
}

TEST(FrequencyResponse, PhaseThatCannotBeFollowedIsNotGuessed) {
    const auto sparse = MeasuredPlant::make(points_of(Fopdt{.K = 1, .T = 0.1, .L = 30}, 0.005, 5, 12));
    ASSERT_FALSE(sparse.has_value());
    EXPECT_NE(sparse.error().message.find("ambiguous"), std::string::npos);
    // Beyond the crossover such points are left out.
    const auto tail = MeasuredPlant::make(points_of(Fopdt{.K = 1, .T = 10, .L = 3}, 0.01, 300, 50));
    ASSERT_TRUE(tail.has_value());
    EXPECT_LT(tail->high(), 300);
    EXPECT_GT(tail->high(), 2);
}

TEST(FrequencyResponse, FaultyColumnsAreNamed) {
    const auto good = points_of(Fopdt{.K = 2, .T = 10, .L = 3}, 0.005, 5, 30);
    const auto where = [](const FrequencyResponse& points) {
        const auto plant = MeasuredPlant::make(points);
        return plant ? std::string() : plant.error().where;
    };
    EXPECT_EQ(where(good), "");
    auto bad = good;
    bad.re.pop_back();
    EXPECT_EQ(where(bad), "plant/re");
    bad = good;
    std::swap(bad.omega[4], bad.omega[5]);
    EXPECT_EQ(where(bad), "plant/omega/5");
    bad = good;
    bad.re[7] = bad.im[7] = 0;
    EXPECT_EQ(where(bad), "plant/re/7");
    bad = good;
    bad.im[3] = NAN;
    EXPECT_EQ(where(bad), "plant/im/3");
    EXPECT_EQ(where(points_of(Fopdt{.K = 2, .T = 10, .L = 3}, 0.005, 5, 7)), "plant/omega");
}

TEST(FrequencyResponse, OtherMethodsSayThatTheyNeedAModel) {
    TuningRequest request;
    request.subject = test::subject_of(points_of(Fopdt{.K = 2, .T = 10, .L = 3}, 0.005, 5, 60));
    request.tune = {{"robust", {}}, {"simc", {}}};
    const auto result = tune(request, {});
    ASSERT_TRUE(result.has_value());
    EXPECT_TRUE(result->controllers[0].evaluation);
    ASSERT_TRUE(result->controllers[1].error);
    EXPECT_EQ(result->controllers[1].error->kind, ErrorKind::unsupported);
    EXPECT_NE(result->controllers[1].error->message.find("simc needs a model"), std::string::npos);
}

}  // namespace
}  // namespace tunewright
