// Loops from files are checked alike with and without a request around them.
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "api/historian/loop_request.h"
#include "api/json/json.h"
#include "api/service.h"
#include "api/services/check_service.h"
#include "tests/api/historian/recorded_plant.h"

namespace tunewright::api {
namespace {

using testing::SizeIs;

/// A slow PI loop with noise, blank cells, moves of the set point and rows in manual.
std::string operation_file() {
    std::mt19937 chance(11);
    std::normal_distribution<double> noise(0, 0.1);
    std::string out = "Time,FIC1.PV,FIC1.SP,FIC1.OP,FIC1.MODE,FIC2.PV,FIC2.OP\n";
    double y = 40, u = 30, integral = 30;
    for (int k = 0; k < 3000; ++k) {
        const double r = k / 700 % 2 == 0 ? 40 : 45;
        const bool automatic = k < 2000 || k > 2200;
        y += 0.1 * (1.4 * u - y) + noise(chance) * 0.3;
        integral += automatic ? 0.05 * (r - y) : 0;
        if (automatic) u = integral + 0.3 * (r - y);
        const std::string pv = k % 97 == 0 ? "Bad" : std::to_string(y + noise(chance));
        out += "2026-05-04T06:00:00." + std::string(3, '0') + "," + pv + "," + std::to_string(r) + "," +
               (k % 83 == 0 ? "" : std::to_string(u)) + "," + (automatic ? "AUTO" : "MAN") + ",Bad," +
               std::to_string(k) + "\n";
        const int seconds = 5 * k;
        char stamp[24];
        std::snprintf(stamp, sizeof stamp, "%02d:%02d:%02d.250", 6 + seconds / 3600, seconds / 60 % 60, seconds % 60);
        out.replace(out.rfind("06:00:00.000"), 12, stamp);
    }
    return out;
}

TEST(CheckRecorded, IsTheCheckOfItsRequests) {
    const auto file = recorded::read_file(operation_file());
    ASSERT_THAT(file.loops, SizeIs(2));
    const std::string request = loop_request(file.loops[0], {});
    const auto prepared = prepare_job(request);
    ASSERT_TRUE(std::holds_alternative<PreparedJob>(prepared)) << std::get<Problem>(prepared).detail;
    const auto by_request = Json::parse(run_job(std::get<PreparedJob>(prepared), {}).result_json);

    RecordedLoops recorded_loops;
    recorded_loops.loops = file.loops;
    const JobOutcome outcome = check_recorded(std::move(recorded_loops), {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::succeeded);
    Json direct = Json::parse(outcome.result_json);
    ASSERT_THAT(direct.at("loops"), SizeIs(2));
    EXPECT_EQ(direct.at("loops").at(0), by_request.at("loops").at(0));
    const Json& broken = direct.at("loops").at(1);
    EXPECT_EQ(broken.at("tag"), "FIC2");
    EXPECT_EQ(broken.at("cause").at("verdict"), "insufficient-data");
    EXPECT_THAT(direct.at("ranking"), SizeIs(2));
}

TEST(CheckRecorded, TellsWhatWasFoundOnReading) {
    auto file = recorded::read_file(operation_file());
    file.loops[0].notes = {"Something was found."};
    RecordedLoops recorded_loops;
    recorded_loops.loops = {file.loops[0]};
    const Json result = Json::parse(check_recorded(std::move(recorded_loops), {}).result_json);
    bool found = false;
    for (const Json& remark : result.at("loops").at(0).at("quality").at("remarks"))
        found = found || (remark.at("code") == "file-read" && remark.at("detail") == "Something was found.");
    EXPECT_TRUE(found);
}

TEST(JoinedRequests, AreOneRequestWithAllLoops) {
    const std::string one = R"({"loops": [{"tag": "A", "csv": "x"}], "cluster": false})";
    EXPECT_EQ(std::get<std::string>(joined_requests(one)), one);
    const auto both = joined_requests(one + "\n\n" + R"({"loops": [{"tag": "B"}, {"tag": "C"}]})" + "\n");
    const Json joined = Json::parse(std::get<std::string>(both));
    EXPECT_THAT(joined.at("loops"), SizeIs(3));
    EXPECT_EQ(joined.at("cluster"), false);
    for (const char* bad :
         {"", "{", "{\"loops\": []}\nx", "{\"loops\": []}\n{\"plant\": 1}", "{\"loops\": 1}\n{\"loops\": []}"})
        EXPECT_EQ(std::get<Problem>(joined_requests(bad)).status, 400) << bad;
}

/// Loops of one answer have one unit of time.
TEST(JoinedRequests, DifferingMembersAreRefused) {
    for (const char* second : {R"({"loops": [], "units": {"time": "min"}})", R"({"loops": [], "cluster": true})"}) {
        const auto both = joined_requests(std::string("{\"loops\": [], \"cluster\": false}\n") + second);
        ASSERT_TRUE(std::holds_alternative<Problem>(both)) << second;
        EXPECT_EQ(std::get<Problem>(both).status, 422);
    }
}

/// A file of measurements without an output.
TEST(CheckRecorded, FilesWithoutALoopAreAnError) {
    const JobOutcome outcome = check_recorded({}, {});
    EXPECT_EQ(outcome.status, JobOutcome::Status::failed);
    EXPECT_EQ(Json::parse(outcome.error_json)["status"], 422);
}

}  // namespace
}  // namespace tunewright::api
