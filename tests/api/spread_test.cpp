// Answers do not depend on the distribution of work over threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "api/examples/examples.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

/// Three threads, the last piece first.
void on_threads(int n, const std::function<void(int)>& f) {
    std::atomic<int> left = n;
    const auto work = [&] {
        for (int i; (i = --left) >= 0;) f(i);
    };
    const std::jthread second(work), third(work);
    work();
}

JobOutcome outcome_of(const std::string& request, const ParallelFor& spread) {
    const auto prepared = prepare_job(request);
    EXPECT_TRUE(std::holds_alternative<PreparedJob>(prepared)) << request;
    RunControl control;
    control.spread = spread;
    return run_job(std::get<PreparedJob>(prepared), control);
}

void expect_the_same(const std::string& request) {
    const JobOutcome one = outcome_of(request, {}), several = outcome_of(request, on_threads);
    EXPECT_EQ(one.status, JobOutcome::Status::succeeded) << one.error_json;
    EXPECT_GT(one.result_json.size(), 1000u);
    EXPECT_EQ(one.result_json, several.result_json);
}

TEST(ParallelFor, ComparisonIsTheSame) {
    expect_the_same(request_with(R"("tune": [{"method": "all"}], "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 10},
                                     "evaluate": {"points": 50, "tradeoff": true})"));
}

TEST(ParallelFor, ExamplesAreTheSame) {
    const Json document = Json::parse(examples_json());
    for (const Json& one : document["examples"]) {
        SCOPED_TRACE(one["id"].dump());
        expect_the_same(one["request"].dump());
    }
}

TEST(ParallelFor, ProgressOfRowsAtWorkAtOnceNeverFalls) {
    const auto prepared = prepare_job(request_with(R"("tune": [{"method": "all"}])"));
    std::vector<double> fractions;
    RunControl control;
    control.spread = on_threads;
    control.progress = [&](const Progress& progress) { fractions.push_back(progress.fraction); };
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), control);
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded);
    EXPECT_GT(fractions.size(), 50u);
    EXPECT_TRUE(std::ranges::is_sorted(fractions));
    EXPECT_EQ(fractions.back(), 1);
}

TEST(ParallelFor, RowsThatHaveEndedWhenItIsStoppedAreAnswered) {
    const auto prepared = prepare_job(request_with(R"("tune": [{"method": "all"}], "evaluate": {"points": 0})"));
    std::stop_source stop;
    RunControl control;
    control.stop = stop.get_token();
    control.spread = on_threads;
    control.progress = [&](const Progress& progress) {
        if (progress.fraction > 0.15) stop.request_stop();
    };
    const JobOutcome outcome = run_job(std::get<PreparedJob>(prepared), control);
    ASSERT_FALSE(outcome.result_json.empty()) << outcome.error_json;
    const Json result = Json::parse(outcome.result_json);
    EXPECT_TRUE(result["partial"].get<bool>());
    EXPECT_GE(result["controllers"].size(), 5u);
    EXPECT_LT(result["controllers"].size(), 50u);
}

}  // namespace
}  // namespace tunewright::api
