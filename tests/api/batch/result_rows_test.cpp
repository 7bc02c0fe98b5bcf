// Results as rows and columns of text.
#include <gmock/gmock.h>

#include <algorithm>

#include "api/batch/rows.h"
#include "api/csv/csv_writer.h"
#include "api/csv/traces.h"
#include "api/json/digest.h"
#include "api/openapi/openapi.h"
#include "tests/api/support.h"

namespace tunewright::api {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> split_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    for (std::size_t end = text.find("\r\n"); end != text.npos; end = text.find("\r\n", start)) {
        lines.push_back(text.substr(start, end - start));
        start = end + 2;
    }
    EXPECT_EQ(start, text.size()) << "every line ends in CR LF";
    return lines;
}

std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> out{""};
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (c == ',' && !quoted)
            out.emplace_back();
        else
            out.back() += c;
    }
    return out;
}

/// The cell of a line of append_csv below a heading.
std::string under(const std::string& heading, const std::string& line) {
    const std::vector<std::string> headings = cells(split_lines(csv_headings()).front()), row = cells(line);
    EXPECT_EQ(headings.size(), row.size()) << line;
    for (std::size_t i = 0; i < row.size(); ++i)
        if (headings[i] == heading) return row[i];
    return "no such column";
}

std::string result_of(const std::string& members) {
    return run_job(StoredRequest{request_with(members), {}}, {}).result_json;
}

TEST(ResultRows, AsNdjsonHoldResultAndErrorAsTheyAre) {
    std::string out;
    append_ndjson({0, "id0", "a \"b\"", "succeeded", "{\"controllers\":[]}", ""}, out);
    append_ndjson({1, "id1", "", "failed", "", "{\"detail\":\"x\"}"}, out);
    append_ndjson({2, "id2", "", "queued", "", ""}, out);
    EXPECT_EQ(out,
              "{\"index\":0,\"id\":\"id0\",\"name\":\"a "
              "\\\"b\\\"\",\"status\":\"succeeded\",\"result\":{\"controllers\":[]}}\n"
              "{\"index\":1,\"id\":\"id1\",\"name\":null,\"status\":\"failed\",\"error\":{\"detail\":\"x\"}}\n"
              "{\"index\":2,\"id\":\"id2\",\"name\":null,\"status\":\"queued\"}\n");
}

TEST(ResultRows, AsNdjsonFitTheDocument) {
    const std::string result = result_of(R"("tune": [{"method": "simc"}], "evaluate": {"points": 0})");
    const std::string error = to_json({422, "invalid-request", "Not valid", "K is 0.", {}, {}});
    for (const ResultRow& row :
         {ResultRow{0, "id", "a", "succeeded", result, ""}, ResultRow{1, "id", "", "failed", "", error},
          ResultRow{2, "id", "", "queued", "", ""}}) {
        std::string line;
        append_ndjson(row, line);
        EXPECT_EQ(schema_faults(Json::parse(line), "BatchRow"), std::vector<std::string>{}) << line;
    }
}

TEST(ResultRows, AsCsvHaveOneLineForEachController) {
    const std::string result = result_of(
        R"("tune": [{"method": "simc"}, {"method": "robust"}], "baseline": {"form": "parallel", "Kp": 1, "Ki": 0.1, "Kd": 0.5}, "evaluate": {"points": 0})");
    const Json value = Json::parse(result);
    std::string out;
    append_csv({7, "id7", "TIC-101", "succeeded", result, ""}, out);
    const std::vector<std::string> lines = split_lines(out);
    ASSERT_EQ(lines.size(), value["controllers"].size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Json& entry = value["controllers"][i];
        EXPECT_EQ(under("index", lines[i]), "7");
        EXPECT_EQ(under("name", lines[i]), "TIC-101");
        EXPECT_EQ(under("method", lines[i]), entry["method"].get<std::string>());
        EXPECT_EQ(std::stod(under("Kp", lines[i])), entry["controller"]["Kp"].get<double>());
        EXPECT_EQ(std::stod(under("Ms", lines[i])), entry["robustness"]["Ms"].get<double>());
        EXPECT_EQ(std::stod(under("load_IAE", lines[i])), entry["performance"]["load"]["IAE"].get<double>());
        EXPECT_EQ(std::stod(under("settling_time", lines[i])),
                  entry["performance"]["setpoint"]["settling_time"].get<double>());
        EXPECT_EQ(under("warnings", lines[i]), std::to_string(entry["warnings"].size()));
        EXPECT_EQ(under("error", lines[i]), "");
    }
    EXPECT_EQ(under("Ti", lines[0]), "10");
    EXPECT_EQ(under("Tf", lines[0]), "");
    EXPECT_EQ(std::stod(under("Tf", lines[1])), value["controllers"][1]["controller"]["filter"]["Tf"].get<double>());
    EXPECT_EQ(under("form", lines.back()), "parallel");
    EXPECT_EQ(under("Ti", lines.back()), "");
    EXPECT_EQ(under("Kd", lines.back()), "0.5");
}

TEST(ResultRows, AsCsvHoldUnitsAndWhatIsToBeTyped) {
    const std::string result = result_of(
        R"("units": {"time": "min", "y": "degC"}, "tune": [{"method": "simc"}], "evaluate": {"points": 0},
           "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 12},
           "implement": {"product": "emerson_deltav_standard", "y_span": [0, 200], "u_span": [0, 100]})");
    const Json value = Json::parse(result);
    std::string out;
    append_csv({0, "id", "TIC-101", "succeeded", result, ""}, out);
    const std::vector<std::string> lines = split_lines(out);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(under("time_unit", lines[0]), "min");
    EXPECT_EQ(under("y_unit", lines[0]), "degC");
    EXPECT_EQ(under("u_unit", lines[0]), "") << "not named";
    const Json& typed = value["controllers"][0]["as_entered"]["as_typed"];
    EXPECT_THAT(under("settings_to_type", lines[0]),
                AllOf(HasSubstr("GAIN " + typed["GAIN"].get<std::string>() + " %/%"), HasSubstr("; STRUCTURE ")));
    const auto load = [&](int entry) -> double {
        return value["controllers"][entry]["implemented"]["performance"]["load"]["IAE"];
    };
    EXPECT_EQ(std::stod(under("today_load_IAE", lines[0])), load(1));
    EXPECT_NEAR(std::stod(under("gain_over_today_percent", lines[0])), 100 * (1 - load(0) / load(1)), 1e-9);
    EXPECT_EQ(under("gain_over_today_percent", lines[1]), "") << "today's own line";
    const Json& before = value["controllers"][1]["as_entered"]["as_typed"];
    EXPECT_THAT(under("today_settings", lines[0]),
                HasSubstr("GAIN " + before["GAIN"].get<std::string>() + " %/%; RESET"));
    const auto Ms = [&](int entry) -> double { return value["controllers"][entry]["implemented"]["robustness"]["Ms"]; };
    EXPECT_EQ(std::stod(under("worst_Ms", lines[0])), Ms(0));
    EXPECT_EQ(std::stod(under("today_Ms", lines[0])), Ms(1));
}

TEST(ResultRows, AsCsvHoldTheRiskOverAllPlants) {
    const std::string request =
        R"({"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3, "uncertainty": {"K": [0.7, 1.4]}},
            "tune": [{"method": "simc"}], "evaluate": {"points": 0},
            "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 12}})";
    const std::string result = run_job(StoredRequest{request, {}}, {}).result_json;
    const Json value = Json::parse(result);
    std::string out;
    append_csv({0, "id", "", "succeeded", result, ""}, out);
    const std::string line = split_lines(out).front();
    const Json& entry = value["controllers"][0];
    const double worst = entry["region"]["worst_Ms"];
    EXPECT_GT(worst, entry["robustness"]["Ms"].get<double>());
    EXPECT_EQ(std::stod(under("worst_Ms", line)), worst);
    EXPECT_EQ(std::stod(under("today_Ms", line)), value["controllers"][1]["region"]["worst_Ms"].get<double>());
    EXPECT_EQ(under("today_settings", line), "Kp 0.5; Ti 12 s; Td 0 s");
}

// The implemented loop differs strongly from the ideal one here: a slow program on a fast plant.
TEST(ResultRows, TheGainOverTodayIsThatOfTheVerdict) {
    const JobOutcome outcome = run_job(StoredRequest{request_with(
                                                         R"("tune": [{"method": "simc"}], "evaluate": {"points": 0},
                             "baseline": {"form": "ideal", "Kp": 0.5, "Ti": 12}, "implement": {"sample_time": 4})"),
                                                     {}},
                                       {});
    const Json value = Json::parse(outcome.result_json), outline = Json::parse(outcome.outline_json);
    std::string out;
    append_csv({0, "id", "TIC-101", "succeeded", value.dump(), ""}, out);
    const std::string line = split_lines(out).front();
    EXPECT_EQ(under("time_unit", line), "s");
    const Json& entry = value["controllers"][0];
    const auto against =
        std::ranges::find_if(entry["verdict"], [](const Json& finding) { return finding["code"] == "against-today"; });
    ASSERT_NE(against, entry["verdict"].end());
    const Json& figures = (*against)["figures"];
    EXPECT_EQ(std::stod(under("today_load_IAE", line)), figures["load_IAE_today"].get<double>());
    EXPECT_NEAR(std::stod(under("gain_over_today_percent", line)), 100 * (1 - figures["ratio"].get<double>()), 1e-9);
    EXPECT_EQ(outline["load_IAE"], figures["load_IAE"]);
    EXPECT_EQ(outline["today"]["load_IAE"], figures["load_IAE_today"]);
    EXPECT_EQ(outline["today"]["controller"]["Kp"], 0.5);
    EXPECT_GT(figures["load_IAE"].get<double>(), 1.001 * entry["performance"]["load"]["IAE"].get<double>());
}

TEST(ResultRows, AsCsvLeaveCellsEmptyWhereThereIsNoNumber) {
    std::string out;
    append_csv({0, "id", "x", "succeeded",
                R"({"controllers": [{"method": "P", "controller": {"form": "ideal", "Kp": 1, "Ti": null},
                "robustness": {"gain_margin": null}}, {"method": "imc", "error": {"detail": "no, \"never\""}}]})",
                ""},
               out);
    const std::vector<std::string> lines = split_lines(out);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(under("Ti", lines[0]), "");
    EXPECT_EQ(under("gain_margin", lines[0]), "");
    EXPECT_THAT(lines[1], HasSubstr(R"(,"no, ""never""")"));
    out.clear();
    append_csv({1, "id", "", "failed", "", R"({"detail": "K is 0"})"}, out);
    append_csv({2, "id", "", "queued", "", ""}, out);
    EXPECT_EQ(under("error", split_lines(out)[0]), "K is 0");
    EXPECT_EQ(under("status", split_lines(out)[1]), "queued");
    EXPECT_EQ(under("Kp", split_lines(out)[1]), "");
}

TEST(ResultRows, ColumnsAreThoseOfTheDocument) {
    const Json document = Json::parse(openapi_json());
    const std::string described = document["paths"]["/v1/batches/{id}/results"]["get"]["description"];
    std::string listed;
    for (const std::string& heading : cells(split_lines(csv_headings()).front()))
        listed += (listed.empty() ? "" : ", ") + heading + (heading == "warnings" ? " (how many)" : "");
    EXPECT_THAT(described, HasSubstr("columns " + listed + "."));
}

TEST(ResultRows, NoNameBecomesAFormula) {
    for (const std::string name : {"=1+1", "+1", "-1", "@A1", "\tx", "\rx"}) {
        std::string out;
        append_csv({0, "id", name, "queued", "", ""}, out);
        EXPECT_THAT(out, HasSubstr("\"'" + name + "\""));
    }
    std::string plain;
    append_csv({0, "id", "TIC=1", "queued", "", ""}, plain);
    EXPECT_THAT(plain, HasSubstr(",TIC=1,"));
}

TEST(TracesCsv, SharesTheTimesThatAreTheSame) {
    const std::string members =
        R"("units": {"time": "min", "y": "degC"}, "tune": [{"method": "simc"}, {"method": "robust"}, {"method": "robust", "Ms": 1.6}],
        "evaluate": {"points": 3, "horizon": 40})";
    const std::string result = result_of(members);
    const auto text = traces_csv(result, Traces::responses);
    ASSERT_TRUE(text);
    const std::vector<std::string> lines = split_lines(*text);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(cells(lines[0]),
                ElementsAre("t [min]", "simc setpoint y [degC]", "simc setpoint u", "simc load y [degC]", "simc load u",
                            "robust setpoint y [degC]", "robust setpoint u", "robust load y [degC]", "robust load u",
                            "robust (2) setpoint y [degC]", "robust (2) setpoint u", "robust (2) load y [degC]",
                            "robust (2) load u"));
    const Json value = Json::parse(result);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(std::stod(cells(lines[i + 1])[0]), 20.0 * static_cast<double>(i));
        EXPECT_EQ(std::stod(cells(lines[i + 1])[8]),
                  value["controllers"][1]["responses"]["load"]["u"][i].get<double>());
    }
}

TEST(TracesCsv, PutsOtherTimesBeside) {
    const std::string result = R"({"controllers": [
        {"method": "a", "responses": {"setpoint": {"t": [0, 1], "y": [0, 2], "u": [1, null]}}},
        {"method": "b", "error": {}},
        {"method": "b", "responses": {"load": {"t": [0, 1, 2], "y": [0, 3, 4], "u": [0, 5, 6]}}}]})";
    EXPECT_THAT(split_lines(traces_csv(result, Traces::responses).value_or("")),
                ElementsAre("a t [s],a setpoint y,a setpoint u,b (2) t [s],b (2) load y,b (2) load u", "0,0,1,0,0,0",
                            "1,2,,1,3,5", ",,,2,4,6"));
}

TEST(TracesCsv, OfFrequenciesAndOfAModel) {
    const std::string frequency =
        traces_csv(result_of(R"("tune": [{"method": "simc"}], "evaluate": {"points": 5})"), Traces::frequency)
            .value_or("");
    EXPECT_THAT(frequency, testing::StartsWith(
                               "omega [rad/s],simc L re,simc L im,simc L phase [deg],simc |S|,simc |T|,simc |CS|\r\n"));
    EXPECT_EQ(traces_csv(R"({"model": {"fit": {"t": [0], "u": [1], "y": [2], "y_model": [3]}}})", Traces::model),
              "t [s],u,y,y_model\r\n0,1,2,3\r\n");
}

TEST(TracesCsv, NameTheUnitOfEveryColumn) {
    const std::string fields = R"("tune": [{"method": "simc"}], "units": {"time": "min", "u": "%", "y": "degC"},
        "evaluate": {"points": 3, "own_step": {"y": 20, "target": 30, "u_max": 100, "length": 4}})";
    const std::string result = result_of(fields);
    EXPECT_EQ(split_lines(traces_csv(result, Traces::responses).value_or("")).front(),
              "simc t [min],simc setpoint y [degC],simc setpoint u [%],simc load y [degC],simc load u [%],"
              "simc t [min],simc own step r [degC],simc own step y [degC],simc own step u [%]");
    EXPECT_THAT(split_lines(traces_csv(result, Traces::frequency).value_or("")).front(),
                testing::EndsWith("simc |S|,simc |T|,simc |CS| [%/degC]"));
}

TEST(TracesCsv, AreNothingWithoutPoints) {
    const std::string result = result_of(R"("tune": [{"method": "simc"}], "evaluate": {"points": 0})");
    for (const Traces traces : {Traces::responses, Traces::frequency, Traces::model})
        EXPECT_FALSE(traces_csv(result, traces));
}

// FIPS 180-4's own example of two blocks.
TEST(Sha256, IsTheSameForEveryCut) {
    const std::string text = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
    EXPECT_EQ(sha256_hex(text), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    const std::string longer(200, 'x');
    for (std::size_t cut = 0; cut <= longer.size(); ++cut) {
        Sha256 digest;
        digest.update(longer.substr(0, cut));
        digest.update(longer.substr(cut));
        EXPECT_EQ(digest.hex(), sha256_hex(longer));
    }
}

/// The cell of a line of append_check_csv below a heading.
std::string under_check(const std::string& heading, const std::string& line) {
    const std::vector<std::string> headings = cells(split_lines(check_csv_headings()).front()), row = cells(line);
    EXPECT_EQ(headings.size(), row.size()) << line;
    for (std::size_t i = 0; i < row.size(); ++i)
        if (headings[i] == heading) return row[i];
    return "no such column";
}

TEST(ResultRows, OfACheckHaveALineForEachLoop) {
    const std::string result = R"({"units": {"time": "min", "y": "m3/h"}, "loops": [
        {"tag": "=FIC1", "cause": {"verdict": "stiction", "confidence": "sure", "size": 3.25},
         "oscillation": {"period": 54.5, "regularity": 31}, "service": {"automatic": 0.98, "manual": null,
         "saturated_low": 0.125}, "performance": {"harris": {"low": 0.01, "high": 0.34}, "idle_index": -0.9,
         "travel": 2.5, "reversals": 130}, "action": {"code": "repair-valve", "owner": "instruments"},
         "quality": {"remarks": [{}, {}]}},
        {"tag": "FIC2", "cause": {"verdict": "healthy", "confidence": "likely", "size": null},
         "performance": {"harris": null}, "action": {"code": "none", "owner": "nobody"}}],
        "ranking": [{"loop": 1, "gain": 0}, {"loop": 0, "gain": 0.5, "share": 0.25, "money": 7}]})";
    std::string out;
    append_check_csv({3, "id3", "unit", "succeeded", result, ""}, out);
    const std::vector<std::string> lines = split_lines(out);
    ASSERT_EQ(lines.size(), 2u);
    const std::pair<const char*, const char*> expected[] = {{"index", "3"},
                                                            {"name", "unit"},
                                                            {"tag", "\"'=FIC1\""},
                                                            {"verdict", "stiction"},
                                                            {"confidence", "sure"},
                                                            {"period", "54.5"},
                                                            {"regularity", "31"},
                                                            {"size", "3.25"},
                                                            {"automatic", "0.98"},
                                                            {"manual", ""},
                                                            {"saturated_low", "0.125"},
                                                            {"harris_low", "0.01"},
                                                            {"harris_high", "0.34"},
                                                            {"idle_index", "-0.9"},
                                                            {"travel", "2.5"},
                                                            {"reversals", "130"},
                                                            {"gain", "0.5"},
                                                            {"share", "0.25"},
                                                            {"money", "7"},
                                                            {"action", "repair-valve"},
                                                            {"owner", "instruments"},
                                                            {"remarks", "2"},
                                                            {"time_unit", "min"},
                                                            {"y_unit", "m3/h"},
                                                            {"error", ""}};
    for (const auto& [heading, cell] : expected) EXPECT_EQ(under_check(heading, lines[0]), cell) << heading;
    EXPECT_EQ(under_check("tag", lines[1]), "FIC2");
    EXPECT_EQ(under_check("gain", lines[1]), "0");
    EXPECT_EQ(under_check("size", lines[1]), "");
    out.clear();
    append_check_csv({4, "id4", "FIC3", "failed", "", R"({"detail": "FIC3.PV has no number."})"}, out);
    append_check_csv({5, "id5", "FIC4", "queued", "", ""}, out);
    const std::vector<std::string> others = split_lines(out);
    ASSERT_EQ(others.size(), 2u);
    EXPECT_EQ(under_check("error", others[0]), "FIC3.PV has no number.");
    EXPECT_EQ(under_check("verdict", others[0]), "");
    EXPECT_EQ(under_check("status", others[1]), "queued");
}

}  // namespace
}  // namespace tunewright::api
